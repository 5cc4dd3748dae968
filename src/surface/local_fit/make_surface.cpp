#include <algorithm>
#include <memory>
#include <utility>

#include "surface/local_fit/blended_function.hpp"
#include "surface/local_fit/cubic.hpp"
#include "surface/rbf/support_domain.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/local_fit.hpp"

namespace taut {
namespace {

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
  extras.domain = detail::make_support_domain(extras.samples, model->support);
  const double margin = model->support.maxCoeff();
  extras.box = Box{model->samples.points.rowwise().minCoeff().array() - margin,
                   model->samples.points.rowwise().maxCoeff().array() + margin};
  return Surface(detail::make_blended_function(*model), std::move(extras));
}

}  // namespace taut
