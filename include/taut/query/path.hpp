#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/curve/flow.hpp"
#include "taut/curve/geodesic.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// What shortens the marched polyline.
enum class CorrectionMethod {
  newton,  ///< Newton's method on a spectral curve: machine precision
  flow,    ///< the paper's curvature flow: second order in the node spacing
  grid,    ///< nothing: the marched path as it is on the cells (see `descend`), the paper's before its correction
};

/// How the cells around the surface are found.
enum class GridMethod {
  automatic,  ///< grow for surfaces fitted to samples, subdivide for the others
  subdivide,  ///< Algorithm I: every cell the surface crosses
  grow,       ///< Algorithm II: from the samples or, on a surface without, from the two ends and PathOptions::seeds
};

/// PathOptions::envelope: as many layers as the error bound wants (`envelope_layers`).
inline constexpr Index kEnvelopeByLaw = -1;

struct PathOptions {
  CorrectionMethod method = CorrectionMethod::newton;
  MarchMethod march = MarchMethod::convergent;
  GridMethod grid = GridMethod::automatic;
  /// Grid cell size h, model units. 0 = chosen, and halved by itself where the cells cannot tell two sheets apart.
  double cell = 0;
  /// d x n: points on or near a surface without samples from which Algorithm II grows, too (grid = grow).
  Points seeds = {};
  /// Layers of cells added on either side of those that the surface crosses (`thicken`), for the marches between cell
  /// centres: axis and dijkstra. 0 = the bare cells; kEnvelopeByLaw.
  Index envelope = 0;
  /// Relative length tolerance, 1e-13 .. 1e-3.
  double tolerance = 1e-9;
  /// eps_E, the node spacing of the flow, model units; 0 = chosen.
  double spacing = 0;
  /// beta of the flow's equation (4), at most 4 with explicit steps.
  double beta = 1;
  FlowTimeStep flow_step = FlowTimeStep::linearly_implicit;
  NodeSpread flow_nodes = NodeSpread::even;
  /// Look for every way round, however long, not only for rivals of the shortest.
  bool all = false;
  /// Fill PathResult::walked_cells. Then every path is marched for itself, by no table.
  bool keep_cells = false;
};

/// Wall-clock seconds of each stage. Stages shared by several paths count for the first of them.
struct PathSeconds {
  double cells = 0;  ///< with the search for a box
  double march = 0;
  double correct = 0;
};

/// One geodesic among several between the same two points.
struct PathCandidate {
  double length = 0;        ///< model units
  double length_error = 0;  ///< as in Geodesic
  bool locally_shortest = false;
  Points points;  ///< d x m
};

/// A piece of a path on a surface with edges, corners or a border.
struct PathPiece {
  enum class Kind {
    face,      ///< a geodesic arc on a smooth face
    edge,      ///< an arc along an edge between two faces
    border,    ///< an arc along the border of the surface
    crossing,  ///< of an edge: a point
    corner,    ///< a point
  };
  Kind kind = Kind::face;
  std::string face;   ///< of an arc on a face: the formula that holds there, as text
  double length = 0;  ///< of an arc, model units
  Vector point;       ///< d: where the piece begins, or the point
  /// Radians. At a crossing: between the path and the edge, on either side. At a corner: the angle of the surface on
  /// the left and on the right of the path, infinite over a border; both are at least pi.
  double left = 0;
  double right = 0;
};

[[nodiscard]] constexpr std::string_view to_string(PathPiece::Kind kind) {
  switch (kind) {
    case PathPiece::Kind::face: return "face";
    case PathPiece::Kind::edge: return "edge";
    case PathPiece::Kind::border: return "border";
    case PathPiece::Kind::crossing: return "crossing";
    case PathPiece::Kind::corner: return "corner";
  }
  return "unknown";
}

/// A path: the geodesic and how it was found.
struct PathResult : Geodesic {
  Vector from;  ///< d: the start, on the surface
  Vector to;    ///< d: the end, on the surface
  /// Why `status` is not ok, in one sentence; where it is, mostly empty: else why the path may not be the shortest.
  std::string message;
  double cell = 0;  ///< h of the cells that were walked, model units
  Index num_cells = 0;
  Index num_layers = 0;                     ///< of the envelope, PathOptions::envelope
  GridMethod grid = GridMethod::automatic;  ///< how they were found; automatic = there are none
  /// False where nothing was corrected (CorrectionMethod::grid): `status` ok then says that there is a marched path,
  /// `points` are its corners, `residual` is what they and what lies between them miss.
  bool corrected = true;
  /// The distance of the ends by the march that led to `grid_path`, model units; NaN where there was none (walks).
  double marched = std::numeric_limits<double>::quiet_NaN();
  Points grid_path;     ///< d x g: the marched path, which the correction started from
  Points walked_cells;  ///< d x n: centres of the cells that the march visited, if PathOptions::keep_cells
  /// Distinct geodesics that were found, shortest first; the first one is this path. Without PathOptions::all only
  /// those that might have been the shortest were looked for.
  std::vector<PathCandidate> candidates;
  /// False when another candidate is as short, within the errors of both or the tolerance.
  bool unique = true;
  /// Were other ways round looked for. If not (more than 6 dimensions and a straight walk arrives, or a march that
  /// tells no ways apart), `unique` says nothing, and the path may not be the shortest; PathOptions::all looks always.
  bool rivals_sought = true;
  /// With Status::disconnected: bounds of the cells prove it for the box that was looked through (on a fitted surface
  /// they are a careful estimate).
  bool proved_apart = false;
  /// In order from start to end, on a surface that is not smooth, or where the path meets its border; else empty.
  std::vector<PathPiece> pieces;
  PathSeconds seconds;
  /// Appendix II of the paper, of this curve; empty where no flow corrected it.
  std::optional<FlowSummary> flow;
};

/// Shortest paths on one surface: keeps the cells, so that asking again is cheap. Not safe to share between threads.
class PathSolver {
 public:
  /// Throws InvalidArgument for options out of range. Does no work yet.
  explicit PathSolver(Surface surface, PathOptions options = {}, Context context = {});
  ~PathSolver();
  PathSolver(PathSolver&&) noexcept;
  PathSolver& operator=(PathSolver&&) noexcept;

  /// The path from p to q (d each), both projected onto the surface first; moving one by more than a cell is told
  /// through Context::note, by more than ten cells it throws InvalidArgument. Also throws SingularPoint when a point
  /// is singular, EmptySurface, OutOfMemory and Cancelled. Everything else is in `status`.
  /// Properties: starts exactly at `from` and ends at `to`; length >= |p - q|; p = q gives length 0.
  [[nodiscard]] PathResult solve(const VectorIn& p, const VectorIn& q);

  /// Between column j of `from` and column j of `to` (d x n each), on all cores; the number of threads changes no
  /// result. A pair that cannot be answered carries its status and message. Throws InvalidArgument when the shapes
  /// differ, EmptySurface, OutOfMemory for cells that all need, and Cancelled.
  [[nodiscard]] std::vector<PathResult> solve_pairs(const PointsIn& from, const PointsIn& to);

  /// From p to every column of `targets` (d x n) over one marched field, on all cores. A target that cannot be answered
  /// carries its status and message; only a bad p throws.
  [[nodiscard]] std::vector<PathResult> solve_from(const VectorIn& p, const PointsIn& targets);

  /// Says that about `num_pairs` pairs of points near these (d x n) will be asked for: cells are made, and where that
  /// pays, a table of distances between a few hundred places, after which starts take microseconds instead of
  /// milliseconds. solve_pairs does it for its own pairs; call it when they come in several parts.
  void expect(const PointsIn& near, Index num_pairs);

  [[nodiscard]] const Surface& surface() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One path on one surface.
[[nodiscard]] PathResult shortest_path(const Surface& surface, const VectorIn& p, const VectorIn& q,
                                       const PathOptions& options = {}, const Context& context = {});

}  // namespace taut
