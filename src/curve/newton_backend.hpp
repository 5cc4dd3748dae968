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
};

namespace detail {

/// A kernel with these sizes at compile time (or Eigen::Dynamic). Each is compiled in a file of its own.
template <int D, int K>
std::unique_ptr<NewtonSolver::Backend> make_newton_driver(const Surface& surface, const NewtonOptions& options);

}  // namespace detail
}  // namespace taut
