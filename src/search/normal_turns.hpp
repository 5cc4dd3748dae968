#pragma once

#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// By how much the normal space turns from each valid cell to those behind its faces: how well cells follow a surface.
class NormalTurns {
 public:
  NormalTurns(const SurfaceCells& cells, const Context& context);

  /// Radians: the given part of the turns stays below it. 0 when there are none.
  [[nodiscard]] double quantile(double part);
  /// Is quantile(part) <= most; in less time.
  [[nodiscard]] bool mostly_within(double most, double part) const;
  /// Cells that follow a surface of dimension n have about 2 n neighbours behind their faces. False where most of them
  /// are missing: cells larger than what they hold make a row, or lie apart.
  [[nodiscard]] bool make_a_sheet() const { return makes_a_sheet_; }

 private:
  std::vector<float> turns_;
  bool makes_a_sheet_ = false;
};

}  // namespace taut::detail
