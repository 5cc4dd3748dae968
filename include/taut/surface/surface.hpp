#pragma once

#include <memory>
#include <optional>
#include <string_view>

#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut {

/// What a surface knows besides its equation.
struct SurfaceExtras {
  /// The surface is cut to where every component of this function is >= 0 (R^d -> R^m, any m). Null = nowhere cut.
  std::shared_ptr<const ImplicitFunction> domain;
  /// Where to look for it. Unset = found automatically.
  std::optional<Box> box;
  /// Points on or near it, such as those it was fitted to: seeds for growing cells, where paths start from in many
  /// dimensions, and what `@17` means on the command line.
  std::shared_ptr<const PointCloud> samples;
};

/// The zero set { x : F(x) = 0, domain(x) >= 0 } in R^d. A value: cheap to copy, immutable, safe to share between
/// threads.
class Surface {
 public:
  /// Throws InvalidArgument when `function` is null, d < 2, k is not in 1..d-1, the extras' dimensions
  /// differ, or the box is turned inside out.
  explicit Surface(std::shared_ptr<const ImplicitFunction> function, SurfaceExtras extras = {});

  [[nodiscard]] Index dim() const { return function_->dim(); }
  [[nodiscard]] Index codim() const { return function_->codim(); }
  [[nodiscard]] std::string_view kind() const { return function_->kind(); }

  [[nodiscard]] const ImplicitFunction& function() const { return *function_; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const { return function_->make_evaluator(); }

  /// Null when the surface is not cut.
  [[nodiscard]] const ImplicitFunction* domain() const { return extras_.domain.get(); }
  [[nodiscard]] const std::optional<Box>& box() const { return extras_.box; }
  /// Null when there are none.
  [[nodiscard]] const PointCloud* samples() const { return extras_.samples.get(); }

  /// The same surface, looked for in `box`.
  [[nodiscard]] Surface with_box(Box box) const;
  /// The same surface with points on or near it, where the search for a path may start.
  [[nodiscard]] Surface with_samples(std::shared_ptr<const PointCloud> samples) const;

  // One-shot evaluation, for tests and small jobs; kernels use an Evaluator.
  [[nodiscard]] Points value(const PointsIn& x) const;     ///< k x n
  [[nodiscard]] Points jacobian(const PointsIn& x) const;  ///< (d k) x n, laid out as in PointBatch
  /// d x d: sum_i weight_i Hess F_i at one point.
  [[nodiscard]] Eigen::MatrixXd hessian(const VectorIn& x, const VectorIn& weight) const;
  /// True where x (a column each) is inside the domain, with `slack` in model units: domain(x) >= -slack |grad domain|.
  [[nodiscard]] Eigen::Array<bool, Eigen::Dynamic, 1> inside_domain(const PointsIn& x, double slack = 0) const;

 private:
  std::shared_ptr<const ImplicitFunction> function_;
  SurfaceExtras extras_;
};

}  // namespace taut
