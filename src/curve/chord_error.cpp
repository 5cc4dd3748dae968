#include "curve/chord_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace taut::detail {

double relative_chord_error(double cst) {
  // acos(1 - c^2 / 2) = 2 asin(c / 2); below the switch the series' next term is c^6 * 5 / 7168 < 1e-15 of the first.
  if (cst >= 2) return std::numbers::pi / 2 - 1;
  const double c2 = cst * cst;
  if (cst < 1e-3) return c2 / 24 * (1 + c2 * (9.0 / 80));
  return 2 * std::asin(cst / 2) / cst - 1;
}

ChordError chord_error(const PointsIn& nodes) {
  const Index m = nodes.cols() - 1;
  ChordError error;
  if (m < 2) return error;
  Vector curvature(m + 1);
  double last = (nodes.col(1) - nodes.col(0)).norm();
  for (Index i = 1; i < m; ++i) {
    const double next = (nodes.col(i + 1) - nodes.col(i)).norm();
    const Vector turn = (nodes.col(i + 1) - nodes.col(i)) / next - (nodes.col(i) - nodes.col(i - 1)) / last;
    curvature(i) = turn.norm() / (0.5 * (next + last));
    last = next;
  }
  curvature(0) = curvature(1);
  curvature(m) = curvature(m - 1);
  double length = 0;
  double weighted = 0;
  for (Index i = 0; i < m; ++i) {
    const double interval = (nodes.col(i + 1) - nodes.col(i)).norm();
    const double ratio = interval * 0.5 * (curvature(i) + curvature(i + 1));  // eps_i / r_i
    error.sum += interval * relative_chord_error(ratio);
    error.max_cst = std::max(error.max_cst, ratio);
    weighted += interval * ratio * ratio;
    length += interval;
  }
  error.cst = length > 0 ? std::sqrt(weighted / length) : 0;
  error.uniform = length * relative_chord_error(error.cst);  // (A1)
  return error;
}

}  // namespace taut::detail
