#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "surface/volume/lattice.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// The least and the largest coefficient that matters in each block of cells, at sizes 4, 8, 16, ... cells. A B-spline
/// lies between them (its basis is positive and sums to 1), which is how empty space is skipped.
class ValuePyramid {
 public:
  ValuePyramid(const Lattice& coefficients, const Context& context);

  /// Least and largest coefficient of blocks that cover the cells first .. last.
  [[nodiscard]] std::array<float, 2> range(const std::array<Index, 3>& first, const std::array<Index, 3>& last) const;

  /// The box, in cells, around all smallest blocks with coefficients on both sides of 0 (or at 0); false when there is
  /// none.
  [[nodiscard]] bool zero_box(Eigen::Array3d& lower, Eigen::Array3d& upper) const;

 private:
  struct Level {
    Lattice least;
    Lattice largest;
  };
  std::array<Index, 3> num_cells_;
  std::vector<Level> levels_;
};

}  // namespace taut::detail
