#pragma once

#include <memory>
#include <optional>

#include "curve/banded_cholesky.hpp"
#include "curve/flow_nodes.hpp"
#include "taut/core/context.hpp"
#include "taut/curve/flow.hpp"

namespace taut::detail {

/// What the flow came to rest at.
struct FlowState {
  FlowNodes nodes;       ///< on the surface up to rounding when converged
  double curvature = 0;  ///< largest discrete |k_g|
  bool converged = false;
  bool singular = false;  ///< stopped where the Jacobian loses rank
};

/// Steps equation (4) through time for a fixed number of nodes:
///   p_t = C_t - (J^+)(J C_t + beta F),  C_t = k_g N of (3),  C_ss ~ (p^{i+1}p^i - p^i p^{i-1}) / Delta h^2.
/// The edges enter with their lengths, Delta h is the mean of all intervals: across the curve this is the geodesic
/// curvature vector, along the curve it is (eps_{i+1} - eps_i) / Delta h^2, the repulsion that spaces the nodes evenly.
/// (The paper divides by Delta h once; with edges that have lengths C_ss needs it twice, and that only rescales time.)
/// The right-hand side is minus the gradient of the discrete energy 1/2 sum_i eps_i^2 under F(p^i) = 0, over Delta h^2;
/// so a time step is checked by the decrease of that energy, and the rest points are its critical points: second order
/// in Delta h.
class FlowSolver {
 public:
  FlowSolver(const Surface& surface, const FlowOptions& options, const Context& context);

  /// Flows `start` until |k_g| <= bound, neighbouring intervals agree to 1e-7, and the nodes are on the surface; or
  /// until no step decreases the energy any more.
  [[nodiscard]] FlowState relax(Points start, double bound);

  /// The node at which the second variation of the discrete energy stops being positive definite, counted from the
  /// start of the curve: the first conjugate point. 0 = positive definite, -1 = cannot be told (no second derivatives).
  [[nodiscard]] Index first_conjugate_node(const FlowNodes& nodes);

  [[nodiscard]] int num_steps() const { return num_steps_; }
  [[nodiscard]] Evaluator& evaluator() { return *evaluator_; }

 private:
  enum class Metric { hessian, stiffness };

  /// C_t Delta h^2 at the nodes q: the edges' difference, tangential part. Keeps the multipliers of the normal part.
  void compute_velocity(const FlowNodes& nodes, const Points& q);
  void compute_hessians(const FlowNodes& nodes);
  void compute_bases(const FlowNodes& nodes);
  /// (shift I + second variation) in tangent coordinates; shift = Delta h^2 / Delta t.
  void assemble(const FlowNodes& nodes, double shift, Metric metric);
  /// The move of every node for a time step of Delta h^2 / shift, d x (m + 1); false when the matrix is not positive
  /// definite.
  [[nodiscard]] bool implicit_move(const FlowNodes& nodes, double shift, Metric metric, Points& move);
  void ambient_move(const FlowNodes& nodes, double shift, Points& move) const;

  Index dim_;
  Index codim_;
  FlowOptions options_;
  const Context& context_;
  std::unique_ptr<Evaluator> evaluator_;
  int num_steps_ = 0;

  Points velocity_;     // d x (m + 1)
  Points multipliers_;  // k x (m + 1)
  Points hessians_;     // d d x (m + 1)
  Points bases_;        // d t x (m + 1), orthonormal tangent bases, t = d - k
  bool hessians_finite_ = true;
  BandedCholesky matrix_;
  Vector rhs_;
};

}  // namespace taut::detail
