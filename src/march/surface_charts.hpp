#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "march/edge.hpp"
#include "march/neighbour_index.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// The edges from the cells y around a cell x, unrolled into the chart of x: entry j of each is edge j. In whole lanes,
/// filled up with edges from a cell that no march settles. Lengths are in cells.
struct ChartLinks {
  std::size_t count;
  const std::uint32_t* cell;  ///< y
  const float* position[2];   ///< z: where y lies, x is at 0; |z| is the geodesic distance of x and y
  const float* cosine;        ///< of the rotation that carries tangent vectors from the chart of y to that of x,
  const float* sine;          ///< along the edge
};

/// Orthonormal charts of the tangent planes at the valid cells of a surface (d - k = 2), with all edges between
/// neighbours unrolled: what marches over the same cells share. In single precision, far below the error of a march;
/// some 450 bytes a cell.
class SurfaceCharts {
 public:
  /// `neighbours`: of the cells, to which a reference is kept.
  SurfaceCharts(const SurfaceCells& cells, const AnyNeighbourIndex& neighbours, const Context& context);

  [[nodiscard]] const SurfaceCells& cells() const { return cells_; }
  [[nodiscard]] Index num_cells() const { return cells_.num_cells(); }
  [[nodiscard]] double cell_size() const { return cells_.grid().size(); }
  /// The largest number of links of a cell, in whole lanes.
  [[nodiscard]] std::size_t most_links() const { return most_links_; }
  [[nodiscard]] ChartLinks links(Index i) const {
    const Block& block = blocks_[static_cast<std::size_t>(i / kBlock)];
    const std::size_t first = block.first[static_cast<std::size_t>(i % kBlock)];
    const std::size_t n = block.first[static_cast<std::size_t>(i % kBlock) + 1] - first;
    const float* at = block.numbers.data() + kNumbers * first;
    return {n, block.linked.data() + first, {at, at + n}, at + 2 * n, at + 3 * n};
  }
  /// d x 2, orthonormal: the axes of a chart, right-handed about the normals.
  [[nodiscard]] auto axes(Index i) const {
    return Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, 2>>(record(i) + axes_at_, cells_.dim(), 2);
  }
  /// The edge from a surface point to cell x: its length and its unit direction in the chart of x. Empty when no edge
  /// joins them or the chord is longer than `radius`.
  [[nodiscard]] std::optional<std::pair<float, Eigen::Vector2f>> edge(const SurfacePoint& from, Index x,
                                                                      double radius) const;

 private:
  static constexpr Index kBlock = 256;        // cells
  static constexpr std::size_t kNumbers = 4;  // of a link

  struct Block {
    std::vector<std::uint32_t> first;  // link of a cell
    std::vector<std::uint32_t> linked;
    std::vector<float> numbers;  // each number of all links of a cell, one after the other
  };

  [[nodiscard]] float* record(Index i) { return records_.data() + static_cast<std::size_t>(i) * record_size_; }
  [[nodiscard]] const float* record(Index i) const {
    return records_.data() + static_cast<std::size_t>(i) * record_size_;
  }
  template <int D, int K>
  void fill_records(Index first, Index last);
  template <int D, int K>
  void link(const NeighbourIndex<D>& neighbours, Index first, Index last, Block& block) const;

  const SurfaceCells& cells_;
  // A cell each, in whole lanes: its integer coordinates (d), where its point lies in it (d), the normals (d k), the
  // axes (2 d).
  std::vector<float> records_;
  std::size_t record_size_;
  std::size_t axes_at_;
  std::vector<Block> blocks_;
  std::size_t most_links_ = 0;
};

}  // namespace taut::detail
