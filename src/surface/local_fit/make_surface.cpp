#include <algorithm>
#include <memory>
#include <utility>

#include "surface/local_fit/blended_function.hpp"
#include "surface/local_fit/cubic.hpp"
#include "surface/rbf/support_domain.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

/// Across the sheet the surface ends at half the support. Bubbles off the sheet lie at 0.6 to 1 of it; the surface
/// itself where a hole of the samples is filled at up to 0.3, if it bends to a radius of two spacings.
constexpr double kFlatness = 2;

void require_consistent(const LocalFitModel& model) {
  const Index d = model.centres.rows();
  const Index size = static_cast<Index>(d == 2 ? detail::Cubic<2>::kSize : detail::Cubic<3>::kSize);
  const Index m = model.centres.cols();
  const bool fits = (d == 2 || d == 3) && m > 0 && model.radii.size() == m && model.coefficients.rows() == size &&
                    model.coefficients.cols() == m && model.samples.points.rows() == d && model.samples.size() > 0 &&
                    model.support.size() == model.samples.size();
  if (!fits) throw InvalidArgument("the local fit's patches, samples and support do not fit together");
  if (!(model.radii.minCoeff() > 0)) throw InvalidArgument("the local fit has a patch without a radius");
}

}  // namespace

Surface make_surface(std::shared_ptr<const LocalFitModel> model) {
  if (!model) throw InvalidArgument("a surface needs a model");
  require_consistent(*model);
  SurfaceExtras extras;
  extras.samples = std::shared_ptr<const PointCloud>(model, &model->samples);
  const bool has_normals = model->samples.normals.cols() == model->samples.size();
  extras.domain = detail::make_support_domain(extras.samples, model->support, has_normals ? kFlatness : 1);
  const double margin = model->support.maxCoeff();
  extras.box = Box{model->samples.points.rowwise().minCoeff().array() - margin,
                   model->samples.points.rowwise().maxCoeff().array() + margin};
  return Surface(detail::make_blended_function(*model), std::move(extras));
}

}  // namespace taut
