#pragma once

#include <vector>

#include "surface/local_fit/patch_solve.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// Across the sheet the surface ends sooner than along it: distances along the normal count so many times. Bubbles off
/// the sheet lie at 0.6 to 1 of the support; the surface itself where a hole of the samples is filled at up to 0.3, if
/// it bends to a radius of two spacings. Of a mesh, whose holes need no filling and whose arched faces have places of
/// their own, less is left: 3 keeps bubbles of the head's and the feline's (docs/measured/scans.md).
inline constexpr double kFlatnessOfCloud = 2;
inline constexpr double kFlatnessOfMesh = 4;

/// How far around each sample there is surface: far enough that the holes between samples of one sheet are filled, by
/// the spacing around it, but less than half of the gap to the next sheet that faces the same way (see
/// default_support_radius). `spacing`: n.
[[nodiscard]] Vector support_radii(OrientedSamples samples, const KdTree& tree, const Vector& spacing,
                                   const Context& context);

/// The samples of a mesh, which are its vertices. `faces`: indices as in `merged_to`.
struct FacedSamples {
  OrientedSamples samples;
  const Eigen::Matrix3Xi& faces;
  const std::vector<Index>& merged_to;
};

/// The longest edge at each vertex; 0 where there is no face.
[[nodiscard]] Vector longest_edges(const FacedSamples& mesh);

/// How far around each vertex there is surface: no farther than its faces ask for, and less where they lie on different
/// planes. `most`: by support_radii, which is what a sample without faces keeps.
[[nodiscard]] Vector support_of_vertices(const FacedSamples& mesh, const Vector& most);

/// Which samples lie where the sampled sheet ends, or at a hole: those whose neighbours within the sheet lie to one
/// side. A few others are taken for such at random samples. n.
[[nodiscard]] std::vector<bool> find_rim(OrientedSamples samples, const KdTree& tree, const Context& context);

}  // namespace taut::detail
