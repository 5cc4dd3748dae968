#include "view/stage.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

#include "core/linear_algebra.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace detail {
namespace {

constexpr Colour kSurfaceColour = Colour::hex(0xC9D3DE);
constexpr Colour kLineColour = Colour::hex(0x5B6B7C);
/// Apart from each other and from the surface for the common kinds of colour blindness too.
constexpr std::array<Colour, 6> kPathColours = {Colour::hex(0xE4482B), Colour::hex(0x1F77C9), Colour::hex(0xF0A202),
                                                Colour::hex(0x1E9E6A), Colour::hex(0x9455C8), Colour::hex(0x12A5B0)};
constexpr Colour kFailedColour = Colour::hex(0xC77700);
constexpr Colour kPointColour = Colour::hex(0x1B2733);
constexpr Colour kCellColour = Colour::hex(0x2E9E5B);
/// Up to so many paths have the usual width; the area they cover grows no further beyond.
constexpr double kPathsAtFullWidth = 8;
constexpr double kThinnest = 0.3;

/// Brings every part of a scene into three dimensions.
class Projection {
 public:
  explicit Projection(const Scene& scene) : d_(find_dim(scene)) {
    origin_ = Vector::Zero(d_);
    if (d_ <= 3) {
      axes_ = Eigen::MatrixXd::Identity(d_, 3);
    } else {
      find_principal_axes(scene);
    }
    find_box(scene);
  }

  [[nodiscard]] Index dim() const { return d_; }

  /// The middle of everything, in three dimensions.
  [[nodiscard]] const Eigen::Vector3d& middle() const { return middle_; }

  /// In three dimensions, relative to the middle: differences stay exact in float far from the origin too.
  [[nodiscard]] Eigen::Matrix3Xf operator()(const Points& points, const char* what) const {
    return (exact(points, what).colwise() - middle_).cast<float>();
  }

 private:
  static Index find_dim(const Scene& scene) {
    if (!scene.meshes.empty()) return 3;
    if (!scene.lines.empty()) return scene.lines.front().vertices.rows();
    if (!scene.paths.empty()) return scene.paths.front().points.rows();
    if (!scene.points.empty()) return scene.points.front().position.size();
    if (scene.cells) return scene.cells->centres.rows();
    throw InvalidArgument("there is nothing in the scene to draw");
  }

  void check_dim(Index rows, const char* what) const {
    if (rows == d_ && rows >= 2) return;
    throw InvalidArgument(std::string(what) + " to draw has dimension " + std::to_string(rows) + ", the scene has " +
                          std::to_string(d_));
  }

  [[nodiscard]] Eigen::Matrix3Xd exact(const Points& points, const char* what) const {
    check_dim(points.rows(), what);
    if (!points.allFinite()) throw InvalidArgument(std::string(what) + " to draw has a coordinate that is not finite");
    return axes_.transpose() * (points.colwise() - origin_);
  }

  void find_box(const Scene& scene) {
    Eigen::AlignedBox3d box;
    const auto include = [&](const Points& points, const char* what) {
      const Eigen::Matrix3Xd projected = exact(points, what);
      for (const auto& x : projected.colwise()) box.extend(Eigen::Vector3d(x));
    };
    for (const SceneMesh& mesh : scene.meshes) include(mesh.mesh.vertices, "a mesh");
    for (const SceneLines& lines : scene.lines) include(lines.vertices, "a line");
    for (const ScenePath& path : scene.paths) include(path.points, "a path");
    for (const ScenePoint& point : scene.points) include(point.position, "a point");
    if (box.isEmpty() && scene.cells) include(scene.cells->centres, "a cell");
    if (box.isEmpty()) throw InvalidArgument("there is nothing in the scene to draw");
    middle_ = box.center();
  }

  void find_principal_axes(const Scene& scene) {
    Index n = 0;
    Vector sum = Vector::Zero(d_);
    const auto each = [&](const auto& visit) {
      for (const ScenePath& path : scene.paths) {
        check_dim(path.points.rows(), "a path");
        for (const auto& x : path.points.colwise()) visit(x);
      }
      if (!scene.paths.empty()) return;
      for (const ScenePoint& point : scene.points) {
        check_dim(point.position.size(), "a point");
        visit(point.position);
      }
      if (scene.cells) {
        for (const auto& x : scene.cells->centres.colwise()) visit(x);
      }
    };
    each([&](const auto& x) {
      sum += x;
      ++n;
    });
    origin_ = sum / static_cast<double>(std::max<Index>(n, 1));
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(d_, d_);
    each([&](const auto& x) {
      const Vector y = x - origin_;
      covariance += y * y.transpose();
    });
    if (!covariance.allFinite()) throw InvalidArgument("a path to draw has a coordinate that is not finite");
    axes_ = symmetric_eigen(covariance).vectors.rightCols(3).rowwise().reverse();
    for (auto axis : axes_.colwise()) {  // the sign of an eigenvector is arbitrary: its largest entry shall be positive
      Index largest = 0;
      axis.cwiseAbs().maxCoeff(&largest);
      if (axis(largest) < 0) axis = -axis;
    }
  }

  Index d_;
  Vector origin_;
  Eigen::MatrixXd axes_;  // d x 3
  Eigen::Vector3d middle_;
};

template <class Faces>
void check_indices(const Faces& faces, Index n, const char* what) {
  if (faces.size() == 0 || (faces.minCoeff() >= 0 && faces.maxCoeff() < n)) return;
  throw InvalidArgument(std::string(what) + " to draw refers to a vertex that is not there (of " + std::to_string(n) +
                        ")");
}

Eigen::Matrix3Xf make_normals(const StageMesh& mesh) {
  Eigen::Matrix3Xf normals = Eigen::Matrix3Xf::Zero(3, mesh.positions.cols());
  for (const auto& face : mesh.faces.colwise()) {
    const Eigen::Vector3f a = mesh.positions.col(face(0));
    const Eigen::Vector3f b = mesh.positions.col(face(1));
    const Eigen::Vector3f c = mesh.positions.col(face(2));
    const Eigen::Vector3f normal = (b - a).cross(c - a);
    for (const int v : face) normals.col(v) += normal;
  }
  for (auto normal : normals.colwise()) {
    const float length = normal.norm();
    if (length > 0) {
      normal /= length;
    } else {
      normal = Eigen::Vector3f::UnitZ();
    }
  }
  return normals;
}

StageMesh stage_mesh(const SceneMesh& scene_mesh, const Projection& project, std::string& scalar_name) {
  const TriangleMesh& mesh = scene_mesh.mesh;
  if (project.dim() != 3) throw InvalidArgument("a mesh can be drawn in 3 dimensions only");
  StageMesh result;
  result.positions = project(mesh.vertices, "a mesh");
  check_indices(mesh.faces, mesh.vertices.cols(), "a mesh");
  result.faces = mesh.faces;
  result.colour = scene_mesh.colour.value_or(kSurfaceColour);
  result.name = scene_mesh.name;
  result.normals = mesh.has_normals() ? Eigen::Matrix3Xf(mesh.normals.cast<float>()) : make_normals(result);
  if (scene_mesh.colours.cols() > 0) {
    if (scene_mesh.colours.cols() != mesh.vertices.cols()) throw InvalidArgument("a mesh needs one colour a vertex");
    result.colours = scene_mesh.colours.cast<float>();
  }
  if (!scene_mesh.coloured_by.empty()) {
    const auto scalar = std::find_if(mesh.scalars.begin(), mesh.scalars.end(),
                                     [&](const VertexScalar& s) { return s.name == scene_mesh.coloured_by; });
    if (scalar == mesh.scalars.end()) throw InvalidArgument("the mesh has no scalar named " + scene_mesh.coloured_by);
    if (scalar->values.size() != mesh.vertices.cols()) throw InvalidArgument("a mesh needs one scalar a vertex");
    result.scalar = scalar->values.cast<float>();
    for (float& s : result.scalar) {
      if (!std::isfinite(s)) s = std::numeric_limits<float>::quiet_NaN();
    }
    scalar_name = scalar->name;
  }
  return result;
}

double polyline_length(const Points& points) {
  double length = 0;
  for (Index i = 1; i < points.cols(); ++i) length += (points.col(i) - points.col(i - 1)).norm();
  return length;
}

void find_scalar_range(Stage& stage) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const StageMesh& mesh : stage.meshes) {
    for (const float s : mesh.scalar) {
      if (std::isnan(s)) continue;
      low = std::min<double>(low, s);
      high = std::max<double>(high, s);
    }
  }
  if (!(low <= high)) {
    stage.scalar_name.clear();
    for (StageMesh& mesh : stage.meshes) mesh.scalar.resize(0);
    return;
  }
  stage.scalar_min = low;
  stage.scalar_max = high > low ? high : low + 1;
}

void find_radius(Stage& stage) {
  double radius = 0;
  const auto reach = [&](const Eigen::Matrix3Xf& points) {
    if (points.cols() > 0) radius = std::max<double>(radius, points.colwise().norm().maxCoeff());
  };
  for (const StageMesh& mesh : stage.meshes) reach(mesh.positions);
  for (const StageLines& lines : stage.lines) reach(lines.positions);
  for (const StagePath& path : stage.paths) reach(path.positions);
  for (const StagePoint& point : stage.points) reach(point.position);
  if (radius == 0 || stage.cells_shown) {
    reach(stage.cell_centres);
    radius += static_cast<double>(stage.cell_size);
  }
  stage.radius = radius > 0 ? radius : 1;
}

}  // namespace
}  // namespace detail

Colour path_colour(std::size_t index) { return detail::kPathColours[index % detail::kPathColours.size()]; }

namespace detail {

bool draws_isolines(const Stage& stage) {
  return !stage.scalar_name.empty() &&
         std::ranges::none_of(stage.lines, [](const StageLines& lines) { return lines.name == "isolines"; });
}

Stage make_stage(const Scene& scene) {
  const Projection project(scene);
  Stage stage;
  stage.flat = project.dim() == 2;
  stage.origin = project.middle();
  stage.title = scene.title;
  stage.caption = scene.caption;
  if (project.dim() > 3) {
    stage.caption.push_back(
        "The path in " + std::to_string(project.dim()) +
        " dimensions, seen in its first three principal components: lengths look shorter than they are.");
  }
  for (const SceneMesh& mesh : scene.meshes) stage.meshes.push_back(stage_mesh(mesh, project, stage.scalar_name));
  for (const SceneLines& lines : scene.lines) {
    check_indices(lines.segments, lines.vertices.cols(), "a line");
    stage.lines.push_back(
        {project(lines.vertices, "a line"), lines.segments, lines.colour.value_or(kLineColour), lines.name});
  }
  const double crowding = std::clamp(
      std::sqrt(kPathsAtFullWidth / static_cast<double>(std::max<std::size_t>(scene.paths.size(), 1))), kThinnest, 1.0);
  for (const ScenePath& path : scene.paths) {
    if (path.points.cols() == 0) continue;
    const Colour chosen = path.failed ? kFailedColour : path_colour(stage.paths.size());
    const double length = std::isnan(path.length) ? polyline_length(path.points) : path.length;
    if (!(path.width > 0) || !std::isfinite(path.width)) throw InvalidArgument("a path's width must be positive");
    stage.paths.push_back({project(path.points, "a path"), path.colour.value_or(chosen), path.label, length,
                           path.width * crowding, path.failed});
  }
  for (const ScenePoint& point : scene.points) {
    if (!(point.size > 0) || !std::isfinite(point.size)) throw InvalidArgument("a point's size must be positive");
    stage.points.push_back(
        {project(point.position, "a point"), point.colour.value_or(kPointColour), point.label, point.size * crowding});
  }
  if (scene.cells) {
    stage.cell_centres = project(scene.cells->centres, "a cell");
    stage.cell_size = project.dim() <= 3 ? static_cast<float>(scene.cells->size) : 0;
    stage.cell_colour = scene.cells->colour.value_or(kCellColour);
    stage.cell_label = scene.cells->label;
    stage.cells_shown = scene.cells->shown;
  }
  if (!stage.flat) {
    if (!(scene.up.norm() > 0) || !scene.up.allFinite()) throw InvalidArgument("the scene's up direction is zero");
    if (!scene.towards_viewer.allFinite()) throw InvalidArgument("the direction to look from is not finite");
    if (project.dim() == 3) {
      stage.up = scene.up.normalized();
      stage.towards_viewer = scene.towards_viewer;
    }
  } else {
    stage.up = Eigen::Vector3d::UnitY();
  }
  find_scalar_range(stage);
  find_radius(stage);
  return stage;
}

std::vector<Eigen::Matrix3Xf> dashes_of(const Eigen::Matrix3Xf& polyline, double dash, double gap) {
  std::vector<Eigen::Matrix3Xf> dashes;
  std::vector<Eigen::Vector3f> piece = {polyline.col(0)};
  double left = dash;  // until the pen is lifted or set down
  bool down = true;
  const auto finish = [&] {
    if (piece.size() > 1) {
      dashes.emplace_back(3, static_cast<Index>(piece.size()));
      for (std::size_t i = 0; i < piece.size(); ++i) dashes.back().col(static_cast<Index>(i)) = piece[i];
    }
    piece.clear();
  };
  for (Index i = 1; i < polyline.cols(); ++i) {
    Eigen::Vector3f from = polyline.col(i - 1);
    const Eigen::Vector3f to = polyline.col(i);
    for (double rest = (to - from).norm(); rest > 0;) {
      const double step = std::min(rest, left);
      from += (to - from) * static_cast<float>(step / rest);
      if (down) piece.push_back(from);
      rest -= step;
      left -= step;
      if (left > 0) continue;
      if (down) finish();
      down = !down;
      left = down ? dash : gap;
      if (down) piece.push_back(from);
    }
  }
  finish();
  return dashes;
}

double nice_step(double range, int count) {
  const double raw = range / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double mantissa = raw / power;
  const double nice = mantissa < 1.5 ? 1 : mantissa < 3.5 ? 2 : mantissa < 7.5 ? 5 : 10;
  return nice * power;
}

std::string format_number(double value, int digits) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits);
  return {text.data(), end.ptr};
}

}  // namespace detail
}  // namespace taut
