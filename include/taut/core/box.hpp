#pragma once

#include "taut/core/types.hpp"

namespace taut {

/// A closed axis-aligned box in R^d.
struct Box {
  Vector lower;  ///< d
  Vector upper;  ///< d, nowhere below `lower`

  [[nodiscard]] Index dim() const { return lower.size(); }
  [[nodiscard]] Vector extent() const { return upper - lower; }
  /// Length of the diagonal: the size a relative tolerance is measured against.
  [[nodiscard]] double diagonal() const { return extent().norm(); }
  [[nodiscard]] bool contains(const VectorIn& x) const {
    return (x.array() >= lower.array()).all() && (x.array() <= upper.array()).all();
  }
};

/// What two boxes that meet have in common.
[[nodiscard]] inline Box intersection(const Box& a, const Box& b) {
  return {a.lower.cwiseMax(b.lower), a.upper.cwiseMin(b.upper)};
}

}  // namespace taut
