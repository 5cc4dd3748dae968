#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "march/arrival.hpp"
#include "march/bucket_front.hpp"
#include "march/lanes.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// The edges from the cells y around a cell x, unrolled into the chart of x: entry j of each is edge j. In whole lanes,
/// filled up with edges from a cell that no march settles.
struct ChartLinks {
  std::size_t count;
  const std::uint32_t* cell;  ///< y
  const float* length;        ///< geodesic distance of x and y, in cells
  const float* position[2];   ///< z: where y lies, x is at 0
  const float* turn[2][2];    ///< carries tangent vectors from the chart of y to that of x, along the edge
};

/// Orthonormal charts of the tangent planes at the valid cells of a surface (d - k = 2), with all edges between
/// neighbours unrolled: what many marches over the same cells share. 32 bytes an edge, in
/// single precision: far below the error of the march.
class SurfaceCharts {
 public:
  /// `links`: the cells that an edge joins to cell i, from first_link[i] to first_link[i + 1]. Keeps a reference to the
  /// cells.
  SurfaceCharts(const SurfaceCells& cells, const std::vector<std::uint32_t>& first_link,
                const std::vector<std::uint32_t>& links);

  [[nodiscard]] Index num_cells() const { return cells_.num_cells(); }
  /// The largest number of links of a cell, in whole lanes.
  [[nodiscard]] std::size_t most_links() const { return most_links_; }
  [[nodiscard]] double cell_size() const { return cells_.grid().size(); }
  [[nodiscard]] ChartLinks links(Index i) const {
    const std::size_t first = first_link_[static_cast<std::size_t>(i)];
    const std::size_t n = first_link_[static_cast<std::size_t>(i) + 1] - first;
    const float* at = numbers_.data() + kNumbers * first;
    return {n, linked_.data() + first, at, {at + n, at + 2 * n}, {{at + 3 * n, at + 4 * n}, {at + 5 * n, at + 6 * n}}};
  }
  /// The edge from cell `source` to cell x: its length, in cells, and its unit direction in the chart of x. Empty when
  /// no edge joins them or the chord is longer than `radius` cells.
  [[nodiscard]] std::optional<std::pair<double, Eigen::Vector2d>> edge(Index source, Index x, double radius) const;
  /// d x 2, orthonormal: the axes of a chart.
  [[nodiscard]] Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2>> axes(Index i) const {
    return {axes_.data() + 2 * cells_.dim() * i, cells_.dim(), 2};
  }

 private:
  static constexpr std::size_t kNumbers = 7;  // of a link

  const SurfaceCells& cells_;
  std::vector<double> axes_;
  std::vector<std::uint32_t> first_link_;
  std::vector<std::uint32_t> linked_;
  std::vector<float> numbers_;  // each number of all links of a cell, one after the other
  std::size_t most_links_ = 0;
};

/// The convergent march from one cell, in charts: the same steps as ConvergentMarch, in the plane. About twice as
/// fast where the charts are there already. One a thread.
class ChartMarch {
 public:
  explicit ChartMarch(const SurfaceCharts& charts);

  /// Distances from the point of cell `source` to those of all cells, in cells' sizes.
  void run(Index source);

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
  [[nodiscard]] Neighbour<2, float> neighbour(const ChartLinks& links, std::size_t j) const;
  [[nodiscard]] std::optional<Arrival<2, float>> solve(const ChartLinks& links);
  void settle(Cell& here, const Arrival<2, float>& arrival, const ChartLinks& links);

  const SurfaceCharts& charts_;
  Index source_ = 0;
  BucketFront front_;
  std::vector<Cell> state_;  // of the cells, and of one that is never settled
  // The neighbours of the cell being visited, settled or not, their gradients in its chart: entry j for link j.
  std::vector<float> distance_, gradient_x_, gradient_y_, offered2_;
  std::vector<float> along_;  // how far the cell lies ahead of the neighbour
  std::vector<float> miss_;   // by how much the ray through the neighbour misses the cell, signed
  Least nearest_;             // the least square of an estimate of the cell's distance
  std::vector<Neighbour<2, float>> one_by_one_;
};

}  // namespace taut::detail
