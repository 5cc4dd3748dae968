// One geodesic correction by the paper's flow (flow_correction.hpp lists its steps). Levels of nodes: on few nodes the
// flow's long waves decay in few steps, so it begins on about as many as resolve the bends and doubles their number up
// to the wanted one, relaxing loosely on all levels but the last. How many are wanted: the paper's threshold eps_E
// where a spacing is asked for, else the Cst that makes (A1) kDefaultAccuracy of the length.
//
// Ends: every round counts evaluated nodes against work_allowed(); rounds of insertion are bounded; a curve whose
// intervals leave the surface however short they are is torn.
#include "curve/flow_correction.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "curve/chord_error.hpp"
#include "curve/flow_check.hpp"
#include "curve/osculating_circles.hpp"
#include "curve/plane_projection.hpp"
#include "curve/polyline.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

constexpr double kDefaultAccuracy = 2e-5;  // (A1) over the length, when no spacing is asked for
constexpr double kAccurateEnough = 1.5;    // ... and what is not worth a doubling
constexpr double kSecondOrder = 0.4;       // of the error, that a doubling leaves at most: a quarter, with a margin
constexpr Index kFewestIntervals = 16;
constexpr Index kMostStartIntervals = 512;
constexpr double kMostNodes = 1e7;          // with a spacing asked for
constexpr Index kMostDefaultNodes = 65536;  // without
constexpr Index kMostRoughNodes = 8192;     // of the first curve
constexpr double kLooseBound = 1e-4;        // |k_g| length on coarse levels
constexpr double kDefaultBound = 1e-6;      // |k_g| length at the end: 1e-13 of the length
constexpr double kGap = 1.5;                // mean intervals of the start from which on it has a gap
constexpr int kMostRounds = 8;              // of insertion into the first curve, before it is relaxed and after
constexpr int kMostSpreadings = 2;          // of the nodes inserted at the end
constexpr int kMostClosingRounds = 8;       // of insertion at the end
constexpr double kStartTurn = 0.3;   // radians the normal may turn along an interval before the first relaxation,
constexpr double kRoughTurn = 0.5;   // ... and after it: up to there a polyline still follows its curve
constexpr double kWantedTurn = 0.3;  // ... at the end, where the spacing asks for no less,
constexpr double kMostTurn = 0.8;    // ... and there at most
constexpr double kRoughJump = 0.15;  // of an interval: how far its middle may be off the surface
constexpr double kFlattest = 8;      // mean radii: one larger counts as so much where nodes go by the curvature
constexpr double kShortest = 1e-6;   // of the length: no interval shorter than that is cut

Index work_allowed(const FlowOptions& options, Index dim) {
  if (options.max_evaluated > 0) return options.max_evaluated;
  // Explicit steps need some m^2 visits of m nodes, implicit ones a few dozen.
  return options.time_step == FlowTimeStep::explicit_euler ? Index{2000000000} / dim : Index{2000000};
}

/// Nothing more is to be had of it.
bool is_over(const FlowState& state) {
  return state.outcome == FlowOutcome::singular || state.outcome == FlowOutcome::out_of_work ||
         state.outcome == FlowOutcome::torn;
}

}  // namespace

FlowCorrection::FlowCorrection(const Surface& surface, const FlowOptions& options, const Context& context)
    : surface_(surface),
      options_(options),
      context_(context),
      evaluator_(surface),
      solver_(evaluator_, surface.dim(), surface.codim(), options, work_allowed(options, surface.dim()), context),
      insertion_(evaluator_, surface.dim(), surface.codim(), options.lattice) {}

double FlowCorrection::bound(double length, bool last) const {
  // A bound on |k_g|; times the length it is an angle, whatever the scale of the surface.
  const double final_bound = options_.curvature_bound > 0 ? options_.curvature_bound : kDefaultBound / length;
  return last ? final_bound : std::max(final_bound, kLooseBound / length);
}

/// Newton-Raphson, dp/dt = -F grad F / |grad F|^2. A node that finds no surface near is left out: its neighbours bridge
/// the gap, insertion closes it.
void FlowCorrection::project_nodes(Points& points) {
  const Index inner = points.cols() - 2;
  if (inner < 1) return;
  const double mean = polyline_length(points) / static_cast<double>(inner + 1);
  // A start by cells is off the surface by up to a cell.
  const double reach = 2 * std::max(mean, options_.lattice.size);
  Points projected = points.middleCols(1, inner);
  // A zero axis: free projection, no plane.
  const auto found = project_in_planes(evaluator_, surface_.dim(), surface_.codim(), projected,
                                       Points::Zero(points.rows(), inner), Vector::Constant(inner, reach), 1e-6 * mean);
  Points kept(points.rows(), points.cols());
  Index count = 0;
  const auto keep = [&](const Vector& p) {
    // Nodes that land on each other would make intervals without a direction.
    if (count == 0 || (p - kept.col(count - 1)).norm() > 1e-3 * mean) kept.col(count++) = p;
  };
  keep(points.col(0));
  for (Index i = 0; i < inner; ++i) {
    if (found(i)) keep(projected.col(i));
  }
  while (count > 1 && (kept.col(count - 1) - points.col(inner + 1)).norm() <= 1e-3 * mean) --count;
  kept.col(count++) = points.col(inner + 1);
  points = kept.leftCols(count);
}

// An interval is too bent by the turn of the normal, or, where the normal comes back to itself, by how far its middle
// is off the surface.
std::vector<bool> FlowCorrection::bent_intervals(const FlowNodes& nodes, double turn) {
  const Vector lengths = interval_lengths(nodes.points());
  const Vector turns = normal_turns(nodes);
  const Vector jumps = interval_jumps(evaluator_, surface_.dim(), surface_.codim(), nodes.points());
  const double shortest = kShortest * lengths.sum();
  std::vector<bool> bent(static_cast<std::size_t>(lengths.size()));
  for (Index i = 0; i < lengths.size(); ++i) {
    bent[static_cast<std::size_t>(i)] = lengths(i) > shortest && (turns(i) > turn || jumps(i) > kRoughJump);
  }
  return bent;
}

/// What is relaxed is a graded polyline, its intervals as long as the path's own bends ask for, and they stay so.
/// Chords are shortest where a long one cuts a sharp bend, so nodes slide until one does, unless the bend's
/// surroundings are cut finely, too: that is why intervals grow from one to the next by a quarter only.
FlowState FlowCorrection::first_curve(const PointsIn& start) {
  const Index num_intervals = std::clamp<Index>(start.cols() - 1, kFewestIntervals, kMostStartIntervals);
  Points points = at_equal_parts(start, num_intervals);
  project_nodes(points);
  if (points.cols() < 3) points = at_equal_parts(start, kFewestIntervals);  // let the flow begin with it as it is
  FlowNodes nodes(surface_.dim(), surface_.codim());
  for (int round = 0; round < kMostRounds && points.cols() < kMostRoughNodes && !solver_.out_of_work(); ++round) {
    nodes.evaluate(evaluator_, points);
    std::vector<bool> wide = bent_intervals(nodes, kStartTurn);
    const Vector lengths = interval_lengths(points);
    for (std::size_t i = 0; i < wide.size(); ++i) {
      wide[i] = wide[i] || lengths(static_cast<Index>(i)) > kGap * lengths.mean();
    }
    if (insertion_.insert(points, wide) == 0) break;
  }
  const double loose = bound(polyline_length(start), false);
  FlowCurve curve{points, interval_lengths(points)};
  for (int round = 0;; ++round) {
    FlowState state = solver_.relax(std::move(curve), loose);
    if (is_over(state) || state.nodes.size() > kMostRoughNodes) return state;
    points = state.nodes.points();
    const std::vector<bool> bent = bent_intervals(state.nodes, kRoughTurn);
    if (std::ranges::find(bent, true) == bent.end()) return state;
    if (insertion_.insert(points, bent) == 0 || round == kMostRounds) {
      state.outcome = FlowOutcome::torn;
      return state;
    }
    cut_to_rule(points,
                {.longest = interval_lengths(points).maxCoeff(), .per_radius = kRoughTurn, .per_turn = kStartTurn});
    curve = {points, interval_lengths(points)};
  }
}

/// Inserts nodes until no interval is much longer than wanted where it is.
void FlowCorrection::cut_to_rule(Points& points, const IntervalRule& rule) {
  FlowNodes nodes(surface_.dim(), surface_.codim());
  for (int round = 0; round < kMostRounds && points.cols() < kMostRoughNodes && !solver_.out_of_work(); ++round) {
    nodes.evaluate(evaluator_, points);
    const Vector longer = interval_lengths(points).cwiseQuotient(wanted_intervals(points, normal_turns(nodes), rule));
    std::vector<bool> wide;
    for (const double ratio : longer) wide.push_back(ratio > kGap);
    if (insertion_.insert(points, wide) == 0) return;
  }
}

// How long intervals are to be: eps_E where a spacing is asked for, else such that (A1) is kDefaultAccuracy of the
// length; all alike, or in proportion to the radius of curvature (NodeSpread::curvature).
IntervalRule FlowCorrection::choose_rule(const Points& points) const {
  const Vector lengths = interval_lengths(points);
  const Vector curvatures = interval_curvatures(points);
  const double length = lengths.sum();
  // As Cst in (A1): the error goes with the square of the curvature.
  const double typical = std::sqrt(lengths.dot(curvatures.cwiseAbs2()) / length);  // root mean square
  const double cst = std::sqrt(24 * kDefaultAccuracy);                             // (A1) for small Cst
  IntervalRule rule{.longest = length / kFewestIntervals, .per_radius = kWantedTurn, .per_turn = kWantedTurn};
  if (options_.spacing > 0) rule.longest = options_.spacing;
  if (options_.nodes == NodeSpread::curvature && typical > 0) {
    const double mean = lengths.dot(curvatures) / length;
    const double flattest = std::min(1 / curvatures.minCoeff(), kFlattest / mean);
    rule.per_radius = std::min(kWantedTurn, options_.spacing > 0 ? options_.spacing / flattest : cst);
    rule.longest = std::min(rule.longest, rule.per_radius * flattest);
  } else if (options_.spacing == 0 && typical > 0) {
    rule.longest = std::min(rule.longest, cst / typical);
  }
  return rule;
}

FlowCurve FlowCorrection::with_widths(Points points, const IntervalRule& rule) {
  FlowNodes nodes(surface_.dim(), surface_.codim());
  nodes.evaluate(evaluator_, points);
  Vector widths = wanted_intervals(points, normal_turns(nodes), rule);
  return {std::move(points), std::move(widths)};
}

/// At the last scale: longer than eps_E, or bent too sharply; all of them where the default accuracy is missed.
std::vector<bool> FlowCorrection::too_long(const FlowState& state) {
  const Points& points = state.nodes.points();
  const Vector lengths = interval_lengths(points);
  const double longest = options_.spacing > 0 ? options_.spacing * (1 + 1e-9) : lengths.sum();
  std::vector<bool> wide = bent_intervals(state.nodes, kMostTurn);
  for (std::size_t i = 0; i < wide.size(); ++i) wide[i] = wide[i] || lengths(static_cast<Index>(i)) > longest;
  const double error = summarise(points).error_sum;
  const bool accurate = options_.spacing > 0 || error <= kAccurateEnough * kDefaultAccuracy * lengths.sum();
  // At a corner, or where the curve bends to and fro within the noise of F, the error is not of second order, and nodes
  // without number would not mend it.
  const bool of_second_order = error < kSecondOrder * last_error_;
  if (!accurate && of_second_order && 2 * points.cols() <= kMostDefaultNodes) wide.assign(wide.size(), true);
  last_error_ = error;
  return wide;
}

// From the first curve to the wanted number of nodes, by levels. `coarse_length` receives the length before the last
// doubling.
FlowState FlowCorrection::refine(FlowState state, double& coarse_length) {
  const Points rough = state.nodes.points();
  const double length = polyline_length(rough);
  const IntervalRule rule = choose_rule(rough);
  const Vector turns = normal_turns(state.nodes);
  const Vector wanted = wanted_intervals(rough, turns, rule);
  // The geodesic is longer than its polyline, and may not be cut into fewer intervals than that takes.
  const double stretch = 1 + summarise(rough).error_sum / length;
  // The last factor keeps rounding from adding an interval to a whole number.
  const double count = std::ceil(stretch * interval_lengths(rough).cwiseQuotient(wanted).sum() * (1 - 1e-9));
  if (options_.spacing > 0 && count > kMostNodes) {
    throw OutOfMemory("correct_flow: spacing = " + describe(options_.spacing) + " asks for " +
                      std::to_string(static_cast<Index>(count)) + " nodes; choose a larger spacing");
  }
  // So many halvings of the number of intervals leave the curve resolved.
  const double sharpest = std::max(interval_curvatures(rough).cwiseProduct(wanted).maxCoeff(),
                                   turns.cwiseQuotient(interval_lengths(rough)).cwiseProduct(wanted).maxCoeff());
  double intervals = std::max(2.0, std::min(count, static_cast<double>(kMostDefaultNodes)));
  if (options_.spacing > 0) intervals = std::max(2.0, count);
  double scale = 1;
  // Coarser by halves, as long as the sharpest bend is still followed at twice the intervals.
  while (intervals >= 2 * kFewestIntervals && 2 * scale * sharpest <= kRoughTurn) {
    intervals = std::ceil(intervals / 2);
    scale *= 2;
  }
  const double coarsest = scale;
  int rounds = 0;  // at the last scale: where insertion does not close a gap, it is not tried for ever
  Points points = spread_nodes(rough, wanted, static_cast<Index>(intervals)).points;
  project_nodes(points);
  while (true) {
    const bool last = scale <= 1;
    // New nodes are spread along the whole curve; where that leaves gaps again and again, they stay where they are put.
    FlowCurve curve =
        rounds <= kMostSpreadings ? with_widths(points, rule) : FlowCurve{points, interval_lengths(points)};
    state = solver_.relax(std::move(curve), bound(length, last));
    points = state.nodes.points();
    if (is_over(state)) break;
    const Vector lengths = interval_lengths(points);
    std::vector<bool> wide;
    if (last) {
      wide = too_long(state);
    } else {
      scale /= 2;
      const Vector now_wanted = wanted_intervals(points, normal_turns(state.nodes), rule);
      for (Index i = 0; i < lengths.size(); ++i) wide.push_back(lengths(i) > kGap * scale * now_wanted(i));
    }
    const Index before = points.cols();
    const Index inserted = insertion_.insert(points, wide);
    if (last && (inserted == 0 || ++rounds > kMostClosingRounds)) break;
    if (last) cut_to_rule(points, rule);  // a bend's surroundings, too: see first_curve
    if (solver_.out_of_work()) {
      state.outcome = FlowOutcome::out_of_work;
      break;
    }
    // A round that put a node into most intervals counts as a doubling: what the error estimate compares with.
    if (2 * inserted > before) coarse_length = lengths.sum();
    context_.report("correct", 1 - std::log2(scale) / (1 + std::log2(coarsest)));
  }
  return state;
}

FlowResult FlowCorrection::run(const PointsIn& start) {
  FlowState state = first_curve(start);
  double coarse_length = polyline_length(state.nodes.points());
  if (!is_over(state)) state = refine(std::move(state), coarse_length);
  FlowResult result;
  result.points = state.nodes.points();
  result.length = polyline_length(result.points);
  result.num_iterations = solver_.num_steps();
  result.summary = summarise(result.points);
  check_flow(surface_, options_, evaluator_, state, coarse_length, result);
  if (state.outcome == FlowOutcome::at_rest) {
    const Index conjugate = solver_.first_conjugate_node(state);
    result.locally_shortest = conjugate == 0;
    if (result.locally_shortest) result.index = 0;
    // The arc length of the node, too short by the chords' error before it.
    if (conjugate > 0) result.conjugate_at = polyline_length(result.points.leftCols(conjugate + 1));
  }
  result.summary.num_inserted = insertion_.num_projected();
  result.summary.num_plane_inserted = insertion_.num_in_plane();
  result.summary.num_across_cells = insertion_.num_across_cells();
  result.summary.num_iterations = solver_.num_steps();
  result.summary.num_evaluated = evaluator_.num_evaluated();
  return result;
}

}  // namespace taut::detail
