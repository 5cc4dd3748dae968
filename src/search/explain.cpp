// What people read about a path: every sentence on why there is none, or why it may not be the shortest. Programs read
// PathResult::obstacle and PathResult::doubts instead; nothing compares these words.
//
// A path that is ok has a sentence on its gravest doubt. One that is not has a sentence on its obstacle, and the doubt
// that says how far it was looked for.
#include "search/explain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface/point_text.hpp"

namespace taut::detail {
namespace {

/// Points of more coordinates are not printed.
constexpr Index kMostPrinted = 16;

bool walked(const PathResult& result) {
  return std::ranges::any_of(result.rungs, [](const RungReport& report) { return report.rung == Rung::walks; });
}

std::string near(const Vector& place) { return fmt::format("near ({:.4g})", fmt::join(place, ", ")); }

std::string cells_spent(const PathResult& result) {
  return fmt::format("as many cells of {:.3g} as may grow do not lead from one end to the other", result.cell);
}

std::string on_obstacle(const PathResult& result) {
  const Obstacle& obstacle = result.obstacle;
  switch (obstacle.kind) {
    case Obstacle::Kind::none: return std::string(result.reason);
    case Obstacle::Kind::apart: {
      const std::string apart = "the two points lie on different components of the surface";
      if (!result.doubts.has(Doubt::beyond_window)) return apart;
      return fmt::format("{} within {}, beyond which it goes on", apart, text_of(result.window));
    }
    case Obstacle::Kind::apart_by_fan:
      return "the two points lie on different components of the surface: no geodesic from the start, of those in all "
             "directions, comes to the end";
    case Obstacle::Kind::apart_by_walks:
      return fmt::format(
          "no path was found: the two points seem to lie on different components (random searches from both ends do "
          "not meet; in {} dimensions there are no cells to prove it; samples of the surface may help)",
          result.from.size());
    case Obstacle::Kind::narrow_gap:
      return fmt::format(
          "no path was found on cells down to {:.3g}{}: {} parts of the surface come within {:.2g} of each other, be "
          "it sheets that nearly touch or the two sides of a thin neck",
          result.cell, walked(result) ? ", nor by walks from both ends" : "", near(obstacle.place), obstacle.size);
    case Obstacle::Kind::singular_between:
      return fmt::format(
          "the surface is singular between the two points: {} its gradient falls to nothing; geodesics through a "
          "singular point are not supported",
          near(obstacle.place));
    case Obstacle::Kind::singular_end:
      return fmt::format(
          "the surface is singular at ({:.4g}): a gradient vanishes there, or the equations depend on each other; take "
          "a "
          "point beside it",
          fmt::join(obstacle.place, ", "));
    case Obstacle::Kind::sheets_not_told:
      return fmt::format(
          "no path was found: cells down to {:.3g} cannot tell the sheets of the surface apart, or the points lie on "
          "different components",
          result.cell);
    case Obstacle::Kind::coarse_cells:
      return fmt::format(
          "no path was found, neither on cells of {:.3g}, coarser than the surface bends, nor by walks from both "
          "ends; give a smaller box around both points, or smaller cells",
          result.cell);
    case Obstacle::Kind::corner:
      return fmt::format(
          "the surface is not smooth at ({:.4g}): its normal jumps there; take a point beside the crease or corner",
          fmt::join(obstacle.place, ", "));
    case Obstacle::Kind::crease:
      return fmt::format(
          "the surface is not smooth between the two points: {} its normal turns by {:.0f} degrees within a cell of "
          "{:.2g}; geodesics over a crease or through a singular point are not supported",
          near(obstacle.place), obstacle.size * 180 / std::numbers::pi, result.cell);
    case Obstacle::Kind::no_way:
      return fmt::format(
          "no path was found on cells down to {:.3g}{}; that there is none is not proved: a smaller box around both "
          "points may help",
          result.cell, walked(result) ? ", nor by walks from both ends" : "");
    case Obstacle::Kind::cells_spent: return "no path was found: " + cells_spent(result);
    case Obstacle::Kind::no_geodesic: {
      const Index d = obstacle.place.size();
      return std::string(result.reason) + (d > 0 && d <= kMostPrinted ? ", " + near(obstacle.place) : "");
    }
    case Obstacle::Kind::jumped:
      return fmt::format("the corrected path is longer ({:.6g}) than the one on the cells ({:.6g})", result.length,
                         obstacle.size);
    case Obstacle::Kind::loose_ends:
      return "the curve found does not lead from one end to the other; please report this";
    case Obstacle::Kind::faces: {
      const std::string lost = result.status == Status::left_domain
                                   ? "the path leaves the domain, and none was found along its border"
                                   : "the path over the edges of this surface was not found";
      if (result.reason.empty()) return lost;
      return fmt::format("{}: {}{}", lost, result.reason, obstacle.place.size() > 0 ? ", " + near(obstacle.place) : "");
    }
    case Obstacle::Kind::contracts:
      return "the loop contracts to where the surface is singular, or thinner than cells can tell";
    case Obstacle::Kind::refused: return "the request was refused";
  }
  return {};
}

/// Empty for what needs no words.
std::string on_doubt(const PathResult& result, Doubt doubt) {
  switch (doubt) {
    case Doubt::beyond_window:
      return fmt::format("a shorter path may exist: the surface goes on beyond {}", text_of(result.window));
    case Doubt::start_failed:
      if (result.obstacle.kind == Obstacle::Kind::faces) {
        return fmt::format("a shorter path may exist: a way of length {:.6g} was not settled {}", result.obstacle.size,
                           near(result.obstacle.place));
      }
      if (std::isnan(result.marched)) return "a shorter path may exist: from one of the starts no geodesic was found";
      return fmt::format(
          "a shorter path may exist: the cells know a way of length {:.6g}, but no geodesic was found along it",
          result.marched);
    case Doubt::sheets_not_told:
      return fmt::format(
          "a shorter path may exist: cells of {:.3g} cannot tell the sheets of the surface apart, this one was found "
          "by walks from both ends",
          result.cell);
    case Doubt::cells_spent: return "a shorter path may exist: found by walks, for " + cells_spent(result);
    case Doubt::coarse_cells:
    case Doubt::sharp_bends:
      return fmt::format("a shorter path may exist: cells of {:.3g} are coarser than the surface bends, and miss ways",
                         result.cell);
    case Doubt::edges_not_searched:
      return "a shorter path may exist: over the edges of this surface it was not looked for (they are too many, or "
             "another method or march than the default was asked for)";
    case Doubt::edges_failed: return "a shorter path may exist: over the edges of this surface no way was found";
    case Doubt::budget_spent: return "a shorter path may exist: it was not looked for everywhere";
    case Doubt::random_search:
    case Doubt::rivals_not_sought: return {};
  }
  return {};
}

}  // namespace

std::string_view in_words(ChainFault fault) {
  switch (fault) {
    case ChainFault::none: return {};
    case ChainFault::no_arc: return "a geodesic on one face was not found";
    case ChainFault::no_corner: return "it runs over the end of an edge where no corner was found";
    case ChainFault::turned_arc: return "an arc along an edge turns back";
    case ChainFault::no_edge: return "it leaves its face where no edge is known";
    case ChainFault::no_reflex_corner: return "it leaves its face by two edges that meet in no corner";
    case ChainFault::singular: return "it leaves its face at a singular point";
    case ChainFault::undetermined: return "the crossings of the edges are not determined";
    case ChainFault::unsettled_stops: return "the crossings of the edges do not settle";
    case ChainFault::unsettled_row: return "the row of faces along it does not settle";
    case ChainFault::contracted: return "the loop has shrunk to a point of an edge or to a corner";
    case ChainFault::bent_crossing: return "the tangents at an edge do not agree";
    case ChainFault::bent_contact: return "it does not meet an edge that it follows along it";
    case ChainFault::corner_with_room: return "it passes a corner that it could go round";
    case ChainFault::not_pressed: return "it is not pressed against an edge that it follows";
  }
  return {};
}

std::string explain(const PathResult& result) {
  if (result.status != Status::ok) {
    const bool past_cells =
        result.doubts.has(Doubt::cells_spent) && result.obstacle.kind != Obstacle::Kind::cells_spent;
    return on_obstacle(result) + (past_cells ? fmt::format(" (found by walks: {})", cells_spent(result)) : "");
  }
  std::string gravest;
  result.doubts.for_each([&](Doubt doubt) {
    if (gravest.empty()) gravest = on_doubt(result, doubt);
  });
  return gravest;
}

}  // namespace taut::detail
