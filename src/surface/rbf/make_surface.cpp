#include <algorithm>
#include <string>
#include <utility>

#include "surface/describe.hpp"
#include "surface/rbf/polynomial.hpp"
#include "surface/rbf/rbf_function.hpp"
#include "surface/rbf/support_domain.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

void require_consistent(const RbfModel& model) {
  const Index d = model.origin.size();
  const detail::PolynomialSpace space{d, model.kernel == RbfKernel::quintic ? 2 : 1};
  const bool fits = d >= 2 && model.centres.rows() == d && model.weights.size() == model.centres.cols() &&
                    model.polynomial.size() == space.size() && model.samples.points.rows() == d;
  if (!fits) throw InvalidArgument("the RBF model's centres, weights, polynomial and samples do not fit together");
  if (!(model.scale > 0)) throw InvalidArgument("the RBF model's scale is " + detail::describe(model.scale));
}

/// Where the samples are, with room for what the surface does between and around them.
Box box_around(const RbfModel& model) {
  const Points& points = model.samples.points;
  Box box{points.rowwise().minCoeff(), points.rowwise().maxCoeff()};
  const double margin =
      model.support_radius > 0 ? model.support_radius : std::max(0.05 * box.diagonal(), 2 * model.report.spacing);
  box.lower.array() -= margin;
  box.upper.array() += margin;
  return box;
}

}  // namespace

Surface make_surface(std::shared_ptr<const RbfModel> model) {
  if (!model) throw InvalidArgument("a surface needs a model");
  require_consistent(*model);
  SurfaceExtras extras;
  extras.samples = std::shared_ptr<const PointCloud>(model, &model->samples);
  if (model->samples.size() > 0) {
    extras.box = box_around(*model);
    if (model->support_radius > 0) {
      extras.domain =
          detail::make_support_domain(extras.samples, Vector::Constant(model->samples.size(), model->support_radius));
    }
  }
  return Surface(std::make_shared<detail::RbfFunction>(*model), std::move(extras));
}

}  // namespace taut
