#pragma once

#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Straight from p to q (d each), d x 2.
[[nodiscard]] inline Points chord(const VectorIn& p, const VectorIn& q) {
  Points ends(p.size(), 2);
  ends << p, q;
  return ends;
}

/// Length of the polyline with these nodes (d x m).
[[nodiscard]] double polyline_length(const PointsIn& nodes);

/// The polyline without repeated points: no two neighbours are equal. Keeps the first and the last.
[[nodiscard]] Points without_repeats(const PointsIn& nodes);

/// Points at the given ascending arc lengths, d x n; the first and the last are the ends of the polyline exactly.
[[nodiscard]] Points at_arc_lengths(const PointsIn& nodes, const std::vector<double>& arcs);

/// Points at `count` equal parts of the length, d x (count + 1), the ends of the polyline among them.
[[nodiscard]] Points at_equal_parts(const PointsIn& nodes, Index count);

/// For each of the n - 1 intervals of arc length: how far the polyline strays from the chord there, as a share of the
/// interval. An arc that turns by an angle a strays by a / 8. Zero where fewer than four nodes are inside: a zigzag of
/// the nodes themselves does not count.
[[nodiscard]] std::vector<double> straying(const PointsIn& nodes, const std::vector<double>& arcs);

/// Cuts [0, 1] into `count` >= 1 intervals on which a density has equal integrals. `density[i] >= 0` holds on the
/// interval of length `lengths[i]`; a floor of a quarter of its mean keeps intervals from growing without bound.
/// Returns the lengths, scaled to the sum of `lengths`.
[[nodiscard]] std::vector<double> equidistribute(const std::vector<double>& lengths, const std::vector<double>& density,
                                                 Index count);

}  // namespace taut::detail
