// The kernel for curves in the plane (d = 2, k = 1), in a file of its own so that kernels compile side by side.
#include "curve/direct_system.hpp"
#include "curve/newton_driver.hpp"

namespace taut::detail {

template std::unique_ptr<NewtonSolver::Backend> make_newton_driver<DirectSystem<2, 1>>(const Surface&,
                                                                                       const NewtonOptions&);

}  // namespace taut::detail
