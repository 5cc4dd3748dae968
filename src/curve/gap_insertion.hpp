#pragma once

#include <vector>

#include "curve/counting_evaluator.hpp"
#include "taut/core/types.hpp"
#include "taut/curve/flow.hpp"

namespace taut::detail {

/// Puts new nodes half-way between successive ones (sec. 4 of the paper), by one of two projections:
///  1. the ordinary one (Newton-Raphson) of the midpoint p' of the gap AB. That is all it takes nearly everywhere.
///  2. Where it falls back on A or B (Figures 3 and 4: the nearest piece of surface is that next to an end, and the gap
///     would stay as wide as it is), equation (5): the projection within the plane through p' perpendicular to AB.
/// The paper has (5) for a gap that falls in one grid cell, and says that the size of the cells keeps such gaps from
/// being any wider. A wider one is bisected by (5) all the same, and counted apart: half of it is nearer to one cell,
/// and the alternative is a curve through the air.
class GapInsertion {
 public:
  GapInsertion(CountingEvaluator& evaluator, Index dim, Index codim, const FlowLattice& lattice)
      : evaluator_(evaluator), dim_(dim), codim_(codim), lattice_(lattice) {}

  /// A node into every interval i of `points` (d x (m + 1)) with `wide[i]`, if one is found. Returns how many were.
  Index insert(Points& points, const std::vector<bool>& wide);

  [[nodiscard]] Index num_projected() const { return num_projected_; }  ///< by ordinary projection
  [[nodiscard]] Index num_in_plane() const { return num_in_plane_; }    ///< by (5)
  [[nodiscard]] Index num_across_cells() const { return num_across_; }  ///< of those: A and B in different cells

 private:
  [[nodiscard]] bool in_one_cell(const VectorIn& a, const VectorIn& b) const;

  CountingEvaluator& evaluator_;
  Index dim_;
  Index codim_;
  FlowLattice lattice_;
  Index num_projected_ = 0;
  Index num_in_plane_ = 0;
  Index num_across_ = 0;
};

}  // namespace taut::detail
