#pragma once

#include "taut/core/types.hpp"

namespace taut::detail {

/// How far each rung of the search goes. Work is counted in cells: making and marching over a million cells of a
/// formula takes some seconds on one core, a cell of a fitted surface about a millisecond.
struct LadderRules {
  /// Faces. On a surface that is cut, its border comes first where so many pairs are asked: the graph takes 30 ms, and
  /// a pair among five holes then 1.2 ms instead of 2.3.
  Index pairs_for_border_first = 64;

  /// Fields. Where sheets cannot be told apart, walks are tried before cells get more than this: ends on one sheet of a
  /// thin shell took 42 s on cells, walks answer in less time than two million cells take.
  Index most_cells_before_walks = 2'000'000;
  /// ... and no finer cells are made where they would be more than this, of a formula and of a fit.
  Index most_cells = 6'000'000;
  Index most_fitted_cells = 100'000;
  /// ... or, in a wider window, where it is not known whether the points hang together at all.
  Index most_cells_in_window = 500'000;

  /// Closer. A part of the box is looked at again where its longest side is smaller by this factor, on cells that are
  /// smaller by that one: else the same would come of it.
  double smaller_part = 0.7;
  double finer_cells = 0.75;

  /// Wider. Windows are 2, 4, ..., 2^6 times as wide as the first. Of x = a z^2 (a = 1, 3, 10) 1,200 pairs came out
  /// right in them.
  int most_doublings = 6;
  /// ... as long as cells of a size that was asked for are no more than this, for a shorter path and for any.
  Index most_cells_for_shorter = 6'000'000;
  Index most_cells_for_any = 500'000;

  /// Fan. Where there is no path yet, before cells get more than this: two shells 0.01 apart took 12 s on cells.
  Index most_cells_before_fan = 100'000;
  /// It may do this part of the work that a field's fan may: half a second. Of 120 fans that were wanted by tests most
  /// took a tenth of that; over the rims of a disc 1:1:0.05 11 of 120 take more, and the doubt stays.
  double fan_effort = 0.03;
  /// It is to tell ways apart, so to this relative tolerance; ways longer by no more than that part than the shortest
  /// are corrected, too.
  double fan_tolerance = 1e-5;
  double fan_rivals = 1e-4;
};

inline constexpr LadderRules kLadderRules;

}  // namespace taut::detail
