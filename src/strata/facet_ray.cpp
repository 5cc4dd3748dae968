// A ray over several faces. On each it is the geodesic of the face's zero set, followed by strides. Where a stride
// first leaves its face is found by bounds: parts of it whose box no condition changes its sign in stay on the face,
// others are halved. Newton's method for the condition that fails there then gives the arc length of the crossing, and
// the ring of faces what lies beyond: with e the edge's direction, N the next face's normal and a = v . e, the ray goes
// on along a e + sqrt(1 - a^2) m, where m = +-N x e points into that face.
#include "strata/facet_ray.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "strata/chain_tolerances.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// A stride is no longer than this part of the model.
constexpr double kStride = 0.5;
/// Halvings of the way between two points of a stride.
constexpr int kMostHalvings = 10;
/// A box around such a part is wider by this part of its length, since it is curved.
constexpr double kBulge = 0.25;
/// Conditions that vanish within this, of the model's size, meet in one point.
constexpr double kAtPoint = 1e-8;
/// Sine of the angle with an edge below which a ray runs along it.
constexpr double kGrazing = 1e-7;
constexpr int kMostRefinements = 30;
constexpr int kMostFaces = 10000;
constexpr double kRounding = 1e-15;

class FacetTracer {
 public:
  FacetTracer(FacetedSurface& surface, const ExponentialOptions& options, const Context& context)
      : s_(surface), options_(options), context_(context), slack_(ChainTolerances::on_edge * surface.scale) {
    options_.points = true;
  }

  [[nodiscard]] FacetRay run(const Point3& x, const Point3& direction, double length);

 private:
  struct Exit {
    double at;  // about: by the chords
    int condition;
  };
  [[nodiscard]] bool begin(const Point3& x, const Point3& direction);
  [[nodiscard]] std::optional<Exit> exit_of(const Points& line);
  [[nodiscard]] std::optional<Exit> exit_between(const Point3& a, const Point3& b, double at, int halvings);
  [[nodiscard]] bool refine(ExponentialMap& map, const Exit& exit, double longest, ExponentialResult& stride);
  void take(const ExponentialResult& stride);
  [[nodiscard]] bool cross(int condition);
  void stop(Status status, const char* reason) {
    result_.ray.status = status;
    result_.ray.reason = reason;
  }

  FacetedSurface& s_;
  ExponentialOptions options_;
  const Context& context_;
  double slack_;
  FacetRay result_;
  int face_ = -1;
  Point3 x_ = Point3::Zero();
  Point3 v_ = Point3::Zero();
  std::vector<Point3> points_;
};

/// On an edge or in a corner the ray begins on the face that the direction points into.
bool FacetTracer::begin(const Point3& x, const Point3& direction) {
  x_ = x;
  const Point3 unit = direction.normalized();
  const std::optional<Star> star = s_.star(x, kAtPoint * s_.scale);
  if (!star) {
    face_ = s_.face_at(x);
    v_ = unit;
    return s_.violation(face_, x) <= slack_;
  }
  double best = 0;
  for (const Wedge& wedge : star->wedges) {
    const Point3 flat = unit - wedge.normal * wedge.normal.dot(unit);
    if (!(flat.norm() > best)) continue;
    constexpr double kAllAround = 6.28;
    if (wedge.angle < kAllAround) {
      constexpr double kBeside = 1e-9;  // radians
      double angle = std::atan2(flat.dot(wedge.normal.cross(wedge.first)), flat.dot(wedge.first));
      if (angle < -kBeside) angle += 2 * std::numbers::pi;
      if (angle > wedge.angle + kBeside) continue;
    }
    best = flat.norm();
    face_ = wedge.face;
    v_ = flat.normalized();
  }
  return best > 0;
}

std::optional<FacetTracer::Exit> FacetTracer::exit_between(const Point3& a, const Point3& b, double at, int halvings) {
  const Point3 bulge = Point3::Constant(kBulge * (b - a).norm());
  const Box box{a.cwiseMin(b) - bulge, a.cwiseMax(b) + bulge};
  std::vector<int> open;
  s_.undecided(box, open);
  int condition = -1;
  if (open.empty()) return std::nullopt;
  if (halvings == 0) {
    if (s_.violation(face_, b, &condition) > slack_) return Exit{at + (b - a).norm() / 2, condition};
    return std::nullopt;
  }
  Point3 middle = (a + b) / 2;
  (void)s_.project(face_, {}, middle);
  if (std::optional<Exit> exit = exit_between(a, middle, at, halvings - 1)) return exit;
  return exit_between(middle, b, at + (middle - a).norm(), halvings - 1);
}

std::optional<FacetTracer::Exit> FacetTracer::exit_of(const Points& line) {
  double at = 0;
  for (Index j = 0; j + 1 < line.cols(); ++j) {
    const Point3 a = line.col(j);
    const Point3 b = line.col(j + 1);
    if (std::optional<Exit> exit = exit_between(a, b, at, kMostHalvings)) return exit;
    at += (b - a).norm();
  }
  return std::nullopt;
}

/// The stride that ends where the condition vanishes.
bool FacetTracer::refine(ExponentialMap& map, const Exit& exit, double longest, ExponentialResult& stride) {
  double t = exit.at;
  double before = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostRefinements; ++step) {
    if (!(t > 0 && t <= longest)) return false;
    stride = map.trace(x_, v_, t, context_);
    if (stride.status != Status::ok) return false;
    Point3 gradient;
    const double value = s_.condition(exit.condition, stride.point, gradient);
    const double slope = gradient.dot(Point3(stride.direction));
    const double change = value / slope;
    if (!std::isfinite(change)) return false;
    // Where rounding is reached steps shrink no more.
    if (std::abs(change) <= kRounding * s_.scale || (std::abs(change) <= slack_ && std::abs(change) >= before / 2)) {
      return true;
    }
    before = std::abs(change);
    t -= change;
  }
  return false;
}

/// What a stride adds. An error so far grows on it, in place and in direction.
void FacetTracer::take(const ExponentialResult& stride) {
  ExponentialResult& ray = result_.ray;
  const double grown = (ray.error + ray.direction_error) * stride.amplification;
  ray.error = grown + stride.error;
  ray.direction_error = grown + stride.direction_error;
  ray.amplification = std::max(1.0, ray.amplification) * stride.amplification;
  ray.length += stride.length;
  ray.off_surface = std::max(ray.off_surface, stride.off_surface);
  ray.num_steps += stride.num_steps;
  ray.num_evaluated += stride.num_evaluated;
  result_.arcs.back().length += stride.length;
  for (Index j = 0; j < stride.points.cols(); ++j) {
    const Point3 x = stride.points.col(j);
    if (points_.empty() || points_.back() != x) points_.push_back(x);
  }
  x_ = stride.point;
  v_ = stride.direction;
}

/// Over the edge that the ray has come to. False where it ends there.
bool FacetTracer::cross(int condition) {
  Point3 foot = x_;
  if (s_.project(face_, {condition}, foot) && (foot - x_).norm() <= slack_) x_ = foot;
  const std::optional<Star> star = s_.star(x_, kAtPoint * s_.scale);
  if (!star) {
    stop(Status::not_converged, "the surface is singular here");
    return false;
  }
  const std::size_t n = star->wedges.size();
  if (n > 2 || (n == 2 && !star->closed)) {
    stop(Status::not_converged, "it meets a corner, beyond which it has no direction");
    return false;
  }
  const auto own =
      std::find_if(star->wedges.begin(), star->wedges.end(), [&](const Wedge& wedge) { return wedge.face == face_; });
  if (own == star->wedges.end() || (n == 1 && star->closed)) {
    stop(Status::not_converged, "it leaves its face where no edge is known");
    return false;
  }
  const double along = v_.dot(own->first);
  const double across = std::sqrt(std::max(0.0, 1 - along * along));
  result_.arcs.back().angle = std::atan2(across, std::abs(along));
  if (n == 1) {
    stop(Status::left_domain, "it meets the border of the surface");
    return false;
  }
  if (across < kGrazing) {
    stop(Status::not_converged, "it runs along an edge");
    return false;
  }
  // The other face's first ray is this one's second. Both are half planes to first order: one line.
  const Wedge& other = star->wedges[own == star->wedges.begin() ? 1 : 0];
  const Point3 e = other.first;
  const Point3 inwards = other.normal.cross(e);
  const double kept = v_.dot(e);
  v_ = (kept * e + std::sqrt(std::max(0.0, 1 - kept * kept)) * inwards).normalized();
  // Where the crossing is not known better than this, the edge and the faces turn the direction.
  result_.ray.direction_error += result_.ray.error / (across * s_.scale);
  face_ = other.face;
  result_.arcs.push_back({.face = face_, .x = x_});
  return true;
}

FacetRay FacetTracer::run(const Point3& x, const Point3& direction, double length) {
  result_.ray.status = Status::ok;
  if (!begin(x, direction)) throw InvalidArgument("the direction points off the faces around the start of the ray");
  result_.arcs.push_back({.face = face_, .x = x_});
  points_.push_back(x_);
  std::optional<ExponentialMap> map;
  int mapped = -1;
  std::optional<ExponentialResult> only;  // the one stride of a ray that is on one face
  int num_strides = 0;
  while (result_.ray.status == Status::ok && length - result_.ray.length > kRounding * length) {
    context_.check_cancelled();
    if (result_.arcs.size() > kMostFaces) {
      stop(Status::not_converged, "it crosses too many edges");
      break;
    }
    if (mapped != face_) {
      map.emplace(s_.face(face_).surface, options_);
      mapped = face_;
    }
    double longest = length - result_.ray.length;
    // A whole ray on one face has its conjugate points told.
    if (num_strides > 0 || s_.face(face_).flat) longest = std::min(longest, kStride * s_.scale);
    ExponentialResult stride = map->trace(x_, v_, longest, context_);
    const std::optional<Exit> exit = exit_of(stride.points);
    ++num_strides;
    if (!exit) {
      only = num_strides == 1 ? std::optional(stride) : std::nullopt;
      take(stride);
      if (stride.status != Status::ok) {
        result_.ray.status = stride.status;
        result_.ray.reason = stride.reason;
      }
      continue;
    }
    only.reset();
    if (exit->condition < 0 || !refine(*map, *exit, std::max(stride.length, longest), stride)) {
      stop(Status::not_converged, "it leaves its face where no edge is known");
      break;
    }
    take(stride);
    (void)cross(exit->condition);
  }
  ExponentialResult& ray = result_.ray;
  if (only && only->conjugate_searched != 0) {
    ray.conjugate_at = only->conjugate_at;
    ray.conjugate_searched = only->conjugate_searched;
    ray.index = only->index;
  }
  if (ray.status == Status::ok) ray.length = length;  // not what the strides' rounding makes of it
  ray.point = x_;
  ray.direction = v_;
  ray.points.resize(3, static_cast<Index>(points_.size()));
  for (std::size_t i = 0; i < points_.size(); ++i) ray.points.col(static_cast<Index>(i)) = points_[i];
  return result_;
}

}  // namespace

FacetRay trace_over_faces(FacetedSurface& surface, const Point3& x, const Point3& direction, double length,
                          const ExponentialOptions& options, const Context& context) {
  return FacetTracer(surface, options, context).run(x, direction, length);
}

}  // namespace taut::detail
