#include "curve/ray_tracer.hpp"

namespace taut::detail {

template std::unique_ptr<ExponentialMap::Backend> make_ray_tracer<3>(const Surface&, const ExponentialOptions&);

}  // namespace taut::detail
