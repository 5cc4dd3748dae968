#pragma once

#include <vector>

#include "surface/local_fit/patch_solve.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Fewest samples that determine a patch of degree three well, with their normals.
[[nodiscard]] Index fewest_samples(Index dim);

/// How many samples a patch around each sample should hold, by cross-validation: patches of growing size are fitted at
/// places spread over the cloud, and the largest is taken that predicts the samples at its middle about as well as the
/// best does. Clean samples get the fewest, noisy ones many. n.
[[nodiscard]] std::vector<Index> samples_by_cross_validation(OrientedSamples samples, const KdTree& tree,
                                                             const Context& context);

struct Ball {
  Index sample = 0;  // its centre
  double radius = 0;
};

/// What is asked of the ball around each sample, should it get one.
struct BallWishes {
  std::vector<Index> samples;  ///< n: it holds at least so many
  Vector radius;               ///< n: and is at least so large
  std::vector<bool> own;       ///< n: this sample gets one in any case
};

/// Balls around samples such that every sample lies within half the radius of one of them. Thinned in a fixed scrambled
/// order, which leaves them evenly spread.
[[nodiscard]] std::vector<Ball> cover(const Points& points, const KdTree& tree, const BallWishes& wishes,
                                      const Context& context);

}  // namespace taut::detail
