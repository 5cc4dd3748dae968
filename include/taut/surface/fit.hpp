#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/point_cloud.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Samples of two sheets, nearer to each other than the samples on each of them, that a fit does not keep apart: the
/// faces of a plate that became one sheet, say. What is fitted there may not be what was sampled.
struct MergedSheets {
  Index count = 0;  ///< how many samples; 0 = all sheets are apart, as far as can be told
  Index at = 0;     ///< one of them, from 0
  double gap = 0;   ///< between the sheets there, the mean, model units
};

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

/// Places of a surface that speak for it as samples do, each as far as its radius. Model units.
struct SupportPlaces {
  Points points;   ///< d x n
  Points normals;  ///< d x n, unit
  Vector radius;   ///< n
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
  /// Of a mesh: places of the surface over those of its faces that the samples do not cover, being large or arched.
  SupportPlaces between;
  double flatness = 1;  ///< >= 1: across the sheet there is surface so many times less far
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

enum class FitMethod {
  automatic,  ///< dense for as many samples as a dense fit takes (and in more than 3 dimensions), else local
  dense,      ///< one system for all samples: `fit_rbf`. A larger cloud is thinned
  local,      ///< many small patches, blended: `fit_local`. Every sample counts
};

/// What both kinds of fit understand, and which one to make. Lengths in model units.
struct FitOptions {
  FitMethod method = FitMethod::automatic;
  /// RbfOptions::smoothing or LocalFitOptions::smoothing. Unset = chosen from the noise.
  std::optional<double> smoothing = std::nullopt;
  /// Most samples a dense fit is given, 0 = kDefaultMaxSamples; with `automatic`, given = dense.
  Index max_samples = 0;
  /// The surface ends this far from every sample; 0 = chosen; negative = nowhere, for a dense fit only.
  double support_radius = 0;
};

using FitModel = std::variant<RbfModel, LocalFitModel>;

/// Fits a surface to a cloud by the method that suits its size. Throws what the two fits throw, and InvalidArgument for
/// a local fit in more than 3 dimensions and for a point that lies far from all others, naming it.
[[nodiscard]] FitModel fit_surface(const PointCloud& cloud, const FitOptions& options = {},
                                   const Context& context = {});

/// The zero set of either.
[[nodiscard]] Surface make_surface(FitModel model);

/// How far a fitted surface stands off its samples (root mean square of |F| / |grad F|), model units: digits of a
/// length beyond that say nothing about what was sampled. None for surfaces that were not fitted.
[[nodiscard]] std::optional<double> fit_residual(const Surface& surface);

/// Why a fitted surface may not be the one that was sampled (MergedSheets), in one sentence; empty where nothing is
/// known against it, and for surfaces that were not fitted. Paths carry it as their message.
[[nodiscard]] std::string fit_doubt(const Surface& surface);

}  // namespace taut
