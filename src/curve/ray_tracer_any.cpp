#include "curve/ray_tracer.hpp"

namespace taut::detail {

template std::unique_ptr<ExponentialMap::Backend> make_ray_tracer<Eigen::Dynamic>(const Surface&,
                                                                                  const ExponentialOptions&);

}  // namespace taut::detail
