// The outermost crossed cell on one side of an axis, best first: of all candidates the outermost is halved, those of
// its halves that may be crossed go back into the queue. The first candidate of the last level to come up is the
// answer, for all others lie farther in. After kMostTests tests the outermost face not refuted yet is taken: the box is
// a little wider.
#include "cells/outermost.hpp"

#include <algorithm>
#include <cstddef>
#include <queue>
#include <tuple>

#include "cells/refine.hpp"

namespace taut::detail {
namespace {

/// Cells tested at a time, as far as a single one has no more halves, and in all.
constexpr Index kBoxesPerTest = 64;
constexpr Index kMostTests = 16'384;

struct Candidate {
  std::int32_t inwards;  // how far in its outer face lies: in cells of level 0, the smaller, the farther out
  int level;
  std::size_t number;  // in the order found

  /// The next to be looked at is the outermost, of those the finest.
  bool operator<(const Candidate& other) const {
    return std::tie(inwards, level, number) > std::tie(other.inwards, other.level, other.number);
  }
};

}  // namespace

std::optional<std::int32_t> outermost_face(CrossingTest& test, Index dim, const std::vector<std::int32_t>& cells,
                                           int level, int last_level, Index axis, int side) {
  const auto d = static_cast<std::size_t>(dim);
  std::vector<std::int32_t> known;  // d a candidate
  std::priority_queue<Candidate> queue;
  const auto add = [&](const std::int32_t* cell, int at_level) {
    // The outer face, in cells of level 0.
    const std::int32_t outer = (cell[axis] + (side > 0 ? 1 : 0)) * (std::int32_t{1} << at_level);
    queue.push({-side * outer, at_level, known.size() / d});
    known.insert(known.end(), cell, cell + dim);
  };
  for (std::size_t c = 0; c < cells.size(); c += d) add(cells.data() + c, level);

  const Index most_parents = std::max<Index>(1, kBoxesPerTest >> dim);
  std::vector<std::int32_t> parents;
  std::vector<std::int32_t> halves;
  std::vector<std::uint8_t> may_cross;
  for (Index num_tests = 0; !queue.empty();) {
    const Candidate first = queue.top();
    if (first.level == last_level || num_tests >= kMostTests) return -side * first.inwards;
    parents.clear();
    for (Index n = 0; n < most_parents && !queue.empty(); ++n) {
      const Candidate next = queue.top();
      // Equals together make a batch; no worse one is halved.
      if (next.inwards != first.inwards || next.level != first.level) break;
      const auto cell = known.begin() + static_cast<std::ptrdiff_t>(next.number * d);
      parents.insert(parents.end(), cell, cell + dim);
      queue.pop();
    }
    halves.clear();
    append_halves(dim, parents.data(), static_cast<Index>(parents.size() / d), halves);
    may_cross.resize(halves.size() / d);
    test.test(halves, first.level - 1, may_cross);
    for (std::size_t h = 0; h < may_cross.size(); ++h) {
      if (may_cross[h] != 0) add(halves.data() + h * d, first.level - 1);
    }
    num_tests += static_cast<Index>(may_cross.size());
  }
  return std::nullopt;
}

}  // namespace taut::detail
