#pragma once

#include <memory>

#include "taut/curve/newton.hpp"

namespace taut {

/// The solver for one pair of sizes (d, k).
class NewtonSolver::Backend {
 public:
  virtual ~Backend() = default;
  [[nodiscard]] virtual Index dim() const = 0;
  virtual NewtonResult solve(const PointsIn& start, const Context& context) = 0;
  virtual NewtonResult refine(const SpectralCurve& curve, const Context& context) = 0;
};

namespace detail {

template <int D, int K>
class DirectSystem;
class KrylovSystem;

/// A solver of these systems: DirectSystem with its sizes at compile time (or Eigen::Dynamic), or KrylovSystem. Each is
/// compiled in a file of its own.
template <class System>
std::unique_ptr<NewtonSolver::Backend> make_newton_driver(const Surface& surface, const NewtonOptions& options);

}  // namespace detail
}  // namespace taut
