#pragma once

#include "taut/query/path.hpp"

namespace taut::detail {

/// Throws InvalidArgument when an option that every way of finding paths uses is out of range.
void check_options(const PathOptions& options);

}  // namespace taut::detail
