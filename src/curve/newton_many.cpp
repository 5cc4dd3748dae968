// The kernel for many tangent directions: systems are solved by conjugate gradients, never formed.
#include "curve/krylov_system.hpp"
#include "curve/newton_driver.hpp"

namespace taut::detail {

template std::unique_ptr<NewtonSolver::Backend> make_newton_driver<KrylovSystem>(const Surface&, const NewtonOptions&);

}  // namespace taut::detail
