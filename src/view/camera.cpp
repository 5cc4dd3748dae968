#include "view/camera.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <unordered_map>

namespace taut::detail {
namespace {

/// An orthonormal frame of the horizon for an up direction: columns u, v, up. For up = z it is the identity.
Eigen::Matrix3d horizon_frame(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up).toRotationMatrix();
}

Eigen::Vector3d direction(const Eigen::Matrix3d& frame, double azimuth, double elevation) {
  return frame * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                 std::sin(elevation));
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

/// Points spread along all paths by length, with the length each stands for.
struct PathSamples {
  std::vector<Eigen::Vector3d> ends;  // two a piece
  std::vector<double> length;         // one a piece
};

PathSamples sample_paths(const Stage& stage) {
  constexpr double kPieces = 800;
  double total = 0;
  for (const StagePath& path : stage.paths) {
    for (Index i = 1; i < path.positions.cols(); ++i)
      total += (path.positions.col(i) - path.positions.col(i - 1)).norm();
  }
  PathSamples samples;
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
        samples.ends.emplace_back(from + (to - from) * k / pieces);
        samples.ends.emplace_back(from + (to - from) * (k + 1) / pieces);
        samples.length.push_back(length / pieces);
      }
      from = to;
    }
  }
  return samples;
}

}  // namespace

Camera::Camera(const Stage& stage, const Eigen::Vector3d& towards_viewer)
    : distance_(kDistance * stage.radius), parallel_(stage.flat) {
  const Eigen::Vector3d back = towards_viewer.normalized();
  Eigen::Vector3d right = stage.up.cross(back);
  // Looking straight down or up, "up" says nothing: any direction of the horizon serves.
  if (right.norm() < 1e-6) right = horizon_frame(stage.up).col(0);
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
  if (!(x0 <= x1)) include(stage.cell_centres);
  const double tiny = 1e-3 * stage.radius;
  scale_ = std::min((right - left) / std::max(x1 - x0, tiny), (bottom - top) / std::max(y1 - y0, tiny));
  shift_x_ = 0.5 * (left + right) - scale_ * 0.5 * (x0 + x1);
  shift_y_ = 0.5 * (top + bottom) - scale_ * 0.5 * (y0 + y1);
}

Eigen::Vector3d choose_view(const Stage& stage) {
  if (stage.flat) return Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d frame = horizon_frame(stage.up);
  constexpr double kDegree = std::numbers::pi / 180;
  const Eigen::Vector3d usual = direction(frame, -60 * kDegree, 24 * kDegree);
  const PathSamples samples = sample_paths(stage);
  if (samples.length.empty()) return usual;
  const Blocker blocker = make_blocker(stage);

  Eigen::Vector3d best = usual;
  double best_score = -std::numeric_limits<double>::infinity();
  for (const double elevation : {24.0, 8.0, 42.0, 62.0, -12.0, -35.0, -62.0}) {
    for (int k = 0; k < 16; ++k) {
      const double azimuth = -60 + 22.5 * k;
      const Eigen::Vector3d view = direction(frame, azimuth * kDegree, elevation * kDegree);
      Camera camera(stage, view);
      camera.fit(stage, 2, 2, BlockedView::kSize - 2, BlockedView::kSize - 2);
      const BlockedView blocked(blocker, camera);
      double seen_length = 0;
      double total = 0;
      for (std::size_t i = 0; i < samples.length.size(); ++i) {
        const Eigen::Vector3d& a = samples.ends[2 * i];
        const Eigen::Vector3d& b = samples.ends[2 * i + 1];
        total += samples.length[i];
        const Eigen::Vector3d middle = 0.5 * (a + b);
        const Eigen::Vector3d lifted = middle + 0.04 * stage.radius * camera.towards_viewer(middle);
        if (!blocked.visible(camera.see(lifted))) continue;
        const Eigen::Vector3d sight = camera.towards_viewer(middle);
        const double across = (b - a).cross(sight).norm();
        seen_length += 0.4 * samples.length[i] + 0.6 * across;
      }
      const double tilt = std::abs(elevation - 24) / 90;
      const double turn = std::min(k, 16 - k) / 8.0;
      const double score = seen_length / total - 0.12 * tilt - 0.01 * turn;
      if (score > best_score + 1e-9) {
        best_score = score;
        best = view;
      }
    }
  }
  return best;
}

}  // namespace taut::detail
