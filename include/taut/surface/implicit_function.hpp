#pragma once

#include <memory>
#include <string_view>

#include "taut/core/types.hpp"

namespace taut {

/// A batch of n points and what is wanted at them. Null outputs are not computed. All arrays are dense and
/// column-major, a point contiguous; the caller owns them.
struct PointBatch {
  Index n = 0;
  const double* x = nullptr;       ///< d x n
  double* value = nullptr;         ///< k x n: F(x)
  double* jacobian = nullptr;      ///< d x k x n: grad F_i at point j is the d entries at (j k + i) d
  const double* weight = nullptr;  ///< k x n: required with `hessian`
  double* hessian = nullptr;       ///< d x d x n, symmetric, both triangles: sum_i weight_i Hess F_i at point j
};

/// A batch of n boxes and bounds over them: of F, or of its slopes.
struct BoxBatch {
  Index n = 0;
  const double* lower = nullptr;     ///< d x n
  const double* upper = nullptr;     ///< d x n
  double* value_lower = nullptr;     ///< k x n: for `bounds`
  double* value_upper = nullptr;     ///< k x n
  double* jacobian_lower = nullptr;  ///< d x k x n, laid out as in PointBatch: for `jacobian_bounds`
  double* jacobian_upper = nullptr;  ///< d x k x n
};

/// Evaluates one function; owns the scratch memory for it, so each thread makes its own.
/// Identities every evaluator keeps, checked by `taut/surface/conformance.hpp`:
///  (1) a batch gives bit for bit what its points give one by one, whatever else is asked for in the same visit;
///  (2) `jacobian` and `hessian` are the derivatives of `value`;
///  (3) where `bounds` returns true, F(x) lies in [value_lower, value_upper] for every x of the box, as evaluated;
///  (4) a NaN coordinate gives NaN; nothing is thrown for a finite or non-finite point.
class Evaluator {
 public:
  virtual ~Evaluator() = default;

  virtual void evaluate(const PointBatch& batch) = 0;

  /// (sum_i weight_i Hess F_i) v at each point, without the d x d matrix where the function knows how. The default
  /// forms it. `v`, `out`: d x n. Uses batch.x, batch.weight and batch.n only.
  virtual void hessian_times(const PointBatch& batch, const double* v, double* out);

  /// Outward-rounded bounds of F over boxes. Returns false (and writes nothing) when the function has none. Both bounds
  /// of F_i are NaN where F_i is NaN all over the box: no zero can lie there.
  virtual bool bounds(const BoxBatch& batch);

  /// Outward-rounded bounds of the Jacobian over boxes, both sides of a kink included. Where those of F_i are finite,
  /// the mean value theorem holds: for points x and c of the box at which F_i has values, F_i(x) - F_i(c) lies in sum_a
  /// [jacobian_lower_ia, jacobian_upper_ia] (x_a - c_a), whatever lies between them. So some are infinite or NaN where
  /// F_i has a pole or a jump. Returns false (and writes nothing) when the function knows none, or when `bounds` are
  /// already the range of F up to rounding, so that derivatives cannot tighten them.
  virtual bool jacobian_bounds(const BoxBatch& batch);

 protected:
  Evaluator(Index dim, Index codim) : dim_(dim), codim_(codim) {}
  Evaluator(const Evaluator&) = default;
  Evaluator& operator=(const Evaluator&) = default;

  Index dim_;
  Index codim_;
};

/// A function F: R^d -> R^k, immutable and shared between threads. This is what to implement for your own surface: see
/// `examples/user_surface.cpp`. F must be C^1; Newton's method and the error estimates want C^2.
class ImplicitFunction {
 public:
  virtual ~ImplicitFunction() = default;
  [[nodiscard]] virtual Index dim() const = 0;    ///< d >= 2
  [[nodiscard]] virtual Index codim() const = 0;  ///< 1 <= k < d
  [[nodiscard]] virtual std::unique_ptr<Evaluator> make_evaluator() const = 0;
  /// One word for reports: "formula", "rbf", "callback".
  [[nodiscard]] virtual std::string_view kind() const { return "callback"; }
};

}  // namespace taut
