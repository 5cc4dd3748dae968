#pragma once

#include "curve/banded_cholesky.hpp"
#include "curve/counting_evaluator.hpp"
#include "curve/flow_nodes.hpp"
#include "taut/core/context.hpp"
#include "taut/curve/flow.hpp"

namespace taut::detail {

/// How a relaxation ended.
enum class FlowOutcome {
  at_rest,      ///< the curvature is below its bound, the intervals are as wanted, the nodes on the surface
  standing,     ///< no step decreases the energy any more
  out_of_work,  ///< as many nodes were evaluated as may be
  singular,     ///< at a point where the Jacobian loses rank
  torn,         ///< an interval leaves the surface, however short it is made
};

/// What the flow came to.
struct FlowState {
  FlowNodes nodes;
  Vector widths;  ///< m, as in FlowCurve, their mean 1
  FlowOutcome outcome = FlowOutcome::standing;
};

/// Steps equation (4) through time for a fixed number of nodes:
///   p_t = C_t - (J^+)(J C_t + beta F),  C_t = k_g N of (3),  C_ss ~ (p^{i+1}p^i - p^i p^{i-1}) / Delta h^2.
/// The edges enter with their lengths, Delta h is the mean of all intervals: across the curve this is the geodesic
/// curvature vector, along the curve it is (eps_{i+1} - eps_i) / Delta h^2, the repulsion that spaces the nodes evenly.
/// Where they are to be spread otherwise, interval i enters as eps_i / w_i, w_i its width against the mean, and the
/// repulsion makes these even; k_g N does not change but for a factor.
/// (The paper divides by Delta h once; with edges that have lengths C_ss needs it twice, and that only rescales time.)
/// The right-hand side is minus the gradient of the discrete energy 1/2 sum_i eps_i^2 / w_i under F(p^i) = 0, over
/// Delta h^2; so a time step is checked by the decrease of that energy, and the rest points are its critical points:
/// second order in Delta h.
class FlowSolver {
 public:
  /// `most_evaluated`: where counting ends.
  FlowSolver(CountingEvaluator& evaluator, Index dim, Index codim, const FlowOptions& options, Index most_evaluated,
             const Context& context);

  /// Flows `start` until |k_g| <= bound, neighbouring eps_i / w_i agree to 1e-7, and the nodes are on the surface; or
  /// until there is no getting nearer to that.
  [[nodiscard]] FlowState relax(FlowCurve start, double bound);

  /// The node at which the second variation of the discrete energy stops being positive definite, counted from the
  /// start of the curve: the first conjugate point. 0 = positive definite, -1 = cannot be told (no second derivatives).
  [[nodiscard]] Index first_conjugate_node(const FlowState& state);

  [[nodiscard]] int num_steps() const { return num_steps_; }
  [[nodiscard]] bool out_of_work() const { return evaluator_.num_evaluated() >= most_evaluated_; }

 private:
  enum class Metric { hessian, stiffness };

  void set_widths(const VectorIn& widths);
  [[nodiscard]] double energy(const PointsIn& points) const;
  /// C_t Delta h^2 at the nodes q: the edges' difference, tangential part. Keeps the multipliers of the normal part.
  void compute_velocity(const FlowNodes& nodes, const Points& q);
  void compute_hessians(const FlowNodes& nodes);
  void compute_bases(const FlowNodes& nodes);
  /// (shift M + second variation) in tangent coordinates; shift = Delta h^2 / Delta t, M the nodes' masses.
  void assemble(const FlowNodes& nodes, double shift, Metric metric);
  /// The move of every node for a time step of Delta h^2 / shift, d x (m + 1); false when the matrix is not positive
  /// definite.
  [[nodiscard]] bool implicit_move(const FlowNodes& nodes, double shift, Metric metric, Points& move);
  void ambient_move(const FlowNodes& nodes, double shift, Points& move) const;
  void project(FlowNodes& nodes);
  /// One step of (4). Both return false where no step leads on.
  [[nodiscard]] bool step_explicitly(FlowNodes& nodes);
  [[nodiscard]] bool step_implicitly(FlowNodes& nodes);
  [[nodiscard]] bool keeps_to_its_sheet(const FlowNodes& from, const FlowNodes& to) const;

  CountingEvaluator& evaluator_;
  Index dim_;
  Index codim_;
  FlowOptions options_;
  Index most_evaluated_;
  const Context& context_;
  int num_steps_ = 0;

  Vector widths_;       // m, mean 1
  Vector masses_;       // m + 1: half of the widths beside a node
  double shift_ = 0;    // Delta h^2 / Delta t of the next implicit step
  double slowest_ = 0;  // that of a time step in which the longest wave decays
  double quiet_ = 0;    // nodes come no nearer to the surface than the noise of F, in intervals
  Points velocity_;     // d x (m + 1)
  Points multipliers_;  // k x (m + 1)
  Points hessians_;     // d d x (m + 1)
  Points bases_;        // d t x (m + 1), orthonormal tangent bases, t = d - k
  bool hessians_finite_ = true;
  BandedCholesky matrix_;
  Vector rhs_;
};

}  // namespace taut::detail
