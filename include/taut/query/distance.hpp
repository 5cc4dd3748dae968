#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/mesh.hpp"
#include "taut/core/status.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct DistanceOptions {
  /// Relative tolerance of distances, 1e-13 .. 1e-3.
  double tolerance = 1e-9;
  /// Targets that lie farther away are not looked for, model units, > 0.
  double max_distance = std::numeric_limits<double>::infinity();
  GridMethod grid = GridMethod::automatic;
  double cell = 0;                              ///< grid cell size h, model units; 0 = chosen
  Points seeds = {};                            ///< as PathOptions::seeds
  MarchMethod march = MarchMethod::convergent;  ///< how starts of corrected paths are found
  /// Panels that a geodesic fan may have; see FanOptions.
  Index max_patches = 60000;
  /// Correct a path to each target that the fan does not answer. False: such a target is not_converged.
  bool paths = true;
};

/// How a distance was found.
enum class DistanceProof : std::uint8_t {
  none,  ///< there is none: see its status
  path,  ///< a corrected path, the shortest of those that were found
  fan,   ///< the shortest of all geodesics from the sources, which were followed in every direction at least as far
};

/// Distances of n targets from the nearest of several sources.
struct Distances {
  Vector distance;                   ///< n, model units; infinity where there is none or beyond `max_distance`
  Vector error;                      ///< n: estimated error of `distance`, model units; infinity where there is none
  std::vector<Status> status;        ///< n: ok, disconnected, ...; ok beyond `max_distance`
  std::vector<DistanceProof> proof;  ///< n
  std::vector<std::int32_t>
      source;   ///< n: column of the nearest source, or number of the curve; -1 where there is none
  Points foot;  ///< d x n: where the geodesic leaves it: the source, or the nearest point of the curve; NaN likewise
  Points departure;  ///< d x n: unit tangent at the source, NaN where there is none
  Points arrival;    ///< d x n: unit tangent at the target, direction of travel, NaN where there is none
  std::map<Index, std::string> message;  ///< why a target has no distance, in one sentence
};

/// Distances from one or several sources to any number of targets. On surfaces in R^3 all geodesics from the sources
/// are followed (GeodesicFan) as far as the targets asked about lie, which is kept for the next question; the least
/// length is the distance. Where rays cannot be followed (creases, borders, singular points) and in other dimensions
/// it is a corrected path to each target (PathSolver). Not safe to share between threads.
class DistanceSolver {
 public:
  /// `sources` (d x m) are projected onto the surface as PathSolver does it; `values` (m, model units; empty = zeros)
  /// are the distances there. Throws InvalidArgument for a wrong shape, options out of range and sources off the
  /// surface, SingularPoint for singular ones.
  DistanceSolver(Surface surface, const PointsIn& sources, const Vector& values = {},
                 const DistanceOptions& options = {}, Context context = {});
  ~DistanceSolver();
  DistanceSolver(DistanceSolver&&) noexcept;
  DistanceSolver& operator=(DistanceSolver&&) noexcept;

  /// Of `targets` (d x n, projected onto the surface), on all cores. A target that cannot be answered carries its
  /// status and message. Throws InvalidArgument for a wrong shape, Cancelled, EmptySurface, OutOfMemory.
  /// Properties the tests check: 0 at a source (of value 0); |u(x) - u(y)| <= d(x, y); the minimum over the single
  /// sources; the same from the other end; the same bits for any number of threads.
  [[nodiscard]] Distances at(const PointsIn& targets);

  /// Other sources, as in the constructor: the cells and what paths need are kept. Answers do not depend on earlier
  /// sources beyond their errors.
  void set_sources(const PointsIn& sources, const Vector& values = {});

  /// Curves as sources instead: each of `polylines` (d x n, n >= 2, projected) stands for the shortest paths from each
  /// of its points to the next; one whose last point is its first is closed. Distances are exact for this geodesic
  /// polygon. What the fan does not answer, single paths do, which end on the curve at a right angle, at a corner or at
  /// its end: some tens of paths a target. Throws InvalidArgument for a polyline of less than two distinct points, and
  /// where no path joins two of them or it goes over an edge.
  void set_curves(const std::vector<Points>& polylines);

  [[nodiscard]] const Surface& surface() const;
  /// d x m, on the surface; of curves their points.
  [[nodiscard]] const Points& sources() const;
  /// Are rays followed at all: surfaces in R^3 without a domain.
  [[nodiscard]] bool has_fan() const;
  [[nodiscard]] Index num_patches() const;  ///< of the fan so far

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The lines on a triangle mesh at which a value given at its vertices (n, linear between them) takes one of `levels`,
/// each in order along its line with lower values to the left seen from outside. One that meets itself repeats its
/// first point at its end. Triangles with a corner that has no finite value are left out. A scalar "level" tells each
/// point's. Throws InvalidArgument when there is not one value a vertex.
[[nodiscard]] Polylines trace_isolines(const TriangleMesh& mesh, const Vector& values,
                                       const std::vector<double>& levels);

/// The same for distances on the surface itself: every point is moved along the geodesic that arrives there until its
/// distance is the level's, to the solver's tolerance. Where that fails (beside a cut locus, where the line has a
/// corner, or where distances are not known) it stays on the mesh's line. `mesh` and `values` come from the solver's
/// surface; `num_moved`, when not null, receives how many points have been brought to their level.
[[nodiscard]] Polylines distance_isolines(DistanceSolver& solver, const TriangleMesh& mesh, const Vector& values,
                                          const std::vector<double>& levels, Index* num_moved = nullptr);

/// `count` levels at equal steps between 0 and the largest finite value, both left out.
[[nodiscard]] std::vector<double> even_levels(const Vector& values, int count);

}  // namespace taut
