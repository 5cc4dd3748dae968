// A surface that moves by delta x = -J^+ (dF/dc) dc takes its geodesics along: of x + delta x the length changes by
// -int x'' . delta x ds, what they do within the surface not counting. x'' = -J^T lambda, lambda = (J J^T)^-1 (x' . H_i
// x')_i, so that the integrand is -lambda . dF/dc.

#include "taut/curve/geodesic.hpp"

#include "core/linear_algebra.hpp"
#include "curve/gauss_collocation.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::GaussCollocation;

/// F and its derivatives by x and c at the nodes of one step.
class ExtendedStages {
 public:
  ExtendedStages(const ImplicitFunction& function, const VectorIn& parameters)
      : evaluator_(function.make_evaluator()),
        parameters_(parameters),
        k_(function.codim()),
        dim_(function.dim()),
        d_(function.dim() - parameters.size()) {}

  /// dL/dc of the curve's parameters t .. t + h.
  [[nodiscard]] Vector integrate(const SpectralCurve& curve, double t, double h) {
    const GaussCollocation& tables = GaussCollocation::tables();
    Vector sum = Vector::Zero(parameters_.size());
    for (Index i = 0; i < GaussCollocation::kStages; ++i) {
      const double at = t + h * tables.node(i);
      const Vector v = curve.velocity(at);
      Vector x(dim_);
      x << curve.point(at), parameters_;
      Eigen::MatrixXd gradients(dim_, k_);
      Vector value(k_);
      evaluator_->evaluate({.n = 1, .x = x.data(), .value = value.data(), .jacobian = gradients.data()});
      Vector along = Vector::Zero(dim_);
      along.head(d_) = v;
      Vector bend(k_);
      for (Index e = 0; e < k_; ++e) {
        const Vector weight = Vector::Unit(k_, e);
        Vector out(dim_);
        evaluator_->hessian_times({.n = 1, .x = x.data(), .weight = weight.data()}, along.data(), out.data());
        bend(e) = along.dot(out);
      }
      // F takes (x, c): the first d rows are derivatives by place, the rest by parameter.
      const Eigen::MatrixXd j = gradients.topRows(d_).transpose();  // k x d
      const Vector lambda = detail::solve_square(j * j.transpose(), bend);
      // ds = |v| dt, and x'' by arc length is that by t over |v|^2.
      sum -= tables.end_once(i) * h / v.norm() * (gradients.bottomRows(dim_ - d_) * lambda);
    }
    return sum;
  }

 private:
  std::unique_ptr<Evaluator> evaluator_;
  Vector parameters_;
  Index k_, dim_, d_;
};

}  // namespace

Vector length_derivative(const ImplicitFunction& function, const SpectralCurve& geodesic, const VectorIn& parameters) {
  if (geodesic.num_elements() == 0 || function.dim() != geodesic.dim() + parameters.size()) {
    throw InvalidArgument("a derivative by parameters needs a curve, and a function of its variables and of them");
  }
  ExtendedStages stages(function, parameters);
  Vector sum = Vector::Zero(parameters.size());
  double begin = 0;
  for (const double length : geodesic.lengths()) {  // two steps an element: their degree is up to 16
    sum += stages.integrate(geodesic, begin, length / 2) + stages.integrate(geodesic, begin + length / 2, length / 2);
    begin += length;
  }
  return sum;
}

}  // namespace taut
