// Tests many cells of one level on all cores. Shares are fixed and put together in order: threads change nothing.
#include "cells/crossed.hpp"

#include "cells/refine.hpp"
#include "core/parallel.hpp"

namespace taut::detail {

std::vector<std::int32_t> crossed(CrossingPool& pool, Index dim, const std::vector<std::int32_t>& cells, int level,
                                  const Context& context) {
  constexpr Index kShare = 1024;  // cells: a few tens of microseconds
  const Index n = static_cast<Index>(cells.size()) / dim;
  std::vector<std::vector<std::int32_t>> found(static_cast<std::size_t>((n + kShare - 1) / kShare));
  parallel_for(context, 0, n, kShare, [&](Index first, Index last) {
    const CrossingPool::Loan test(pool);
    const std::vector<std::int32_t> share(cells.begin() + first * dim, cells.begin() + last * dim);
    // From a level to the same level: a test without halving.
    Refiner(*test, dim).refine(share, level, level, found[static_cast<std::size_t>(first / kShare)]);
  });
  std::vector<std::int32_t> all;
  for (const std::vector<std::int32_t>& some : found) all.insert(all.end(), some.begin(), some.end());
  return all;
}

}  // namespace taut::detail
