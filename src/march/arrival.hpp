#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "march/edge.hpp"
#include "march/tangent_coordinates.hpp"

namespace taut::detail {

/// A neighbour y of x whose distance is known, unrolled into the tangent space at x (geodesic normal coordinates). All
/// vectors are in the frame of x, so their first k entries are zero.
template <int D, class Scalar = double>
struct UnrolledNeighbour {
  SmallVector<D, Scalar> position;  ///< z: where y lies; x is at 0
  SmallVector<D, Scalar> gradient;  ///< g: the unit gradient of the distance at y, carried to x along the edge
  Scalar distance;                  ///< u at y
  Scalar length;                    ///< |z|, the geodesic distance of x and y
  Scalar along;                     ///< -z . g: how far x lies ahead of y
  Scalar estimate;                  ///< of u at x from y alone
  Index source;                     ///< which source the distance is from
};

/// What the neighbours say about x.
template <int D, class Scalar = double>
struct Arrival {
  Scalar distance;                  ///< u at x
  SmallVector<D, Scalar> gradient;  ///< unit gradient of u at x: in the frame of x where neighbours are, finally in R^d
  /// True when x lies between the rays through its neighbours, n = 1 included. False: beside all rays (at an edge of
  /// the surface, on the cut locus, or come too early), the distance is known from a single neighbour.
  bool enclosed;
  Index source;  ///< which source the distance is from
};

/// The square of an estimate of u at x from one point y alone, as if the front through y were a circle about its
/// source. `along`: component of the step along the gradient at y; `length2`: its squared length.
template <class Scalar>
Scalar circular_estimate2(Scalar distance, Scalar along, Scalar length2) {
  return std::max(Scalar{0}, distance * distance + 2 * distance * along + length2);
}

/// Neighbours whose gradient makes less than this cosine with the way to x lie beside or ahead of it.
inline constexpr double kBehind = 0.3;
/// Neighbours whose gradients differ by more than this (cosine) from the first one's belong to another branch of the
/// distance, across the cut locus.
inline constexpr double kMinBranchCosine = 0.5;

/// The neighbour with the least estimate.
template <int D, class Scalar>
const UnrolledNeighbour<D, Scalar>& best_of(const std::vector<UnrolledNeighbour<D, Scalar>>& neighbours) {
  return *std::min_element(neighbours.begin(), neighbours.end(),
                           [](const auto& a, const auto& b) { return a.estimate < b.estimate; });
}

/// From a single neighbour: the best one's ray, where it passes close to x, else the shortest way over an edge.
template <int D, class Scalar>
Arrival<D, Scalar> arrival_from_one(const std::vector<UnrolledNeighbour<D, Scalar>>& neighbours, Index surface_dim) {
  const UnrolledNeighbour<D, Scalar>& first = best_of(neighbours);
  // Where the ray through y passes close to x, the front there is a circle about its source to good accuracy. Far
  // beside it only the triangle inequality u(y) + |z| is safe.
  constexpr Scalar kNearRay = 0.9;  // cosine
  if (surface_dim > 1 && first.along > kNearRay * first.length) {
    // From the source as y sees it, at z - u g, to x.
    const SmallVector<D, Scalar> ray = first.distance * first.gradient - first.position;
    return {first.estimate, ray / ray.norm(), false, first.source};
  }
  const UnrolledNeighbour<D, Scalar>& y =
      *std::min_element(neighbours.begin(), neighbours.end(),
                        [](const auto& a, const auto& b) { return a.distance + a.length < b.distance + b.length; });
  const SmallVector<D, Scalar> direction = y.length > 0 ? SmallVector<D, Scalar>(-y.position / y.length) : y.gradient;
  // On a curve (n = 1) one neighbour is all there is on the side of the source.
  return {y.distance + y.length, direction, surface_dim == 1, y.source};
}

/// n = 2. Do the rays through two neighbours, which miss x by signed distances, pass on either side of it and from
/// behind?
template <int D, class Scalar>
bool surrounds(const UnrolledNeighbour<D, Scalar>& left, Scalar miss_left, const UnrolledNeighbour<D, Scalar>& right,
               Scalar miss_right) {
  // t: where between the two the ray through x starts. The front there must still lie behind x.
  const Scalar t = miss_left / (miss_left - miss_right);
  return miss_left > miss_right && left.along + t * (right.along - left.along) > 0;
}

/// n = 2. Fermat's principle on the segment z(t) between two neighbours: the least sqrt(2 v(t)) + |z(t)|.
template <int D, class Scalar>
Arrival<D, Scalar> arrival_between(const UnrolledNeighbour<D, Scalar>& left, Scalar miss_left,
                                   const UnrolledNeighbour<D, Scalar>& right, Scalar miss_right) {
  using Vec = SmallVector<D, Scalar>;
  constexpr Scalar kHalf = 0.5;
  // z(t) = z_left + t edge, v(t) = v0 + t rise + t (1 - t) bend: the interpolation of v in ArrivalSolver, on this
  // segment.
  const Vec edge = right.position - left.position;
  const Scalar edge2 = edge.squaredNorm();
  const Scalar v0 = kHalf * left.distance * left.distance;
  const Scalar rise = kHalf * right.distance * right.distance - v0;
  const Scalar bend = kHalf * (left.distance * left.gradient.dot(edge) - right.distance * right.gradient.dot(edge));
  // The rays themselves give t to first order. A step of third order (Chebyshev's method) settles the direction, unless
  // it is a long one.
  Scalar t = std::clamp(miss_left / (miss_left - miss_right), Scalar{0}, Scalar{1});
  constexpr Scalar kShort = 0.2;
  constexpr int kMostSteps = 3;
  bool settled = false;
  for (int step = 0;; ++step) {
    const Vec z = left.position + t * edge;
    const Scalar length = z.norm();
    const Scalar u = std::sqrt(std::max(Scalar{0}, 2 * (v0 + t * rise + bend * t * (1 - t))));
    const Scalar per_length = 1 / length;
    const Scalar along = z.dot(edge) * per_length;
    const Scalar curvature = (edge2 - along * along) * per_length;  // of |z(t)|
    // No curvature: x lies on the line through both neighbours. u = 0: z(t) is the source. Then no step is defined.
    if (settled || step == kMostSteps || !(curvature > 0) || !(u > 0)) {
      return {u + length, length > 0 ? Vec(-per_length * z) : left.gradient, true, left.source};
    }
    const Scalar per_u = 1 / u;
    const Scalar slope = (rise + bend * (1 - 2 * t)) * per_u;  // of sqrt(2 v(t)), then its second derivative
    const Scalar bending = -(2 * bend + slope * slope) * per_u;
    const Scalar third = -3 * (slope * bending * per_u + along * curvature * per_length);
    // v(t) need not be convex. Half of the curvature of |z| alone still makes it a step down.
    const Scalar per_second = 1 / std::max(curvature + bending, kHalf * curvature);
    const Scalar newton = (slope + along) * per_second;
    // Chebyshev's factor on Newton's step, kept within 1/2 .. 2 far from the minimum, where the series behind it is no
    // guide.
    const Scalar more = std::clamp(1 + kHalf * newton * third * per_second, kHalf, Scalar{2});
    const Scalar next = std::clamp(t - newton * more, Scalar{0}, Scalar{1});
    settled = std::abs(next - t) < kShort;
    t = next;
  }
}

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
    candidates_.clear();
  }
  /// Offers neighbour y with distance u, gradient (d) and source. Whether an edge joins it to x is found out later.
  /// What the pointers point to must stay until solve().
  void add(const SurfacePoint& y, double u, const double* gradient, Index source) {
    const Map g(gradient, d_);
    const Vec chord = Map(x_.x, d_) - Map(y.x, d_);
    const double along = g.dot(chord);
    const double chord2 = chord.squaredNorm();
    candidates_.push_back({y, gradient, chord, u, chord2, along, circular_estimate2(u, along, chord2), source});
  }
  /// Empty when no edge joins a neighbour to x.
  [[nodiscard]] std::optional<Arrival<D>> solve();

 private:
  using Vec = SmallVector<D>;
  using Map = Eigen::Map<const Vec>;

  /// A neighbour as it was offered.
  struct Candidate {
    SurfacePoint point;
    const double* gradient;
    Vec chord;  // x - y
    double distance;
    double chord2;
    double along;      // chord . gradient
    double estimate2;  // of the squared distance at x
    Index source;
  };

  [[nodiscard]] Index codim() const { return K == Eigen::Dynamic ? k_ : K; }
  [[nodiscard]] Index surface_dim() const { return d_ - codim(); }

  bool unroll(const Candidate& y, UnrolledNeighbour<D>& neighbour) const;
  void unroll_all();
  /// From the frame of x to R^d.
  [[nodiscard]] Arrival<D> lift(Arrival<D> arrival) const {
    arrival.gradient = frame_.lift(arrival.gradient);
    return arrival;
  }
  void drop(std::size_t c) { candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(c)); }
  [[nodiscard]] std::size_t best_candidate() const;
  [[nodiscard]] Arrival<D> one_sided() const;
  [[nodiscard]] std::optional<Arrival<D>> solve_on_surface();
  [[nodiscard]] Arrival<D> solve_by_votes() const;

  Index d_;
  Index k_;
  SurfacePoint x_{};
  TangentCoordinates<D, K> frame_;
  std::vector<Candidate> candidates_;
  std::vector<UnrolledNeighbour<D>> neighbours_;
};

/// False when no edge joins y to x.
template <int D, int K>
bool ArrivalSolver<D, K>::unroll(const Candidate& y, UnrolledNeighbour<D>& neighbour) const {
  Edge<D> edge;
  if (!make_edge<D, K>(y.point, x_, d_, k_, edge)) return false;
  const Map g(y.gradient, d_);
  const double component = edge.component(g);
  // Parallel transport along the edge: the tangent of the edge at y becomes its tangent at x, what is across stays.
  Vec chord = frame_.coordinates(edge.chord);
  const double norm = chord.norm();
  if (norm > 0) chord /= norm;
  const Vec across = g - (component / edge.tangent_length) * (edge.chord - edge.normal_part);
  neighbour.gradient = (frame_.coordinates(across) + component * chord).normalized();
  neighbour.position = -edge.length * chord;
  neighbour.distance = y.distance;
  neighbour.length = edge.length;
  neighbour.along = -neighbour.gradient.dot(neighbour.position);
  neighbour.estimate = std::sqrt(circular_estimate2(y.distance, neighbour.along, edge.length * edge.length));
  neighbour.source = y.source;
  return true;
}

template <int D, int K>
void ArrivalSolver<D, K>::unroll_all() {
  neighbours_.clear();
  UnrolledNeighbour<D> neighbour;
  for (const Candidate& y : candidates_) {
    if (unroll(y, neighbour)) neighbours_.push_back(neighbour);
  }
}

template <int D, int K>
std::size_t ArrivalSolver<D, K>::best_candidate() const {
  std::size_t least = 0;
  for (std::size_t c = 1; c < candidates_.size(); ++c) {
    if (candidates_[c].estimate2 < candidates_[least].estimate2) least = c;
  }
  return least;
}

template <int D, int K>
Arrival<D> ArrivalSolver<D, K>::one_sided() const {
  return lift(arrival_from_one(neighbours_, surface_dim()));
}

template <int D, int K>
std::optional<Arrival<D>> ArrivalSolver<D, K>::solve() {
  frame_.set(x_.normals);
  // n = 2 unrolls only the two neighbours it chooses, unrolling being most of the work; n = 1 and n >= 3 need all.
  constexpr bool kDynamic = D == Eigen::Dynamic;
  if constexpr (kDynamic || D - K == 2) {
    if (surface_dim() == 2) return solve_on_surface();
  }
  unroll_all();
  if (neighbours_.empty()) return std::nullopt;
  if constexpr (kDynamic || D - K >= 3) {
    if (surface_dim() >= 3) return solve_by_votes();
  }
  return one_sided();
}

/// n = 2. The ray through x passes between two neighbours, one on either side: of those on each side the one whose ray
/// passes x most closely. The choice is made with plain chords; what is chosen is then unrolled.
template <int D, int K>
std::optional<Arrival<D>> ArrivalSolver<D, K>::solve_on_surface() {
  const Index k = codim();
  UnrolledNeighbour<D> first;
  // Every turn returns or drops a candidate that no edge joins to x.
  while (!candidates_.empty()) {
    const std::size_t best = best_candidate();
    if (!unroll(candidates_[best], first)) {
      drop(best);
      continue;
    }
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::size_t chosen[2] = {kNone, kNone};  // with the ray to the left and to the right of x
    double least[2] = {kInfinity, kInfinity};
    const Vec branch = frame_.lift(first.gradient);
    for (std::size_t c = 0; c < candidates_.size(); ++c) {
      const Candidate& y = candidates_[c];
      const Map gradient(y.gradient, d_);
      if (gradient.dot(branch) < kMinBranchCosine) continue;
      const double miss = frame_.cross(gradient, y.chord);
      // Those beside or ahead of x only where nobody is behind.
      // Squared with its sign: compared with kBehind |chord| without a root for each candidate.
      const double along2 = y.along * std::abs(y.along);
      if (along2 < -kBehind * kBehind * y.chord2) continue;
      const double measure = std::abs(miss) + (along2 < kBehind * kBehind * y.chord2 ? 4 * std::sqrt(y.chord2) : 0.0);
      const int side = miss >= 0 ? 0 : 1;
      if (measure < least[side]) {
        least[side] = measure;
        chosen[side] = c;
      }
    }
    UnrolledNeighbour<D> pair[2];
    std::size_t unusable = kNone;
    for (int side = 0; side < 2; ++side) {
      if (chosen[side] == best) {
        pair[side] = first;
      } else if (chosen[side] != kNone && !unroll(candidates_[chosen[side]], pair[side])) {
        unusable = chosen[side];
      }
    }
    if (unusable != kNone) {
      drop(unusable);
      continue;
    }
    if (chosen[0] != kNone && chosen[1] != kNone) {
      const auto miss = [&](const UnrolledNeighbour<D>& y) {
        return y.gradient(k + 1) * y.position(k) - y.gradient(k) * y.position(k + 1);
      };
      const double miss_left = miss(pair[0]);
      const double miss_right = miss(pair[1]);
      if (surrounds(pair[0], miss_left, pair[1], miss_right)) {
        Arrival<D> arrival = arrival_between(pair[0], miss_left, pair[1], miss_right);
        // Where the fronts of two sources meet, the pair may be of both: the nearest neighbour tells.
        arrival.source = first.source;
        return lift(arrival);
      }
    }
    // x lies beside all rays: at an edge of the surface, on the cut locus, or come too early.
    unroll_all();
    return one_sided();
  }
  return std::nullopt;
}

/// n >= 3. For a quadratic v the trapezoidal rule v(0) = v_i - (u_i g_i + G) . z_i / 2 is exact for every neighbour i,
/// with G = u r the gradient of v at x and, by the eikonal equation, v(0) = |G|^2 / 2. Least squares for G over all
/// neighbours of the branch that lie behind x, by Gauss-Newton from the best single neighbour.
template <int D, int K>
Arrival<D> ArrivalSolver<D, K>::solve_by_votes() const {
  const Index n = surface_dim();
  const UnrolledNeighbour<D>& first = best_of(neighbours_);
  Vec gradient = first.distance * first.gradient - first.position;  // G; its length is the distance
  const double start = gradient.norm();
  if (!(start > 0)) return one_sided();
  const Vec ray = gradient / start;
  // cos^2 / |z|^2: who is near and straight behind counts most.
  const auto weight = [&](const UnrolledNeighbour<D>& y) {
    const double behind = -y.position.dot(ray);
    if (!(behind > 0) || y.gradient.dot(first.gradient) < kMinBranchCosine) return 0.0;
    return behind * behind / (y.length * y.length * y.length * y.length);
  };
  // Bounds by the triangle inequality, u_i - |z_i| <= u <= u_i + |z_i|.
  double lower = 0;
  double upper = std::numeric_limits<double>::infinity();
  double sum = 0;
  double spread = 0;
  Vec side = Vec::Zero(d_);
  for (const UnrolledNeighbour<D>& y : neighbours_) {
    const double w = weight(y);
    if (!(w > 0)) continue;
    const Vec across = y.position - y.position.dot(ray) * ray;
    side += w * across;
    spread += w * across.squaredNorm();
    sum += w;
    lower = std::max(lower, y.distance - y.length);
    upper = std::min(upper, y.distance + y.length);
  }
  // By Cauchy and Schwarz |side|^2 <= spread * sum, with equality where all neighbours lie off the ray by the same
  // vector. Near that, nothing holds the direction from the other side.
  constexpr double kOneSided = 0.6;
  if (!(side.squaredNorm() < kOneSided * spread * sum)) return one_sided();

  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxMarchDim, kMaxMarchDim>;
  using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxMarchDim, 1>;
  // Keeps the directions that no neighbour tells about where they were.
  constexpr double kRidge = 1e-3;
  const double ridge = 0.25 * kRidge * spread / static_cast<double>(n);
  // The start is right to first order in |z|, and the residual is quadratic in G.
  constexpr int kSteps = 2;
  for (int step = 0; step < kSteps; ++step) {
    Matrix normal = ridge * Matrix::Identity(n, n);
    Coordinates right = Coordinates::Zero(n);
    const double v = 0.5 * gradient.squaredNorm();
    for (const UnrolledNeighbour<D>& y : neighbours_) {
      const double w = weight(y);
      if (!(w > 0)) continue;
      const double residual =
          v - 0.5 * y.distance * y.distance + 0.5 * (gradient + y.distance * y.gradient).dot(y.position);
      // Derivative of the residual with respect to G. The first k entries of all vectors are zero in the frame of x.
      const Coordinates row = (gradient + 0.5 * y.position).tail(n);
      normal.template selfadjointView<Eigen::Lower>().rankUpdate(row, w);
      right += w * residual * row;
    }
    const Eigen::LLT<Matrix> factor(normal);
    if (factor.info() != Eigen::Success) return one_sided();
    gradient.tail(n) -= factor.solve(right);
  }
  const double distance = gradient.norm();
  if (!(distance > 0)) return one_sided();
  // Neighbours on both sides of a kink can contradict each other: then lower > upper, and the upper bound is kept.
  return {std::clamp(distance, std::min(lower, upper), upper), frame_.lift(Vec(gradient / distance)), true,
          first.source};
}

}  // namespace taut::detail
