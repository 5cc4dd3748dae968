#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "cells/crossing.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Halves cells that the surface may cross, depth first in blocks: memory stays bounded by the levels, tests come in
/// batches of hundreds, and the cells come out in Morton order when they go in so.
class Refiner {
 public:
  Refiner(CrossingTest& test, Index dim);

  /// `cells`: d x n coordinates at `level`, not tested yet. Appends to `out` the cells of level `last_level` <= level
  /// inside them that the surface may cross. `check`, when given, is called for each finished block.
  void refine(const std::vector<std::int32_t>& cells, int level, int last_level, std::vector<std::int32_t>& out,
              const std::function<void()>& check = {});

 private:
  void refine(const std::int32_t* cells, Index n, int level, std::vector<std::int32_t>& out);

  CrossingTest& test_;
  Index dim_;
  int last_level_ = 0;
  const std::function<void()>* check_ = nullptr;
};

/// Throws InvalidArgument above d = 12, where the 2^d halves of a cell are too many to go through.
void check_halving(Index dim);

/// The 2^d halves of each of n cells, in Morton order, appended to `out`.
void append_halves(Index dim, const std::int32_t* cells, Index n, std::vector<std::int32_t>& out);

}  // namespace taut::detail
