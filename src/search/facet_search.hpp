#pragma once

#include <memory>
#include <vector>

#include "strata/facet_chain.hpp"
#include "strata/facet_graph.hpp"
#include "strata/facet_ways.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// Finds shortest paths on a surface made of faces: with edges and corners, or a border. One thread's; others work with
/// clones, and which of them answers changes nothing.
class FacetSearch {
 public:
  /// Keeps the references.
  FacetSearch(const Surface& surface, const PathOptions& options, const Context& context);
  /// Is the surface one: else the rest is not to be called.
  [[nodiscard]] bool is_ready() const { return surface_ != nullptr; }
  /// Has its formula kinks, so that paths may have to cross edges.
  [[nodiscard]] bool has_kinks() const { return is_ready() && surface_->num_kinks() > 0; }

  /// Makes the graph that paths between points in this box share, unless it is there already: of all the surface,
  /// which lies in `extent`, or, where it goes on, around the box. True when it made one: clones are old then. Throws
  /// OutOfMemory, Cancelled.
  bool prepare(const SurfaceExtent& extent, const Box& points);
  /// For another thread: shares the graph.
  [[nodiscard]] std::unique_ptr<FacetSearch> clone() const;

  /// The shortest path from p to q, points of the surface. Where it is not found out, `status` is not_converged, and
  /// the obstacle says why: none where no way was found at all. With the doubt start_failed the obstacle is that of the
  /// way that was not settled.
  [[nodiscard]] PathResult find(const Vector& p, const Vector& q, const SurfaceExtent& extent);

 private:
  FacetSearch(const PathOptions& options, const Context& context) : options_(options), context_(context) {}
  struct Found {
    FacetChain chain;
    FacetWay way;
  };
  /// Null where no surface is found in the box.
  [[nodiscard]] std::shared_ptr<const FacetGraph> graph(const Box& box, double cells);
  [[nodiscard]] PathResult search(const Vector& p, const Vector& q, const SurfaceExtent& extent);
  /// Corrects the ways over the graph. True when some are solved.
  [[nodiscard]] bool correct(const FacetGraph& graph, const Point3& p, const Point3& q, PathResult& result,
                             std::vector<Found>& found, double& shortest_way);
  void deliver(const std::vector<Found>& found, PathResult& result) const;

  const PathOptions& options_;
  const Context& context_;
  std::unique_ptr<FacetedSurface> surface_;
  std::shared_ptr<const FacetGraph> shared_;
  FacetedSurface::Known known_;  // with the shared graph
};

}  // namespace taut::detail
