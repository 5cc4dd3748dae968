// Paths along borders in any dimension, from starts whose geodesics leave the domain.
#include "search/contact_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/stopwatch.hpp"
#include "search/candidates.hpp"
#include "search/explain.hpp"
#include "strata/bordered_surface.hpp"
#include "strata/contact_chain.hpp"

namespace taut::detail {
namespace {

/// Lengths are sums of arcs, each good to rounding.
constexpr double kRounding = 4e-16;

/// Of arcs, relative: their directions, which contacts are found by, are good to about its root.
constexpr double kArcTolerance = 1e-11;

/// As a result between these ends.
PathResult result_of(const ContactChain& chain, PathResult result) {
  result.status = Status::ok;
  result.length = chain.length;
  result.length_error = chain.error + kRounding * chain.length;
  result.index = chain.index;
  result.locally_shortest = chain.locally_shortest;
  result.num_iterations = chain.steps;
  Index count = 1;
  for (const ContactArc& arc : chain.arcs) count += arc.geodesic.points.cols() - 1;
  result.points.resize(result.from.size(), count);
  Index at = 0;
  for (const ContactArc& arc : chain.arcs) {
    const NewtonResult& geodesic = arc.geodesic;
    const Points& x = geodesic.points;
    result.points.middleCols(at, x.cols()) = x;
    at += x.cols() - 1;
    result.residual.surface = std::max(result.residual.surface, geodesic.residual.surface);
    result.residual.geodesic_curvature =
        std::max(result.residual.geodesic_curvature, geodesic.residual.geodesic_curvature);
    result.num_iterations += geodesic.num_iterations;
    PathPiece piece;
    piece.kind = arc.border == BorderedSurface::kFree ? PathPiece::Kind::face : PathPiece::Kind::border;
    piece.length = geodesic.length;
    piece.point = x.col(0);
    result.pieces.push_back(std::move(piece));
  }
  if (chain.arcs.size() == 1 && chain.arcs.front().border == BorderedSurface::kFree) result.pieces.clear();
  result.points.col(0) = result.from;
  result.points.rightCols<1>() = result.to;
  result.start_direction = chain.arcs.front().geodesic.start_direction;
  result.end_direction = chain.arcs.back().geodesic.end_direction;
  return result;
}

}  // namespace

bool has_contacts(const Surface& surface, const PathOptions& options) {
  const bool in_space = surface.dim() == 3 && surface.codim() == 1;
  return surface.domain() != nullptr && surface.samples() == nullptr && !in_space &&
         surface.dim() - surface.codim() >= 2 && options.method == CorrectionMethod::newton;
}

PathResult search_contacts(const Surface& surface, const PathOptions& options, const std::vector<StartPath>& starts,
                           const Vector& p, const Vector& q, const Context& context) {
  const Stopwatch watch;
  BorderedSurface bordered(surface, std::min(kArcTolerance, options.tolerance));
  PathResult best;
  best.from = p;
  best.to = q;
  best.status = Status::left_domain;
  const PathResult blank = best;
  std::vector<PathCandidate> candidates;
  double shortest = std::numeric_limits<double>::infinity();
  Obstacle lost;
  for (const StartPath& start : starts) {
    if (!options.all && start.length > shortest) continue;
    const ContactChain chain = shorten_inside(bordered, start.points, context);
    if (!chain.solved) {
      if (lost.kind != Obstacle::Kind::none) continue;
      lost = {Obstacle::Kind::faces, chain.place, start.length};
      best.reason = in_words(chain.fault);
      continue;
    }
    PathResult result = result_of(chain, blank);
    result.grid_path = start.points;
    result.marched = start.length;
    add_candidate(candidates, candidate_of(result));
    if (!(result.length < shortest)) continue;
    shortest = result.length;
    result.reason = best.reason;
    best = std::move(result);
  }
  best.obstacle = lost;
  if (best.status == Status::ok && lost.kind != Obstacle::Kind::none) best.doubts.add(Doubt::start_failed);
  best.doubts.add(Doubt::rivals_not_sought);
  best.candidates = std::move(candidates);
  best.tied = !first_is_unique(best.candidates, options.tolerance);
  best.seconds.correct = watch.seconds();
  return best;
}

}  // namespace taut::detail
