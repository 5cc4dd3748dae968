#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/core/status.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/query/path.hpp"

namespace taut::detail {

/// The nearest point of curves to a point of the surface.
struct CurveFoot {
  Status status = Status::not_converged;
  double distance = 0;     ///< model units
  double error = 0;        ///< estimated, of `distance`: of the path, and what a nearer point might save
  std::int32_t curve = 0;  ///< on which it lies
  Vector foot;             ///< d
  PathResult path;         ///< from the target to the foot
  std::string message;     ///< why the status is not ok
};

/// Of `target` (d, on the surface), over shortest paths to points of the curves, each of them arcs in a row at unit
/// speed. u, the distance to the point at arc length s, is 1-Lipschitz: a stretch of a curve is left out where that
/// proves it to be farther. What is left is halved until it is short; there a minimum is where du/ds, the tangent of
/// the path times that of the curve, changes its sign: at a right angle, at a corner of the curve or at its end.
/// `tolerance`: relative, of the distance. Properties the tests check: closed forms on spheres, cylinders, and a cube.
[[nodiscard]] CurveFoot nearest_on_curves(PathSolver& paths, const std::vector<std::vector<SpectralCurve>>& curves,
                                          const VectorIn& target, double tolerance);

}  // namespace taut::detail
