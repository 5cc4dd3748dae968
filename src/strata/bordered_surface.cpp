// Notation: J the Jacobian of {F, g}, h_i = t . Hess_i t for a unit tangent t. A curve along the border has
//   x'' = -J^+ h + (what lies in the border) = J^T lambda + ...,   lambda = -(J J^T)^-1 h,
// and of that the part lambda_g P grad g stays within the surface, P the projection onto its tangent space.
#include "strata/bordered_surface.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/linear_algebra.hpp"
#include "curve/looks_at_border.hpp"
#include "surface/stacked_function.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {

BorderedSurface::BorderedSurface(const Surface& surface, double tolerance)
    : surface_(surface), dim_(surface.dim()), tolerance_(tolerance), domain_(surface.domain()->make_evaluator()) {
  const Index m = surface.domain()->codim();
  for (Index i = kFree; i < m; ++i) {
    const std::vector<Index> components = i == kFree ? std::vector<Index>{} : std::vector<Index>{i};
    Surface cut(std::make_shared<const StackedFunction>(surface, components));
    std::unique_ptr<Evaluator> evaluator = cut.make_evaluator();
    sheets_.push_back({std::move(cut), std::move(evaluator), std::nullopt});
  }
}

NewtonSolver& BorderedSurface::solver(int border) {
  Sheet& one = sheet(border);
  if (!one.solver) one.solver.emplace(one.surface, NewtonOptions{.tolerance = tolerance_});
  return *one.solver;
}

Eigen::Array<bool, Eigen::Dynamic, 1> BorderedSurface::project(int border, Points& x, Eigen::MatrixXd* normals) {
  return project_to_surface(*sheet(border).evaluator, dim_, codim(border), x, {}, normals);
}

Points BorderedSurface::room(const Points& x) {
  const Index n = x.cols();
  const Index m = num_borders();
  Points value(m, n);
  Points jacobian(dim_ * m, n);
  domain_->evaluate({.n = n, .x = x.data(), .value = value.data(), .jacobian = jacobian.data()});
  for (Index j = 0; j < n; ++j) {
    const Eigen::Map<const Points> gradients(jacobian.col(j).data(), dim_, m);
    value.col(j).array() /= gradients.colwise().norm().transpose().array().max(std::numeric_limits<double>::min());
  }
  return value;
}

Points BorderedSurface::looked_at(const Points& curve) {
  return looks_at_border(surface_, *sheet(kFree).evaluator, curve);
}

Vector BorderedSurface::pull(int border, const Points& x, const Points& tangents) {
  const Index n = x.cols();
  const Index k = codim(border);
  Evaluator& evaluator = *sheet(border).evaluator;
  Points jacobian(dim_ * k, n);
  evaluator.evaluate({.n = n, .x = x.data(), .jacobian = jacobian.data()});
  Points bend(k, n);
  Points product(dim_, n);
  for (Index i = 0; i < k; ++i) {
    Points weight = Points::Zero(k, n);
    weight.row(i).setOnes();
    evaluator.hessian_times({.n = n, .x = x.data(), .weight = weight.data()}, tangents.data(), product.data());
    bend.row(i) = tangents.cwiseProduct(product).colwise().sum();
  }
  Vector result(n);
  for (Index j = 0; j < n; ++j) {
    const Eigen::Map<const Points> gradients(jacobian.col(j).data(), dim_, k);
    const ThinQr qr = thin_qr(gradients);  // J^T = Q R: grad g's part off the others is R_kk
    const Vector lambda = -solve_square(qr.r.transpose() * qr.r, bend.col(j));
    result(j) = lambda(k - 1) * std::abs(qr.r(k - 1, k - 1));
  }
  return result;
}

}  // namespace taut::detail
