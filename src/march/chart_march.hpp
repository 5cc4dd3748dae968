#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "march/arrival.hpp"
#include "march/bucket_front.hpp"
#include "march/lanes.hpp"
#include "march/methods.hpp"
#include "march/surface_charts.hpp"

namespace taut::detail {

/// How far a march goes; by default, everywhere.
struct ChartGoal {
  /// Until nothing shorter comes to `end` by any of the cells around it.
  std::optional<SurfacePoint> end;
  std::span<const Index> around_end;
  /// Cells are left out that no path to `end` of at most this length, in cells, leads through.
  double longest = std::numeric_limits<double>::infinity();
};

/// The convergent march from one point, in charts: the same steps as ConvergentMarch, in the plane, in single precision
/// and about three times as fast. One a thread.
class ChartMarch {
 public:
  explicit ChartMarch(const SurfaceCharts& charts);

  /// Distances, in cells' sizes, from a surface point to the points of the cells. `around_source`: the valid cells of
  /// the block around it.
  void run(const SurfacePoint& source, std::span<const Index> around_source, const Context& context,
           const ChartGoal& goal = {});

  /// Infinity where the march did not come.
  [[nodiscard]] float distance(Index i) const { return cell(i).distance; }
  /// The unit gradient in the chart of cell i; zero where the distance is 0 or infinite.
  [[nodiscard]] Eigen::Vector2f gradient(Index i) const { return {cell(i).gradient[0], cell(i).gradient[1]}; }

 private:
  struct alignas(Floats) Cell {
    float distance;     // infinite until it is settled
    float gradient[2];  // where it is settled
    float offered2;     // the square of the best estimate so far; less than all where no offers are taken
  };

  [[nodiscard]] Cell& cell(Index i) { return state_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Cell& cell(Index i) const { return state_[static_cast<std::size_t>(i)]; }

  void visit(Index i);
  void offer_direct(Index j);
  void gather(const ChartLinks& links);
  [[nodiscard]] UnrolledNeighbour<2, float> neighbour(const ChartLinks& links, std::size_t j) const;
  [[nodiscard]] std::optional<Arrival<2, float>> solve(const ChartLinks& links);
  void settle(Index i, const Arrival<2, float>& arrival, const ChartLinks& links);
  void watch(Index i, float distance);
  [[nodiscard]] bool leads_astray(Index i, float distance) const;

  const SurfaceCharts& charts_;
  SurfacePoint source_{};
  ChartGoal goal_;
  float reached_ = 0;  // the largest distance settled
  float end_ = 0;      // of the end, an upper bound
  BucketFront front_;
  std::vector<Cell> state_;  // of the cells, and of one that is never settled
  // The neighbours of the cell being visited, settled or not, their gradients in its chart: entry j for link j.
  std::vector<float> distance_, gradient_x_, gradient_y_, offered2_;
  std::vector<float> length2_;  // of the edge, squared
  std::vector<float> along_;    // how far the cell lies ahead of the neighbour
  std::vector<float> miss_;     // by how much the ray through the neighbour misses the cell, signed
  Least nearest_;               // the least square of an estimate of the cell's distance
  std::vector<UnrolledNeighbour<2, float>> one_by_one_;
};

/// The field of a task with one source and no radius.
void march_in_charts(const MarchTask& task, const SurfaceCharts& charts, DistanceField& field);

}  // namespace taut::detail
