#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
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
  CurveResidual residual;
  int iterations = 0;
  Points points;  ///< 3 x m
};

/// A broken geodesic: arcs[i] from stops[i] to stops[i + 1].
struct FacetChain {
  std::vector<ChainStop> stops;
  std::vector<ChainArc> arcs;
  bool solved = false;
  bool locally_shortest = false;
  double length = 0;
  double error = 0;
  int rounds = 0;
  std::string why;  ///< why it is not solved

  [[nodiscard]] Points points() const;
  /// Arc i becomes `parts`, with the stops `between` them: one fewer.
  void replace_arc(std::size_t i, std::vector<ChainStop> between, std::vector<ChainArc> parts);
  /// Arcs i - 1 and i become one on this face, from the points they have; stop i goes.
  void join_arcs(std::size_t i, int face);
};

}  // namespace taut::detail
