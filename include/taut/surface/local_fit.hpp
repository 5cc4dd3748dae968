#pragma once

#include <memory>
#include <optional>

#include "taut/core/context.hpp"
#include "taut/surface/merged_sheets.hpp"
#include "taut/surface/point_cloud.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// What a local fit did and how well it did it. Lengths in model units.
struct LocalFitReport {
  Index num_samples = 0;        ///< different points in the cloud
  Index samples_per_patch = 0;  ///< the median over the patches
  double spacing = 0;           ///< mean distance between neighbouring samples, the median
  double noise = 0;             ///< estimated standard deviation of the samples along the normal
  double residual_rms = 0;      ///< |F| / |grad F| at the samples: how far the surface stands off them
  double residual_max = 0;
  Index residual_at = 0;       ///< the sample (of the cloud, from 0) with the largest
  MergedSheets merged_sheets;  ///< `at` counts in the cloud
};

/// A surface in R^2 or R^3 put together of many small pieces: polynomials of degree three, each fitted to the samples
/// in one ball, blended where the balls overlap (a partition of unity). What `fit_local` makes and a `.taut` file
/// holds.
struct LocalFitModel {
  Points centres;  ///< d x m, model units
  Vector radii;    ///< m
  /// q x m, q = 10 (d = 2) or 20 (d = 3): f(x) = R p((x - c) / R), the coefficients of
  /// 1, u_a, u_a u_b (1/2 if a = b), u_a u_b u_c (1/2 if two are alike, 1/6 if three), a <= b <= c row by row.
  Points coefficients;
  /// n: how far around each sample there is surface, model units.
  Vector support;
  /// The whole cloud in the order it came (so that the 17th sample stays the 17th), with unit normals.
  PointCloud samples;
  LocalFitReport report;
};

struct LocalFitOptions {
  /// A length >= 0 in model units: patches are at least so large that ripples of this wavelength are flattened to less
  /// than two thirds. 0 = patches as small as the samples allow. Unset = chosen by cross-validation, as small as they
  /// are allowed for a mesh, whose vertices are taken at their word.
  std::optional<double> smoothing = std::nullopt;
  /// The surface ends this far from every sample, model units. 0 = chosen, for each sample by its own spacing.
  double support_radius = 0;
  /// Neighbours for estimated normals; more are taken where the samples are noisy.
  Index normal_neighbours = 10;
};

/// Fits F to a cloud in R^2 or R^3, of any size: time and memory grow with the number of samples, the cost of F at a
/// point does not. F is close to the signed distance near the samples, positive outside, and C^3. The surface passes by
/// the samples, not through them: `report.residual_rms` says how near. On samples of a smooth surface the distance from
/// it falls with the fourth power of the spacing, the error of the normals with the third (tested).
/// The same bits for any number of threads.
/// Throws InvalidArgument with a clear reason (another dimension, too few points, all on a line, non-finite
/// coordinates, an option out of range), OutOfMemory before allocating more than `context` allows, Cancelled.
[[nodiscard]] LocalFitModel fit_local(const PointCloud& cloud, const LocalFitOptions& options = {},
                                      const Context& context = {});

/// Bytes that fitting this many samples takes at most, estimated.
[[nodiscard]] double local_fit_bytes(Index num_samples);

/// The zero set of a model, with its support domain and samples. Throws InvalidArgument when the model's parts do not
/// fit together.
[[nodiscard]] Surface make_surface(std::shared_ptr<const LocalFitModel> model);

}  // namespace taut
