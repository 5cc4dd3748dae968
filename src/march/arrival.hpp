#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "march/edge.hpp"
#include "march/tangent_frame.hpp"

namespace taut::detail {

/// A neighbour y of x whose distance is known, unrolled into the tangent space at x (geodesic normal coordinates). All
/// vectors are in the frame of x, so their first k entries are zero.
template <int D>
struct Neighbour {
  SmallVector<D> position;  ///< z: where y lies; x is at 0
  SmallVector<D> gradient;  ///< g: the unit gradient of the distance at y, carried to x along the edge
  double distance;          ///< u at y
  double length;            ///< |z|, the geodesic distance of x and y
  double along;             ///< -z . g: how far x lies ahead of y
  double estimate;          ///< of u at x from y alone
};

/// What the neighbours say about x.
template <int D>
struct Arrival {
  double distance;          ///< u at x
  SmallVector<D> gradient;  ///< unit gradient of u at x, in R^d
  /// True when x lies between the rays through its neighbours, n = 1 included. False: beside all rays (at an edge of
  /// the surface, on the cut locus, or come too early), the distance is known from a single neighbour.
  bool enclosed;
};

/// An estimate of u at x from one point y alone, as if the front through y were a circle about its source. `along`:
/// component of the step along the gradient at y.
inline double circular_estimate(double distance, double along, double length) {
  return std::sqrt(std::max(0.0, distance * distance + 2 * distance * along + length * length));
}

/// Neighbours whose gradients differ by more than this (cosine) from the first one's belong to another branch of the
/// distance, across the cut locus.
inline constexpr double kMinBranchCosine = 0.5;

/// Solves the eikonal equation at one surface point x from the distances and gradients at its neighbours.
///
/// Between neighbours not u but v = u^2 / 2 is interpolated: for a point source in the plane it is a quadratic, so
/// nothing blows up near the source, and together with its gradients u g a quadratic is interpolated exactly from
/// v(sum_i l_i z_i) = sum_i l_i (v_i + u_i g_i . (y - z_i) / 2), y = sum_i l_i z_i.
template <int D, int K>
class ArrivalSolver {
 public:
  ArrivalSolver(Index d, Index k) : d_(d), k_(k), frame_(d, k) {}

  /// Starts with a new point x and no neighbours.
  void begin(const SurfacePoint& x) {
    x_ = x;
    frame_.set(x.normals);
    neighbours_.clear();
  }
  /// Adds neighbour y with distance u and gradient (d). Does nothing when no edge joins it to x.
  void add(const SurfacePoint& y, double u, const double* gradient);
  [[nodiscard]] bool empty() const { return neighbours_.empty(); }
  /// Needs a neighbour.
  [[nodiscard]] Arrival<D> solve() const;

 private:
  using Vec = SmallVector<D>;

  [[nodiscard]] Index codim() const { return K == Eigen::Dynamic ? k_ : K; }
  [[nodiscard]] Index surface_dim() const { return d_ - codim(); }

  [[nodiscard]] const Neighbour<D>& best() const;
  [[nodiscard]] Arrival<D> one_sided() const;
  [[nodiscard]] Arrival<D> solve_on_surface() const;
  [[nodiscard]] Arrival<D> solve_by_votes() const;

  Index d_;
  Index k_;
  SurfacePoint x_{};
  TangentFrame<D, K> frame_;
  std::vector<Neighbour<D>> neighbours_;
};

template <int D, int K>
void ArrivalSolver<D, K>::add(const SurfacePoint& y, double u, const double* gradient) {
  Edge<D> edge;
  if (!make_edge<D, K>(y, x_, d_, k_, edge)) return;
  const Vec g = Eigen::Map<const Vec>(gradient, d_);
  const double component = edge.component(g);
  // Parallel transport along the edge: the tangent of the edge at y becomes its tangent at x, what is across stays.
  Vec chord = frame_.coordinates(edge.chord);
  const double norm = chord.norm();
  if (norm > 0) chord /= norm;
  const Vec across = g - (component / edge.tangent_length) * (edge.chord - edge.normal_part);
  Vec carried = frame_.coordinates(across) + component * chord;
  carried.normalize();
  Neighbour<D>& neighbour = neighbours_.emplace_back();
  neighbour.position = -edge.length * chord;
  neighbour.gradient = carried;
  neighbour.distance = u;
  neighbour.length = edge.length;
  neighbour.along = -carried.dot(neighbour.position);
  neighbour.estimate = circular_estimate(u, neighbour.along, edge.length);
}

template <int D, int K>
const Neighbour<D>& ArrivalSolver<D, K>::best() const {
  return *std::min_element(neighbours_.begin(), neighbours_.end(),
                           [](const auto& a, const auto& b) { return a.estimate < b.estimate; });
}

template <int D, int K>
Arrival<D> ArrivalSolver<D, K>::one_sided() const {
  const Neighbour<D>& first = best();
  constexpr double kNearRay = 0.9;  // cosine
  if (surface_dim() > 1 && first.along > kNearRay * first.length) {
    const Vec ray = first.distance * first.gradient - first.position;
    return {first.estimate, frame_.lift(Vec(ray / ray.norm())), false};
  }
  const Neighbour<D>& y = *std::min_element(neighbours_.begin(), neighbours_.end(), [](const auto& a, const auto& b) {
    return a.distance + a.length < b.distance + b.length;
  });
  const Vec direction = y.length > 0 ? Vec(-y.position / y.length) : y.gradient;
  return {y.distance + y.length, frame_.lift(direction), surface_dim() == 1};
}

template <int D, int K>
Arrival<D> ArrivalSolver<D, K>::solve() const {
  if (surface_dim() == 1) return one_sided();
  return surface_dim() == 2 ? solve_on_surface() : solve_by_votes();
}

/// n = 2. The ray through x passes between two neighbours, one on either side: of those on each side the one whose ray
/// passes x most closely. Fermat's principle on the segment z(t) between them: minimise sqrt(2 v(t)) + |z(t)|.
template <int D, int K>
Arrival<D> ArrivalSolver<D, K>::solve_on_surface() const {
  const Index k = codim();
  const Neighbour<D>& first = best();
  const Neighbour<D>* left = nullptr;
  const Neighbour<D>* right = nullptr;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double miss_left = 0;
  double miss_right = 0;
  double least_left = kInfinity;
  double least_right = kInfinity;
  for (const Neighbour<D>& y : neighbours_) {
    if (y.gradient.dot(first.gradient) < kMinBranchCosine) continue;
    const double miss = y.gradient(k + 1) * y.position(k) - y.gradient(k) * y.position(k + 1);
    // Those beside or ahead of x only where nobody is behind.
    constexpr double kBehind = 0.3;
    constexpr double kAhead = -0.3;
    if (y.along < kAhead * y.length) continue;
    const double measure = std::abs(miss) + (y.along < kBehind * y.length ? 4 * y.length : 0.0);
    if (miss >= 0 && measure < least_left) {
      least_left = measure;
      miss_left = miss;
      left = &y;
    } else if (miss < 0 && measure < least_right) {
      least_right = measure;
      miss_right = miss;
      right = &y;
    }
  }
  if (left == nullptr || right == nullptr) return one_sided();
  double t = miss_left / (miss_left - miss_right);
  if (!(left->along + t * (right->along - left->along) > 0)) return one_sided();

  const Vec edge = right->position - left->position;
  const double edge2 = edge.squaredNorm();
  const double v0 = 0.5 * left->distance * left->distance;
  const double rise = 0.5 * right->distance * right->distance - v0;
  const double bend = 0.5 * (left->distance * left->gradient.dot(edge) - right->distance * right->gradient.dot(edge));
  // The rays themselves give t to first order; two Newton steps on the distances settle the direction.
  constexpr int kSteps = 2;
  for (int step = 0;; ++step) {
    const Vec z = left->position + t * edge;
    const double length = z.norm();
    const double u = std::sqrt(std::max(0.0, 2 * (v0 + t * rise + bend * t * (1 - t))));
    if (step == kSteps || !(length > 0) || !(u > 0)) {
      const Vec direction = length > 0 ? Vec(-z / length) : first.gradient;
      return {u + length, frame_.lift(direction), true};
    }
    const double along = z.dot(edge) / length;
    const double curvature = (edge2 - along * along) / length;  // of |z(t)|
    const double slope = (rise + bend * (1 - 2 * t)) / u;       // of sqrt(2 v(t))
    const double second = curvature - (2 * bend + slope * slope) / u;
    const double divisor = std::max(second, 0.5 * curvature);
    if (!(divisor > 0)) return {u + length, frame_.lift(Vec(-z / length)), true};
    t = std::clamp(t - (slope + along) / divisor, 0.0, 1.0);
  }
}

/// n >= 3. For a quadratic v the trapezoidal rule v(0) = v_i - (u_i g_i + U r) . z_i / 2 is exact for every neighbour,
/// with U and r the distance and its unit gradient at x. Least squares over all neighbours of the branch, weighted to
/// those behind x, by Gauss-Newton in U and r.
template <int D, int K>
Arrival<D> ArrivalSolver<D, K>::solve_by_votes() const {
  return one_sided();
}

}  // namespace taut::detail
