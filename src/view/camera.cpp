#include "view/camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <vector>

#include "taut/core/error.hpp"

namespace taut {
namespace detail {
namespace {

/// An orthonormal frame of the horizon for a unit up direction: columns u, v, up, where u is as near to the x axis as
/// the horizon allows (to the y axis where x points up). For up = z it is the identity.
Eigen::Matrix3d horizon_frame(const Eigen::Vector3d& up) {
  constexpr double kNearlyUp = 0.9;
  const Eigen::Vector3d axis = Eigen::Vector3d::Unit(std::abs(up.x()) > kNearlyUp ? 1 : 0);
  Eigen::Matrix3d frame;
  frame.col(0) = (axis - axis.dot(up) * up).normalized();
  frame.col(1) = up.cross(frame.col(0));
  frame.col(2) = up;
  return frame;
}

/// In degrees.
Eigen::Vector3d direction(const Eigen::Matrix3d& frame, double azimuth, double elevation) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double a = azimuth * kDegree;
  const double e = elevation * kDegree;
  return frame * Eigen::Vector3d(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
}

/// A coarse stand-in for the meshes, only for finding out what hides what: vertices merged within blocks of space.
struct Blocker {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3i> faces;
};

Blocker make_blocker(const Stage& stage) {
  constexpr Index kFacesWanted = 4000;
  Blocker blocker;
  for (const StageMesh& mesh : stage.meshes) {
    const auto first = static_cast<int>(blocker.positions.size());
    if (mesh.faces.cols() <= kFacesWanted) {
      for (const auto& x : mesh.positions.colwise()) blocker.positions.emplace_back(x.cast<double>());
      for (const auto& face : mesh.faces.colwise()) blocker.faces.emplace_back(face.array() + first);
      continue;
    }
    const double block = 2 * stage.radius / 32;
    std::unordered_map<std::int64_t, int> number;
    std::vector<int> merged(static_cast<std::size_t>(mesh.positions.cols()));
    for (Index v = 0; v < mesh.positions.cols(); ++v) {
      const Eigen::Vector3d x = mesh.positions.col(v).cast<double>();
      const Eigen::Vector3d cell = (x / block).array().floor() + 512;
      const std::int64_t key = (static_cast<std::int64_t>(cell.x()) << 40) +
                               (static_cast<std::int64_t>(cell.y()) << 20) + static_cast<std::int64_t>(cell.z());
      const auto [it, is_new] = number.emplace(key, static_cast<int>(blocker.positions.size()));
      if (is_new) blocker.positions.push_back(x);
      merged[static_cast<std::size_t>(v)] = it->second;
    }
    for (const auto& face : mesh.faces.colwise()) {
      const Eigen::Vector3i f(merged[static_cast<std::size_t>(face(0))], merged[static_cast<std::size_t>(face(1))],
                              merged[static_cast<std::size_t>(face(2))]);
      if (f(0) != f(1) && f(1) != f(2) && f(2) != f(0)) blocker.faces.push_back(f);
    }
  }
  return blocker;
}

/// A small depth buffer of the blocker.
class BlockedView {
 public:
  static constexpr int kSize = 96;

  BlockedView(const Blocker& blocker, const Camera& camera)
      : nearness_(kSize * kSize, -std::numeric_limits<double>::infinity()) {
    std::vector<Seen> seen;
    seen.reserve(blocker.positions.size());
    for (const Eigen::Vector3d& x : blocker.positions) seen.push_back(camera.see(x));
    for (const Eigen::Vector3i& f : blocker.faces) {
      draw(seen[static_cast<std::size_t>(f(0))], seen[static_cast<std::size_t>(f(1))],
           seen[static_cast<std::size_t>(f(2))]);
    }
  }

  [[nodiscard]] bool visible(const Seen& p) const {
    const int x = static_cast<int>(p.x);
    const int y = static_cast<int>(p.y);
    if (x < 0 || y < 0 || x >= kSize || y >= kSize) return true;
    return p.nearness >= nearness_[static_cast<std::size_t>(y * kSize + x)];
  }

 private:
  void draw(const Seen& a, const Seen& b, const Seen& c) {
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (area == 0) return;
    const int x0 = std::max(0, static_cast<int>(std::min({a.x, b.x, c.x})));
    const int x1 = std::min(kSize - 1, static_cast<int>(std::max({a.x, b.x, c.x})));
    const int y0 = std::max(0, static_cast<int>(std::min({a.y, b.y, c.y})));
    const int y1 = std::min(kSize - 1, static_cast<int>(std::max({a.y, b.y, c.y})));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double px = x + 0.5;
        const double py = y + 0.5;
        const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
        const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        double& nearness = nearness_[static_cast<std::size_t>(y * kSize + x)];
        nearness = std::max(nearness, u * a.nearness + v * b.nearness + (1 - u - v) * c.nearness);
      }
    }
  }

  std::vector<double> nearness_;
};

/// A short piece of a path, or a point, that should be seen.
struct Sight {
  Eigen::Vector3d middle;
  Eigen::Vector3d along;   ///< unit; zero for a point
  Eigen::Vector3d normal;  ///< of the surface there; zero where there is none
  double weight = 0;       ///< its length
};

/// The mesh vertices in blocks of space, to find the one nearest to a point on the surface.
class NormalLookup {
 public:
  explicit NormalLookup(const Stage& stage) : block_(2 * stage.radius / kBlocks) {
    for (const StageMesh& mesh : stage.meshes) {
      for (Index v = 0; v < mesh.positions.cols(); ++v) {
        const std::int64_t block = key(mesh.positions.col(v).cast<double>());
        normals_.try_emplace(block, Eigen::Vector3d::Zero()).first->second += mesh.normals.col(v).cast<double>();
      }
    }
  }

  /// The mean normal round x, unit or zero.
  [[nodiscard]] Eigen::Vector3d near(const Eigen::Vector3d& x) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto found = normals_.find(key(x + block_ * Eigen::Vector3d(i, j, k)));
          // Of the block itself first: those beside it may belong to the other side of a thin body.
          if (found != normals_.end()) sum += (i == 0 && j == 0 && k == 0 ? 1.0 : 0.05) * found->second.normalized();
        }
      }
    }
    return sum.norm() > 0.02 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d::Zero();
  }

 private:
  static constexpr double kBlocks = 48;

  [[nodiscard]] std::int64_t key(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d cell = (x / block_).array().floor() + 512;
    return (static_cast<std::int64_t>(cell.x()) << 40) + (static_cast<std::int64_t>(cell.y()) << 20) +
           static_cast<std::int64_t>(cell.z());
  }

  double block_;
  std::unordered_map<std::int64_t, Eigen::Vector3d> normals_;
};

/// Pieces spread along all paths by length, and the points.
std::vector<Sight> find_sights(const Stage& stage) {
  constexpr double kPieces = 800;
  constexpr double kPointPieces = 40;  // what a point counts for, in pieces
  double total = 0;
  for (const StagePath& path : stage.paths) {
    for (Index i = 1; i < path.positions.cols(); ++i)
      total += (path.positions.col(i) - path.positions.col(i - 1)).norm();
  }
  const NormalLookup normals(stage);
  std::vector<Sight> sights;
  const double step = total / kPieces;
  for (const StagePath& path : stage.paths) {
    if (path.positions.cols() < 2) continue;
    Eigen::Vector3d from = path.positions.col(0).cast<double>();
    for (Index i = 1; i < path.positions.cols(); ++i) {
      const Eigen::Vector3d to = path.positions.col(i).cast<double>();
      const double length = (to - from).norm();
      if (length < step && i + 1 < path.positions.cols()) continue;
      const int pieces = step > 0 ? std::clamp(static_cast<int>(length / step), 1, 800) : 1;
      for (int k = 0; k < pieces; ++k) {
        const Eigen::Vector3d middle = from + (to - from) * (k + 0.5) / pieces;
        sights.push_back({middle, (to - from).normalized(), normals.near(middle), length / pieces});
      }
      from = to;
    }
  }
  for (const StagePoint& point : stage.points) {
    const Eigen::Vector3d x = point.position.cast<double>();
    const double weight = step > 0 ? step * kPointPieces / static_cast<double>(stage.points.size()) : 1;
    sights.push_back({x, Eigen::Vector3d::Zero(), normals.near(x), weight});
  }
  return sights;
}

/// Where the meshes face on the whole: the sum of their faces' area vectors over their area. Zero for a closed surface;
/// for an open scan it points to the side that was scanned.
Eigen::Vector3d mean_facing(const Stage& stage) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (const StageMesh& mesh : stage.meshes) {
    for (const auto& face : mesh.faces.colwise()) {
      const Eigen::Vector3d a = mesh.positions.col(face(0)).cast<double>();
      const Eigen::Vector3d ab = mesh.positions.col(face(1)).cast<double>() - a;
      const Eigen::Vector3d ac = mesh.positions.col(face(2)).cast<double>() - a;
      const Eigen::Vector3d normal = ab.cross(ac);
      sum += normal;
      area += normal.norm();
    }
  }
  return area > 0 ? Eigen::Vector3d(sum / area) : Eigen::Vector3d::Zero();
}

/// How well a direction shows the paths and points: the part of them that is unhidden and seen from outside, more of it
/// where it is not foreshortened.
double seen_part(const std::vector<Sight>& sights, const Stage& stage, const Blocker& blocker,
                 const Eigen::Vector3d& view) {
  // What a piece counts where it is unhidden but seen from the surface's inner side.
  constexpr double kFromInside = 0.15;
  Camera camera(stage, view);
  camera.fit(stage, 2, 2, BlockedView::kSize - 2, BlockedView::kSize - 2);
  const BlockedView blocked(blocker, camera);
  double seen = 0;
  double total = 0;
  for (const Sight& sight : sights) {
    total += sight.weight;
    const Eigen::Vector3d towards = camera.towards_viewer(sight.middle);
    const Eigen::Vector3d lifted = sight.middle + 0.04 * stage.radius * towards;
    if (!blocked.visible(camera.see(lifted))) continue;
    const double across = sight.along.isZero() ? 1 : sight.along.cross(towards).norm();
    const double outside = sight.normal.dot(towards) < 0 ? kFromInside : 1;
    seen += sight.weight * outside * (0.4 + 0.6 * across);
  }
  return total > 0 ? seen / total : 0;
}

}  // namespace

Camera::Camera(const Stage& stage, const Eigen::Vector3d& towards_viewer)
    : distance_(kDistance * stage.radius), parallel_(stage.flat) {
  const Eigen::Vector3d back = towards_viewer.normalized();
  Eigen::Vector3d right = stage.up.cross(back);
  // Looking straight down or up, "up" says nothing: any direction of the horizon serves.
  constexpr double kStraight = 1e-6;
  if (right.norm() < kStraight) right = horizon_frame(stage.up).col(0);
  right.normalize();
  axes_ << right, back.cross(right), back;
}

void Camera::fit(const Stage& stage, double left, double top, double right, double bottom) {
  scale_ = 1;
  shift_x_ = shift_y_ = 0;
  double x0 = std::numeric_limits<double>::infinity();
  double x1 = -x0;
  double y0 = x0;
  double y1 = -x0;
  const auto include = [&](const Eigen::Matrix3Xf& points) {
    for (const auto& p : points.colwise()) {
      const Seen seen = see(p.cast<double>());
      x0 = std::min(x0, seen.x);
      x1 = std::max(x1, seen.x);
      y0 = std::min(y0, seen.y);
      y1 = std::max(y1, seen.y);
    }
  };
  for (const StageMesh& mesh : stage.meshes) include(mesh.positions);
  for (const StageLines& lines : stage.lines) include(lines.positions);
  for (const StagePath& path : stage.paths) include(path.positions);
  for (const StagePoint& point : stage.points) include(point.position);
  if (stage.cells_shown) {
    include(stage.cell_centres.array() - 0.5F * stage.cell_size);
    include(stage.cell_centres.array() + 0.5F * stage.cell_size);
  }
  if (!(x0 <= x1)) include(stage.cell_centres);
  const double tiny = 1e-3 * stage.radius;
  scale_ = std::min((right - left) / std::max(x1 - x0, tiny), (bottom - top) / std::max(y1 - y0, tiny));
  shift_x_ = 0.5 * (left + right) - scale_ * 0.5 * (x0 + x1);
  shift_y_ = 0.5 * (top + bottom) - scale_ * 0.5 * (y0 + y1);
}

Eigen::Vector3d choose_view(const Stage& stage) {
  if (stage.flat) return Eigen::Vector3d::UnitZ();
  constexpr double kUsualAzimuth = -60;
  constexpr double kUsualElevation = 24;
  // Weights against the part of the paths that is seen.
  constexpr double kFacing = 0.6;
  constexpr double kTilt = 0.12 / 90;   // a degree from the usual elevation
  constexpr double kTurn = 0.01 / 180;  // a degree from the usual azimuth
  const Eigen::Matrix3d frame = horizon_frame(stage.up);
  const std::vector<Sight> sights = find_sights(stage);
  const Eigen::Vector3d facing = mean_facing(stage);
  constexpr double kOpen = 0.02;  // below it, a closed surface and rounding
  Eigen::Vector3d best = direction(frame, kUsualAzimuth, kUsualElevation);
  if (sights.empty() && facing.norm() < kOpen) return best;
  const Blocker blocker = make_blocker(stage);
  double best_score = -std::numeric_limits<double>::infinity();
  for (const double elevation : {24.0, 8.0, 42.0, 62.0, -12.0, -35.0, -62.0}) {
    for (int k = 0; k < 16; ++k) {
      const Eigen::Vector3d view = direction(frame, kUsualAzimuth + 22.5 * k, elevation);
      const double turn = 22.5 * std::min(k, 16 - k);
      const double score = seen_part(sights, stage, blocker, view) + kFacing * facing.dot(view) -
                           kTilt * std::abs(elevation - kUsualElevation) - kTurn * turn;
      if (score > best_score + 1e-9) {
        best_score = score;
        best = view;
      }
    }
  }
  return best;
}

}  // namespace detail

Eigen::Vector3d view_direction(double azimuth, double elevation, const Eigen::Vector3d& up) {
  if (!std::isfinite(azimuth) || !(std::abs(elevation) <= 90)) {
    throw InvalidArgument("a view needs a finite azimuth and an elevation from -90 to 90 degrees");
  }
  if (!(up.norm() > 0) || !up.allFinite()) throw InvalidArgument("the up direction of a view is zero or not finite");
  // Straight from above or below, a hair aside: so the azimuth still says which way the picture is turned.
  constexpr double kSteepest = 89.999;
  return detail::direction(detail::horizon_frame(up.normalized()), azimuth,
                           std::clamp(elevation, -kSteepest, kSteepest));
}

}  // namespace taut
