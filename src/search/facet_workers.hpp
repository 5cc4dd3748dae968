#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "search/facet_search.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Clones of one FacetSearch, one for each thread that asks, which share the graph made for all points asked about.
class FacetWorkers {
 public:
  /// Keeps the references. Does no work yet.
  FacetWorkers(const Surface& surface, const PathOptions& options, const Context& context)
      : surface_(surface), options_(options), context_(context) {}

  /// Paths will be asked for between points near these (d x n).
  void expect(const PointsIn& near);

  /// As FacetSearch::find; none where the surface is none of faces. From several threads.
  [[nodiscard]] std::optional<PathResult> find(const Vector& p, const Vector& q, const SurfaceExtent& extent);

 private:
  [[nodiscard]] std::unique_ptr<FacetSearch> worker(const SurfaceExtent& extent);

  const Surface& surface_;
  const PathOptions& options_;
  const Context& context_;
  std::mutex turn_;
  std::unique_ptr<FacetSearch> first_;              // made where it is first needed
  bool ready_ = false;                              // for the points that are asked about now
  std::vector<std::unique_ptr<FacetSearch>> idle_;  // clones, of threads that are done with a pair
  Box asked_;                                       // around the points that are asked about now
};

}  // namespace taut::detail
