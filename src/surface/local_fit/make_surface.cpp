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

void require_consistent(const LocalFitModel& model) {
  const Index d = model.centres.rows();
  const Index size = static_cast<Index>(d == 2 ? detail::Cubic<2>::kSize : detail::Cubic<3>::kSize);
  const Index m = model.centres.cols();
  const bool fits = (d == 2 || d == 3) && m > 0 && model.radii.size() == m && model.coefficients.rows() == size &&
                    model.coefficients.cols() == m && model.samples.points.rows() == d && model.samples.size() > 0 &&
                    model.support.size() == model.samples.size() &&
                    model.between.points.cols() == model.between.radius.size() &&
                    model.between.normals.cols() == model.between.radius.size();
  if (!fits) throw InvalidArgument("the local fit's patches, samples and support do not fit together");
  if (!(model.radii.minCoeff() > 0)) throw InvalidArgument("the local fit has a patch without a radius");
}

/// The samples, and the places between them.
std::shared_ptr<const ImplicitFunction> support_domain(const std::shared_ptr<const LocalFitModel>& model) {
  const std::shared_ptr<const PointCloud> samples(model, &model->samples);
  const bool has_normals = samples->normals.cols() == samples->size();
  const double flatness = has_normals ? model->flatness : 1;
  const SupportPlaces& between = model->between;
  if (between.radius.size() == 0 || !has_normals) return detail::make_support_domain(samples, model->support, flatness);
  const auto all = std::make_shared<PointCloud>();
  const Index n = samples->size();
  const Index m = between.radius.size();
  all->points.resize(samples->dim(), n + m);
  all->points << samples->points, between.points;
  all->normals.resize(samples->dim(), n + m);
  all->normals << samples->normals, between.normals;
  Vector radius(n + m);
  radius << model->support, between.radius;
  return detail::make_support_domain(all, radius, flatness);
}

}  // namespace

Surface make_surface(std::shared_ptr<const LocalFitModel> model) {
  if (!model) throw InvalidArgument("a surface needs a model");
  require_consistent(*model);
  SurfaceExtras extras;
  extras.samples = std::shared_ptr<const PointCloud>(model, &model->samples);
  extras.domain = support_domain(model);
  const double margin = model->support.maxCoeff();
  extras.box = Box{model->samples.points.rowwise().minCoeff().array() - margin,
                   model->samples.points.rowwise().maxCoeff().array() + margin};
  return Surface(detail::make_blended_function(*model), std::move(extras));
}

}  // namespace taut
