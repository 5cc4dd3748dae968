// Time steps of the paper's equation (4) for a fixed number of nodes (notation in flow_nodes.hpp and flow_solver.hpp).
//
// Explicit Euler is the paper's scheme: stable for Delta t < Delta h^2 / 2, hence O(m^2) steps for m nodes. The
// implicit step linearises the velocity about the nodes in tangent coordinates: (shift M + A) y = T^T C_t with A the
// second variation of the discrete energy, block tridiagonal, factored in O(m (d - k)^3). As the shift goes to zero it
// becomes Newton's method, and the last steps converge quadratically. Where A is not positive definite, its curvature
// term is left out, which makes it a step of a gradient flow. Beyond kMaxCoupled directions one tridiagonal solve
// serves all coordinates. A step is kept if the energy does not rise and no node has left its sheet; else the shift
// grows tenfold.
//
// At rest: |k_g| below its bound, intervals even, nodes on the surface, each down to what rounding leaves; or, where
// neither energy nor curvature falls, to what the noise of F leaves, which the length hardly sees.
#include "curve/flow_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/linear_algebra.hpp"
#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Up to this many tangent directions the implicit system is assembled with its curvature term and factored; beyond, the
// nodes are coupled through the edges alone, one scalar tridiagonal solve for all coordinates: linear in d.
constexpr Index kMaxCoupled = 24;
constexpr double kExplicitStep = 0.25;  // Delta t / Delta h^2 for even nodes; stable below 1/2
constexpr double kEvenness = 1e-7;      // of eps_i / w_i, from one to the next
constexpr int kMaxIdle = 6;             // steps without progress; of explicit ones a thousand a node
constexpr double kOffSurface = 1e-9;    // of an interval, at rest
constexpr int kMaxProjectionSteps = 8;
constexpr double kMostShift = 1e6;  // a step that long in time is too long for nothing but rounding
// The same where the noise of F forbids more; a relative length error of some 1e-8 at most.
constexpr double kNoisyBound = 1e-4;  // |k_g| length
constexpr double kNoisyEvenness = 1e-4;
constexpr double kNoisyOffSurface = 1e-6;
// Nodes creep round a bend as sharp as an interval without end. On a curve that is straight within the surface that is
// no harm: their places are no part of the answer, and how long intervals are is looked at apart.
constexpr double kCreepingUnevenness = 1;
constexpr double kCreepingOffSurface = 1e-5;
constexpr double kRankMargin = 1e-10;
// A step s along the tangent plane leaves the surface by about s^2 / (2 r). One that leaves it by more than this part
// of s, or turns a node's normal by more than the angle of this cosine, has lost the sheet it started on.
constexpr double kMostRise = 0.3;
constexpr double kLeastCosine = 0.3;
constexpr double kFarthestApart = 0.2;  // ... and the cosine between neighbours' normals, for the same reason

/// Longest Newton-Raphson step of an inner node to the surface.
double off_surface(const FlowNodes& nodes) {
  return nodes.correction().middleCols(1, nodes.size() - 2).colwise().norm().maxCoeff();
}

/// What |k_g| is worth at best: positions carry a rounding of some eps |p|, divided by Delta h^2.
double curvature_noise(const PointsIn& points, double shortest_interval) {
  return 64 * kEpsilon * points.cwiseAbs().maxCoeff() / (shortest_interval * shortest_interval);
}

}  // namespace

FlowSolver::FlowSolver(CountingEvaluator& evaluator, Index dim, Index codim, const FlowOptions& options,
                       Index most_evaluated, const Context& context)
    : evaluator_(evaluator),
      dim_(dim),
      codim_(codim),
      options_(options),
      most_evaluated_(most_evaluated),
      context_(context) {}

void FlowSolver::set_widths(const VectorIn& widths) {
  const Index m = widths.size();
  // Mean 1, so that even nodes have the paper's formulas and stability limits.
  widths_ = widths / widths.mean();
  masses_.resize(m + 1);
  masses_ << widths_(0) / 2, (widths_.head(m - 1) + widths_.tail(m - 1)) / 2, widths_(m - 1) / 2;
}

double FlowSolver::energy(const PointsIn& points) const {
  double sum = 0;
  for (Index i = 0; i + 1 < points.cols(); ++i) sum += (points.col(i + 1) - points.col(i)).squaredNorm() / widths_(i);
  return 0.5 * sum;
}

void FlowSolver::compute_velocity(const FlowNodes& nodes, const Points& q) {
  velocity_.resize(dim_, q.cols());
  multipliers_.resize(codim_, q.cols());
  velocity_.col(0).setZero();
  velocity_.col(q.cols() - 1).setZero();
  multipliers_.setZero();
  Vector pull(dim_);
  for (Index i = 1; i + 1 < q.cols(); ++i) {
    pull = (q.col(i + 1) - q.col(i)) / widths_(i) - (q.col(i) - q.col(i - 1)) / widths_(i - 1);  // C_ss, Figure 2
    // At rest pull + J^T lambda = 0 at every node: lambda weighs the Hessians in the second variation.
    nodes.multipliers(i, -pull, multipliers_.col(i));
    const auto normal = nodes.normals(i);
    velocity_.col(i) = pull - normal * (normal.transpose() * pull);  // (3)
  }
}

void FlowSolver::compute_hessians(const FlowNodes& nodes) {
  hessians_.resize(dim_ * dim_, nodes.size());
  evaluator_.evaluate(
      {.n = nodes.size(), .x = nodes.points().data(), .weight = multipliers_.data(), .hessian = hessians_.data()});
  hessians_finite_ = hessians_.allFinite();
}

void FlowSolver::compute_bases(const FlowNodes& nodes) {
  const Index t = dim_ - codim_;
  bases_.resize(dim_ * t, nodes.size());
  for (Index i = 0; i < nodes.size(); ++i) {
    auto basis = Eigen::Map<Eigen::MatrixXd>(bases_.data() + i * dim_ * t, dim_, t);
    if (codim_ == 1) {
      // Columns 2 .. d of the reflection that takes the first axis to the normal.
      Vector v = nodes.normals(i).col(0);
      // The sign that does not cancel.
      v(0) += v(0) < 0 ? -1.0 : 1.0;
      const double scale = 2 / v.squaredNorm();
      for (Index c = 0; c < t; ++c) {
        basis.col(c) = (-scale * v(c + 1)) * v;
        basis(c + 1, c) += 1;
      }
    } else {
      basis = orthogonal_complement(nodes.normals(i));
    }
  }
}

void FlowSolver::assemble(const FlowNodes& nodes, double shift, Metric metric) {
  const Index t = dim_ - codim_;
  const Index inner = nodes.size() - 2;
  matrix_.reset(inner * t, 2 * t - 1);
  Eigen::MatrixXd block(t, t);
  for (Index i = 1; i <= inner; ++i) {
    const auto basis = Eigen::Map<const Eigen::MatrixXd>(bases_.data() + i * dim_ * t, dim_, t);
    const Index row = (i - 1) * t;
    block.setZero();
    if (metric == Metric::hessian) {
      const auto hessian = Eigen::Map<const Eigen::MatrixXd>(hessians_.data() + i * dim_ * dim_, dim_, dim_);
      // The Lagrangian is E - lambda F, since J^T lambda is the normal part of -pull = grad E: hence the minus.
      block.noalias() -= basis.transpose() * (hessian * basis);
    }
    block.diagonal().array() += 1 / widths_(i - 1) + 1 / widths_(i) + shift * masses_(i);
    for (Index r = 0; r < t; ++r) {
      for (Index c = 0; c <= r; ++c) matrix_.at(row + r, row + c) = block(r, c);
    }
    if (i == 1) continue;
    const auto previous = Eigen::Map<const Eigen::MatrixXd>(bases_.data() + (i - 1) * dim_ * t, dim_, t);
    block.noalias() = (-1 / widths_(i - 1)) * basis.transpose() * previous;
    for (Index r = 0; r < t; ++r) {
      for (Index c = 0; c < t; ++c) matrix_.at(row + r, row - t + c) = block(r, c);
    }
  }
}

bool FlowSolver::implicit_move(const FlowNodes& nodes, double shift, Metric metric, Points& move) {
  const Index t = dim_ - codim_;
  const Index inner = nodes.size() - 2;
  assemble(nodes, shift, metric);
  if (matrix_.factor() >= 0) return false;
  rhs_.resize(inner * t);
  for (Index i = 1; i <= inner; ++i) {
    const auto basis = Eigen::Map<const Eigen::MatrixXd>(bases_.data() + i * dim_ * t, dim_, t);
    rhs_.segment((i - 1) * t, t).noalias() = basis.transpose() * velocity_.col(i);
  }
  matrix_.solve(rhs_);
  move.setZero(dim_, nodes.size());
  for (Index i = 1; i <= inner; ++i) {
    const auto basis = Eigen::Map<const Eigen::MatrixXd>(bases_.data() + i * dim_ * t, dim_, t);
    move.col(i).noalias() = basis * rhs_.segment((i - 1) * t, t);
  }
  return true;
}

void FlowSolver::ambient_move(const FlowNodes& nodes, double shift, Points& move) const {
  // (stiffness + shift M) x = velocity by elimination, then back into the tangent spaces.
  const Index inner = nodes.size() - 2;
  Vector ratio(inner + 1);
  ratio(0) = 0;
  move.setZero(dim_, nodes.size());
  for (Index i = 1; i <= inner; ++i) {
    const double before = 1 / widths_(i - 1);
    const double after = 1 / widths_(i);
    const double pivot = before + after + shift * masses_(i) - before * ratio(i - 1);
    ratio(i) = after / pivot;
    move.col(i) = (velocity_.col(i) + before * move.col(i - 1)) / pivot;
  }
  for (Index i = inner - 1; i >= 1; --i) move.col(i) += ratio(i) * move.col(i + 1);
  for (Index i = 1; i <= inner; ++i) {
    const auto normal = nodes.normals(i);
    const Vector across = normal.transpose() * move.col(i);
    move.col(i) -= normal * across;
  }
}

/// Energies are compared between nodes on the surface: those of a fresh polyline are not there yet.
void FlowSolver::project(FlowNodes& nodes) {
  FlowNodes trial(dim_, codim_);
  const double mean = polyline_length(nodes.points()) / static_cast<double>(nodes.size() - 1);
  for (int step = 0; step < kMaxProjectionSteps; ++step) {
    const double off = off_surface(nodes);
    if (off <= kOffSurface * mean || !(off <= mean)) break;
    trial.evaluate(evaluator_, nodes.corrected());
    // Newton's steps that do not come nearer: the noise of F, or too far from the surface.
    if (!(off_surface(trial) < off)) break;
    std::swap(nodes, trial);
  }
}

bool FlowSolver::keeps_to_its_sheet(const FlowNodes& from, const FlowNodes& to) const {
  for (Index i = 1; i + 1 < from.size(); ++i) {
    const double moved = (to.points().col(i) - from.points().col(i)).norm();
    const double off = to.correction().col(i).norm();
    // Nodes may be as far off as they were before, besides what the move itself explains.
    if (!(off <= kMostRise * moved + 2 * from.correction().col(i).norm() + kNoisyOffSurface * moved)) return false;
    if (codim_ == 1 && from.normals(i).col(0).dot(to.normals(i).col(0)) < kLeastCosine) return false;
  }
  // Bases of several normals carry no orientation to compare.
  if (codim_ > 1) return true;
  // Neighbours that drift apart around the surface would let the curve slip through it.
  for (Index i = 1; i < from.size(); ++i) {
    if (to.normals(i).col(0).dot(to.normals(i - 1).col(0)) < kFarthestApart &&
        from.normals(i).col(0).dot(from.normals(i - 1).col(0)) >= kFarthestApart) {
      return false;
    }
  }
  return true;
}

bool FlowSolver::step_explicitly(FlowNodes& nodes) {
  double step = 1;  // of Delta h^2, the local one where nodes are not even
  for (Index i = 1; i + 1 < nodes.size(); ++i) {
    // Gershgorin's bound on the stiffness at the node; 1 for even nodes.
    step = std::min(step, 2 * masses_(i) / (1 / widths_(i - 1) + 1 / widths_(i)));
  }
  step *= kExplicitStep;
  ++num_steps_;
  compute_velocity(nodes, nodes.points());
  Points next = nodes.points() + options_.beta * step * nodes.correction();
  for (Index i = 1; i + 1 < nodes.size(); ++i) next.col(i) += step / masses_(i) * velocity_.col(i);
  next.col(0) = nodes.points().col(0);
  next.rightCols<1>() = nodes.points().rightCols<1>();
  nodes.evaluate(evaluator_, std::move(next));
  return true;
}

/// Steps of (4), each taken where the last one came to, the velocity linearised about the nodes. A step that does not
/// decrease the energy, or loses the sheet, is taken again over a shorter time.
bool FlowSolver::step_implicitly(FlowNodes& nodes) {
  // Coupled: second derivatives and a matrix of blocks. Otherwise edges only.
  const bool coupled = dim_ - codim_ <= kMaxCoupled;
  const Points on_surface = nodes.corrected();
  const double before = energy(on_surface);
  // The part beta F draws the nodes to the surface, implicitly too: a share beta / (beta + shift) of the way.
  const double share = options_.beta / (options_.beta + shift_);
  Points q = nodes.points();
  q.middleCols(1, q.cols() - 2) += share * nodes.correction().middleCols(1, q.cols() - 2);
  compute_velocity(nodes, q);
  if (coupled) {
    compute_bases(nodes);
    compute_hessians(nodes);
  }
  FlowNodes trial(dim_, codim_);
  Points move;
  while (shift_ <= kMostShift && !out_of_work()) {
    ++num_steps_;
    if (!coupled) {
      ambient_move(nodes, shift_, move);
    } else if (!hessians_finite_ || !implicit_move(nodes, shift_, Metric::hessian, move)) {
      // Not positive definite: the curve is not near a minimum. Without the curvature term it always is.
      if (!implicit_move(nodes, shift_, Metric::stiffness, move)) return false;
    }
    trial.evaluate(evaluator_, q + move);
    if (trial.rank_margin() >= kRankMargin && keeps_to_its_sheet(nodes, trial) &&
        // Energies of nodes as far off the surface as the noise of F are known no better than that.
        energy(trial.corrected()) <= before * (1 + 1e-13 + 0.01 * quiet_)) {
      std::swap(nodes, trial);
      // A step that succeeds may be ten times as long in time the next time, at last infinitely long: Newton's.
      shift_ = shift_ < 1e-6 * slowest_ ? 0 : 0.1 * shift_;
      return true;
    }
    shift_ = std::max(10 * shift_, 0.01 * slowest_);
  }
  return false;
}

FlowState FlowSolver::relax(FlowCurve start, double bound) {
  const Index m = start.points.cols() - 1;
  const bool explicit_step = options_.time_step == FlowTimeStep::explicit_euler;
  set_widths(start.widths);
  FlowState state{.nodes = FlowNodes(dim_, codim_), .widths = widths_};
  FlowNodes& nodes = state.nodes;
  nodes.evaluate(evaluator_, std::move(start.points));
  // The least eigenvalue of the stiffness of m even intervals, to leading order.
  slowest_ = std::pow(std::numbers::pi / static_cast<double>(m), 2);
  shift_ = slowest_;
  quiet_ = kNoisyOffSurface;
  if (nodes.rank_margin() >= kRankMargin && !explicit_step) project(nodes);

  double lowest_curvature = std::numeric_limits<double>::infinity();
  double lowest_energy = std::numeric_limits<double>::infinity();
  Index num_idle = 0;
  Points on_surface;
  double mean = 0;
  double off = 0;
  Repose repose;
  while (true) {
    context_.check_cancelled();
    if (nodes.rank_margin() < kRankMargin) {
      state.outcome = FlowOutcome::singular;
      return state;
    }
    on_surface = nodes.corrected();
    mean = polyline_length(on_surface) / static_cast<double>(m);
    off = off_surface(nodes);
    // The nearest that the nodes have come so far.
    quiet_ = std::min(quiet_, off / mean);
    repose = measure_repose(nodes, on_surface, widths_);
    const double noise = curvature_noise(on_surface, mean * widths_.minCoeff());
    const double rounding = kEpsilon * on_surface.cwiseAbs().maxCoeff();
    if (repose.geodesic_curvature <= std::max(bound, noise) &&
        repose.unevenness <= std::max(kEvenness, 64 * rounding / (mean * widths_.minCoeff())) &&
        off <= std::max(kOffSurface * mean, 64 * rounding)) {
      state.outcome = FlowOutcome::at_rest;
      break;
    }
    // Neither the curvature nor the energy falls any more, nor do nodes come nearer to the surface.
    const double now = energy(on_surface);
    if (repose.geodesic_curvature < 0.5 * lowest_curvature || now < lowest_energy * (1 - 1e-12)) {
      lowest_curvature = std::min(lowest_curvature, repose.geodesic_curvature);
      lowest_energy = std::min(lowest_energy, now);
      num_idle = 0;
    } else if (++num_idle > (explicit_step ? 1000 * m : kMaxIdle)) {
      break;
    }
    if (out_of_work() || !(explicit_step ? step_explicitly(nodes) : step_implicitly(nodes))) break;
  }
  const double noise = curvature_noise(on_surface, mean * widths_.minCoeff());
  const bool only_creeps = repose.geodesic_curvature <= std::max(bound, noise) &&
                           repose.unevenness < kCreepingUnevenness && off <= kCreepingOffSurface * mean;
  if (only_creeps) state.outcome = FlowOutcome::at_rest;
  if (state.outcome != FlowOutcome::at_rest && out_of_work()) state.outcome = FlowOutcome::out_of_work;
  if (state.outcome != FlowOutcome::at_rest && options_.curvature_bound == 0) {
    // Stopped by the noise of F (a smoothed fit carries 1e-10 of its size)? Then what is left is small all the same.
    const double length = mean * static_cast<double>(m);
    if (repose.geodesic_curvature * length <= kNoisyBound && repose.unevenness <= kNoisyEvenness &&
        off <= kNoisyOffSurface * mean) {
      state.outcome = FlowOutcome::at_rest;
    }
  }
  // The curve that was judged is the one stepped onto the surface; explicit steps hand over the paper's own nodes.
  if (!explicit_step) nodes.evaluate(evaluator_, std::move(on_surface));
  return state;
}

Index FlowSolver::first_conjugate_node(const FlowState& state) {
  const Index t = dim_ - codim_;
  if (t > kMaxCoupled) return -1;
  set_widths(state.widths);
  compute_velocity(state.nodes, state.nodes.points());
  compute_hessians(state.nodes);
  if (!hessians_finite_) return -1;
  compute_bases(state.nodes);
  assemble(state.nodes, 0, Metric::hessian);
  const Index row = matrix_.factor();
  // Rows are those of inner nodes, t each; node 0 is fixed and has none.
  return row < 0 ? 0 : row / t + 1;
}

}  // namespace taut::detail
