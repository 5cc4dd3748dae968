// The entrance to Newton's correction: options and start are checked here, and the solver is chosen by the sizes d and
// k. Up to kManyTangents - 1 tangent directions systems are factored (direct_system.hpp), in kernels of fixed size for
// one equation in 3 and 4 dimensions; from there on they are solved by conjugate gradients (krylov_system.hpp). The
// method itself is in newton_driver.hpp (meshes) and newton_kernel.hpp (one mesh).
#include "taut/curve/newton.hpp"

#include <string>

#include "core/check_tolerance.hpp"
#include "curve/newton_backend.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

void check(const NewtonOptions& options) {
  detail::check_tolerance(options.tolerance);
  if (options.max_iterations < 1) {
    throw InvalidArgument("max_iterations is " + std::to_string(options.max_iterations) + ", must be at least 1");
  }
  if (options.max_elements < 1) {
    throw InvalidArgument("max_elements is " + std::to_string(options.max_elements) + ", must be at least 1");
  }
}

// From here on tangent coordinates cost more to eliminate than products with the Hessian; measured (docs/newton.md).
constexpr Index kManyTangents = 12;

// Sizes that are worth a kernel of their own; the rest shares one with sizes at run time.
std::unique_ptr<NewtonSolver::Backend> make_backend(const Surface& surface, const NewtonOptions& options) {
  using detail::DirectSystem;
  using detail::make_newton_driver;
  check(options);
  if (surface.codim() == 1) {
    if (surface.dim() == 3) return make_newton_driver<DirectSystem<3, 1>>(surface, options);
    if (surface.dim() == 4) return make_newton_driver<DirectSystem<4, 1>>(surface, options);
  }
  if (surface.dim() - surface.codim() >= kManyTangents)
    return make_newton_driver<detail::KrylovSystem>(surface, options);
  return make_newton_driver<DirectSystem<Eigen::Dynamic, Eigen::Dynamic>>(surface, options);
}

}  // namespace

NewtonSolver::NewtonSolver(const Surface& surface, const NewtonOptions& options)
    : backend_(make_backend(surface, options)) {}
NewtonSolver::~NewtonSolver() = default;
NewtonSolver::NewtonSolver(NewtonSolver&&) noexcept = default;
NewtonSolver& NewtonSolver::operator=(NewtonSolver&&) noexcept = default;

NewtonResult NewtonSolver::solve(const PointsIn& start, const Context& context) {
  if (start.rows() != backend_->dim()) {
    throw InvalidArgument("the start path has dimension " + std::to_string(start.rows()) + ", the surface has " +
                          std::to_string(backend_->dim()));
  }
  if (start.cols() < 2) {
    throw InvalidArgument("the start path has " + std::to_string(start.cols()) + " points, needs at least 2");
  }
  for (Index j = 0; j < start.cols(); ++j) {
    if (!start.col(j).allFinite()) {
      throw InvalidArgument("point " + std::to_string(j) + " of the start path is not finite");
    }
  }
  return backend_->solve(start, context);
}

NewtonResult NewtonSolver::refine(const SpectralCurve& curve, const Context& context) {
  if (curve.dim() != backend_->dim()) {
    throw InvalidArgument("the curve has dimension " + std::to_string(curve.dim()) + ", the surface has " +
                          std::to_string(backend_->dim()));
  }
  if (!curve.nodes().allFinite()) throw InvalidArgument("a node of the curve is not finite");
  return backend_->refine(curve, context);
}

NewtonResult correct_newton(const Surface& surface, const PointsIn& start, const NewtonOptions& options,
                            const Context& context) {
  return NewtonSolver(surface, options).solve(start, context);
}

}  // namespace taut
