#pragma once

#include <string>

#include "taut/search/path_result.hpp"

namespace taut::detail {

/// A result's obstacle and doubts in one sentence for people, empty where there is nothing to say: of several doubts
/// the gravest. That ways were looked for at random or not at all is told by `doubts` alone.
[[nodiscard]] std::string explain(const PathResult& result);

}  // namespace taut::detail
