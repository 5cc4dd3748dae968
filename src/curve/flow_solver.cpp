#include "curve/flow_solver.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace taut::detail {
namespace {

// Up to this many tangent directions the implicit system is assembled with its curvature term and factored; beyond, the
// nodes are coupled through the edges alone, one scalar tridiagonal solve for all coordinates: linear in d.
constexpr Index kMaxCoupled = 24;
constexpr double kExplicitStep = 0.25;  // Delta t / Delta h^2; stable below 1/2
constexpr double kEvenness = 1e-7;      // of an interval, from one to the next
constexpr Index kMaxIdle = 6;
constexpr double kMaxOffSurface = 0.25;  // of an interval: a step that leaves the surface farther is too long
constexpr double kOffSurface = 1e-9;     // of an interval, at rest
constexpr int kMaxProjectionSteps = 8;
// The same where the noise of F forbids more; a relative length error of some 1e-8 at most.
constexpr double kNoisyBound = 1e-4;  // |k_g| length
constexpr double kNoisyEvenness = 1e-4;
constexpr double kNoisyOffSurface = 1e-6;
constexpr double kRankMargin = 1e-10;

double energy(const PointsIn& points) {
  double sum = 0;
  for (Index i = 0; i + 1 < points.cols(); ++i) sum += (points.col(i + 1) - points.col(i)).squaredNorm();
  return 0.5 * sum;
}

/// Longest Newton-Raphson step of an inner node to the surface.
double off_surface(const FlowNodes& nodes) {
  return nodes.correction().middleCols(1, nodes.size() - 2).colwise().norm().maxCoeff();
}

/// What |k_g| is worth at best: positions carry a rounding of some eps |p|, divided by Delta h^2.
double curvature_noise(const PointsIn& points, double mean_interval) {
  return 64 * std::numeric_limits<double>::epsilon() * points.cwiseAbs().maxCoeff() / (mean_interval * mean_interval);
}

}  // namespace

FlowSolver::FlowSolver(const Surface& surface, const FlowOptions& options, const Context& context)
    : dim_(surface.dim()),
      codim_(surface.codim()),
      options_(options),
      context_(context),
      evaluator_(surface.make_evaluator()) {}

void FlowSolver::compute_velocity(const FlowNodes& nodes, const Points& q) {
  velocity_.resize(dim_, q.cols());
  multipliers_.resize(codim_, q.cols());
  velocity_.col(0).setZero();
  velocity_.col(q.cols() - 1).setZero();
  multipliers_.setZero();
  Vector pull(dim_);
  for (Index i = 1; i + 1 < q.cols(); ++i) {
    pull = (q.col(i + 1) - q.col(i)) - (q.col(i) - q.col(i - 1));  // C_ss Delta h^2, Figure 2
    nodes.multipliers(i, -pull, multipliers_.col(i));
    const auto normal = nodes.normals(i);
    velocity_.col(i) = pull - normal * (normal.transpose() * pull);  // (3)
  }
}

void FlowSolver::compute_hessians(const FlowNodes& nodes) {
  hessians_.resize(dim_ * dim_, nodes.size());
  evaluator_->evaluate(
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
      v(0) += v(0) < 0 ? -1.0 : 1.0;
      const double scale = 2 / v.squaredNorm();
      for (Index c = 0; c < t; ++c) {
        basis.col(c) = (-scale * v(c + 1)) * v;
        basis(c + 1, c) += 1;
      }
    } else {
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(nodes.normals(i));
      Eigen::MatrixXd selector = Eigen::MatrixXd::Zero(dim_, t);
      selector.bottomRows(t).setIdentity();
      basis = qr.householderQ() * selector;
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
      block.noalias() -= basis.transpose() * (hessian * basis);
    }
    block.diagonal().array() += 2 + shift;
    for (Index r = 0; r < t; ++r) {
      for (Index c = 0; c <= r; ++c) matrix_.at(row + r, row + c) = block(r, c);
    }
    if (i == 1) continue;
    const auto previous = Eigen::Map<const Eigen::MatrixXd>(bases_.data() + (i - 1) * dim_ * t, dim_, t);
    block.noalias() = -basis.transpose() * previous;
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
  // (2 + shift) x_i - x_{i-1} - x_{i+1} = velocity_i by elimination, then back into the tangent spaces.
  const Index inner = nodes.size() - 2;
  Vector ratio(inner + 1);
  ratio(0) = 0;
  move.setZero(dim_, nodes.size());
  for (Index i = 1; i <= inner; ++i) {
    const double pivot = 2 + shift - ratio(i - 1);
    ratio(i) = 1 / pivot;
    move.col(i) = (velocity_.col(i) + move.col(i - 1)) / pivot;
  }
  for (Index i = inner - 1; i >= 1; --i) move.col(i) += ratio(i) * move.col(i + 1);
  for (Index i = 1; i <= inner; ++i) {
    const auto normal = nodes.normals(i);
    const Vector across = normal.transpose() * move.col(i);
    move.col(i) -= normal * across;
  }
}

FlowState FlowSolver::relax(Points start, double bound) {
  const Index m = start.cols() - 1;
  FlowState state{.nodes = FlowNodes(dim_, codim_)};
  FlowNodes trial(dim_, codim_);
  state.nodes.evaluate(*evaluator_, std::move(start));
  if (state.nodes.rank_margin() < kRankMargin) {
    state.singular = true;
    return state;
  }
  // Energies are compared between nodes on the surface: those of a fresh polyline are not there yet.
  const double fresh_mean = polyline_length(state.nodes.points()) / static_cast<double>(m);
  for (int step = 0; step < kMaxProjectionSteps; ++step) {
    const double off = off_surface(state.nodes);
    if (off <= 1e-9 * fresh_mean || off > kMaxOffSurface * fresh_mean) break;
    trial.evaluate(*evaluator_, state.nodes.corrected());
    if (!(off_surface(trial) < off)) break;
    std::swap(state.nodes, trial);
  }
  const bool coupled = dim_ - codim_ <= kMaxCoupled;
  const bool explicit_step = options_.time_step == FlowTimeStep::explicit_euler;
  // Delta h^2 / Delta t for a time step in which the longest wave decays: (pi / m)^2.
  const double slowest = std::pow(std::numbers::pi / static_cast<double>(m), 2);
  double shift = explicit_step ? 1 / kExplicitStep : slowest;

  Points move;
  Points on_surface = state.nodes.corrected();
  double best_energy = energy(on_surface);
  double lowest_curvature = std::numeric_limits<double>::infinity();
  double lowest_energy = std::numeric_limits<double>::infinity();
  Index num_idle = 0;
  double quiet = kNoisyOffSurface;  // nodes come no nearer to the surface than the noise of F, in intervals
  while (true) {
    context_.check_cancelled();
    const double mean = polyline_length(on_surface) / static_cast<double>(m);
    const double off = off_surface(state.nodes);
    quiet = std::min(quiet, off / mean);
    const Repose repose = measure_repose(state.nodes, on_surface);
    state.curvature = repose.geodesic_curvature;
    const double noise = curvature_noise(on_surface, mean);
    const double rounding = std::numeric_limits<double>::epsilon() * on_surface.cwiseAbs().maxCoeff();
    if (state.curvature <= std::max(bound, noise) && repose.unevenness <= std::max(kEvenness, 64 * rounding / mean) &&
        off <= std::max(kOffSurface * mean, 64 * rounding)) {
      state.converged = true;
      break;
    }
    // Neither the curvature nor the energy falls any more.
    if (state.curvature < 0.5 * lowest_curvature || best_energy < lowest_energy * (1 - 1e-12)) {
      lowest_curvature = std::min(lowest_curvature, state.curvature);
      lowest_energy = best_energy;
      num_idle = 0;
    } else if (++num_idle > (explicit_step ? 1000 * m : kMaxIdle)) {
      break;
    }
    if (num_steps_ >= options_.max_steps) break;

    // (4): the part beta F draws the nodes to the surface, implicitly too: a share beta / (beta + shift) of the way.
    const double share = explicit_step ? options_.beta * kExplicitStep : options_.beta / (options_.beta + shift);
    Points q = state.nodes.points();
    q.middleCols(1, m - 1) += share * state.nodes.correction().middleCols(1, m - 1);
    compute_velocity(state.nodes, q);
    if (!explicit_step && coupled) {
      compute_bases(state.nodes);
      compute_hessians(state.nodes);
    }

    bool accepted = false;
    while (!accepted) {
      ++num_steps_;
      if (explicit_step) {
        move = kExplicitStep * velocity_;
      } else if (!coupled) {
        ambient_move(state.nodes, shift, move);
      } else if (!hessians_finite_ || !implicit_move(state.nodes, shift, Metric::hessian, move)) {
        // Not positive definite: the curve is not near a minimum. Without the curvature term it always is.
        if (!implicit_move(state.nodes, shift, Metric::stiffness, move)) break;
      }
      trial.evaluate(*evaluator_, q + move);
      const double trial_off = off_surface(trial);
      Points trial_on_surface = trial.corrected();
      const double trial_energy = energy(trial_on_surface);
      if (explicit_step || (trial.rank_margin() >= kRankMargin && trial_off <= kMaxOffSurface * mean &&
                            trial_energy <= best_energy * (1 + 1e-13 + 0.01 * quiet))) {
        std::swap(state.nodes, trial);
        on_surface = std::move(trial_on_surface);
        best_energy = trial_energy;
        accepted = true;
        if (!explicit_step) shift = shift < 1e-6 * slowest ? 0 : 0.1 * shift;
        if (state.nodes.rank_margin() < kRankMargin) {
          state.singular = true;
          return state;
        }
      } else {
        shift = std::max(4 * shift, 0.01 * slowest);
        if (shift > 1e6) break;
      }
    }
    if (!accepted) break;
  }
  if (!state.converged && num_steps_ < options_.max_steps && options_.curvature_bound == 0) {
    // Stopped by the noise of F (a smoothed fit carries 1e-10 of its size)? Then what is left is small all the same.
    const double length = polyline_length(on_surface);
    const Repose repose = measure_repose(state.nodes, on_surface);
    state.converged = repose.geodesic_curvature * length <= kNoisyBound && repose.unevenness <= kNoisyEvenness &&
                      off_surface(state.nodes) <= kNoisyOffSurface * length / static_cast<double>(m);
  }
  state.nodes.evaluate(*evaluator_, std::move(on_surface));
  return state;
}

Index FlowSolver::first_conjugate_node(const FlowNodes& nodes) {
  const Index t = dim_ - codim_;
  if (t > kMaxCoupled) return -1;
  compute_velocity(nodes, nodes.points());
  compute_hessians(nodes);
  if (!hessians_finite_) return -1;
  compute_bases(nodes);
  assemble(nodes, 0, Metric::hessian);
  const Index row = matrix_.factor();
  return row < 0 ? 0 : row / t + 1;
}

}  // namespace taut::detail
