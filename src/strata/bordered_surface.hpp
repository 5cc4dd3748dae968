#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/curve/newton.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A smooth surface in any dimension that is cut by a domain, and its borders: one a component g_i of the domain, the
/// surface {F = 0, g_i = 0}. One thread's.
class BorderedSurface {
 public:
  /// Of a surface with a domain. `tolerance`: of the lengths of arcs, relative.
  BorderedSurface(const Surface& surface, double tolerance);

  /// Stands for the surface itself where a border is asked for.
  static constexpr int kFree = -1;

  [[nodiscard]] Index dim() const { return dim_; }
  [[nodiscard]] Index num_borders() const { return static_cast<Index>(sheets_.size()) - 1; }
  /// How many equations that border (or the surface) has.
  [[nodiscard]] Index codim(int border) const { return sheet(border).surface.codim(); }
  /// Makes geodesics of that border (or of the surface).
  [[nodiscard]] NewtonSolver& solver(int border);
  /// Moves points (d x n) onto that border (or the surface); false where that fails, and the point stays. `normals`, if
  /// any: an orthonormal basis of the normal space, as of project_to_surface.
  Eigen::Array<bool, Eigen::Dynamic, 1> project(int border, Points& x, Eigen::MatrixXd* normals = nullptr);
  /// How far points of the surface (d x n) are from every border, to first order, model units: num_borders() x n,
  /// negative outside.
  [[nodiscard]] Points room(const Points& x);
  /// The points of a curve on the surface with more where it may cross a border: looks_at_border.
  [[nodiscard]] Points looked_at(const Points& curve);
  /// The curvature within the surface of a curve that runs along the border with these unit tangents (both d x n), 1 /
  /// model units: positive where it bends to the inside, so that a taut curve would leave the border.
  [[nodiscard]] Vector pull(int border, const Points& x, const Points& tangents);

 private:
  struct Sheet {
    Surface surface;
    std::unique_ptr<Evaluator> evaluator;
    std::optional<NewtonSolver> solver;
  };
  [[nodiscard]] const Sheet& sheet(int border) const { return sheets_[static_cast<std::size_t>(border + 1)]; }
  [[nodiscard]] Sheet& sheet(int border) { return sheets_[static_cast<std::size_t>(border + 1)]; }

  Surface surface_;
  Index dim_;
  double tolerance_;
  std::vector<Sheet> sheets_;  // the surface, then its borders
  std::unique_ptr<Evaluator> domain_;
};

}  // namespace taut::detail
