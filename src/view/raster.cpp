#include "view/raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "core/parallel.hpp"
#include "view/cell_skin.hpp"
#include "view/shading.hpp"
#include "view/tube.hpp"

namespace taut::detail {
namespace {

constexpr int kSamples = 3;       // a side of a pixel
constexpr int kBandHeight = 16;   // pixels drawn at a time by one thread
constexpr int kBandsAtATime = 6;  // by one thread, in the same memory
constexpr float kFaint = 0.30F;   // opacity of a path behind a surface
constexpr float kCellOpacity = 0.30F;
constexpr float kCellEdgeOpacity = 0.75F;
constexpr float kNothing = -std::numeric_limits<float>::infinity();
/// The isolines of a scalar: this many, and this dark.
constexpr int kIsolines = 12;
constexpr float kIsolineShade = 0.55F;
/// Lines stand out of the mesh by this part of the scene's radius: its triangles are chords of what they lie on.
constexpr double kLineLift = 0.003;

/// A vertex ready to be rasterised.
struct ScreenVertex {
  float x = 0;  // in samples
  float y = 0;
  float nearness = 0;
  float weight = 0;        // 1 / depth, for perspective-correct interpolation; 1 in parallel projection
  Eigen::Vector3f normal;  // in camera axes
  Eigen::Vector3f view;    // towards the viewer, in camera axes
};

enum class Layer : std::uint8_t { surface, cells, path };

/// Triangles of one mesh, tube or ball on the screen.
struct Batch {
  std::vector<ScreenVertex> vertices;
  const Eigen::Matrix3Xi* faces = nullptr;
  Rgb colour;                               // linear
  const Eigen::VectorXf* scalar = nullptr;  // one a vertex, or null
  const Eigen::Matrix3Xf* colours = nullptr;
  Layer layer = Layer::surface;
  float gloss = 0.10F;
  float opacity = 1;
};

/// A line about a pixel wide.
struct ScreenLine {
  Seen a;
  Seen b;
  Rgb colour;  // linear
  Layer layer = Layer::surface;
  float opacity = 1;
};

struct ScalarScale {
  float low = 0;
  float high = 1;
  float step = 0;
};

class Projector {
 public:
  Projector(const Camera& camera, double samples) : camera_(camera), samples_(samples) {}

  [[nodiscard]] std::vector<ScreenVertex> operator()(const Eigen::Matrix3Xf& positions, const Eigen::Matrix3Xf& normals,
                                                     double lift) const {
    std::vector<ScreenVertex> vertices(static_cast<std::size_t>(positions.cols()));
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      const Eigen::Vector3d x = positions.col(static_cast<Index>(v)).cast<double>();
      const Eigen::Vector3d sight = camera_.towards_viewer(x);
      const Seen seen = camera_.see(x);
      ScreenVertex& out = vertices[v];
      out.x = static_cast<float>(seen.x * samples_);
      out.y = static_cast<float>(seen.y * samples_);
      out.nearness = static_cast<float>(lift == 0 ? seen.nearness : camera_.see(x + lift * sight).nearness);
      out.weight = camera_.parallel() ? 1.0F : static_cast<float>(seen.nearness);
      out.normal = camera_.axes().transpose().cast<float>() * normals.col(static_cast<Index>(v));
      out.view = (camera_.axes().transpose() * sight).cast<float>();
    }
    return vertices;
  }

 private:
  const Camera& camera_;
  double samples_;
};

/// A triangle's plane equations on the screen: value(x, y) = at0 + dx x + dy y of barycentric coordinates.
struct Triangle {
  std::array<const ScreenVertex*, 3> corner;
  std::array<double, 3> dx;
  std::array<double, 3> dy;
  std::array<double, 3> at0;
  int x0, x1, y0, y1;  // samples it may cover, inclusive

  /// False when it covers no sample.
  bool set(const ScreenVertex& a, const ScreenVertex& b, const ScreenVertex& c, int width, int first_row,
           int last_row) {
    corner = {&a, &b, &c};
    x0 = std::max(0, static_cast<int>(std::ceil(std::min({a.x, b.x, c.x}) - 0.5F)));
    x1 = std::min(width - 1, static_cast<int>(std::floor(std::max({a.x, b.x, c.x}) - 0.5F)));
    y0 = std::max(first_row, static_cast<int>(std::ceil(std::min({a.y, b.y, c.y}) - 0.5F)));
    y1 = std::min(last_row, static_cast<int>(std::floor(std::max({a.y, b.y, c.y}) - 0.5F)));
    if (x0 > x1 || y0 > y1) return false;
    const double area = (static_cast<double>(b.x) - a.x) * (static_cast<double>(c.y) - a.y) -
                        (static_cast<double>(b.y) - a.y) * (static_cast<double>(c.x) - a.x);
    if (area == 0 || !std::isfinite(area)) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      const ScreenVertex& p = *corner[(i + 1) % 3];
      const ScreenVertex& q = *corner[(i + 2) % 3];
      dx[i] = (static_cast<double>(p.y) - q.y) / area;
      dy[i] = (static_cast<double>(q.x) - p.x) / area;
      at0[i] = -(dx[i] * p.x + dy[i] * p.y);
    }
    return true;
  }
};

/// Rows first_row .. last_row of the samples, with their depth and colour for either layer.
class Band {
 public:
  Band(int width, const ScalarScale& scale) : width_(width), scale_(scale) {}

  /// Empties it and moves it to other rows; its memory is used again.
  void move_to(int first_row, int last_row) {
    first_row_ = first_row;
    last_row_ = last_row;
    const auto n = static_cast<std::size_t>(width_) * static_cast<std::size_t>(last_row - first_row + 1);
    for (Plane& plane : planes_) {
      plane.nearness.assign(n, kNothing);
      plane.colour.resize(4 * n);
    }
  }

  void draw(const Batch& batch) {
    Triangle triangle;
    for (const auto& face : batch.faces->colwise()) {
      const ScreenVertex& a = batch.vertices[static_cast<std::size_t>(face(0))];
      const ScreenVertex& b = batch.vertices[static_cast<std::size_t>(face(1))];
      const ScreenVertex& c = batch.vertices[static_cast<std::size_t>(face(2))];
      if (!triangle.set(a, b, c, width_, first_row_, last_row_)) continue;
      fill(batch, triangle, face);
    }
  }

  void draw(const ScreenLine& line) {
    const auto [a, b] = std::pair(line.a, line.b);
    if (std::max(a.y, b.y) * kSamples < first_row_ - kSamples || std::min(a.y, b.y) * kSamples > last_row_ + kSamples) {
      return;
    }
    const double steps = std::ceil(std::max({1.0, std::abs(b.x - a.x), std::abs(b.y - a.y)}) * kSamples);
    for (int k = 0; k <= static_cast<int>(steps); ++k) {
      const double t = k / steps;
      const int cx = static_cast<int>(std::floor((a.x + t * (b.x - a.x)) * kSamples));
      const int cy = static_cast<int>(std::floor((a.y + t * (b.y - a.y)) * kSamples));
      const auto nearness = static_cast<float>(a.nearness + t * (b.nearness - a.nearness));
      constexpr int kHalf = kSamples / 2;
      for (int y = std::max(cy - kHalf, first_row_); y <= std::min(cy + kHalf, last_row_); ++y) {
        for (int x = std::max(cx - kHalf, 0); x <= std::min(cx + kHalf, width_ - 1); ++x) {
          put(plane(line.layer), x, y, nearness, line.colour, line.opacity);
        }
      }
    }
  }

  /// The colour of a sample: linear, multiplied by alpha, with alpha.
  [[nodiscard]] Eigen::Array4f resolve(int x, int y) const {
    const std::size_t i = index(x, y);
    Eigen::Array4f result = Eigen::Array4f::Zero();
    const float surface = planes_[0].nearness[i];
    for (const Plane& plane : planes_) {
      const float nearness = plane.nearness[i];
      if (nearness == kNothing) continue;
      const bool is_path = &plane == &planes_.back();
      if (!is_path && nearness < surface) continue;  // cells behind the surface are not seen
      const float opacity = plane.colour[4 * i + 3] * (nearness >= surface ? 1 : kFaint);
      const Eigen::Array4f over(plane.colour[4 * i], plane.colour[4 * i + 1], plane.colour[4 * i + 2], 1);
      result = opacity * over + (1 - opacity) * result;
    }
    return result;
  }

 private:
  struct Plane {
    std::vector<float> nearness;
    std::vector<float> colour;  // red, green, blue, opacity
  };

  [[nodiscard]] Plane& plane(Layer layer) { return planes_[static_cast<std::size_t>(layer)]; }

  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - first_row_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  void put(Plane& plane, int x, int y, float nearness, const Rgb& colour, float opacity) const {
    const std::size_t i = index(x, y);
    if (nearness <= plane.nearness[i]) return;
    plane.nearness[i] = nearness;
    for (std::size_t channel = 0; channel < 3; ++channel)
      plane.colour[4 * i + channel] = colour(static_cast<Index>(channel));
    plane.colour[4 * i + 3] = opacity;
  }

  void fill(const Batch& batch, const Triangle& t, const Eigen::Vector3i& face) {
    Plane& drawn = plane(batch.layer);
    const float slope = scalar_slope(batch, t, face);
    for (int y = t.y0; y <= t.y1; ++y) {
      for (int x = t.x0; x <= t.x1; ++x) {
        std::array<float, 3> u{};
        bool inside = true;
        for (std::size_t i = 0; i < 3; ++i) {
          const double value = t.at0[i] + t.dx[i] * (x + 0.5) + t.dy[i] * (y + 0.5);
          inside = inside && value >= -1e-9;
          u[i] = static_cast<float>(value);
        }
        if (!inside) continue;
        const float nearness =
            u[0] * t.corner[0]->nearness + u[1] * t.corner[1]->nearness + u[2] * t.corner[2]->nearness;
        if (nearness <= drawn.nearness[index(x, y)]) continue;
        for (std::size_t i = 0; i < 3; ++i) u[i] *= t.corner[i]->weight;
        const float sum = u[0] + u[1] + u[2];
        for (float& value : u) value /= sum;
        put(drawn, x, y, nearness, colour_at(batch, t, face, u, slope), batch.opacity);
      }
    }
  }

  /// |gradient| of the scalar over the screen, a sample; 0 without one.
  [[nodiscard]] static float scalar_slope(const Batch& batch, const Triangle& t, const Eigen::Vector3i& face) {
    if (batch.scalar == nullptr) return 0;
    double gx = 0;
    double gy = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double s = (*batch.scalar)(face(static_cast<Index>(i)));
      gx += s * t.dx[i];
      gy += s * t.dy[i];
    }
    return static_cast<float>(std::hypot(gx, gy));
  }

  [[nodiscard]] Rgb colour_at(const Batch& batch, const Triangle& t, const Eigen::Vector3i& face,
                              const std::array<float, 3>& u, float slope) const {
    const auto mix = [&](const auto& of_corner) {
      return (u[0] * of_corner(0) + u[1] * of_corner(1) + u[2] * of_corner(2)).eval();
    };
    const Eigen::Vector3f normal =
        mix([&](std::size_t i) -> const Eigen::Vector3f& { return t.corner[i]->normal; }).normalized();
    const Eigen::Vector3f view =
        mix([&](std::size_t i) -> const Eigen::Vector3f& { return t.corner[i]->view; }).normalized();
    Rgb base = batch.colour;
    if (batch.colours != nullptr) {
      const Eigen::Vector3f c = mix([&](std::size_t i) { return batch.colours->col(face(static_cast<Index>(i))); });
      base = to_linear(Colour{c(0), c(1), c(2)});
    }
    if (batch.scalar != nullptr) {
      float s = 0;
      for (std::size_t i = 0; i < 3; ++i) s += u[i] * (*batch.scalar)(face(static_cast<Index>(i)));
      if (!std::isnan(s)) {
        const float at = std::clamp((s - scale_.low) / (scale_.high - scale_.low), 0.0F, 1.0F);
        base = linear_viridis()[static_cast<std::size_t>(at * 255 + 0.5F)];
        base *= isoline(s, slope);
      }
    }
    return shade(base, normal, view, batch.gloss);
  }

  /// Darkens a line about a pixel wide along each multiple of the step.
  [[nodiscard]] float isoline(float s, float slope) const {
    if (!(scale_.step > 0) || !(slope > 0)) return 1;
    const float distance = std::abs(s - scale_.step * std::round(s / scale_.step)) / slope / kSamples;  // pixels
    const float crowded = std::clamp(scale_.step / slope / kSamples / 6, 0.0F, 1.0F);
    const float line = std::clamp(1.1F - distance, 0.0F, 1.0F) * crowded;
    return 1 - (1 - kIsolineShade) * line;
  }

  int width_;
  int first_row_ = 0;
  int last_row_ = -1;
  ScalarScale scale_;
  std::array<Plane, 3> planes_;  // by layer
};

void write_pixels(const Band& band, int first, int last, Image& image) {
  for (int y = first; y < last; ++y) {
    for (int x = 0; x < image.width; ++x) {
      Eigen::Array4f sum = Eigen::Array4f::Zero();
      for (int j = 0; j < kSamples; ++j) {
        for (int i = 0; i < kSamples; ++i) sum += band.resolve(kSamples * x + i, kSamples * y + j);
      }
      sum /= kSamples * kSamples;
      const std::size_t at =
          4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
      const float alpha = sum(3);
      if (alpha <= 0) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        image.rgba[at + c] = static_cast<std::uint8_t>(255 * to_srgb(sum(static_cast<Index>(c)) / alpha) + 0.5F);
      }
      image.rgba[at + 3] = static_cast<std::uint8_t>(255 * std::min(alpha, 1.0F) + 0.5F);
    }
  }
}

/// Everything of a stage on the screen.
class Screen {
 public:
  Screen(const Stage& stage, const Camera& camera, const RenderOptions& options)
      : stage_(stage), camera_(camera), project_(camera, kSamples) {
    for (const StageMesh& mesh : stage.meshes) add(mesh);
    for (const StageLines& lines : stage.lines) {
      add_lines(lines.positions, lines.segments, kLineLift * stage.radius, to_linear(lines.colour), Layer::surface, 1);
    }
    if (stage.cells_shown && stage.cell_size > 0) add_cells();
    if (options.paths) add_paths(0.5 * options.path_width / camera.scale());
  }

  void draw(Band& band) const {
    for (const Batch& batch : batches_) band.draw(batch);
    for (const ScreenLine& line : lines_) band.draw(line);
  }

 private:
  void add(const StageMesh& mesh) {
    Batch batch{
        .vertices = project_(mesh.positions, mesh.normals, 0), .faces = &mesh.faces, .colour = to_linear(mesh.colour)};
    if (mesh.scalar.size() > 0) batch.scalar = &mesh.scalar;
    if (mesh.colours.cols() > 0) batch.colours = &mesh.colours;
    batches_.push_back(std::move(batch));
  }

  /// `lift`: how far the lines stand out of what they lie on, towards the viewer.
  void add_lines(const Eigen::Matrix3Xf& positions, const Eigen::Matrix2Xi& segments, double lift, const Rgb& colour,
                 Layer layer, float opacity) {
    std::vector<Seen> seen;
    seen.reserve(static_cast<std::size_t>(positions.cols()));
    for (const auto& position : positions.colwise()) {
      const Eigen::Vector3d x = position.cast<double>();
      seen.push_back(camera_.see(x));
      if (lift > 0) seen.back().nearness = camera_.see(x + lift * camera_.towards_viewer(x)).nearness;
    }
    for (const auto& segment : segments.colwise()) {
      lines_.push_back({seen[static_cast<std::size_t>(segment(0))], seen[static_cast<std::size_t>(segment(1))], colour,
                        layer, opacity});
    }
  }

  void add_cells() {
    skin_ = make_cell_skin(stage_);
    const Rgb colour = to_linear(stage_.cell_colour);
    batches_.push_back({.vertices = project_(skin_.positions, skin_.normals, 0),
                        .faces = &skin_.faces,
                        .colour = colour,
                        .layer = Layer::cells,
                        .gloss = 0,
                        .opacity = kCellOpacity});
    add_lines(skin_.positions, skin_.edges, 0.05 * static_cast<double>(stage_.cell_size), 0.5F * colour, Layer::cells,
              kCellEdgeOpacity);
  }

  void add_paths(double radius) {
    const double lift = kPathLift * stage_.radius;
    const auto add_tube = [&](Tube tube, const Colour& colour, double extra_lift) {
      tubes_.push_back(std::make_unique<Tube>(std::move(tube)));
      const Tube& kept = *tubes_.back();
      batches_.push_back({.vertices = project_(kept.positions, kept.normals, lift + extra_lift),
                          .faces = &kept.faces,
                          .colour = to_linear(colour),
                          .layer = Layer::path,
                          .gloss = 0.22F});
    };
    for (const StagePath& path : stage_.paths) {
      const auto thick = static_cast<float>(radius * path.width);
      if (!path.failed) {
        add_tube(make_tube(path.positions, thick), path.colour, 0);
        continue;
      }
      for (const Eigen::Matrix3Xf& dash : dashes_of(path.positions, kDash * stage_.radius, kDashGap * stage_.radius)) {
        add_tube(make_tube(dash, thick), path.colour, 0);
      }
    }
    for (const StagePoint& point : stage_.points) {
      const double ball = 2 * radius * point.size;
      add_tube(make_ball(point.position, static_cast<float>(ball)), point.colour, 0.5 * ball);
    }
  }

  const Stage& stage_;
  const Camera& camera_;
  Projector project_;
  std::vector<Batch> batches_;
  std::vector<ScreenLine> lines_;
  std::vector<std::unique_ptr<Tube>> tubes_;  // what batches point into
  CellSkin skin_;
};

}  // namespace

Image render(const Stage& stage, const Camera& camera, const RenderOptions& options, const Context& context) {
  const Screen screen(stage, camera, options);
  const double range = stage.scalar_max - stage.scalar_min;
  const bool isolines = options.isolines && draws_isolines(stage);
  const ScalarScale scale{static_cast<float>(stage.scalar_min), static_cast<float>(stage.scalar_max),
                          isolines ? static_cast<float>(nice_step(range, kIsolines)) : 0};
  Image image{options.width, options.height, {}};
  image.rgba.assign(4 * static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height), 0);
  parallel_for(context, 0, options.height, kBandsAtATime * kBandHeight, [&](Index first, Index last) {
    Band band(kSamples * options.width, scale);
    for (Index row = first; row < last; row += kBandHeight) {
      const Index end = std::min<Index>(row + kBandHeight, last);
      band.move_to(kSamples * static_cast<int>(row), kSamples * static_cast<int>(end) - 1);
      screen.draw(band);
      write_pixels(band, static_cast<int>(row), static_cast<int>(end), image);
    }
  });
  return image;
}

bool DepthImage::hides(const Seen& point) const {
  const int x = static_cast<int>(std::floor(point.x));
  const int y = static_cast<int>(std::floor(point.y));
  if (x < 0 || y < 0 || x >= width || y >= height) return false;
  const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  return nearness[at] > static_cast<float>(point.nearness);
}

DepthImage render_depth(const Stage& stage, const Camera& camera, int width, int height) {
  DepthImage image{width, height, {}};
  image.nearness.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNothing);
  const Projector project(camera, 1);
  Triangle t;
  for (const StageMesh& mesh : stage.meshes) {
    const std::vector<ScreenVertex> vertices = project(mesh.positions, mesh.normals, 0);
    for (const auto& face : mesh.faces.colwise()) {
      if (!t.set(vertices[static_cast<std::size_t>(face(0))], vertices[static_cast<std::size_t>(face(1))],
                 vertices[static_cast<std::size_t>(face(2))], width, 0, height - 1)) {
        continue;
      }
      for (int y = t.y0; y <= t.y1; ++y) {
        for (int x = t.x0; x <= t.x1; ++x) {
          double near = 0;
          bool inside = true;
          for (std::size_t i = 0; i < 3; ++i) {
            const double u = t.at0[i] + t.dx[i] * (x + 0.5) + t.dy[i] * (y + 0.5);
            inside = inside && u >= -1e-9;
            near += u * t.corner[i]->nearness;
          }
          if (!inside) continue;
          float& kept = image.nearness[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                       static_cast<std::size_t>(x)];
          kept = std::max(kept, static_cast<float>(near));
        }
      }
    }
  }
  return image;
}

}  // namespace taut::detail
