#pragma once

#include "taut/core/types.hpp"

namespace taut::detail {

/// Which ways are offered as starts. Measured on 2,000 random pairs each of 14 surfaces (docs/measured/shortest.md):
/// none too long by two fields.
struct RivalRules {
  double excess = 0.15;    ///< ways up to this part longer than the shortest, by the marched distances, are rivals
  double near_cells = 4;   ///< two points within so many cells have no rivals between them
  Index most = 16;         ///< starts, and ...
  Index most_of_all = 64;  ///< ... with PathOptions::all
  /// Over rims, places this close to each other lead to different geodesics: StartPathOptions::spread.
  double spread_over_bends = 0.04;
  /// Where a table bounds the distance, marches keep to the cells that rivals run through, and so many more.
  double margin_cells = 2;
  double error = 0.1;   ///< of marched lengths against those of the geodesics they lead to, relative, at first
  double doubt = 0.03;  ///< a path this much longer than its marched way has missed it, relative
};

/// When a table of distances is made, on which cells, and what it is believed. By the table 1 of 28,000 random pairs on
/// the tangle cube came out too long, by 2.5e-4, none on 20 other surfaces (docs/measured/shortest.md).
struct TableRules {
  double worthwhile = 0.2;  ///< it costs less than this part of marching from both ends of each pair
  /// Cells as coarse as may be: the normal turns by at most this (radians) from one to the next in that part of them
  /// ...
  double turn = 0.85;
  double turn_quantile = 0.95;
  double fewest_cells = 400;
  double refinement = 1.2;  ///< ... else they are made finer by this factor
  /// As few landmarks as tell ways apart: this times cells times turn squared, ...
  double landmarks_per_turn2 = 0.1;
  double fewest_landmarks = 320;  ///< ... and at least these
  /// Distances on its cells, in that part of them against those of a single pair's cells, and on so many ways between
  /// landmarks against geodesics, are wrong by at most `wrong`, relative; else finer cells are taken.
  double wrong = 0.03;
  double checked_part = 0.99;
  Index ways = 48;
  double ways_tolerance = 1e-3;
  /// Rivals within so many times the error measured are sought, at least within `wrong`; ...
  double safety = 2;
  /// ... a path that is longer than the table says by so many times it is in doubt, at least by this part.
  double doubt_safety = 3;
  double least_doubt = 0.004;
};

inline constexpr RivalRules kRivalRules;
inline constexpr TableRules kTableRules;

}  // namespace taut::detail
