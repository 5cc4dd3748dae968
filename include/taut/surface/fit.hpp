#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "taut/core/context.hpp"
#include "taut/surface/local_fit.hpp"
#include "taut/surface/point_cloud.hpp"
#include "taut/surface/rbf.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

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
