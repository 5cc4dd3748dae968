#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "strata/faceted_surface.hpp"
#include "taut/curve/geodesic.hpp"

namespace taut::detail {

/// Where two arcs of a broken geodesic meet.
struct ChainStop {
  enum class Kind : std::uint8_t {
    end,
    crossing,  ///< of an edge
    contact,   ///< with an edge that is followed on one side of it
    corner,
  };
  Kind kind = Kind::end;
  Point3 x = Point3::Zero();
  int edge = -1;
  double left = 0;   ///< at a corner: angle of the surface on the left of the path, radians; infinite beyond a border
  double right = 0;  ///< and on the right
};

/// Why a chain could not be made a broken geodesic.
enum class ChainFault : std::uint8_t {
  none,
  no_arc,            ///< a geodesic on one face was not found
  no_corner,         ///< a stop runs over the end of its edge, where no corner was found
  turned_arc,        ///< an arc along an edge turns back
  no_edge,           ///< an arc leaves its face where no edge is known
  no_reflex_corner,  ///< an arc leaves its face by two edges that meet in no corner
  singular,          ///< an arc leaves its face at a singular point
  undetermined,      ///< the crossings of the edges are not determined
  unsettled_stops,   ///< the crossings of the edges do not settle
  unsettled_row,     ///< the row of faces does not settle
  contracted,        ///< a loop has shrunk to nothing in a corner, or beside one
  bent_crossing,     ///< settled, but the tangents at an edge do not agree
  bent_contact,      ///< settled, but it does not meet an edge that it follows along it
  corner_with_room,  ///< settled, but it passes a corner that it could go round
  not_pressed,       ///< settled, but it is not pressed against an edge that it follows
};

/// A fault and where it is.
struct ChainTrouble {
  ChainFault fault = ChainFault::none;
  Point3 place = Point3::Zero();
};

/// A geodesic arc on a face, or an arc of an edge.
struct ChainArc {
  int face = -1;  ///< -1: along `edge`
  int edge = -1;
  Points start;  ///< 3 x m: a curve to begin from, or points of the edge
  /// The way over the graph that it comes from, and the edges its points lie on: which side it goes round.
  std::vector<Point3> guide;
  std::vector<int> guide_edges;
  bool done = false;
  bool ok = false;
  double length = 0;
  double error = 0;
  Point3 first = Point3::Zero();  ///< unit tangents at its ends
  Point3 last = Point3::Zero();
  /// Jacobi fields along it: reduced length, M12 and the slope of the reduced length at the end.
  double m12 = 1;
  double m = 1;
  double slope = 1;
  bool shortest = true;
  int index = 0;  ///< conjugate points inside
  CurveResidual residual;
  int iterations = 0;
  Points points;  ///< 3 x m
  Points line;    ///< 3 x n: on the face, at equal parts of the arc; empty of a straight one
};

/// A broken geodesic: arcs[i] from stops[i] to stops[i + 1].
struct FacetChain {
  std::vector<ChainStop> stops;
  std::vector<ChainArc> arcs;
  bool closed = false;      ///< the last stop is the first one again: a crossing, a contact or a corner
  bool stationary = false;  ///< look for the geodesic next to it, be its length a minimum or not
  bool solved = false;
  bool locally_shortest = false;
  /// Directions in which the length falls: those of the crossings along their edges, and the conjugate points of arcs.
  /// Where the path follows an edge or passes a corner it is held to first order.
  int index = 0;
  int neutral = 0;  ///< directions in which it changes by less than can be told; of crossings alone
  double length = 0;
  double error = 0;
  int rounds = 0;
  ChainTrouble trouble;  ///< why it is not solved

  /// The arc that comes to stop i; of a closed chain's first stop the last one.
  [[nodiscard]] const ChainArc& before(std::size_t i) const { return i > 0 ? arcs[i - 1] : arcs.back(); }
  [[nodiscard]] ChainArc& before(std::size_t i) { return i > 0 ? arcs[i - 1] : arcs.back(); }
  /// The first stop that is not an end, and one past the last, each counted once.
  [[nodiscard]] std::size_t first_inner() const { return closed ? 0 : 1; }
  [[nodiscard]] std::size_t end_inner() const { return stops.size() - 1; }
  [[nodiscard]] Points points() const;
  /// Arc i becomes `parts`, with the stops `between` them: one fewer.
  void replace_arc(std::size_t i, std::vector<ChainStop> between, std::vector<ChainArc> parts);
  /// Arcs i - 1 and i become one on this face, from the points they have; stop i goes.
  void join_arcs(std::size_t i, int face);
};

}  // namespace taut::detail
