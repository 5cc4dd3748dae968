#include "taut/march/barrier.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "march/stencil.hpp"

namespace taut {
namespace {

double turn_between(const SurfaceCells& cells, Index i, Index j) {
  const Eigen::MatrixXd shared = cells.normals(i).transpose() * cells.normals(j);
  if (cells.codim() == 1) return std::acos(std::clamp(shared(0), -1.0, 1.0));
  const double lost = static_cast<double>(cells.codim()) - shared.squaredNorm();
  return std::asin(std::sqrt(std::clamp(lost, 0.0, 1.0)));
}

}  // namespace

std::optional<Barrier> find_barrier(const SurfaceCells& cells, const DistanceField& field, const VectorIn& x) {
  detail::Stencil stencil(cells.dim());
  const auto reached = [&](Index i) { return i < field.distance.size() && std::isfinite(field.distance(i)); };
  double least = std::numeric_limits<double>::infinity();
  std::optional<Barrier> barrier;
  for (Index i = 0; i < field.distance.size(); ++i) {
    if (!reached(i)) continue;
    const double length = field.distance(i) + (cells.point(i) - x).norm();
    if (length >= least) continue;
    for (const Index j : stencil.block(cells.grid(), cells.grid().cell(i))) {
      if (!cells.valid(j) || reached(j)) continue;
      least = length;
      barrier = {cells.point(i), turn_between(cells, i, j)};
      break;
    }
  }
  return barrier;
}

}  // namespace taut
