#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "strata/facet_step.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Points of every face, edge and corner in the cells of a box, joined to their neighbours on the same face. Shortest
/// ways over it are some per cent too long, and tell which faces a shortest path may cross. Immutable.
class FacetGraph {
 public:
  /// Nodes so many cells apart are joined.
  static constexpr double kReach = 2.3;

  /// Cells of at most `size` (model units) of `box`. Throws EmptySurface, OutOfMemory, Cancelled.
  FacetGraph(FacetedSurface& surface, const Box& box, double size, const Context& context);

  [[nodiscard]] const Box& box() const { return box_; }
  [[nodiscard]] double size() const { return size_; }
  [[nodiscard]] Index num_cells() const { return num_cells_; }
  /// False where there are so many faces and edges in each cell that they are not looked for in all of them: then the
  /// graph has no links.
  [[nodiscard]] bool complete() const { return complete_; }
  [[nodiscard]] const std::vector<FacetNode>& nodes() const { return nodes_; }
  [[nodiscard]] std::span<const FacetLink> links(std::uint32_t node) const {
    return {links_.data() + first_[node], links_.data() + first_[node + 1]};
  }
  /// Corners that reach into a face.
  [[nodiscard]] const std::vector<std::uint32_t>& reflex_corners() const { return reflex_; }

  /// The steps from a point that is no node, to nodes within `reach`.
  [[nodiscard]] std::vector<FacetLink> links_of(FacetedSurface& surface, const FacetNode& point, double reach) const;

 private:
  /// Nodes by cubes of side kReach cells.
  struct Bins {
    std::unordered_map<std::uint64_t, std::uint32_t> index;
    std::vector<std::uint64_t> keys;
    std::vector<std::vector<std::uint32_t>> nodes;
    [[nodiscard]] const std::vector<std::uint32_t>* at(std::uint64_t key) const;
  };
  [[nodiscard]] std::uint64_t bin_of(const Point3& x) const;
  void add(double scale, FacetNode node);
  /// A point of the face with these conditions zero near the cell's centre that `is_right` accepts.
  template <class IsRight>
  [[nodiscard]] bool find_point(FacetedSurface& surface, const Box& cell, int face, const std::vector<int>& conditions,
                                bool try_corners, const IsRight& is_right, Point3& x);
  void fill_cell(FacetedSurface& surface, const Box& cell, const std::vector<int>& kinks);
  void link(FacetedSurface& surface);

  Box box_;
  double size_;
  Index num_cells_ = 0;
  Index num_projected_ = 0;  // points tried on faces and edges
  bool complete_ = true;
  std::vector<FacetNode> nodes_;
  std::vector<std::uint32_t> reflex_;
  std::vector<std::size_t> first_;  // of a node's links; one more than nodes
  std::vector<FacetLink> links_;
  Bins bins_;
};

/// The size at which a box has about `cells` cells that the surface crosses. Throws EmptySurface, OutOfMemory,
/// Cancelled.
[[nodiscard]] double cell_size_for(const FacetedSurface& surface, const Box& box, double cells, const Context& context);

}  // namespace taut::detail
