#include "strata/arc_tracer.hpp"

#include <cmath>

#include "strata/edge_arc.hpp"
#include "strata/face_arc.hpp"

namespace taut::detail {
namespace {

/// Arcs traced for one chain, in all; chains that settle take 10 to 100.
constexpr int kMostTraced = 1000;

}  // namespace

bool ArcTracer::trace(ChainArc& arc, const Point3& a, const Point3& b) {
  if (arc.done) return arc.ok;
  if (++num_traced_ > kMostTraced) return false;
  arc.done = true;
  arc.ok = arc.face >= 0 ? trace_face_arc(surface_, arc, a, b, context_) : trace_edge_arc(surface_, arc, a, b);
  return arc.ok;
}

bool ArcTracer::trace(FacetChain& chain) {
  chain.length = 0;
  for (std::size_t i = 0; i < chain.arcs.size(); ++i) {
    if (!trace(chain.arcs[i], chain.stops[i].x, chain.stops[i + 1].x)) {
      lost_ = i;
      return false;
    }
    chain.length += chain.arcs[i].length;
  }
  return std::isfinite(chain.length);
}

}  // namespace taut::detail
