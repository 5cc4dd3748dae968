#pragma once

#include <memory>

#include "taut/core/context.hpp"
#include "taut/surface/point_cloud.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// phi(r) of a polyharmonic spline. Orders below 3 are not C^2 and refused where derivatives are needed.
enum class RbfKernel {
  cubic,    ///< r^3, C^2 everywhere: the default
  quintic,  ///< r^5, C^4
};

/// F(x) = sum_i weight_i phi(|x - centre_i|) + a polynomial: what fitting produces and a `.taut` file holds.
struct RbfModel {
  RbfKernel kernel = RbfKernel::cubic;
  Points centres;        ///< d x n, in the unit frame: x_unit = (x - origin) / scale
  Vector weights;        ///< n
  Vector polynomial;     ///< coefficients of 1, x_1 .. x_d (and x_i x_j, i <= j, for the quintic kernel)
  Vector origin;         ///< d
  double scale = 1;      ///< model units; F is returned in model units (close to a signed distance near the samples)
  double support_radius = 0;  ///< model units: the surface ends this far from every sample; 0 = it does not end
  PointCloud samples;    ///< the whole cloud, outliers and duplicates removed, normals oriented
};

struct RbfOptions {
  RbfKernel kernel = RbfKernel::cubic;
  /// >= 0, in model units^... 0 interpolates the samples; larger values smooth noise (see docs/rbf.md).
  double smoothing = 0;
  /// Off-surface constraints stand this far from the samples along +-normal, model units. 0 = chosen from the spacing.
  double offset = 0;
  /// Most samples a dense solve is given; a larger cloud is thinned to a well-spread subset and the user is told.
  Index max_samples = 0;  ///< 0 = the default
  /// Model units; 0 = chosen from the spacing, negative = no domain (the surface is not cut).
  double support_radius = 0;
  /// Neighbours for estimated normals.
  Index normal_neighbours = 16;
};

/// Fits F to a cloud. Throws InvalidArgument with a clear reason: too few points, all on a line, non-finite coordinates.
[[nodiscard]] RbfModel fit_rbf(const PointCloud& cloud, const RbfOptions& options = {}, const Context& context = {});

/// The zero set of a model, with its support domain and samples.
[[nodiscard]] Surface make_surface(std::shared_ptr<const RbfModel> model);

/// Unit normals for `cloud`: its own where they are given, else from its faces, else by local PCA; made consistent along
/// a minimum spanning tree and turned outwards. d x n.
[[nodiscard]] Points estimate_normals(const PointCloud& cloud, Index neighbours = 16, const Context& context = {});

}  // namespace taut
