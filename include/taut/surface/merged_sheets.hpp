#pragma once

#include "taut/core/types.hpp"

namespace taut {

/// Samples of two sheets, nearer to each other than the samples on each of them, that a fit does not keep apart: the
/// faces of a plate that became one sheet, say. What is fitted there may not be what was sampled.
struct MergedSheets {
  Index count = 0;  ///< how many samples; 0 = all sheets are apart, as far as can be told
  Index at = 0;     ///< one of them, from 0
  double gap = 0;   ///< between the sheets there, the mean, model units
};

}  // namespace taut
