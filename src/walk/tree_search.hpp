#pragma once

#include <cstdint>

#include "taut/core/context.hpp"
#include "walk/surface_walker.hpp"

namespace taut::detail {

struct TreeSearchOptions {
  Index max_steps = 20'000;  ///< of the walker
  std::uint64_t seed = 1;    ///< the same seed searches the same way
};

/// A way between two points of a surface that a straight walk does not find: two trees of short steps grow from both
/// ends towards random targets, and towards each other (bidirectional rapidly exploring random trees with projection:
/// Kuffner and LaValle 2000, Berenson et al. 2009). d x m from p to q, straightened where a walk allows, or d x 0 when
/// none was found: a hint, no proof, that there is none.
[[nodiscard]] Points search_by_trees(SurfaceWalker& walker, const Vector& p, const Vector& q,
                                     const TreeSearchOptions& options, const Context& context);

}  // namespace taut::detail
