#pragma once

#include "taut/core/types.hpp"

namespace taut {

/// The work that Algorithm I or II has done, to hold against N, the number of cells that came of it (Appendix I).
struct CellCounts {
  Index num_tests = 0;    ///< crossing tests, of cells of all sizes
  Index num_lookups = 0;  ///< Algorithm II: neighbours looked up among the cells seen so far, 2 d a cell of the patch
  bool complete = true;   ///< false: Algorithm II stopped at GrowOptions::most_cells
};

}  // namespace taut
