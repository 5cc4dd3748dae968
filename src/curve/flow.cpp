// The correction of the paper's section 4, from outside: options are checked, ends that are too close for it are
// answered by their chord, and flow_correction.cpp does the rest. Time is measured for the summary only (the paper's K
// and (A2)); nothing is decided by it.
#include "taut/curve/flow.hpp"

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "curve/chord_error.hpp"
#include "curve/flow_correction.hpp"
#include "curve/polyline.hpp"
#include "surface/describe.hpp"
#include "surface/normal_angle.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::FlowNodes;

void validate(const Surface& surface, const PointsIn& start, const FlowOptions& options) {
  if (start.rows() != surface.dim() || start.cols() < 2) {
    throw InvalidArgument("correct_flow: start is " + std::to_string(start.rows()) + " x " +
                          std::to_string(start.cols()) + ", needs " + std::to_string(surface.dim()) +
                          " rows and at least 2 columns");
  }
  if (!start.allFinite()) throw InvalidArgument("correct_flow: start holds a coordinate that is not finite");
  const auto not_negative = [](double v, const char* name) {
    if (!(v >= 0) || !std::isfinite(v)) {
      throw InvalidArgument(std::string("correct_flow: ") + name + " = " + detail::describe(v) +
                            ", must be finite and >= 0");
    }
  };
  not_negative(options.spacing, "spacing");
  not_negative(options.lattice.size, "lattice.size");
  if (options.lattice.size > 0 &&
      (options.lattice.origin.size() != surface.dim() || !options.lattice.origin.allFinite())) {
    throw InvalidArgument("correct_flow: lattice.origin must be " + std::to_string(surface.dim()) + " finite numbers");
  }
  not_negative(options.curvature_bound, "curvature_bound");
  // An explicit step moves nodes by beta / 4 of the way to the surface: beyond 8 it would diverge, beyond 4 overshoot.
  const double most = options.time_step == FlowTimeStep::explicit_euler ? 4 : std::numeric_limits<double>::max();
  if (!(options.beta > 0 && options.beta <= most)) {
    throw InvalidArgument("correct_flow: beta = " + detail::describe(options.beta) +
                          ", must be > 0 (and at most 4 with explicit steps)");
  }
  if (options.max_evaluated < 0) {
    throw InvalidArgument("correct_flow: max_evaluated = " + std::to_string(options.max_evaluated) + ", must be >= 0");
  }
}

/// The chord, where the flow would only stir up rounding: ends within kNear of the coordinates' size, the surface
/// between them as good as flat, and a start that goes from one to the other without a detour (any start, where the
/// ends are equal to rounding). None otherwise.
std::optional<FlowResult> chord_of_near_ends(const Surface& surface, const PointsIn& start) {
  constexpr double kNear = 1e-7;
  constexpr double kFlat = 1e-4;   // turn of the normal from end to end, radians: 1e-9 of the length
  constexpr double kDetour = 1.5;  // length of the start over the chord
  constexpr double kEqual = 64 * std::numeric_limits<double>::epsilon();
  const double scale = start.cwiseAbs().maxCoeff();
  Points ends(start.rows(), 2);
  ends << start.col(0), start.rightCols<1>();
  const double chord = (ends.col(1) - ends.col(0)).norm();
  if (chord > kNear * scale) return std::nullopt;
  const bool equal = chord <= kEqual * scale;
  if (!equal && detail::polyline_length(start) > kDetour * chord) return std::nullopt;
  FlowNodes nodes(surface.dim(), surface.codim());
  const auto evaluator = surface.make_evaluator();
  nodes.evaluate(*evaluator, ends);
  double turn = 0;  // at most
  if (!equal) {
    // What of the one normal space is not in the other: the sines of the angles between them.
    const Eigen::MatrixXd overlap = nodes.normals(0).transpose() * nodes.normals(1);
    turn = (nodes.normals(1) - nodes.normals(0) * overlap).norm();
    if (!(turn <= kFlat) || !(detail::same_orientation(nodes.normals(0), nodes.normals(1)))) return std::nullopt;
  }
  FlowResult result;
  result.points = ends;
  result.length = chord;
  // An arc that turns by an angle a is longer than its chord by a^2 / 24, to leading order.
  result.length_error = chord * turn * turn / 24 + (chord > 0 ? std::numeric_limits<double>::epsilon() * scale : 0);
  result.summary = {
      .num_intervals = 1, .length = chord, .mean_interval = chord, .longest_interval = chord, .cst = turn};
  result.summary.error_a1 = result.summary.error_sum = chord * turn * turn / 24;
  result.residual.surface = nodes.correction().colwise().norm().maxCoeff();
  result.locally_shortest = true;
  result.index = 0;
  result.status = Status::ok;
  if (result.residual.surface > 1e-6 * chord + kEqual * scale && !equal) {
    result.status = Status::not_converged;
    result.locally_shortest = false;
    result.index.reset();
    result.reason = "an end point does not lie on the surface";
  } else if (!surface.inside_domain(ends, 1e-6 * chord + kEqual * scale).all()) {
    result.status = Status::left_domain;
    result.reason = "the curve leaves the surface's domain";
  }
  return result;
}

}  // namespace

FlowResult correct_flow(const Surface& surface, const PointsIn& start, const FlowOptions& options,
                        const Context& context) {
  validate(surface, start, options);
  context.check_cancelled();
  const auto begin = std::chrono::steady_clock::now();
  std::optional<FlowResult> result = chord_of_near_ends(surface, start);
  if (!result) result = detail::FlowCorrection(surface, options, context).run(start);
  detail::set_seconds(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), result->summary);
  return *std::move(result);
}

}  // namespace taut
