#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "march/start_paths.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Marched distances from landmarks, cells spread evenly over the surface, to all cells: made once, it gives the starts
/// between any two points in microseconds, where two fields take milliseconds. Safe to share between threads.
class DistanceTable {
 public:
  /// Marches from about `num_landmarks` >= 1 cells, in parallel. Cells are taken over; they must be complete.
  /// Takes O(landmarks * cells) time and 4 (d + 1) bytes of memory for each of these pairs. Throws InvalidArgument for
  /// lazy cells, OutOfMemory, Cancelled.
  DistanceTable(const Surface& surface, SurfaceCells cells, Index num_landmarks, const Context& context = {});

  [[nodiscard]] Index num_landmarks() const { return static_cast<Index>(landmarks_.size()); }
  [[nodiscard]] const SurfaceCells& cells() const { return cells_; }
  /// The surface point of a landmark.
  [[nodiscard]] Vector landmark(Index l) const { return cells_.point(landmarks_[static_cast<std::size_t>(l)]); }
  /// Distance between neighbouring landmarks, about, model units.
  [[nodiscard]] double spacing() const { return spacing_; }
  [[nodiscard]] std::size_t bytes() const;

  /// The length of the shortest way past a landmark, model units: no less than the distance of p and q, up to the
  /// table's error, and up to a few spacings more where they are close. Infinity where it knows of none.
  [[nodiscard]] double upper_bound(const VectorIn& p, const VectorIn& q) const;
  /// As the function start_paths on fields from p and q: one start for each way that may be the shortest, if marched
  /// distances are wrong by no more than `options.excess`. Every way passes landmarks at most half a spacing off; what
  /// such a detour may cost decides which of them are looked at (`options.spread` plays no part). Lengths are those of
  /// the ways past a landmark, by the table. Empty where the table cannot tell: the ends are within a few spacings of
  /// each other, or one of them is in no cell, or no way leads from one to the other.
  [[nodiscard]] std::vector<StartPath> start_paths(const VectorIn& p, const VectorIn& q,
                                                   const StartPathOptions& options = {}) const;

 private:
  struct View;                     // the landmarks as seen from a point
  using Way = std::vector<Index>;  // cells, from one end to the other

  void choose_landmarks(Index count);
  void link_cells();
  void fill(const Surface& surface, const Context& context);
  [[nodiscard]] Index nearest_cell(const VectorIn& x) const;
  [[nodiscard]] View look(const VectorIn& x) const;
  [[nodiscard]] bool take_shortcuts(View& from, View& to) const;
  void walk(Index cell, std::size_t landmark, Way& way) const;
  [[nodiscard]] float least_sum(const View& from, const View& to) const;
  [[nodiscard]] Way way_to(std::size_t landmark, const View& from) const;
  [[nodiscard]] Way way_past(const View& from, const View& to, std::size_t landmark) const;
  [[nodiscard]] double distance_to(const std::vector<Way>& ways, Index i) const;
  [[nodiscard]] double straying(const Way& way, const std::vector<Way>& known) const;
  [[nodiscard]] const float* row(Index cell) const {
    return table_.data() +
           static_cast<std::size_t>(cell) * landmarks_.size() * static_cast<std::size_t>(cells_.dim() + 1);
  }

  SurfaceCells cells_;
  double spacing_ = 0;
  std::vector<Index> landmarks_;  // their cells
  // A row a cell: distance to every landmark, in cells' sizes, then its gradient, axis by axis.
  std::vector<float> table_;
  std::vector<float> between_;             // the distance of each landmark from each, model units
  std::vector<std::uint32_t> first_link_;  // num_cells + 1
  std::vector<std::uint32_t> links_;       // cells on the same sheet around each
};

}  // namespace taut::detail
