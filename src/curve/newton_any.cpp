// The kernel with sizes d and k at run time, for all that has no kernel of its own and few tangent directions.
#include "curve/direct_system.hpp"
#include "curve/newton_driver.hpp"

namespace taut::detail {

template std::unique_ptr<NewtonSolver::Backend> make_newton_driver<DirectSystem<Eigen::Dynamic, Eigen::Dynamic>>(
    const Surface&, const NewtonOptions&);

}  // namespace taut::detail
