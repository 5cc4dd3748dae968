#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "march/arrival.hpp"
#include "march/surroundings.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {

/// Up to this many cells from a source the distance is that of the edge from the source itself.
inline constexpr double kDirectCells = 3;

/// The edge from source s to x when x is near enough for it to be the shortest path: its length and direction at x (d).
template <int D, int K>
std::optional<std::pair<double, SmallVector<D>>> direct_from_source(const DistanceField& field, Index s,
                                                                    const SurfacePoint& x, double radius,
                                                                    TangentCoordinates<D, K>& frame) {
  const Index d = field.sources.rows();
  const Index k = field.source_normals.rows() / d;
  Edge<D> edge;
  const SurfacePoint source{field.sources.col(s).data(), field.source_normals.col(s).data()};
  if (!make_edge<D, K>(source, x, d, k, edge) || edge.chord.squaredNorm() > radius * radius) return std::nullopt;
  frame.set(x.normals);
  SmallVector<D> direction = frame.coordinates(edge.chord);
  const double norm = direction.norm();
  if (norm > 0) direction /= norm;
  return std::pair(edge.length, frame.lift(direction));
}

/// What a field says at a point.
template <int D>
struct Reading {
  Arrival<D> arrival;
  /// The source the distance was taken from directly; -1: it was solved for from cells.
  Index direct_source = -1;
};

/// Reads a field, finished or still growing, at any surface point. `map`: of the cells, where there is
/// one.
template <int D, int K>
class FieldReader {
 public:
  FieldReader(const SurfaceCells& cells, const DistanceField& field, const CellMap* map = nullptr)
      : cells_(cells),
        field_(field),
        d_(field.sources.rows()),
        k_(field.source_normals.rows() / d_),
        surroundings_(cells, map),
        solver_(d_, k_),
        frame_(d_, k_),
        cell_(static_cast<std::size_t>(d_)) {}

  /// The distance at x, infinity where no reached cell with an edge to x lies around it.
  [[nodiscard]] double distance(const SurfacePoint& x) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (field_.method == MarchMethod::convergent) {
      const std::optional<Reading<D>> reading = read(x);
      return reading ? reading->arrival.distance : kInfinity;
    }
    for (Index s = 0; s < field_.sources.cols(); ++s) {
      if (std::equal(x.x, x.x + d_, field_.sources.col(s).data())) return 0;
    }
    return step_down(x, kInfinity).second;
  }

  /// Convergent fields only, by the update the march itself makes. Empty when no reached cell with an edge to x lies
  /// around it.
  [[nodiscard]] std::optional<Reading<D>> read(const SurfacePoint& x) {
    std::optional<Reading<D>> reading;
    solver_.begin(x);
    std::int32_t tried = -1;
    for (const Index i : known_around(x.x)) {
      const std::int32_t source = field_.nearest_source[static_cast<std::size_t>(i)];
      solver_.add({cells_.point(i).data(), cells_.normals(i).data()}, field_.distance(i), &field_.gradient(0, i),
                  source);
      // Neighbouring cells mostly have the same source: its edge is made once.
      if (source == tried) continue;
      tried = source;
      const auto direct = direct_from_source<D, K>(field_, source, x, kDirectCells * cells_.grid().size(), frame_);
      if (direct && !(reading && reading->arrival.distance <= direct->first)) {
        reading = {{direct->first, direct->second, true, source}, source};
      }
    }
    // Near a source its own edge is the better number, as in the march.
    if (reading) return reading;
    if (const auto arrival = solver_.solve()) reading = {*arrival, -1};
    return reading;
  }

  /// The nearest source within the block around x that has an edge to x; -1 when there is none.
  [[nodiscard]] Index source_nearby(const SurfacePoint& x) {
    Index nearest = -1;
    double least = std::numeric_limits<double>::infinity();
    Edge<D> edge;
    // By cells, not by length: the block is what step_down() sees as well.
    std::vector<std::int32_t> source_cell(cell_.size());
    cells_.grid().cell_of(Eigen::Map<const Vector>(x.x, d_), cell_);
    for (Index s = 0; s < field_.sources.cols(); ++s) {
      const SurfacePoint source{field_.sources.col(s).data(), field_.source_normals.col(s).data()};
      cells_.grid().cell_of(field_.sources.col(s), source_cell);
      bool near = true;
      for (std::size_t a = 0; a < cell_.size(); ++a) near = near && std::abs(cell_[a] - source_cell[a]) <= 1;
      if (!near || !make_edge<D, K>(source, x, d_, k_, edge) || !(edge.length < least)) continue;
      least = edge.length;
      nearest = s;
    }
    return nearest;
  }

  /// The reached cell around x over which the way down along one edge is the shortest, of those with a distance below
  /// `below`, and the length of that way. (-1, infinity) when there is none.
  [[nodiscard]] std::pair<Index, double> step_down(const SurfacePoint& x, double below) {
    std::pair<Index, double> best{-1, std::numeric_limits<double>::infinity()};
    Edge<D> edge;
    for (const Index i : known_around(x.x)) {
      const SurfacePoint y{cells_.point(i).data(), cells_.normals(i).data()};
      if (!(field_.distance(i) < below) || !make_edge<D, K>(y, x, d_, k_, edge)) continue;
      const double length = field_.distance(i) + edge.length;
      if (length < best.second) best = {i, length};
    }
    return best;
  }

 private:
  // Reached cells in the block around x.
  std::span<const Index> known_around(const double* x) {
    cells_.grid().cell_of(Eigen::Map<const Vector>(x, d_), cell_);
    known_.clear();
    for (const Index i : surroundings_.around(cell_)) {
      if (i < field_.distance.size() && field_.distance(i) < std::numeric_limits<double>::infinity()) {
        known_.push_back(i);
      }
    }
    return known_;
  }

  const SurfaceCells& cells_;
  const DistanceField& field_;
  Index d_;
  Index k_;
  Surroundings<D> surroundings_;
  ArrivalSolver<D, K> solver_;
  TangentCoordinates<D, K> frame_;
  std::vector<std::int32_t> cell_;
  std::vector<Index> known_;
};

}  // namespace taut::detail
