#pragma once

#include <vector>

#include "homotopy/strand.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// Shortens a strand on its surface without leaving its homotopy class: in steps along the gradient of the energy in
/// the metric of the stiffness matrix, each so short that no point moves by more than a segment or turns its normal by
/// more than half a radian. See docs/loops.md.
class Shortening {
 public:
  enum class Outcome {
    settled,  ///< the next step would be small
    a_point,  ///< less than half a segment is left of it: within its class it shrinks to a point
    stuck,    ///< no step shortens it, or the work allowed was used up
  };

  /// `gap`: the longest segment, model units. `most_projected`: points projected in all, the work allowed.
  Shortening(const StrandMaker& maker, Strand strand, double gap, Index most_projected = 20'000'000);

  /// Until no point would move by more than `settle` (model units).
  [[nodiscard]] Outcome run(double settle, const Context& context);
  /// Pushes the strand off a saddle: a small smooth move, the same every time.
  void disturb(int round);

  /// It is closed, or its ends are the same to rounding.
  [[nodiscard]] bool returns() const;
  [[nodiscard]] const Strand& strand() const { return strand_; }
  [[nodiscard]] int num_steps() const { return num_steps_; }
  /// True when a curve (d x m) is so close that it is of the same class: StrandMaker::is_near, two segments.
  [[nodiscard]] bool is_followed_by(const PointsIn& curve) const;

 private:
  [[nodiscard]] Points direction(double& slope) const;
  [[nodiscard]] double energy(const Points& points) const;
  [[nodiscard]] bool step(const Points& move, double most, double slope);
  [[nodiscard]] bool is_bounded(const Strand& moved) const;
  void set_weights();
  void thin_out();
  [[nodiscard]] bool is_a_point() const;

  const StrandMaker& maker_;
  Strand strand_;
  double gap_;
  double scale_;
  std::vector<double> weights_;  // parameter length of each segment
  Index last_projected_;         // of the maker's count
  int num_steps_ = 0;
};

}  // namespace taut::detail
