#pragma once

#include <Eigen/Core>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Calls `body.template operator()<D, K>()` with the dimensions as constants where they are common, else Dynamic.
template <class Body>
decltype(auto) with_dimensions(Index d, Index k, Body&& body) {
  if (k == 1) {
    switch (d) {
      case 3: return body.template operator()<3, 1>();
      case 4: return body.template operator()<4, 1>();
      default: break;
    }
  }
  return body.template operator()<Eigen::Dynamic, Eigen::Dynamic>();
}

}  // namespace taut::detail
