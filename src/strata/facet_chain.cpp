#include "strata/facet_chain.hpp"

#include <iterator>
#include <utility>

#include "curve/polyline.hpp"

namespace taut::detail {

Points FacetChain::points() const {
  std::vector<Point3> all;
  for (const ChainArc& arc : arcs) {
    for (Index j = 0; j < arc.points.cols(); ++j) {
      const Point3 x = arc.points.col(j);
      if (all.empty() || all.back() != x) all.push_back(x);
    }
  }
  Points result(3, static_cast<Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) result.col(static_cast<Index>(i)) = all[i];
  return result;
}

void FacetChain::replace_arc(std::size_t i, std::vector<ChainStop> between, std::vector<ChainArc> parts) {
  const auto at = static_cast<std::ptrdiff_t>(i);
  stops.insert(stops.begin() + at + 1, std::make_move_iterator(between.begin()),
               std::make_move_iterator(between.end()));
  arcs.erase(arcs.begin() + at);
  arcs.insert(arcs.begin() + at, std::make_move_iterator(parts.begin()), std::make_move_iterator(parts.end()));
}

void FacetChain::join_arcs(std::size_t i, int face) {
  ChainArc joined;
  joined.face = face;
  const Points& a = arcs[i - 1].points;
  const Points& b = arcs[i].points;
  joined.start.resize(3, a.cols() + b.cols() - 1);
  joined.start << a, b.rightCols(b.cols() - 1);
  if (joined.start.cols() > 2) joined.start = without_repeats(joined.start);
  stops.erase(stops.begin() + static_cast<std::ptrdiff_t>(i));
  arcs.erase(arcs.begin() + static_cast<std::ptrdiff_t>(i));
  arcs[i - 1] = std::move(joined);
}

}  // namespace taut::detail
