#pragma once

#include <string>

#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// Looks for samples beside which a second sheet of samples lies, nearer than the samples on it are, and asks whether F
/// vanishes on each of the two; then for samples taken for one noisy sheet that lie in two layers, but not of a mesh:
/// what looks like noise there is shape. `normals`: unit, those F was fitted to; `tree`: over `points`.
[[nodiscard]] MergedSheets find_merged_sheets(const Points& points, const Points& normals, const KdTree& tree,
                                              const ImplicitFunction& function, bool of_mesh, const Context& context);

/// Why the fitted surface may not be the one that was sampled, in one sentence with its place and what helps; empty
/// where all sheets are apart. `samples`: all of the cloud, which `merged.at` counts in.
[[nodiscard]] std::string doubt(const MergedSheets& merged, const Points& samples);

}  // namespace taut::detail
