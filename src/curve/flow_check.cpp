// What a relaxed polyline is worth. Residuals: the discrete |k_g| at the nodes, the distance to the surface at nodes
// and at the middles of intervals. The length's error is the larger of two estimates, with a margin of one half:
// Appendix II's sum over the intervals, and half the change since about half as many nodes (a second-order error would
// change by three times itself); to it come the bend that is left, which straightening shortens by about (|k_g| L)^2 /
// 10 of L at most, and rounding. The status names the first of the reasons for doubt that applies, gravest first.
#include "curve/flow_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/linear_algebra.hpp"

namespace taut::detail {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kJump = 0.25;      // an interval whose middle is this far off (in intervals) is no part of the surface
constexpr double kAgreement = 0.5;  // least cosine between the normals at the ends of an interval
constexpr double kSingular = 1e-4;  // of the typical gradient
constexpr double kWeak = 0.1;       // ... half-way between normals that do not agree
constexpr double kEndOff = 1e-6;    // of the length
constexpr double kHardlyBent = 0.1;  // |k_g| length below which what straightening gains is known

/// Least agreement of neighbouring normals: near 1 on a curve that is resolved; across a singular point it is not,
/// however fine the nodes.
double least_agreement(const FlowNodes& nodes) {
  double agreement = 1;
  for (Index i = 0; i + 1 < nodes.size(); ++i) {
    const Eigen::MatrixXd overlap = nodes.normals(i).transpose() * nodes.normals(i + 1);
    // k = 1: the cosine with its sign. k > 1: bases have no common orientation, the product of the cosines has to do.
    agreement = std::min(agreement, nodes.codim() == 1 ? overlap(0, 0) : std::abs(determinant(overlap)));
  }
  return agreement;
}

}  // namespace

Vector interval_jumps(CountingEvaluator& evaluator, Index dim, Index codim, const PointsIn& points) {
  const Index m = points.cols() - 1;
  FlowNodes between(dim, codim);
  between.evaluate(evaluator, 0.5 * (points.leftCols(m) + points.rightCols(m)));
  return between.correction().colwise().norm().transpose().cwiseQuotient(
      (points.rightCols(m) - points.leftCols(m)).colwise().norm().transpose());
}

void check_flow(const Surface& surface, const FlowOptions& options, CountingEvaluator& evaluator,
                const FlowState& state, double coarse_length, FlowResult& result) {
  const Index m = result.points.cols() - 1;
  const double scale = result.points.cwiseAbs().maxCoeff();
  result.residual.geodesic_curvature = measure_repose(state.nodes, result.points, state.widths).geodesic_curvature;
  FlowNodes between(surface.dim(), surface.codim());
  between.evaluate(evaluator, 0.5 * (result.points.leftCols(m) + result.points.rightCols(m)));
  double jump = 0;
  for (Index i = 0; i < m; ++i) {
    const double off = between.correction().col(i).norm();
    result.residual.surface = std::max(result.residual.surface, off);
    jump = std::max(jump, off / (result.points.col(i + 1) - result.points.col(i)).norm());
  }
  result.residual.surface = std::max(result.residual.surface, state.nodes.correction().colwise().norm().maxCoeff());
  const double ends = std::max(state.nodes.correction().col(0).norm(), state.nodes.correction().col(m).norm());
  const double agreement = least_agreement(state.nodes);

  const double bend = result.residual.geodesic_curvature * result.length;
  const double from_levels = 0.5 * std::abs(result.length - coarse_length);
  result.length_error = 1.5 * std::max(result.summary.error_sum, from_levels) + bend * bend * result.length / 10 +
                        64 * kEpsilon * (result.length + scale * std::sqrt(static_cast<double>(m)));

  result.status = Status::not_converged;
  // Normals that disagree are a bend that is too sharp, unless the gradient between them is weak: then a point without
  // one.
  if (state.outcome == FlowOutcome::singular || (agreement < kAgreement && between.rank_margin() < kWeak) ||
      state.nodes.rank_margin() < kSingular) {
    result.status = Status::rank_deficient;
    result.reason = "the curve runs into a point where the surface has no normal";
  } else if (state.outcome == FlowOutcome::out_of_work) {
    result.reason = "the work allowed was used up before the curve came to rest";
  } else if (state.outcome == FlowOutcome::torn) {
    result.reason = "the start does not follow the surface: intervals leave it, however short";
  } else if (state.outcome != FlowOutcome::at_rest) {
    result.reason = "the geodesic curvature did not fall below its bound";
  } else if (ends > kEndOff * result.length + 16 * kEpsilon * scale) {
    result.reason = "an end point does not lie on the surface";
  } else if (options.spacing > 0 && result.summary.longest_interval > options.spacing * (1 + 1e-6)) {
    result.reason = "a gap could not be closed to the spacing";
  } else if (!(jump <= kJump) || agreement < kAgreement) {
    result.reason = "the surface bends too sharply for the nodes allowed: an interval leaves it";
  } else if (!surface.inside_domain(result.points, kEndOff * result.length).all()) {
    result.status = Status::left_domain;
    result.reason = "the curve leaves the surface's domain";
  } else {
    result.status = Status::ok;
  }
  // Where a curve that is bent within the surface would come to rest, nobody knows.
  const bool at_rest = state.outcome == FlowOutcome::at_rest;
  if (!at_rest && !(bend <= kHardlyBent)) result.length_error = std::numeric_limits<double>::infinity();
}

}  // namespace taut::detail
