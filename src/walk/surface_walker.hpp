#pragma once

#include <memory>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A point of the surface with an orthonormal basis of its normal space (d k entries, a vector after the other).
struct Foothold {
  Vector point;
  Vector normals;
};

/// Goes over a surface in small steps without cells, for dimensions where there would be too many: along the tangent
/// space towards a target, each step projected back onto the surface. Keeps the evaluator. Not for sharing.
class SurfaceWalker {
 public:
  /// `step`: longest step, model units.
  SurfaceWalker(const Surface& surface, double step);

  [[nodiscard]] double step() const { return step_; }
  [[nodiscard]] Index num_steps() const { return num_steps_; }  ///< taken so far, refused ones included

  /// x (d) brought onto the surface; false where it does not get there within `reach`.
  bool stand(const Vector& x, double reach, Foothold& result);

  /// Takes at most `most` steps from `from` towards `target` (d, on the surface or not) while they bring it nearer;
  /// appends where they lead. True when `target` is on the surface and was reached: the last foothold is then close to
  /// it and sees it along its tangent space, not across a gap to another sheet.
  bool walk(const Foothold& from, const Vector& target, Index most, std::vector<Foothold>& steps);

  /// All of the way from p to q, both on the surface: d x m from p to q, or d x 0 where the walk gets stuck (q straight
  /// behind the surface, a singular point).
  [[nodiscard]] Points walk(const Vector& p, const Vector& q);

 private:
  [[nodiscard]] bool turns(const Foothold& a, const Foothold& b) const;
  [[nodiscard]] Vector tangent_part(const Foothold& at, Vector r) const;

  Index d_;
  Index k_;
  double step_;
  std::unique_ptr<Evaluator> evaluator_;
  Index num_steps_ = 0;
};

}  // namespace taut::detail
