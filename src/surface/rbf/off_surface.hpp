#pragma once

#include "surface/rbf/kd_tree.hpp"
#include "surface/rbf/rbf_solve.hpp"

namespace taut::detail {

/// F = 0 at each sample and F = e at sample + e normal (outside; F = -e at sample - e normal inside where there is no
/// room outside; with `both_sides` both), where e = `offset` or, where that is less, half-way to where another sample
/// becomes nearer. A side that leaves less than a twentieth of `offset` has no room.
/// `samples`, `normals` (unit): d x n; `tree` of the samples.
[[nodiscard]] Constraints off_surface_constraints(const Points& samples, const Points& normals, const KdTree& tree,
                                                  double offset, bool both_sides);

}  // namespace taut::detail
