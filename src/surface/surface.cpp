#include "taut/surface/surface.hpp"

#include <string>
#include <utility>

#include "surface/sign_evaluator.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"

namespace taut {
namespace {

// Below, `dense` is a copy of points that may be a block of a larger matrix: evaluators take them without gaps.

void require_dim(const char* what, Index found, Index expected) {
  if (found == expected) return;
  throw InvalidArgument(std::string(what) + " has dimension " + std::to_string(found) + ", the surface has " +
                        std::to_string(expected));
}

}  // namespace

Surface::Surface(std::shared_ptr<const ImplicitFunction> function, SurfaceExtras extras)
    : function_(std::move(function)), extras_(std::move(extras)) {
  if (!function_) throw InvalidArgument("a surface needs a function");
  const Index d = dim();
  const Index k = codim();
  if (d < 2) throw InvalidArgument("a surface needs at least 2 dimensions, not " + std::to_string(d));
  if (k < 1 || k >= d) {
    std::string message = std::to_string(k) + " equations in " + std::to_string(d) +
                          " dimensions leave no curve to walk on: at most " + std::to_string(d - 1) + " are possible";
    if (k >= d) {
      const auto diagnosis = diagnose_rank(*function_, Box{Vector::Constant(d, -1), Vector::Constant(d, 1)});
      if (diagnosis) message += "; " + diagnosis->text();
    }
    throw InvalidArgument(message);
  }
  if (extras_.domain) require_dim("the domain", extras_.domain->dim(), d);
  if (extras_.box) {
    require_dim("the box's lower corner", extras_.box->lower.size(), d);
    require_dim("the box's upper corner", extras_.box->upper.size(), d);
    if (!(extras_.box->lower.array() <= extras_.box->upper.array()).all()) {
      throw InvalidArgument("the box's lower corner must nowhere be above its upper corner, nor NaN");
    }
  }
  if (extras_.samples) require_dim("the samples", extras_.samples->dim(), d);
}

Surface Surface::with_box(Box box) const {
  SurfaceExtras extras = extras_;
  extras.box = std::move(box);
  return Surface(function_, std::move(extras));
}

Surface Surface::with_samples(std::shared_ptr<const PointCloud> samples) const {
  SurfaceExtras extras = extras_;
  extras.samples = std::move(samples);
  return Surface(function_, std::move(extras));
}

Points Surface::value(const PointsIn& x) const {
  require_dim("the point", x.rows(), dim());
  Points result(codim(), x.cols());
  const Points dense = x;
  make_evaluator()->evaluate({.n = dense.cols(), .x = dense.data(), .value = result.data()});
  return result;
}

Points Surface::jacobian(const PointsIn& x) const {
  require_dim("the point", x.rows(), dim());
  Points result(dim() * codim(), x.cols());
  const Points dense = x;
  make_evaluator()->evaluate({.n = dense.cols(), .x = dense.data(), .jacobian = result.data()});
  return result;
}

Eigen::MatrixXd Surface::hessian(const VectorIn& x, const VectorIn& weight) const {
  require_dim("the point", x.size(), dim());
  require_dim("the weight", weight.size(), codim());
  Eigen::MatrixXd result(dim(), dim());
  make_evaluator()->evaluate({.n = 1, .x = x.data(), .weight = weight.data(), .hessian = result.data()});
  return result;
}

Eigen::Array<bool, Eigen::Dynamic, 1> Surface::inside_domain(const PointsIn& x, double slack) const {
  require_dim("the point", x.rows(), dim());
  using Mask = Eigen::Array<bool, Eigen::Dynamic, 1>;
  if (domain() == nullptr) return Mask::Constant(x.cols(), true);
  const Index m = domain()->codim();
  const Points dense = x;
  const std::unique_ptr<Evaluator> evaluator = domain()->make_evaluator();
  Mask inside(x.cols());
  detail::are_nonnegative(*evaluator, m, dense.cols(), dense.data(), inside.data());
  if (!(slack > 0)) return inside;
  Vector value(m);
  Eigen::MatrixXd gradients(dim(), m);
  for (Index j = 0; j < x.cols(); ++j) {
    if (inside(j)) continue;
    evaluator->evaluate({.n = 1, .x = dense.col(j).data(), .value = value.data(), .jacobian = gradients.data()});
    inside(j) = (value.transpose().array() >= -slack * gradients.colwise().norm().array()).all();
  }
  return inside;
}

}  // namespace taut
