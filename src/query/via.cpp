// A path through given points: the shortest path of each leg, one after the other. Lengths and errors add up; the whole
// is as certain as its least certain leg, and its status that of the leg that can be used least. It may bend at the
// points: they are met, not smoothed.
#include "taut/query/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "curve/polyline.hpp"

namespace taut {
namespace {

/// The less a leg can be used, the higher.
int severity(Status status) {
  if (status == Status::ok) return 0;
  return status == Status::disconnected ? 2 : 1;
}

/// All columns in a row; those without columns may have no rows either.
Points in_a_row(const std::vector<const Points*>& parts, Index dim) {
  Index count = 0;
  for (const Points* part : parts) count += part->cols();
  Points all(dim, count);
  Index next = 0;
  for (const Points* part : parts) {
    if (part->cols() > 0) all.middleCols(next, part->cols()) = *part;
    next += part->cols();
  }
  return all;
}

/// The legs' points in a row, without the joints' second copies.
Points joined(const std::vector<PathResult>& legs, Points PathResult::*points_of) {
  std::vector<const Points*> parts;
  for (const PathResult& leg : legs) parts.push_back(&(leg.*points_of));
  Points points = detail::without_repeats(in_a_row(parts, legs.front().from.size()));
  if (points.cols() == 1) points = points.replicate(1, 2).eval();  // all points the same: a path of that point
  return points;
}

/// Of the legs that were found on cells of this size.
Points walked_cells(const std::vector<PathResult>& legs, double cell) {
  std::vector<const Points*> parts;
  for (const PathResult& leg : legs) {
    if (leg.cell == cell) parts.push_back(&leg.walked_cells);
  }
  return in_a_row(parts, legs.front().from.size());
}

std::string leg_text(std::size_t leg, std::size_t num_legs, const std::string& problem) {
  return fmt::format("leg {} of {}: {}", leg + 1, num_legs, problem);
}

}  // namespace

ViaResult path_through(PathSolver& solver, const PointsIn& points) {
  const Index dim = solver.surface().dim();
  if (points.rows() != dim || points.cols() < 2) {
    throw InvalidArgument(fmt::format("points ({} x {}) for a path through them: must be {} x n, n >= 2", points.rows(),
                                      points.cols(), dim));
  }
  const auto num_legs = static_cast<std::size_t>(points.cols() - 1);
  solver.expect(points, points.cols() - 1);
  ViaResult whole;
  for (std::size_t i = 0; i < num_legs; ++i) {
    const auto j = static_cast<Index>(i);
    try {
      whole.legs.push_back(solver.solve(points.col(j), points.col(j + 1)));
    } catch (const InvalidArgument& error) {
      throw InvalidArgument(leg_text(i, num_legs, error.what()));
    } catch (const SingularPoint& error) {
      throw SingularPoint(leg_text(i, num_legs, error.what()));
    }
  }
  whole.from = whole.legs.front().from;
  whole.to = whole.legs.back().to;
  whole.status = Status::ok;
  whole.locally_shortest = true;
  whole.unique = true;
  whole.index = 0;
  whole.marched = 0;
  bool complete = true;
  for (std::size_t i = 0; i < num_legs; ++i) {
    const PathResult& leg = whole.legs[i];
    if (severity(leg.status) > severity(whole.status)) {
      whole.status = leg.status;
      whole.message = leg_text(i, num_legs, leg.message);
    }
    complete = complete && leg.points.cols() > 0;
    whole.length += leg.length;
    whole.length_error += leg.length_error;
    whole.locally_shortest = whole.locally_shortest && leg.locally_shortest;
    // Fields that vanish at the points are fields of the legs: their negative directions add up.
    whole.index = whole.index && leg.index ? std::optional(*whole.index + *leg.index) : std::nullopt;
    whole.unique = whole.unique && leg.unique;
    whole.tied = whole.tied || leg.tied;
    whole.doubts.add(leg.doubts);
    whole.residual.surface = std::max(whole.residual.surface, leg.residual.surface);
    whole.residual.geodesic_curvature = std::max(whole.residual.geodesic_curvature, leg.residual.geodesic_curvature);
    whole.num_iterations += leg.num_iterations;
    whole.corrected = whole.corrected && leg.corrected;
    whole.marched += leg.marched;
    whole.cell = std::max(whole.cell, leg.cell);
    whole.num_cells = std::max(whole.num_cells, leg.num_cells);
    whole.num_layers = std::max(whole.num_layers, leg.num_layers);
    if (leg.grid != GridMethod::automatic) whole.grid = leg.grid;
    whole.seconds.cells += leg.seconds.cells;
    whole.seconds.march += leg.seconds.march;
    whole.seconds.correct += leg.seconds.correct;
  }
  // Without all legs there is no curve, and a sum of some lengths would mislead.
  if (complete) {
    whole.points = joined(whole.legs, &PathResult::points);
    whole.grid_path = joined(whole.legs, &PathResult::grid_path);
    whole.walked_cells = walked_cells(whole.legs, whole.cell);
  } else {
    whole.length = 0;
    whole.length_error = 0;
    whole.locally_shortest = false;
    whole.index.reset();
  }
  return whole;
}

}  // namespace taut
