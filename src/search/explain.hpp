#pragma once

#include <string>
#include <string_view>

#include "strata/facet_chain.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// A result's obstacle and doubts in one sentence for people, empty where there is nothing to say: of several doubts
/// the gravest. That ways were looked for at random or not at all is told by `doubts` alone.
[[nodiscard]] std::string explain(const PathResult& result);

/// Why a broken geodesic was not found, for PathResult::reason.
[[nodiscard]] std::string_view in_words(ChainFault fault);

}  // namespace taut::detail
