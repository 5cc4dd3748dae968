#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "curve/nodal_curve.hpp"
#include "curve/reference_element.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// How Newton's iteration on one mesh ended.
enum class Relaxation {
  converged,
  saddle,       ///< a geodesic, but not a minimum: energy falls along a direction of negative curvature
  stalled,      ///< no step decreases the energy any more, or the iterations are used up
  singular,     ///< the Jacobian lost rank, or F is not finite, at a node
  off_surface,  ///< the start does not project onto the surface
  collapsed,    ///< the curve shrank to a point
};

/// What one relaxation is asked for.
struct RelaxationGoal {
  double energy = 1e-12;       ///< stop when the next step would lower the energy by less than this fraction of it
  double off_surface = 1e-12;  ///< ... and nodes are at most this far off the surface, model units
  int max_iterations = 100;
  bool minimum = true;  ///< accept only a local minimum; else the nearest geodesic, by steps of either kind
};

/// Newton's method for a geodesic on one mesh.
///
/// Notation: curve x(t), 0 <= t <= T, on elements [t_e, t_{e+1}] of length h_e, polynomial of degree p on
/// Gauss-Lobatto-Legendre nodes x_j in R^d; ends fixed. E = 1/2 int |x'|^2 dt = 1/2 sum_ij K_ij x_i . x_j exactly,
/// under F(x_j) = 0. J is the k x d Jacobian at a node, T its d x q tangents, n = -J^+ F the step to the linearised
/// surface. Stationary: K x + J^T mu = 0. One step: x_j <- x_j + n_j + s_j, s_j = T_j y_j, with
///   A_ij = T_i^T (K_ij I + delta_ij sum_l mu_l Hess F_l) T_j,   A y = -T^T (K (x + n) + mu Hess F n),
/// which is Newton's method for the constrained problem written in tangent coordinates. When A is not positive definite
/// the curvature term is dropped: then T^T K T is the metric of a Sobolev gradient, and the step shortens the curve.
/// The energy of x + n decides about a step's length.
///
/// How the systems are solved is `System`: DirectSystem or KrylovSystem.
template <class System>
class NewtonKernel {
 public:
  using Frame = typename System::Frame;
  static constexpr int D = Frame::kD;
  static constexpr int K = Frame::kK;
  using VectorD = Eigen::Matrix<double, D, 1>;
  using VectorK = Eigen::Matrix<double, K, 1>;
  using Nodes = Eigen::Matrix<double, D, Eigen::Dynamic>;

  NewtonKernel(Index dim, Index codim) : d_(dim), k_(codim), system_(dim, codim) {
    curve_.dim = dim;
    curve_.codim = codim;
    frame_.resize(d_, k_);
    mu_scratch_.resize(k_);
    vector_.resize(d_);
  }

  // The mesh and the curve on it.

  /// Sets degree and element lengths; nodes are to be filled in by `nodes`.
  void set_mesh(int degree, const std::vector<double>& lengths) {
    curve_.set_mesh(degree, lengths);
    period_ = 0;
    for (const double h : lengths) period_ += h;
    const Index n = num_nodes();
    for (Nodes* field : {&base_, &step_, &old_normal_}) field->resize(d_, n);
    bends_.resize(n);
    system_.resize(curve_);
  }
  [[nodiscard]] int degree() const { return curve_.degree(); }
  [[nodiscard]] const ReferenceElement& element() const { return *curve_.element; }
  [[nodiscard]] Index num_elements() const { return curve_.num_elements(); }
  [[nodiscard]] Index num_nodes() const { return curve_.num_nodes(); }
  [[nodiscard]] const std::vector<double>& lengths() const { return curve_.lengths; }
  [[nodiscard]] double period() const { return period_; }  ///< T
  [[nodiscard]] Nodes& nodes() { return curve_.x; }
  [[nodiscard]] const Nodes& nodes() const { return curve_.x; }
  /// Has node j, of the last visit, a tangent space: only an end may have none (a singular point).
  [[nodiscard]] bool regular(Index j) const { return j == 0 ? regular_start_ : j + 1 < num_nodes() || regular_end_; }
  /// How much the tangent space turns from node i to node j, both regular (an angle, radians, for small ones).
  [[nodiscard]] double turn(Index i, Index j) const { return system_.turn(i, j); }
  /// A unit normal at node j, a regular one (the first of k), of the last visit.
  [[nodiscard]] auto normal(Index j) const { return curve_.normal.col(j); }
  [[nodiscard]] Index codim() const { return k_; }

  [[nodiscard]] double energy() const { return energy_; }
  [[nodiscard]] double length() const { return std::sqrt(2 * energy_ * period_); }
  [[nodiscard]] double decrement() const { return decrement_; }      ///< energy the last step was predicted to gain
  [[nodiscard]] double off_surface() const { return off_surface_; }  ///< max |n| at the last visit
  [[nodiscard]] int num_iterations() const { return iterations_; }
  [[nodiscard]] Index num_evaluated() const { return evaluated_; }
  /// Did the last relaxation end with a full Newton step: then no more energy than left() can be gained.
  [[nodiscard]] bool settled() const { return settled_; }
  [[nodiscard]] double left() const { return left_; }
  /// Energy that may be left to gain along a direction in which it hardly changes.
  [[nodiscard]] double soft_energy() const { return soft_energy_; }
  void reset_counters() {
    iterations_ = 0;
    evaluated_ = 0;
    worst_rate_ = 0;
  }

  /// Can the mesh tell minima from saddles: is every element alone positive definite.
  [[nodiscard]] bool resolved() const { return system_.resolved(); }
  /// After a relaxation that converged: is the curve a minimum, not counting neutral directions.
  [[nodiscard]] bool minimum() const { return system_.minimum(); }
  /// Directions in which the energy falls.
  [[nodiscard]] int num_negative() const { return system_.num_negative(); }
  /// How far the ends are off the surface, model units.
  [[nodiscard]] double ends_off() const { return ends_off_; }
  /// Parameter of the first conjugate point, for a curve with negative directions. None when an end is a singular
  /// point of the surface.
  std::optional<double> conjugate_point() { return system_.conjugate_point(curve_, regular_start_ && regular_end_); }

  /// Moves the nodes to a geodesic.
  Relaxation relax(Evaluator& evaluator, const RelaxationGoal& goal, const Context& context) {
    const Relaxation projected = project(evaluator);
    if (projected != Relaxation::converged) return projected;
    const double start_energy = energy_;
    push_ = kFirstPush;
    sunk_ = false;
    left_ = kUnknown;
    last_gain_ = 0;
    // The shortening steps of sink() count as iterations, too.
    const int last = iterations_ + goal.max_iterations;
    while (true) {
      context.check_cancelled();
      settled_ = false;
      if (arrived(evaluator, goal)) return Relaxation::converged;
      if (iterations_ >= last) return Relaxation::stalled;
      ++iterations_;
      left_ = kUnknown;
      soft_energy_ = 0;
      // The square of the length: 1e-11 of it is left.
      if (energy_ <= 1e-22 * start_energy || energy_ == 0) return Relaxation::collapsed;
      Progress progress = plan(evaluator, goal);
      if (progress == Progress::planned) progress = explore(evaluator, goal);
      if (progress == Progress::planned && plan_.flat) progress = finish(evaluator, goal);
      if (progress == Progress::planned) progress = advance(evaluator, goal);
      if (progress == Progress::ended) return outcome_;
    }
  }

 private:
  static constexpr double kNeutral = 1e-7;    // of the stiffness: curvature below is that of (nearly) conjugate ends
  static constexpr double kReach = 0.25;      // of the length: how far curves are looked for along a soft direction
  static constexpr double kInValley = 1e-3;   // of the energy: where all but soft directions have settled
  static constexpr double kLevel = 1e-4;      // of the stiffness: curvature below is known only close to the geodesic
  static constexpr double kExact = 1e-24;     // of the energy
  static constexpr double kFirstPush = 0.03;  // of the length: the first step away from a saddle
  static constexpr double kLeastRate = 10;    // of second-order convergence, in the energy's own size...
  static constexpr double kRateSafety = 100;  // ... and by how much the worst that was seen is exceeded at most
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();
  static constexpr int kMostProjections = 3;
  static constexpr int kMostSinking = 30;
  static constexpr int kMostHalvings = 30;
  static constexpr int kFewHalvings = 2;
  static constexpr double kFarthestApart = 0.2;  // cosine between the normals of neighbours
  static constexpr double kMostTurn = 0.7;       // radians a node may move around its surface in one step

  // What an iteration is about to do with step_, and what it knows about the second variation.
  struct Plan {
    double slope = 0;      // dE step_
    double worthless = 0;  // energy not worth a step
    bool flat = false;     // step_ promises no more than that
    bool descend = true;   // towards a minimum: the energy has to fall
    SoftDirection soft;
    [[nodiscard]] bool negative() const { return soft.relative() < -kNeutral; }
  };
  // How an iteration goes on after one of its parts.
  enum class Progress {
    planned,  // step_ is still to be taken
    moved,    // the curve has moved, or has to be looked at again
    ended,    // with outcome_
  };
  Progress end(Relaxation outcome) {
    outcome_ = outcome;
    return Progress::ended;
  }

  // Where the steps promise that nothing is left worth another system, only the way to the surface is: is that so.
  bool arrived(Evaluator& evaluator, const RelaxationGoal& goal) {
    // Conjugate gradients cannot confirm a minimum without a search of their own.
    if constexpr (!System::kFactors) return false;
    if (!(left_ <= worthless(goal)) || !goal.minimum) return false;
    if (system_.confirm_minimum(curve_, evaluator, left_) != Confirmation::minimum) return false;
    for (int round = 0; off_surface_ > goal.off_surface; ++round) {
      curve_.x = base_;
      visit(evaluator);
      if (!measure() || round == kMostProjections) return false;
    }
    curve_.x = base_;
    settled_ = true;
    return true;
  }

  // Energy not worth a step.
  // No less than rounding, whatever is asked for.
  [[nodiscard]] double worthless(const RelaxationGoal& goal) const { return std::max(goal.energy, 4e-16) * energy_; }

  // Newton's step, or a shortening one where the energy is not convex.
  Progress plan(Evaluator& evaluator, const RelaxationGoal& goal) {
    system_.linearise(evaluator, curve_, frame_);
    plan_ = {};
    plan_.worthless = worthless(goal);
    definite_ = system_.factor(curve_, evaluator, true, true);
    if (!definite_) {
      plan_.soft = system_.soft_direction(curve_, evaluator);
      // Where any geodesic will do, the indefinite matrix is solved as it is: Newton's step to a saddle.
      plan_.descend = goal.minimum || system_.minimum() || !system_.factor(curve_, evaluator, true, false);
      // Otherwise a shortening step, in the metric T^T K T.
      if (plan_.descend && !system_.factor(curve_, evaluator, false, true)) return end(Relaxation::stalled);
    }
    plan_.slope = system_.solve(step_);
    decrement_ = 0.5 * std::abs(plan_.slope);
    plan_.flat = decrement_ <= plan_.worthless;
    watch_rate();
    if (!plan_.flat || !definite_) return Progress::planned;
    switch (system_.confirm_minimum(curve_, evaluator, plan_.worthless)) {
      case Confirmation::minimum: break;
      // The curve has not moved: the next round solves to a smaller residual.
      case Confirmation::too_coarse: return Progress::moved;
      case Confirmation::soft:
        plan_.soft = system_.soft_direction(curve_, evaluator);
        if (plan_.soft.curvature > 0) break;
        definite_ = false;
        plan_.descend = goal.minimum;
    }
    return Progress::planned;
  }

  // Where all but soft directions have settled: along them, down a valley or off a saddle.
  Progress explore(Evaluator& evaluator, const RelaxationGoal& goal) {
    // As long as hard directions still gain, soft ones are not worth a look.
    if (!goal.minimum || decrement_ > kInValley * energy_) return Progress::planned;
    const bool level = plan_.soft.found && std::abs(plan_.soft.relative()) < kLevel && degree() > 1;
    // Curvatures as small as that are known only from a curve on the floor of the valley.
    if (level && !sunk_) return sink_once(evaluator);
    if (level && !definite_) {
      soft_energy_ = energy_along(plan_.soft);
      if (soft_energy_ > plan_.worthless) {
        system_.soft_step(step_);
        // Over a flat valley the direction is good for a quarter of the length.
        step_ *= kReach * length() / plan_.soft.longest;
        sunk_ = false;
        if (slide(evaluator)) return Progress::moved;
        sunk_ = true;
        if (!system_.factor(curve_, evaluator, false, true)) return end(Relaxation::stalled);
      }
      if (plan_.flat) (void)system_.confirm_minimum(curve_, evaluator, plan_.worthless);
      system_.solve(step_);
    } else if (plan_.negative()) {
      if (leave_saddle(evaluator)) return Progress::moved;
      system_.solve(step_);
    }
    return Progress::planned;
  }

  // With a worthless step left.
  Progress finish(Evaluator& evaluator, const RelaxationGoal& goal) {
    // No gain left but along a direction that falls, and explore() found no way down along it.
    if (plan_.negative() && goal.minimum) return end(Relaxation::saddle);
    // Along a nearly neutral direction (conjugate ends) even a worthless step is long: then only go to the surface.
    const double longest = step_.colwise().norm().maxCoeff();
    // A step s leaves the surface by about s^2 / 2 r: short enough not to spoil the nodes' place on it.
    const bool short_step = longest * longest <= goal.off_surface * period_;
    if (definite_ && !short_step && !sunk_ && degree() > 1 && goal.minimum &&
        2 * decrement_ < kLevel * curve_.apply_stiffness(step_, old_normal_, vector_)) {
      return sink_once(evaluator);
    }
    if (off_surface_ <= goal.off_surface) {
      curve_.x = base_;
      settled_ = (definite_ || !plan_.descend) && short_step;
      if (settled_) {
        curve_.x += step_;
        left_ = std::min(decrement_, second_order(decrement_));
      }
      return end(Relaxation::converged);
    }
    // One more step costs no more than the projection alone.
    if (decrement_ > 1e-2 * goal.energy * energy_) return Progress::planned;
    curve_.x = base_;
    visit(evaluator);
    if (!measure()) return end(Relaxation::singular);
    if (definite_ && short_step) left_ = decrement_;
    return Progress::moved;
  }

  // Energy left after a full Newton step that gained this much, where no direction is soft.
  [[nodiscard]] double second_order(double gain) const {
    return kRateSafety * std::max(kLeastRate, worst_rate_) * gain * (gain / energy_);
  }
  // Takes note of how fast this solve converges, from one step worth its while to the next.
  void watch_rate() {
    if (plan_.flat) return;
    const double gain = decrement_ / energy_;
    if (last_gain_ > 0) worst_rate_ = std::max(worst_rate_, gain / (last_gain_ * last_gain_));
    last_gain_ = gain;
  }

  // Takes the step as far as it leads down.
  Progress advance(Evaluator& evaluator, const RelaxationGoal& goal) {
    // On the floor of a valley many halvings only creep: a few, then slide along it.
    const bool valley = definite_ && plan_.descend && degree() > 1 && decrement_ <= kInValley * energy_;
    const bool fresh = sunk_;
    sunk_ = false;
    if (search(evaluator, plan_.slope, !plan_.descend, valley ? kFewHalvings : kMostHalvings)) {
      if (definite_ && plan_.descend && !plan_.soft.found && share_ == 1) left_ = second_order(decrement_);
      return Progress::moved;
    }
    if (valley) {
      step_ = trial_step_;
      restore(evaluator);
      if (slide(evaluator)) return Progress::moved;
      sunk_ = fresh;
      if (search(evaluator, plan_.slope, !plan_.descend, kMostHalvings)) return Progress::moved;
    }
    if (plan_.flat) return end(Relaxation::converged);
    // Close to a conjugate point a Newton step can be too long to be of use; shortening still is.
    if (definite_ && plan_.descend && shorten(evaluator, goal)) return Progress::moved;
    return end(failure_);
  }

  // F, J (and what the system wants) at the nodes.
  void visit(Evaluator& evaluator) {
    const Index n = num_nodes();
    evaluated_ += n;
    PointBatch batch{.n = n, .x = curve_.x.data(), .value = curve_.value.data(), .jacobian = curve_.jacobian.data()};
    system_.ask(batch, curve_);
    evaluator.evaluate(batch);
  }

  // Frames, normal corrections, the corrected nodes `base_`, their force and energy. False where J loses rank.
  bool measure() {
    const Index n = num_nodes();
    off_surface_ = 0;
    base_ = curve_.x;
    for (Index j = 0; j < n; ++j) {
      const auto gradients = curve_.gradients(j);
      const bool regular = curve_.value.col(j).allFinite() && frame_.compute(gradients);
      if (j == 0 || j + 1 == n) {  // an end may be a singular point: it does not move
        if (j == 0) ends_off_ = 0;
        if (regular) {
          frame_.pseudo_inverse(curve_.value.col(j), mu_scratch_, vector_);
          ends_off_ = std::max(ends_off_, vector_.norm());
        }
        (j == 0 ? regular_start_ : regular_end_) = regular;
        if (regular) {
          curve_.normal.col(j) = frame_.first_normal();
          system_.keep(j, frame_);
        }
        continue;
      }
      if (!regular) return false;
      frame_.pseudo_inverse(-curve_.value.col(j), mu_scratch_, vector_);
      curve_.normal.col(j) = frame_.first_normal();
      system_.keep(j, frame_);
      curve_.off.col(j) = vector_;
      base_.col(j) += vector_;
      off_surface_ = std::max(off_surface_, vector_.norm());
    }
    energy_ = curve_.apply_stiffness(base_, curve_.force, vector_) / 2;
    return std::isfinite(energy_);
  }

  Relaxation project(Evaluator& evaluator) {
    for (int round = 0; round < 50; ++round) {
      visit(evaluator);
      if (!measure()) return Relaxation::singular;
      double worst = 0;
      for (Index j = 1; j + 1 < num_nodes(); ++j) {
        const auto e = static_cast<std::size_t>(std::min(j / degree(), num_elements() - 1));
        // Distances between nodes are the measure of how far a step is credible, by the curve or, where it folds, by
        // the mesh.
        const double near = std::max((curve_.x.col(j + 1) - curve_.x.col(j - 1)).norm() / 2,
                                     curve_.lengths[e] / (2 * static_cast<double>(degree())));
        const double share = curve_.off.col(j).norm() / near;
        worst = std::max(worst, share);
        // where F is far from linear (inside a thin body) a full step would fly away
        if (share > 0.5) base_.col(j) = curve_.x.col(j) + (0.5 / share) * curve_.off.col(j);
      }
      // Newton's method does the rest: nodes only have to be in its reach.
      if (worst <= 0.05) return Relaxation::converged;
      curve_.x = base_;
    }
    return Relaxation::off_surface;
  }

  // One Sobolev step from where the last search began. False when that, too, leads nowhere.
  bool shorten(Evaluator& evaluator, const RelaxationGoal& goal) {
    if (!restore(evaluator)) return false;
    system_.linearise(evaluator, curve_, frame_);
    if (!system_.factor(curve_, evaluator, false, true)) return false;
    const double slope = system_.solve(step_);
    decrement_ = 0.5 * std::abs(slope);
    if (search(evaluator, slope, false, kMostHalvings)) return true;
    // Not even shortening gains anything: the curve is at rest as far as numbers tell.
    if (decrement_ <= std::max(goal.energy, 4e-16) * trial_energy_) failure_ = Relaxation::converged;
    return false;
  }

  // Back to where the last search began.
  bool restore(Evaluator& evaluator) {
    curve_.x = trial_base_;
    visit(evaluator);
    return measure();
  }

  // What curves may gain along a soft direction (of step_'s size unless the system has found it), within their length.
  double energy_along(const SoftDirection& soft) {
    if (soft.longest <= 0) return 0;
    const double reach = length() / soft.longest;
    return reach * soft.slope + reach * reach * std::abs(soft.curvature) / 2;
  }

  Progress sink_once(Evaluator& evaluator) {
    sunk_ = true;
    sink(evaluator);
    return Progress::moved;
  }

  // Shortening steps to the floor of a valley, until they gain no less than the one before: only the way along it is
  // left.
  void sink(Evaluator& evaluator) {
    double before = std::numeric_limits<double>::infinity();
    int standing = 0;
    for (int step = 0; step < kMostSinking; ++step) {
      ++iterations_;
      system_.linearise(evaluator, curve_, frame_);
      if (!system_.factor(curve_, evaluator, false, true)) return;
      const double slope = system_.solve(step_);
      // Hard directions gain by a large factor a step: when gains stay alike, a soft direction makes them.
      if (step > 2 && std::abs(slope) > 0.7 * before) ++standing;
      if (standing > 2 || std::abs(slope) <= kExact * energy_ || !search(evaluator, slope, false, kMostHalvings))
        return;
      before = std::abs(slope);
    }
  }

  // Along a valley whose floor is nearly level the energy tells nothing of a step: bending away from the floor costs
  // more than is to be gained. A long way along step_, then back to the floor by shortening steps, and only then the
  // energies are compared. False, and the curve where it was, when no length of step leads down.
  bool slide(Evaluator& evaluator) {
    const double longest = step_.colwise().norm().maxCoeff();
    if (!(longest > 0) || degree() == 1) return false;
    const Nodes origin = curve_.x;
    const Nodes along = step_;
    const double before = energy_;
    double size = std::min(1.0, kReach * length() / longest);
    for (int attempt = 0; attempt < 4; ++attempt, size /= 4) {
      step_ = size * along;
      if (search(evaluator, 0, true, kMostHalvings)) {
        sink(evaluator);
        // More than rounding, or it was no way down.
        if (energy_ < before - 2e-15 * before) return true;
      }
      curve_.x = origin;
      visit(evaluator);
      if (!measure()) return false;
      system_.linearise(evaluator, curve_, frame_);
    }
    step_ = along;
    return false;
  }

  // x = base_ + share_ step_, halving the share until the energy falls enough and no node has left its sheet. `free`
  // accepts any energy (a step towards a saddle).
  bool search(Evaluator& evaluator, double slope, bool free, int most_halvings) {
    const double energy = energy_;
    trial_energy_ = energy_;
    const double off = off_surface_;
    trial_base_ = base_;
    trial_step_ = step_;
    old_normal_ = curve_.normal;
    const double longest = trial_step_.colwise().norm().maxCoeff();
    // No node moves farther than a quarter of the length, nor farther round the surface than kMostTurn.
    share_ = std::min({1.0, 0.25 * length() / std::max(longest, 1e-300), largest_step(evaluator)});
    failure_ = Relaxation::stalled;
    for (int halving = 0; halving < most_halvings; ++halving, share_ /= 2) {
      curve_.x = trial_base_ + share_ * trial_step_;
      visit(evaluator);
      if (!measure()) {
        failure_ = Relaxation::singular;
        continue;
      }
      failure_ = Relaxation::stalled;
      if (!same_sheet(share_, off)) continue;
      // Armijo's condition, with room for rounding.
      if (free || energy_ <= energy + 1e-4 * share_ * slope + 1e-14 * energy) return true;
    }
    return false;
  }

  // The share of step_ over which the surface turns by at most kMostTurn under every node (k = 1; for more equations
  // only same_sheet() watches).
  double largest_step(Evaluator& evaluator) {
    double share = 1;
    if (k_ > 1) return share;
    system_.bends(curve_, evaluator, step_, bends_);
    for (Index j = 1; j + 1 < num_nodes(); ++j) {
      const double bend = bends_(j);
      // Normal curvature along s is |s . Hess F s| / (|grad F| |s|^2); times |s| it is an angle.
      const double reach = kMostTurn * curve_.jacobian.col(j).norm() * step_.col(j).norm();
      if (bend * share > reach) share = reach / bend;
    }
    return share;
  }

  // A step s along the tangent plane leaves the surface by about s^2 / (2 radius). One that leaves it by much more, or
  // meets a turned normal, has lost the sheet it started on.
  [[nodiscard]] bool same_sheet(double alpha, double off) const {
    for (Index j = 1; j + 1 < num_nodes(); ++j) {
      const double moved = alpha * trial_step_.col(j).norm();
      if (curve_.off.col(j).norm() > 0.3 * moved + 2 * off + 1e-12 * period_) return false;
      // Only one normal has a sign to compare.
      if (k_ > 1) continue;
      if (curve_.normal.col(j).dot(old_normal_.col(j)) < 0.3 || drifts_apart(j)) return false;
    }
    return k_ > 1 || !drifts_apart(num_nodes() - 1);
  }

  // Neighbours that drift apart around the surface, j - 1 and j here, would let the curve slip through it.
  [[nodiscard]] bool drifts_apart(Index j) const {
    if (!regular(j - 1) || !regular(j)) return false;
    return curve_.normal.col(j).dot(curve_.normal.col(j - 1)) < kFarthestApart &&
           old_normal_.col(j).dot(old_normal_.col(j - 1)) >= kFarthestApart;
  }

  // Goes down along the negative direction, by steps that grow while they succeed.
  bool leave_saddle(Evaluator& evaluator) {
    system_.soft_step(step_);
    const double longest = step_.colwise().norm().maxCoeff();
    if (!(longest > 0)) return false;
    step_ *= push_ * length() / longest;
    const double before = energy_;
    if (!search(evaluator, 0, false, kMostHalvings)) return false;
    push_ = std::min(0.2, 2 * push_);
    return energy_ < before - 1e-13 * before || plan_.slope < -1e-13 * before;
  }

  Index d_;
  Index k_;
  System system_;
  NodalCurve<D, K> curve_;
  double period_ = 0;

  Nodes base_, step_, old_normal_, trial_base_, trial_step_;
  Eigen::VectorXd bends_;

  Frame frame_;
  VectorK mu_scratch_;
  VectorD vector_;

  double energy_ = 0;
  double decrement_ = 0;
  double trial_energy_ = 0;  // where the last search began
  double share_ = 1;         // of its step that it took
  double left_ = 0;          // energy that may be left to gain, where that is known
  double last_gain_ = 0;     // of the last step worth its while, of the energy; 0 before the first on a mesh
  double worst_rate_ = 0;    // largest gain / (gain before)^2
  double off_surface_ = 0;
  int iterations_ = 0;
  Index evaluated_ = 0;
  bool definite_ = false;
  bool settled_ = false;
  double soft_energy_ = 0;
  bool regular_start_ = false;
  bool regular_end_ = false;
  double ends_off_ = 0;
  Plan plan_;
  double push_ = kFirstPush;                  // how far to go from a saddle, of the length
  bool sunk_ = false;                         // the curve lies on the floor of a valley
  Relaxation failure_ = Relaxation::stalled;  // why the last search found nothing
  Relaxation outcome_ = Relaxation::stalled;
};

}  // namespace taut::detail
