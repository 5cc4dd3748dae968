// Closed chains begin and end in one stop, the seam, which is a crossing where there is one: Newton's method moves it
// with the others, while changes of the row of arcs happen between the ends of the list.
#include "strata/closed_chain.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "strata/way_chain.hpp"

namespace taut::detail {

void begin_at(FacetChain& chain, std::size_t at) {
  if (at == 0) return;
  chain.stops.pop_back();
  std::rotate(chain.stops.begin(), chain.stops.begin() + static_cast<std::ptrdiff_t>(at), chain.stops.end());
  std::rotate(chain.arcs.begin(), chain.arcs.begin() + static_cast<std::ptrdiff_t>(at), chain.arcs.end());
  chain.stops.push_back(chain.stops.front());
}

std::optional<FacetChain> closed_chain_of(FacetedSurface& surface, const FacetWay& way) {
  FacetChain chain = chain_of(surface, way);
  if (chain.arcs.size() < 2) return std::nullopt;
  // The way's ends: a stop only where the faces differ.
  ChainStop& first = chain.stops.front();
  const bool joins = chain.arcs.front().face == chain.arcs.back().face;
  if (!joins) {
    first.kind = way.corner.front() || way.edge.front() < 0 ? ChainStop::Kind::corner : ChainStop::Kind::crossing;
    first.edge = way.edge.front();
  }
  chain.stops.back() = first;
  chain.closed = true;
  begin_at(chain, 1);
  if (joins) {
    const std::size_t at = chain.stops.size() - 2;
    for (const std::size_t i : {at - 1, at}) chain.arcs[i].points = chain.arcs[i].start;
    if (at > 0) chain.join_arcs(at, chain.arcs[at].face);
  }
  return chain;
}

}  // namespace taut::detail
