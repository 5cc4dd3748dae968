#include "taut/surface/fit.hpp"

#include <string>
#include <utility>

#include "surface/describe.hpp"
#include "surface/fitted_function.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

/// A dense fit costs the cube of the samples, a local one 3 to 10 microseconds for each; at this size both take under a
/// second, and the dense one passes through the samples. Beyond it, it would leave samples out.
bool suits_local(const PointCloud& cloud) { return cloud.dim() <= 3 && cloud.size() > kDefaultMaxSamples; }

/// A record far from all others (a placeholder such as 0,0,0 among map coordinates) would stretch the box of the
/// surface, and with it the cells, beyond use. Distances are from the median point, in terms of what 95 % stay within.
void refuse_strays(const PointCloud& cloud) {
  constexpr double kFar = 20;
  const Index n = cloud.size();
  if (n == 0 || !cloud.points.allFinite()) return;  // the fits say what is wrong
  Vector middle(cloud.dim());
  for (Index axis = 0; axis < cloud.dim(); ++axis)
    middle(axis) = detail::quantile(cloud.points.row(axis).transpose(), 0.5);
  const Vector distance = (cloud.points.colwise() - middle).colwise().norm();
  const double usual = detail::quantile(distance, 0.95);
  Index first = 0;
  const double farthest = distance.maxCoeff(&first);
  if (!(usual > 0) || farthest <= kFar * usual) return;
  const Index count = (distance.array() > kFar * usual).count();
  throw InvalidArgument("point " + std::to_string(first) + " at " + detail::describe(cloud.points.col(first)) +
                        " lies " + detail::describe(farthest) + " from the middle of the cloud, 95 % of it within " +
                        detail::describe(usual) +
                        (count > 1 ? " (" + std::to_string(count) + " such points)" : std::string()) +
                        ": take it out of the file if it is a placeholder");
}

}  // namespace

FitModel fit_surface(const PointCloud& cloud, const FitOptions& options, const Context& context) {
  refuse_strays(cloud);
  const bool chosen = options.method == FitMethod::automatic && options.max_samples == 0 &&
                      options.support_radius >= 0 && suits_local(cloud);
  if (chosen || options.method == FitMethod::local) {
    if (cloud.dim() > 3) {
      throw InvalidArgument("a local fit is for points in 2 or 3 dimensions, not " + std::to_string(cloud.dim()) +
                            ": take the dense one");
    }
    return fit_local(cloud, {.smoothing = options.smoothing, .support_radius = options.support_radius}, context);
  }
  RbfOptions dense;
  dense.smoothing = options.smoothing;
  dense.max_samples = options.max_samples;
  dense.support_radius = options.support_radius;
  return fit_rbf(cloud, dense, context);
}

Surface make_surface(FitModel model) {
  return std::visit(
      []<class Model>(Model&& kind) { return make_surface(std::make_shared<const Model>(std::forward<Model>(kind))); },
      std::move(model));
}

std::optional<double> fit_residual(const Surface& surface) {
  const auto* const fitted = dynamic_cast<const detail::FittedFunction*>(&surface.function());
  if (fitted == nullptr) return std::nullopt;
  return fitted->residual_rms();
}

std::string fit_doubt(const Surface& surface) {
  const auto* const fitted = dynamic_cast<const detail::FittedFunction*>(&surface.function());
  return fitted == nullptr ? std::string() : fitted->doubt();
}

}  // namespace taut
