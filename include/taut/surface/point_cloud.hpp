#pragma once

#include <Eigen/Core>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut {

/// Points as a scanner or a file gives them.
struct PointCloud {
  Points points;           ///< d x n
  Points normals;          ///< d x n, pointing outwards, any length, a zero column = unknown; d x 0 when there are none
  Eigen::Matrix3Xi faces;  ///< 3 x m, indices into `points`; 3 x 0 when there are none (d = 3 only)

  [[nodiscard]] Index dim() const { return points.rows(); }
  [[nodiscard]] Index size() const { return points.cols(); }
  [[nodiscard]] bool has_normals() const { return normals.cols() == points.cols() && points.cols() > 0; }
};

/// Outward unit normals for every point of `cloud`, d x n.
///  - Given normals are kept, only brought to length 1: their side is the user's.
///  - Else the corners' angle-weighted mean of the face normals. A closed mesh that is wound inside out is turned.
///  - Else the direction of least spread of the nearest `neighbours` points (2 d at least), made consistent along a
///    minimum spanning tree of the neighbourhood graph (Hoppe et al. 1992, with edges compared by reflection, so that
///    sharp bends and thin parts keep their side) and turned so that each connected piece encloses a positive volume
///    (an open piece: so that its convex side is the outer one).
/// Points without a usable normal (zero, NaN, no face) take that of their nearest neighbours; `context.note` tells how
/// many. Throws InvalidArgument for a point that is not finite, for points that span less than d - 1 directions, and
/// for normals or faces that do not fit the points.
[[nodiscard]] Points estimate_normals(const PointCloud& cloud, Index neighbours = 10, const Context& context = {});

}  // namespace taut
