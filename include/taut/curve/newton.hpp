#pragma once

#include <memory>

#include "taut/core/context.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct NewtonOptions {
  /// Relative length tolerance: done when length_error <= tolerance * length, 1e-13 .. 1e-3. Where rounding forbids it,
  /// `length_error` says what was reached.
  double tolerance = 1e-9;
  int max_iterations = 500;  ///< Newton or shortening steps in all, >= 1
  int max_elements = 4096;   ///< >= 1
  /// Go on from a geodesic that is not even locally shortest to one that is. If false, the result is the geodesic
  /// nearest to the start, minimum or not.
  bool leave_saddles = true;
};

/// What Newton's method adds to a geodesic.
struct NewtonResult : Geodesic {
  SpectralCurve curve;      ///< the nodes lie on the surface; in between the curve is off by at most `residual.surface`
  Index num_evaluated = 0;  ///< points at which F and its derivatives were evaluated
};

/// Shortens a curve on one surface to a geodesic, again and again: keeps the evaluator and all workspace. Not for
/// sharing between threads. See docs/newton.md.
class NewtonSolver {
 public:
  /// Throws InvalidArgument when an option breaks its rule.
  explicit NewtonSolver(const Surface& surface, const NewtonOptions& options = {});
  ~NewtonSolver();
  NewtonSolver(NewtonSolver&&) noexcept;
  NewtonSolver& operator=(NewtonSolver&&) noexcept;

  /// `start` is d x m, m >= 2, on or near the surface; its ends stay fixed and must lie on it. Throws InvalidArgument
  /// for a wrong shape or a coordinate that is not finite, Cancelled; every mathematical outcome is in the status.
  [[nodiscard]] NewtonResult solve(const PointsIn& start, const Context& context = {});

  /// The same from a curve close to a geodesic, such as one that was found to a looser tolerance: without the polyline
  /// that takes a far start there. Its ends must lie on the surface.
  [[nodiscard]] NewtonResult refine(const SpectralCurve& curve, const Context& context = {});

  class Backend;

 private:
  std::unique_ptr<Backend> backend_;
};

/// The same once: Newton's method on a spectral element curve, piecewise polynomials of degree p on
/// Gauss-Lobatto-Legendre nodes with F = 0 at the nodes, adaptive in element size and degree until `tolerance` is met.
[[nodiscard]] NewtonResult correct_newton(const Surface& surface, const PointsIn& start,
                                          const NewtonOptions& options = {}, const Context& context = {});

}  // namespace taut
