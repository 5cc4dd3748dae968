#pragma once

#include <memory>
#include <optional>

#include "taut/core/context.hpp"
#include "taut/surface/merged_sheets.hpp"
#include "taut/surface/normals.hpp"
#include "taut/surface/point_cloud.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// phi(r) of a polyharmonic spline, conditionally positive definite in every dimension d >= 2 with the polynomial
/// named.
enum class RbfKernel {
  cubic,    ///< r^3 with a polynomial of degree 1: C^2 everywhere, C^infinity away from the centres. The default
  quintic,  ///< r^5 with a polynomial of degree 2: C^4, more accurate on smooth shapes, worse conditioned
};

/// What a fit did and how well it did it. Lengths in model units.
struct RbfReport {
  Index num_samples = 0;    ///< different points in the cloud
  Index num_fitted = 0;     ///< samples that became constraints
  double spacing = 0;       ///< mean distance between neighbouring fitted samples
  double noise = 0;         ///< estimated standard deviation of the samples along the normal
  double smoothing = 0;     ///< the smoothing length that was used
  double offset = 0;        ///< how far the off-surface constraints stand, where nothing made them shrink
  double residual = 0;      ///< largest miss of a constraint by the solver: rounding
  double left_out_rms = 0;  ///< |F| / |grad F| at the samples that are no constraints; 0 when there are none
  double left_out_max = 0;
  double residual_rms = 0;  ///< the same at all samples
  double residual_max = 0;
  Index residual_at = 0;       ///< the sample (of the cloud, from 0) with the largest
  MergedSheets merged_sheets;  ///< `at` counts in the cloud
};

/// F(x) = scale F_unit((x - origin) / scale), F_unit(u) = sum_i weight_i phi(|u - centre_i|) + a polynomial: what
/// fitting produces and a `.taut` file holds.
struct RbfModel {
  RbfKernel kernel = RbfKernel::cubic;
  Points centres;     ///< d x n, in the unit frame
  Vector weights;     ///< n
  Vector polynomial;  ///< coefficients of 1, x_1 .. x_d and, for the quintic kernel, x_i x_j with j <= i row by row
  Vector origin;      ///< d, model units
  double scale = 1;   ///< model units, a power of two
  /// Model units: the surface ends this far from every sample; 0 = it does not end.
  double support_radius = 0;
  /// The whole cloud in the order it came (so that the 17th sample stays the 17th), with unit normals.
  PointCloud samples;
  RbfReport report;
};

struct RbfOptions {
  RbfKernel kernel = RbfKernel::cubic;
  /// A length >= 0 in model units: bumps of this wavelength are flattened to half, much longer ones kept, much shorter
  /// ones removed (docs/rbf.md gives the law). 0 = pass through the samples. Unset = chosen from the noise found in
  /// the samples, 0 for clean ones.
  std::optional<double> smoothing = std::nullopt;
  /// Off-surface constraints stand this far from the samples along the normal, model units; less where another sample
  /// is near. 0 = chosen from the spacing.
  double offset = 0;
  /// Off-surface constraints inside as well as outside. Half as many centres again and, on smooth shapes, a less
  /// accurate zero set (docs/rbf.md says why); |grad F| stays nearer to 1. The quintic kernel always has both.
  bool both_sides = false;
  /// Most samples a dense solve is given; a larger cloud is thinned to a well-spread subset and the user is told. Time
  /// grows with its cube, memory with its square (32 n^2 bytes). 0 = `kDefaultMaxSamples`.
  Index max_samples = 0;
  /// The surface ends this far from every sample, model units. 0 = chosen from the spacing and from the gap between
  /// sheets that face the same way, or no end where the cloud's faces form a watertight mesh; negative = no end.
  double support_radius = 0;
  /// Neighbours for estimated normals.
  Index normal_neighbours = 10;
};

inline constexpr Index kDefaultMaxSamples = 2500;

/// Fits F to a cloud in any dimension d >= 2: F = 0 at the samples, F = +-offset off the surface along the normals, so
/// that F is close to the signed distance near the samples, positive outside.
/// Throws InvalidArgument with a clear reason (too few points, all on a line, non-finite coordinates, an option out of
/// range), OutOfMemory before allocating more than `context` allows, Cancelled.
[[nodiscard]] RbfModel fit_rbf(const PointCloud& cloud, const RbfOptions& options = {}, const Context& context = {});

/// The zero set of a model, with its support domain and samples. Throws InvalidArgument when the model's parts do not
/// fit together.
[[nodiscard]] Surface make_surface(std::shared_ptr<const RbfModel> model);

}  // namespace taut
