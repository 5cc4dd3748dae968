#pragma once

#include <string_view>
#include <vector>

#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Throws InvalidArgument naming the first point (from 0) with a coordinate that is not finite.
void require_finite(const Points& points, std::string_view what);

/// A cloud without coincident points. A mesh with seams and an STL triangle soup repeat their vertices.
struct MergedPoints {
  Points points;                   ///< d x m, in the order of first appearance
  std::vector<Index> merged_from;  ///< m: the first original of each
  std::vector<Index> merged_to;    ///< n: where each original went
};
[[nodiscard]] MergedPoints merge_duplicates(const Points& points);

/// Number of directions the points spread in (0 = one point, 1 = a line, ...), with the smaller spreads counted as
/// none below `tolerance` times the largest.
[[nodiscard]] Index affine_rank(const Points& points, double tolerance = 1e-9);

/// Mean distance between neighbours around each point, from how many fall into a ball on a (d - 1)-surface: the side of
/// the (d - 1)-cube that one sample stands for. n.
[[nodiscard]] Vector local_spacing(const Points& points, const KdTree& tree, const Context& context = {});

/// Standard deviation of the points along the normal about the quadrics that fit their neighbourhoods best, as a
/// multiple of the local spacing: its 10 % quantile, since noise is everywhere but unresolved features are not. Only
/// neighbours that face the same way count: the two faces of a thin sheet are not noise. 0 where there are too few
/// points for quadrics (or d > 5). `normals`: unit.
[[nodiscard]] double relative_noise(const Points& points, const Points& normals, const KdTree& tree);

/// The q-quantile, 0 <= q <= 1, of the finite entries; 0 of none.
[[nodiscard]] double quantile(const Vector& values, double q);

/// Indices 0 .. n - 1 in a fixed order without structure.
[[nodiscard]] std::vector<Index> scrambled_order(Index n);

/// Points such that each point has one of them among about its `count` nearest, wherever it is dense or sparse.
[[nodiscard]] std::vector<Index> spread_by_count(const Points& points, const KdTree& tree, Index count);

/// A maximal subset of points no two of which are closer than `radius`: every point left out has a member of the subset
/// within `radius`. Visits the points in a fixed scrambled order; returns ascending indices.
[[nodiscard]] std::vector<Index> spread_subset(const Points& points, const KdTree& tree, double radius);

/// The same with the radius chosen so that at most `max_size`, and not much fewer, are left. O(n log n).
[[nodiscard]] std::vector<Index> spread_subset_of_size(const Points& points, const KdTree& tree, Index max_size);

}  // namespace taut::detail
