#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "march/front.hpp"
#include "march/methods.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

/// A field while it is marched: the part all methods share. A cell's distance is infinite until it is settled; before,
/// the front holds the estimate.
class GrowingField {
 public:
  /// Which neighbours of a cell a lazy set must have before they are asked for.
  enum class Growth { corners, faces };

  GrowingField(const MarchTask& task, DistanceField& field, Growth growth = Growth::corners);

  [[nodiscard]] Front& front() { return front_; }
  [[nodiscard]] const DistanceField& field() const { return field_; }
  [[nodiscard]] bool settled(Index i) const { return field_.distance(i) < kUnknown; }
  [[nodiscard]] double distance(Index i) const { return field_.distance(i); }
  /// d: to be filled when the cell is settled.
  [[nodiscard]] double* gradient(Index i) { return &field_.gradient(0, i); }
  [[nodiscard]] Index source(Index i) const { return field_.nearest_source[static_cast<std::size_t>(i)]; }

  /// An estimate of the distance at an unsettled cell; taken, and true, when it is lower than what was known.
  bool offer(Index i, double estimate, Index source) {
    if (front_.contains(i) && !(estimate < front_.key(i))) return false;
    set(i, estimate, source);
    return true;
  }
  /// The same, taken in any case.
  void set(Index i, double estimate, Index source) {
    field_.nearest_source[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(source);
    front_.set(i, estimate);
  }
  /// Takes the first cell out of the front, and grows its neighbours where the cells are lazy.
  Index pop();
  /// Fixes the distance at a cell that was taken out, and which source it is from.
  void settle(Index i, double distance, Index source);
  /// To be called last: leaves nothing unsettled in the field.
  void finish(double target_distance);

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  void grow();

  const MarchTask& task_;
  DistanceField& field_;
  Growth growth_;
  bool gradients_;  // of the convergent method
  std::size_t memory_limit_;
  Front front_;
};

}  // namespace taut::detail
