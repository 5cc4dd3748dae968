// Paths over the rim of a wafer, the ellipsoid 1:1:c: flat for almost all of their length, and then turned round within
// c^2 of it. In the plane through the axis the length is an elliptic integral.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "taut/curve/newton.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

Surface wafer(double c) { return parse_surface("x^2+y^2+z^2/" + std::to_string(c * c * 1e6) + "*10^6=1"); }

/// Ellipsoids 1:1:c, and the length from (1/2, 0, c sqrt(3)/2) over the rim to (1/2, 0, -c sqrt(3)/2), by quadrature
/// with 25 digits.
struct Wafer {
  double c;
  double length;
};
constexpr Wafer kWafers[] = {
    {0.02, 1.001899857824367362}, {0.005, 1.000153383953867757}, {0.002, 1.000028206424403839}};

/// Points of that path, close together at the rim.
Points polyline_over_rim(double c, Index segments) {
  Points path(3, segments + 1);
  const double widest = std::asinh(std::acos(0.5) / c);
  for (Index j = 0; j <= segments; ++j) {
    const double t = c * std::sinh(widest * (1 - 2 * static_cast<double>(j) / static_cast<double>(segments)));
    path.col(j) << std::cos(t), 0, c * std::sin(t);
  }
  return path;
}

TEST(SharpRims, NewtonMeetsEveryTolerance) {
  for (const auto [c, truth] : kWafers) {
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13}) {
      const NewtonResult path = correct_newton(wafer(c), polyline_over_rim(c, 200), {.tolerance = tolerance});
      EXPECT_EQ(path.status, Status::ok) << "c " << c << " tolerance " << tolerance << ": " << path.reason;
      EXPECT_LE(std::abs(path.length - truth), path.length_error + 1e-15) << "c " << c << " tolerance " << tolerance;
      EXPECT_LE(path.length_error, tolerance * truth + 2e-15);
    }
  }
}

}  // namespace
}  // namespace taut
