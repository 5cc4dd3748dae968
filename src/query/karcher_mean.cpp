// The Karcher mean by Newton's method: the gradient of half the variance is minus the mean of the logs, and
// DistanceSolver gives all logs at a point at once. On 2-surfaces the Hessian of half a squared distance L^2 / 2 is
// known from the geodesic's scales: 1 along it and L M12 / m12 across. Elsewhere, and where the Hessian is not
// definite, it is gradient descent, with steps halved until the variance falls.

#include "taut/query/point_sets.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/linear_algebra.hpp"
#include "march/point_normals.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut {
namespace {

struct MeanRules {
  int starts = 3;               ///< of the points, from which a minimum is sought
  double shortest_step = 1e-6;  ///< of Newton's: halved to less, none leads down
  double rounding = 1e-12;      ///< of the variance: what the last steps gain drowns in it
  double tolerable = 1e3;       ///< times what is asked for: a gradient at rest where no step leads down
  double same_place = 1e-5;     ///< of the root of the variance: two minima that close are one
  double as_good = 1e-6;        ///< of the variance: another minimum that is higher by no more is as good
};
constexpr MeanRules kRules;

/// Distances and directions from one place to the points.
struct Look {
  Vector x;
  bool complete = false;
  bool converged = false;  // the gradient vanishes
  std::string message;
  double variance = 0;
  Vector mean_log;
  Vector distance;
  Points departure;  // d x n
};

class Descent {
 public:
  Descent(const Surface& surface, const PointsIn& points, Vector weights, const KarcherMeanOptions& options,
          const Context& context)
      : surface_(surface),
        points_(points),
        weights_(std::move(weights)),
        options_(options),
        context_(context),
        solver_(surface, points.leftCols(1), {}, options.distance, context),
        exponential_(surface, {.conjugate = false, .points = false}) {}

  int num_iterations = 0;

  [[nodiscard]] Look look(const VectorIn& x) {
    solver_.set_sources(x);
    const Distances u = solver_.at(points_);
    Look seen{.x = solver_.sources().col(0),
              .message = {},
              .mean_log = Vector::Zero(x.size()),
              .distance = u.distance,
              .departure = u.departure};
    seen.complete = true;
    for (Index j = 0; j < points_.cols(); ++j) {
      if (u.status[static_cast<std::size_t>(j)] != Status::ok || !std::isfinite(u.distance(j))) {
        seen.complete = false;
        seen.message = fmt::format("point {} has no distance: {}", j,
                                   u.message.contains(j) ? u.message.at(j) : "beyond what was asked for");
        return seen;
      }
      if (u.distance(j) == 0 || weights_(j) == 0) continue;
      seen.variance += weights_(j) * u.distance(j) * u.distance(j);
      seen.mean_log += weights_(j) * u.distance(j) * u.departure.col(j);
    }
    return seen;
  }

  /// Goes down from x until the gradient vanishes within what the distances' tolerance tells.
  [[nodiscard]] Look follow(const VectorIn& x) {
    Look here = look(x);
    double step = 1;
    for (int i = 0; here.complete && i < options_.max_iterations; ++i, ++num_iterations) {
      const double spread = std::sqrt(here.variance);
      const double slope = here.mean_log.norm();
      if (!(slope > enough(spread))) {
        here.converged = true;
        return here;
      }
      const Vector down = downhill(here);
      const ExponentialResult ray = exponential_.trace(here.x, down, step * down.norm(), context_);
      Look next = look(ray.point);
      if (!next.complete) return next;
      // The variance falls by 2 <down, mean log> to first order, by half of it with Newton's step.
      // A quarter of the first-order gain, half of Newton's: Armijo's condition.
      const double expected = 0.5 * step * down.dot(here.mean_log);
      if (next.variance > here.variance - expected && step * down.norm() > enough(spread)) {
        // Rounding hides what the last steps gain: then the gradient tells.
        const bool hidden = std::abs(next.variance - here.variance) < kRules.rounding * here.variance;
        if (!hidden || next.mean_log.norm() > slope) {
          step /= 2;
          // No step leads down any more: at rest if the gradient is small enough for it.
          if (step < kRules.shortest_step) {
            here.converged = slope <= kRules.tolerable * enough(spread);
            return here;
          }
          continue;
        }
      }
      here = std::move(next);
      // Back to full steps, which Newton's method needs to converge fast.
      step = std::min(1.0, 2 * step);
    }
    return here;
  }

  [[nodiscard]] double enough(double spread) const { return options_.distance.tolerance * spread + 1e-15; }

 private:
  /// Newton's step where the Hessian says that it leads to a minimum, else the mean of the logs.
  [[nodiscard]] Vector downhill(const Look& here) const {
    const Index d = surface_.dim();
    if (d - surface_.codim() != 2) return here.mean_log;
    const Points normals = detail::normals_at(surface_, here.x);
    if (!normals.allFinite()) return here.mean_log;
    const Eigen::MatrixXd tangents = detail::orthogonal_complement(normals.reshaped(d, surface_.codim()));
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
    for (Index j = 0; j < points_.cols(); ++j) {
      const double length = here.distance(j);
      if (weights_(j) == 0) continue;
      if (length == 0) {
        hessian += weights_(j) * Eigen::Matrix2d::Identity();
        continue;
      }
      const GeodesicScales scales = geodesic_scales(surface_, here.x, here.departure.col(j), length);
      if (scales.status != Status::ok || !(scales.m12 > 0)) return here.mean_log;  // a conjugate point
      const Eigen::Vector2d along = (tangents.transpose() * here.departure.col(j)).normalized();
      const Eigen::Vector2d across(-along.y(), along.x());
      hessian +=
          weights_(j) * (along * along.transpose() + length * scales.M12 / scales.m12 * across * across.transpose());
    }
    const Eigen::LLT<Eigen::Matrix2d> factor(hessian);
    if (factor.info() != Eigen::Success) return here.mean_log;
    const Eigen::Vector2d step = factor.solve(tangents.transpose() * here.mean_log);
    // Nearly singular: farther than the farthest point is no step for a quadratic model.
    if (!(step.norm() <= here.distance.maxCoeff())) return here.mean_log;
    return tangents * step;
  }

  const Surface& surface_;
  Points points_;
  Vector weights_;
  const KarcherMeanOptions& options_;
  const Context& context_;
  DistanceSolver solver_;
  ExponentialMap exponential_;
};

}  // namespace

KarcherMean karcher_mean(const Surface& surface, const PointsIn& points, const Vector& weights,
                         const KarcherMeanOptions& options, const Context& context) {
  const Index n = points.cols();
  if (points.rows() != surface.dim() || n == 0) {
    throw InvalidArgument(
        fmt::format("the points ({} x {}) of a mean: must be {} x n, n >= 1", points.rows(), n, surface.dim()));
  }
  if (detail::is_kinked(surface)) {
    throw InvalidArgument("means are found on smooth surfaces; this one has edges (min, max, abs or sign)");
  }
  if (weights.size() != 0 && weights.size() != n) {
    throw InvalidArgument(fmt::format("{} points have {} weights: give one each", n, weights.size()));
  }
  Vector w = weights.size() == 0 ? Vector(Vector::Ones(n)) : weights;
  if (!w.allFinite() || w.minCoeff() < 0 || !(w.sum() > 0)) {
    throw InvalidArgument("weights must not be negative, and not all zero");
  }
  if (options.max_iterations < 1) throw InvalidArgument("max_iterations must be at least 1");
  w /= w.sum();
  Descent descent(surface, points, w, options, context);
  KarcherMean result;
  // The variance may have several minima: the descent begins at points far from each other.
  std::vector<Look> found;
  Index first = 0;
  w.maxCoeff(&first);
  Vector nearest = Vector::Constant(n, std::numeric_limits<double>::infinity());  // to starts and minima so far
  for (int start = 0; start < std::min<Index>(kRules.starts, n); ++start) {
    Index at = first;
    // The point farthest from all starts and minima so far.
    if (start > 0) nearest.maxCoeff(&at);
    if (start > 0 && !(nearest(at) > 0)) break;
    const Look begin = descent.look(points.col(at));
    const Look minimum = descent.follow(points.col(at));
    if (!minimum.complete && start == 0) {
      result.message = minimum.message;
      result.point = minimum.x;
      result.num_iterations = descent.num_iterations;
      return result;
    }
    if (!minimum.complete) continue;
    if (begin.complete) nearest = nearest.cwiseMin(begin.distance);
    nearest = nearest.cwiseMin(minimum.distance);
    const bool known = std::ranges::any_of(found, [&](const Look& other) {
      return (other.x - minimum.x).norm() <= kRules.same_place * std::sqrt(std::max(other.variance, minimum.variance));
    });
    if (!known && (start == 0 || minimum.converged)) found.push_back(minimum);
  }
  std::ranges::stable_sort(found, {}, &Look::variance);
  const Look& best = found.front();
  if (best.converged) result.status = Status::ok;
  result.point = best.x;
  result.variance = best.variance;
  result.gradient = best.mean_log.norm();
  result.distance = best.distance;
  result.num_iterations = descent.num_iterations;
  for (std::size_t i = 1; i < found.size(); ++i) {
    result.others.push_back(found[i].x);
    if (found[i].variance <= best.variance * (1 + kRules.as_good)) {
      result.unique = false;
      result.message = "another point was found that is as good: the points lie all round the surface";
    }
  }
  if (result.status != Status::ok) result.message = "the descent did not come to rest";
  return result;
}

}  // namespace taut
