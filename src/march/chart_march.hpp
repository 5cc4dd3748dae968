#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "march/arrival.hpp"
#include "march/bucket_front.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut::detail {

/// An edge from a cell y to a cell x, unrolled into the chart of x. Half a cache line.
struct ChartLink {
  std::uint32_t cell;        ///< y
  float length;              ///< geodesic distance of x and y, in cells
  Eigen::Vector2f position;  ///< z: where y lies, x is at 0
  Eigen::Matrix2f turn;      ///< carries tangent vectors from the chart of y to that of x, along the edge
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
  /// The largest number of links of a cell.
  [[nodiscard]] std::size_t most_links() const { return most_links_; }
  [[nodiscard]] double cell_size() const { return cells_.grid().size(); }
  [[nodiscard]] std::span<const ChartLink> links(Index i) const {
    const auto at = static_cast<std::size_t>(i);
    return {links_.data() + first_link_[at], first_link_[at + 1] - first_link_[at]};
  }
  /// The edge from cell `source` to cell x: its length, in cells, and its unit direction in the chart of x. Empty when
  /// no edge joins them or the chord is longer than `radius` cells.
  [[nodiscard]] std::optional<std::pair<double, Eigen::Vector2d>> edge(Index source, Index x, double radius) const;
  /// d x 2, orthonormal: the axes of a chart.
  [[nodiscard]] Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2>> axes(Index i) const {
    return {axes_.data() + 2 * cells_.dim() * i, cells_.dim(), 2};
  }

 private:
  const SurfaceCells& cells_;
  std::vector<double> axes_;
  std::vector<std::uint32_t> first_link_;
  std::vector<ChartLink> links_;
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
  [[nodiscard]] const Eigen::Vector2f& gradient(Index i) const { return cell(i).gradient; }

 private:
  struct Cell {
    float distance;            // infinite until it is settled
    Eigen::Vector2f gradient;  // where it is settled
    float offered2;            // the square of the best estimate so far, less than all others where direct
    bool direct;               // the estimate is the edge from the source itself
    bool delayed;              // has come first before, without neighbours on both sides of its ray
  };
  /// The settled neighbours of a cell, unrolled into its chart: entry n of each is neighbour n. Filled up to whole
  /// lanes with neighbours infinitely far, so to speak.
  struct Neighbours {
    explicit Neighbours(std::size_t most);
    void set(std::size_t n, const Eigen::Vector2f& position, const Eigen::Vector2f& gradient, float distance,
             float length);
    [[nodiscard]] Neighbour<2, float> operator[](std::size_t n) const;

    std::size_t count = 0;
    std::vector<float> position_x, position_y, gradient_x, gradient_y, distance, length, along, estimate2;
    std::vector<float> miss;  // by how much the ray through it misses the cell, signed
  };

  [[nodiscard]] Cell& cell(Index i) { return state_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const Cell& cell(Index i) const { return state_[static_cast<std::size_t>(i)]; }

  void visit(Index i);
  void offer_direct(Index j);
  void offer(const ChartLink& link, const Cell& here);
  void sort_links(Index i);
  [[nodiscard]] std::size_t gather();
  [[nodiscard]] std::optional<Arrival<2, float>> solve(std::size_t first);

  const SurfaceCharts& charts_;
  Index source_ = 0;
  BucketFront front_;
  std::vector<Cell> state_;
  // Of the cell being visited: links to neighbours that are settled, and to the others.
  std::vector<const ChartLink*> settled_;
  std::vector<const ChartLink*> waiting_;
  std::size_t num_settled_ = 0;
  std::size_t num_waiting_ = 0;
  Neighbours neighbours_;
  std::vector<Neighbour<2, float>> one_by_one_;
};

}  // namespace taut::detail
