#include "taut/curve/flow.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "curve/chord_error.hpp"
#include "curve/flow_solver.hpp"
#include "curve/plane_projection.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::ChordError;
using detail::FlowNodes;
using detail::FlowSolver;
using detail::FlowState;

constexpr double kDefaultAccuracy = 2e-5;  // (A1) over the length, when no spacing is asked for
constexpr Index kFewestIntervals = 16;
constexpr Index kMostStartIntervals = 4096;
constexpr double kMostNodes = 1e7;          // with a spacing asked for
constexpr Index kMostDefaultNodes = 65536;  // without
constexpr double kCoarsestTurn = 0.5;   // eps / r up to which a polyline still follows its curve (29 degrees a node)
constexpr double kLooseBound = 1e-4;    // |k_g| length on coarse levels
constexpr double kDefaultBound = 1e-6;  // |k_g| length at the end: 1e-13 of the length
constexpr double kJump = 0.25;  // an interval whose middle is this far off (in intervals) is no part of the surface

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
  not_negative(options.cell, "cell");
  not_negative(options.curvature_bound, "curvature_bound");
  const double most = options.time_step == FlowTimeStep::explicit_euler ? 4 : std::numeric_limits<double>::max();
  if (!(options.beta > 0 && options.beta <= most)) {
    throw InvalidArgument("correct_flow: beta = " + detail::describe(options.beta) +
                          ", must be > 0 (and at most 4 with explicit steps)");
  }
  if (options.max_steps < 1) {
    throw InvalidArgument("correct_flow: max_steps = " + std::to_string(options.max_steps) + ", must be >= 1");
  }
}

/// One correction: the levels from coarse to fine around the solver.
class Correction {
 public:
  Correction(const Surface& surface, const FlowOptions& options, const Context& context)
      : surface_(surface), options_(options), context_(context), solver_(surface, options, context) {}

  FlowResult run(const PointsIn& start);

 private:
  /// Number of nodes to end with and how many halvings lead there.
  struct Plan {
    Index num_intervals;
    int num_halvings;
  };
  [[nodiscard]] Plan plan(const Points& curve) const;

  /// True when the default accuracy is there, or as many nodes as a default may take.
  [[nodiscard]] static bool is_resolved(const Points& nodes);

  void project_nodes(Points& nodes);
  /// Adds nodes between those farther apart than `threshold`, once each. Returns how many were found.
  Index insert(Points& nodes, double threshold);
  [[nodiscard]] FlowState first_curve(const PointsIn& start);
  [[nodiscard]] double bound(double length, bool last) const;
  void judge(const FlowState& state, double coarse_length, FlowResult& result);
  void judge_status(const FlowState& state, FlowResult& result);

  const Surface& surface_;
  const FlowOptions& options_;
  const Context& context_;
  FlowSolver solver_;
  Index num_inserted_ = 0;
  Index num_plane_inserted_ = 0;
};

double Correction::bound(double length, bool last) const {
  const double final_bound = options_.curvature_bound > 0 ? options_.curvature_bound : kDefaultBound / length;
  return last ? final_bound : std::max(final_bound, kLooseBound / length);
}

void Correction::project_nodes(Points& nodes) {
  const Index inner = nodes.cols() - 2;
  if (inner < 1) return;
  const double mean = detail::polyline_length(nodes) / static_cast<double>(inner + 1);
  const double reach = std::max({2 * mean, 2 * options_.cell, 0.0});
  Points projected = nodes.middleCols(1, inner);
  const auto found =
      detail::project_in_planes(solver_.evaluator(), surface_.dim(), surface_.codim(), projected,
                                Points::Zero(nodes.rows(), inner), Vector::Constant(inner, reach), 1e-6 * mean);
  // A node that finds no surface near is left out: its neighbours bridge the gap, insertion closes it.
  Points kept(nodes.rows(), nodes.cols());
  Index count = 0;
  const auto keep = [&](const Vector& p) {
    if (count == 0 || (p - kept.col(count - 1)).norm() > 1e-3 * mean) kept.col(count++) = p;
  };
  keep(nodes.col(0));
  for (Index i = 0; i < inner; ++i) {
    if (found(i)) keep(projected.col(i));
  }
  while (count > 1 && (kept.col(count - 1) - nodes.col(inner + 1)).norm() <= 1e-3 * mean) --count;
  kept.col(count++) = nodes.col(inner + 1);
  nodes = kept.leftCols(count);
}

Index Correction::insert(Points& nodes, double threshold) {
  std::vector<Index> wide;
  for (Index i = 0; i + 1 < nodes.cols(); ++i) {
    if ((nodes.col(i + 1) - nodes.col(i)).norm() > threshold) wide.push_back(i);
  }
  if (wide.empty()) return 0;
  const auto count = static_cast<Index>(wide.size());
  const Index d = nodes.rows();
  Points fresh(d, count);
  Points axes = Points::Zero(d, count);
  Vector gap(count);
  std::vector<bool> in_plane(wide.size());
  for (Index j = 0; j < count; ++j) {
    const Index i = wide[static_cast<std::size_t>(j)];
    const Vector edge = nodes.col(i + 1) - nodes.col(i);
    gap(j) = edge.norm();
    fresh.col(j) = nodes.col(i) + 0.5 * edge;
    in_plane[static_cast<std::size_t>(j)] =
        edge.cwiseAbs().maxCoeff() <= options_.cell;  // the gap lies within one cell
    if (in_plane[static_cast<std::size_t>(j)]) axes.col(j) = edge / gap(j);
  }
  const Points middle = fresh;
  const double tolerance = 1e-9 * gap.minCoeff();
  auto found = detail::project_in_planes(solver_.evaluator(), d, surface_.codim(), fresh, axes, gap, tolerance);

  // Figure 3: a projection that falls back onto A or B closes nothing. Those gaps get their plane too (Figure 4).
  std::vector<Index> again;
  for (Index j = 0; j < count; ++j) {
    if (in_plane[static_cast<std::size_t>(j)]) continue;
    const Index i = wide[static_cast<std::size_t>(j)];
    const double farther = std::max((fresh.col(j) - nodes.col(i)).norm(), (nodes.col(i + 1) - fresh.col(j)).norm());
    if (!found(j) || farther > 0.9 * gap(j)) again.push_back(j);
  }
  if (!again.empty()) {
    const auto retry = static_cast<Index>(again.size());
    Points points(d, retry);
    Points planes(d, retry);
    Vector reach(retry);
    for (Index a = 0; a < retry; ++a) {
      const Index j = again[static_cast<std::size_t>(a)];
      const Index i = wide[static_cast<std::size_t>(j)];
      points.col(a) = middle.col(j);
      planes.col(a) = (nodes.col(i + 1) - nodes.col(i)) / gap(j);
      reach(a) = 2 * gap(j);
    }
    const auto closed =
        detail::project_in_planes(solver_.evaluator(), d, surface_.codim(), points, planes, reach, tolerance);
    for (Index a = 0; a < retry; ++a) {
      const Index j = again[static_cast<std::size_t>(a)];
      fresh.col(j) = points.col(a);
      found(j) = closed(a);
      in_plane[static_cast<std::size_t>(j)] = true;
    }
  }

  Points merged(d, nodes.cols() + count);
  Index out = 0;
  Index next = 0;
  for (Index i = 0; i < nodes.cols(); ++i) {
    merged.col(out++) = nodes.col(i);
    if (next < count && wide[static_cast<std::size_t>(next)] == i) {
      if (found(next)) {
        merged.col(out++) = fresh.col(next);
        ++num_inserted_;
        if (in_plane[static_cast<std::size_t>(next)]) ++num_plane_inserted_;
      }
      ++next;
    }
  }
  const Index added = out - nodes.cols();
  nodes = merged.leftCols(out);
  return added;
}

/// The start path, projected and pulled taut at about its own resolution.
FlowState Correction::first_curve(const PointsIn& start) {
  const Index num_intervals = std::clamp<Index>(start.cols() - 1, kFewestIntervals, kMostStartIntervals);
  Points nodes = detail::resample(start, num_intervals);
  const double threshold = 1.5 * detail::polyline_length(nodes) / static_cast<double>(num_intervals);
  project_nodes(nodes);
  for (int round = 0; round < 8 && insert(nodes, threshold) > 0; ++round) {
  }
  if (nodes.cols() < 3) {  // nothing of the path could be projected: let the flow start from it as it is
    nodes = detail::resample(start, kFewestIntervals);
  }
  return solver_.relax(std::move(nodes), bound(detail::polyline_length(start), false));
}

Correction::Plan Correction::plan(const Points& curve) const {
  const ChordError error = detail::chord_error(curve);
  const double length = detail::polyline_length(curve) + error.sum;
  const double interval = detail::polyline_length(curve) / static_cast<double>(curve.cols() - 1);
  const double sharpest = error.max_cst / interval;  // largest curvature
  Plan plan{};
  if (options_.spacing > 0) {
    plan.num_intervals = std::max<Index>(2, static_cast<Index>(std::ceil(length / options_.spacing * (1 - 1e-9))));
    // A few nodes first, each halving doubles them: exactly as many as the spacing asks for, whatever the start was.
    double intervals = static_cast<double>(plan.num_intervals);
    while (intervals >= 2 * kFewestIntervals && 2 * sharpest * length <= kCoarsestTurn * intervals) {
      intervals = std::ceil(intervals / 2);
      ++plan.num_halvings;
    }
    return plan;
  }
  const double wanted = std::max(error.cst / interval * length / std::sqrt(24 * kDefaultAccuracy),
                                 sharpest * length / (0.4 * kCoarsestTurn));
  plan.num_intervals = kFewestIntervals;
  while (static_cast<double>(plan.num_intervals) < std::min(wanted, 0.25 * static_cast<double>(kMostDefaultNodes))) {
    plan.num_intervals *= 2;
    if (static_cast<double>(plan.num_intervals) * kCoarsestTurn > 2 * sharpest * length) ++plan.num_halvings;
  }
  return plan;
}

bool Correction::is_resolved(const Points& nodes) {
  const ChordError error = detail::chord_error(nodes);
  return 2 * nodes.cols() > kMostDefaultNodes ||
         (error.max_cst <= 0.5 * kCoarsestTurn && error.sum <= 1.5 * kDefaultAccuracy * detail::polyline_length(nodes));
}

FlowResult Correction::run(const PointsIn& start) {
  FlowState state = first_curve(start);
  FlowResult result;
  if (state.singular) {
    judge(state, detail::polyline_length(state.nodes.points()), result);
    return result;
  }
  const Plan steps = plan(state.nodes.points());
  if (static_cast<double>(steps.num_intervals) > kMostNodes) {
    throw OutOfMemory("correct_flow: spacing = " + detail::describe(options_.spacing) + " asks for " +
                      std::to_string(steps.num_intervals) + " nodes; choose a larger spacing");
  }
  // Each level evens out its nodes along the curve; a new one begins with as many as the plan says.
  const Index coarsest = (steps.num_intervals + (Index{1} << steps.num_halvings) - 1) >> steps.num_halvings;
  const double length = detail::polyline_length(state.nodes.points());
  double coarse_length = length;
  Points nodes = detail::resample(state.nodes.points(), coarsest);
  for (int level = 0;; ++level) {
    if (level > 0) {
      coarse_length = detail::polyline_length(nodes);
      // eps_E of this level: every interval is longer
      insert(nodes, 0.75 * coarse_length / static_cast<double>(nodes.cols() - 1));
    }
    const bool last = level >= steps.num_halvings;
    state = solver_.relax(std::move(nodes), bound(length, last));
    nodes = state.nodes.points();
    if (state.singular || (last && (options_.spacing > 0 || is_resolved(nodes)))) break;
    context_.report("correct", std::min(1.0, static_cast<double>(level + 1) / (steps.num_halvings + 1)));
  }
  judge(state, coarse_length, result);
  return result;
}

void Correction::judge(const FlowState& state, double coarse_length, FlowResult& result) {
  result.points = state.nodes.points();
  const Index m = result.points.cols() - 1;
  result.length = detail::polyline_length(result.points);
  result.num_iterations = solver_.num_steps();
  result.num_inserted = num_inserted_;
  result.num_plane_inserted = num_plane_inserted_;
  for (Index i = 0; i < m; ++i) {
    result.spacing = std::max(result.spacing, (result.points.col(i + 1) - result.points.col(i)).norm());
  }
  const ChordError error = detail::chord_error(result.points);
  result.model_error = error.sum;
  result.model_error_uniform = error.uniform;
  result.cst = error.cst;
  result.residual.geodesic_curvature = detail::measure_repose(state.nodes, result.points).geodesic_curvature;
  const double from_curvature = std::pow(result.residual.geodesic_curvature * result.length, 2) * result.length / 10;
  const double from_levels = 0.5 * std::abs(result.length - coarse_length);
  result.length_error = 1.5 * std::max(error.sum, from_levels) + from_curvature +
                        64 * std::numeric_limits<double>::epsilon() *
                            (result.length + result.points.cwiseAbs().maxCoeff() * std::sqrt(static_cast<double>(m)));
  judge_status(state, result);
  if (state.converged) {
    const Index conjugate = solver_.first_conjugate_node(state.nodes);
    result.locally_shortest = conjugate == 0;
    if (result.locally_shortest) result.index = 0;
    if (conjugate > 0) result.conjugate_at = detail::polyline_length(result.points.leftCols(conjugate + 1));
  }
}

void Correction::judge_status(const FlowState& state, FlowResult& result) {
  const Index m = result.points.cols() - 1;
  const Points middle = 0.5 * (result.points.leftCols(m) + result.points.rightCols(m));
  FlowNodes between(surface_.dim(), surface_.codim());
  between.evaluate(solver_.evaluator(), middle);
  double jump = 0;
  for (Index i = 0; i < m; ++i) {
    const double off = between.correction().col(i).norm();
    result.residual.surface = std::max(result.residual.surface, off);
    jump = std::max(jump, off / (result.points.col(i + 1) - result.points.col(i)).norm());
  }
  result.residual.surface = std::max(result.residual.surface, state.nodes.correction().colwise().norm().maxCoeff());
  const double ends = std::max(state.nodes.correction().col(0).norm(), state.nodes.correction().col(m).norm());

  // Neighbouring normals agree on a curve that is resolved; across a singular point they do not, however fine the
  // nodes.
  double agreement = 1;
  for (Index i = 0; i < m; ++i) {
    const auto cosines = state.nodes.normals(i).transpose() * state.nodes.normals(i + 1);
    agreement = std::min(agreement, std::abs(Eigen::MatrixXd(cosines).determinant()));
    if (surface_.codim() == 1)
      agreement = std::min(agreement, state.nodes.normals(i).col(0).dot(state.nodes.normals(i + 1).col(0)));
  }

  constexpr double kSingular = 1e-4;
  if (state.singular || (agreement < 0.5 && between.rank_margin() < 0.1) || state.nodes.rank_margin() < kSingular) {
    result.status = Status::rank_deficient;
    result.reason = "the curve runs into a point where the surface has no normal";
  } else if (!state.converged) {
    result.status = Status::not_converged;
    result.reason = "the geodesic curvature did not fall below its bound";
  } else if (ends >
             1e-6 * result.length + 16 * std::numeric_limits<double>::epsilon() * result.points.cwiseAbs().maxCoeff()) {
    result.status = Status::not_converged;
    result.reason = "an end point does not lie on the surface";
  } else if (options_.spacing > 0 && result.spacing > options_.spacing * (1 + 1e-6)) {
    result.status = Status::not_converged;
    result.reason = "a gap could not be closed to the spacing";
  } else if (!(jump <= kJump) || agreement < 0.5) {
    result.status = Status::not_converged;
    result.reason = "the spacing is too coarse for the surface: an interval leaves it";
  } else if (!surface_.inside_domain(result.points, 1e-6 * result.length).all()) {
    result.status = Status::left_domain;
    result.reason = "the curve leaves the surface's domain";
  } else {
    result.status = Status::ok;
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
    const Eigen::MatrixXd overlap = nodes.normals(0).transpose() * nodes.normals(1);
    turn = (nodes.normals(1) - nodes.normals(0) * overlap).norm();
    if (!(turn <= kFlat) || !(overlap.determinant() > 0)) return std::nullopt;
  }
  FlowResult result;
  result.points = ends;
  result.length = result.spacing = chord;
  result.length_error = chord * turn * turn / 24 + (chord > 0 ? std::numeric_limits<double>::epsilon() * scale : 0);
  result.model_error = result.model_error_uniform = chord * turn * turn / 24;
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
  if (std::optional<FlowResult> chord = chord_of_near_ends(surface, start)) return *std::move(chord);
  return Correction(surface, options, context).run(start);
}

}  // namespace taut
