// The march of the paper's section 3.2: fast marching (Sethian 1996) of first order for |grad u| = 1 in R^d, on the
// centres of the cells as nodes of a Cartesian grid. A neighbour that is no cell counts as infinitely far. Paths keep
// to the envelope and run from centre to centre along the axes. Hence distances are biased on the crossed cells alone,
// and converge in an envelope of more layers (Memoli and Sapiro 2001; docs/march.md). A settled cell costs 4 d^2
// look-ups in the grid and 2 d moves in the heap: this is the only march without a limit on d.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "march/centre_reader.hpp"
#include "march/centre_watch.hpp"
#include "march/growing_field.hpp"
#include "march/methods.hpp"

namespace taut::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The paper's fast marching (sec. 3.2; Sethian 1996) between cell centres, as if the cells were a piece of flat R^d.
/// It walks all cells, valid or not, and no others: all that hang together across faces are reached.
class AxisMarch {
 public:
  AxisMarch(const MarchTask& task, DistanceField& field)
      : cells_(task.cells),
        h_(cells_.grid().size()),
        growing_(task, field, GrowingField::Growth::faces),
        target_(task, field),
        coordinates_(static_cast<std::size_t>(field.sources.rows())) {
    for (Index s = 0; s < field.sources.cols(); ++s) {
      const Index start = checked_start_cell(cells_.grid(), field.sources.col(s));
      growing_.offer(start, (cells_.grid().centre(start) - field.sources.col(s)).norm(), s);
    }
  }

  void run() {
    Front& front = growing_.front();
    while (!front.empty() && !target_.is_final(front.min_key())) {
      const double distance = front.min_key();
      const Index i = growing_.pop();
      growing_.settle(i, distance, growing_.source(i));
      for (std::size_t a = 0; a < coordinates_.size(); ++a) {
        for (const int step : {-1, 1}) {
          const Index j = neighbour(i, a, step);
          if (j == CellGrid::kNone || growing_.settled(j)) continue;
          growing_.offer(j, update(j), growing_.source(i));
        }
      }
      target_.settled(cells_.grid().cell(i));
    }
    growing_.finish(target_.distance());
  }

 private:
  [[nodiscard]] Index neighbour(Index i, std::size_t axis, int step) {
    const auto cell = cells_.grid().cell(i);
    std::copy(cell.begin(), cell.end(), coordinates_.begin());
    coordinates_[axis] += step;
    return cells_.grid().find(coordinates_);
  }

  /// Solves sum_a max(u - m_a, 0)^2 = h^2, m_a the smaller settled value on axis a: upwind differences of |grad u| = 1.
  [[nodiscard]] double update(Index j) {
    upwind_.clear();
    for (std::size_t a = 0; a < coordinates_.size(); ++a) {
      double least = kInfinity;
      for (const int step : {-1, 1}) {
        const Index i = neighbour(j, a, step);
        if (i != CellGrid::kNone) least = std::min(least, growing_.distance(i));
      }
      if (least < kInfinity) upwind_.push_back(least);
    }
    std::sort(upwind_.begin(), upwind_.end());
    const double base = upwind_.front();
    double sum = 0;
    double sum2 = 0;
    double u = base + h_;
    double count = 0;
    for (const double value : upwind_) {
      // An axis whose value is not below u so far is not upwind, nor are those after it.
      if (!(value < u)) break;
      // Relative to the least value: squares of the distances themselves would cancel far from the source.
      const double m = value - base;
      sum += m;
      sum2 += m * m;
      count += 1;
      u = base + (sum + std::sqrt(std::max(0.0, sum * sum - count * (sum2 - h_ * h_)))) / count;
    }
    return u;
  }

  SurfaceCells& cells_;
  double h_;
  GrowingField growing_;
  CentreWatch target_;
  std::vector<std::int32_t> coordinates_;
  std::vector<double> upwind_;
};

}  // namespace

void march_axis(const MarchTask& task, DistanceField& field) { AxisMarch(task, field).run(); }

}  // namespace taut::detail
