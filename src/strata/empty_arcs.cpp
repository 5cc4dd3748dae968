#include "strata/empty_arcs.hpp"

namespace taut::detail {

bool drop_empty_arcs(FacetChain& chain, double together) {
  using Kind = ChainStop::Kind;
  bool changed = false;
  for (std::size_t i = 0; i < chain.arcs.size() && chain.arcs.size() > 1;) {
    if (chain.arcs[i].length > together) {
      ++i;
      continue;
    }
    changed = true;
    ChainStop& a = chain.stops[i];
    ChainStop& b = chain.stops[i + 1];
    if (a.kind == Kind::end) {
      chain.stops.erase(chain.stops.begin() + 1);
      chain.arcs.erase(chain.arcs.begin());
      chain.arcs.front().done = false;
      continue;
    }
    if (b.kind == Kind::end) {
      chain.stops.erase(chain.stops.end() - 2);
      chain.arcs.pop_back();
      chain.arcs.back().done = false;
      continue;
    }
    // Of two stops the corner stays; two crossings of one edge are none; of different edges, they are a corner.
    const int before = chain.arcs[i - 1].face;
    const int after = chain.arcs[i + 1].face;
    if (a.kind != Kind::corner && b.kind != Kind::corner && a.edge == b.edge && before == after && before >= 0) {
      chain.stops.erase(chain.stops.begin() + static_cast<std::ptrdiff_t>(i));
      chain.arcs.erase(chain.arcs.begin() + static_cast<std::ptrdiff_t>(i));
      chain.join_arcs(i, before);
      continue;
    }
    if (a.kind != Kind::corner) {
      if (b.kind != Kind::corner && a.edge != b.edge) b.kind = Kind::corner;
      chain.stops.erase(chain.stops.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      chain.stops.erase(chain.stops.begin() + static_cast<std::ptrdiff_t>(i + 1));
    }
    chain.arcs.erase(chain.arcs.begin() + static_cast<std::ptrdiff_t>(i));
    for (ChainArc& arc : chain.arcs) arc.done = false;
  }
  return changed;
}

}  // namespace taut::detail
