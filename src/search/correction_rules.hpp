#pragma once

#include <cstddef>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Which starts are corrected, and how far.
struct CorrectionRules {
  /// Newton's method leads to a path that is hardly longer than its start: where it grows by more than this factor, the
  /// curve has jumped somewhere, or the start cut through the surface.
  double most_growth = 1.1;
  /// Starts are corrected as long as they may turn out the shortest, their lengths being as wrong as is to be expected,
  /// or this many times as wrong as those of the ways corrected before.
  double error_factor = 3;
  double rough_tolerance = 1e-3;  ///< to which several starts are corrected first, to see which may be the shortest
  double spliced = 0.01;          ///< splices are tried that seem longer than the shortest by no more than this part
  /// So many at a time: of more, most would be corrected in vain.
  static constexpr std::size_t kAtATime = 4;
};

/// How a start from which Newton's method fails is brought to rest first.
struct GentleRules {
  double promise = 0.01;  ///< it promises a path that is not longer than one found by more than this part
  int most = 4;           ///< starts
  /// Nodes at which the flow evaluates F, for one set of starts: paths over a scan at 300 cells take 10,000 to 100,000,
  /// 0.1 to 0.5 s.
  Index most_nodes = 400'000;
  /// Points projected in shortening, in all and at a time: 96 segments come to rest within some 300 steps, 30,000
  /// points; on noise of the size of the segments they never do.
  Index most_projected = 100'000;
  Index most_points = 5'000;
  double segments = 96;             ///< of shortening
  double off = 0.1;                 ///< how far from the surface its start may be, in its length
  double settled[2] = {0.1, 1e-3};  ///< steps at which it is at rest, in segments: Newton's method is tried after each
};

inline constexpr CorrectionRules kCorrectionRules;
inline constexpr GentleRules kGentleRules;

}  // namespace taut::detail
