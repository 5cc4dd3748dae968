#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "taut/cells/mesh_surface.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/core/mesh.hpp"
#include "taut/core/status.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Points spread over a surface, each as far as can be from those before it (Gonzalez 1985, with geodesic distances as
/// by Peyre and Cohen). No two are nearer to each other than the last `cover`, and every cell is at most that far from
/// one of them.
struct FarthestPoints {
  Points points;               ///< d x n, in the order they were chosen
  Vector distance;             ///< of every cell from the nearest of them, model units; infinity = not reached
  std::vector<Index> nearest;  ///< by cell: the nearest of them, -1 = not reached
  std::vector<double> cover;   ///< after each: the largest distance left, model units
};

/// Chooses cells' surface points one by one, starting from `first` (d, on the surface), by marched distances.
/// Throws what `march` throws.
[[nodiscard]] FarthestPoints farthest_points(const Surface& surface, SurfaceCells& cells, const VectorIn& first,
                                             Index count, const Context& context = {});

struct FarthestPointsOptions {
  GridMethod grid = GridMethod::automatic;
  /// Cell size h, model units; 0 = chosen, so fine that there are some dozen cells for each point, as far as the levels
  /// of refinement go.
  double cell = 0;
  Points seeds = {};  ///< as PathOptions::seeds
};

/// The same on cells of its own, in up to 6 dimensions (where the formula has edges: on the vertices of its mesh): at
/// most as many points as there are cells that a march from `first` (d, projected onto the surface; empty: the point of
/// any cell) reaches. Throws as PathSolver::solve, and InvalidArgument unless count >= 1.
[[nodiscard]] FarthestPoints farthest_points(const Surface& surface, const VectorIn& first, Index count,
                                             const FarthestPointsOptions& options = {}, const Context& context = {});

/// The parts of a surface in which one source is nearer than the others.
struct VoronoiResult {
  /// The display mesh, with vertex scalars "distance" (NaN where there is none) and "source" (as `label`, NaN
  /// likewise).
  SurfaceMesh mesh;
  std::vector<std::int32_t> label;  ///< by vertex: number of the nearest source, -1 where no source is reached
  /// Where two parts meet, a line a stretch, each with the lower-numbered part to its left seen from outside; scalars
  /// "left" and "right" are their numbers. Ends are where three parts meet, or where the mesh ends.
  Polylines boundaries;
  Index num_exact = 0;           ///< vertices whose label is proved by the fan; the others' are marched
  Index num_exact_boundary = 0;  ///< points of `boundaries` at which two distances are equal to rounding
};

/// For surfaces in R^3; `sources` d x m, projected onto the surface as by PathSolver. Labels and distances as of
/// DistanceSolver where geodesics can be followed, else as the nearest cell's of a march. Boundary points lie on the
/// edges of the mesh, brought onto the surface and bisected until the label changes within rounding; points where three
/// parts meet are good to a part of a triangle. Throws InvalidArgument in other dimensions, and what DistanceSolver
/// throws.
[[nodiscard]] VoronoiResult geodesic_voronoi(const Surface& surface, const PointsIn& sources,
                                             const DistanceOptions& options = {}, const Context& context = {});

struct KarcherMeanOptions {
  DistanceOptions distance = {};
  int max_iterations = 200;  ///< from each start, >= 1
};

/// The point of a surface with the least weighted mean of squared distances from given ones (Karcher 1977).
struct KarcherMean {
  Status status = Status::not_converged;
  std::string message;  ///< why it is not ok, or why it is not unique, in one sentence
  Vector point;         ///< d, on the surface
  double variance = 0;  ///< weighted mean of squared distances, model units squared
  double gradient = 0;  ///< length of the weighted mean of log_point(points), model units: 0 at the mean
  Vector distance;      ///< n: from `point` to each of the points
  /// False where another point was found that is as good, or where a point lies on the cut locus of the mean so that it
  /// could be drawn another way. True is no proof: the mean was looked for from several starts.
  bool unique = true;
  std::vector<Vector> others;  ///< other minima that were found, d each
  int num_iterations = 0;      ///< from all starts together
};

/// Of `points` (d x n) with `weights` (n, not negative, empty = equal), from the heaviest point and from those farthest
/// from what was found: on 2-surfaces by Newton's method (three to six steps), elsewhere by x <- exp_x(mean of
/// log_x(points)); with a shorter step where that does not lower the variance. Points within a small ball have one mean
/// (Afsari 2011); on a sphere, points all round it have many. Throws InvalidArgument for wrong shapes and weights, and
/// what DistanceSolver throws. Cost: a fan of geodesics an iteration on surfaces in R^3, a path a point elsewhere.
[[nodiscard]] KarcherMean karcher_mean(const Surface& surface, const PointsIn& points, const Vector& weights = {},
                                       const KarcherMeanOptions& options = {}, const Context& context = {});

}  // namespace taut
