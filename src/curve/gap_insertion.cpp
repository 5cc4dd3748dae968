// New nodes between successive ones, sec. 4 of the paper: all midpoints are projected freely in one batch; those that
// fall back on an end, or find nothing, are projected again within the plane through the midpoint across the gap,
// equation (5), in a second batch. A gap that neither closes stays as it is. Whether it falls in one cell, as the paper
// has it, decides how far (5) may lead, and is counted.
#include "curve/gap_insertion.hpp"

#include <algorithm>
#include <cmath>

#include "curve/plane_projection.hpp"

namespace taut::detail {
namespace {

constexpr double kExact = 1e-9;  // of the shortest gap: how near to the surface a new node is brought
// A new node that lands less than this part of AB beside an end, and not between them, has fallen back on that end.
constexpr double kBeside = 0.2;
constexpr double kFreeReach = 1;   // of the gap: how far an ordinary projection may lead
constexpr double kPlaneReach = 2;  // of the gap, at least: how far (5) may lead. Within a cell as far as it is wide,
constexpr double kFreePlaneReach = 20;  // ... and where no cell tells how deep the groove may be, so far

}  // namespace

bool GapInsertion::in_one_cell(const VectorIn& a, const VectorIn& b) const {
  if (!(lattice_.size > 0)) return true;  // no grid: nothing to judge by
  for (Index c = 0; c < dim_; ++c) {
    const double at_a = std::floor((a(c) - lattice_.origin(c)) / lattice_.size);
    const double at_b = std::floor((b(c) - lattice_.origin(c)) / lattice_.size);
    if (at_a != at_b) return false;
  }
  return true;
}

Index GapInsertion::insert(Points& points, const std::vector<bool>& wide) {
  struct Gap {
    Index first;  // A; B is the next node
    double width;
    bool found = false;
    bool in_plane = false;
    bool across = false;  // A and B in different cells
  };
  std::vector<Gap> gaps;
  for (std::size_t i = 0; i < wide.size(); ++i) {
    const auto first = static_cast<Index>(i);
    if (wide[i]) gaps.push_back({first, (points.col(first + 1) - points.col(first)).norm()});
  }
  if (gaps.empty()) return 0;
  const auto count = static_cast<Index>(gaps.size());
  const double tolerance = kExact * std::ranges::min(gaps, {}, &Gap::width).width;

  Points fresh(dim_, count);
  Vector reach(count);
  for (Index j = 0; j < count; ++j) {
    const Gap& gap = gaps[static_cast<std::size_t>(j)];
    fresh.col(j) = (points.col(gap.first) + points.col(gap.first + 1)) / 2;
    reach(j) = kFreeReach * gap.width;
  }
  const auto found = project_in_planes(evaluator_, dim_, codim_, fresh, Points::Zero(dim_, count), reach, tolerance);

  std::vector<Index> fallen;
  for (Index j = 0; j < count; ++j) {
    Gap& gap = gaps[static_cast<std::size_t>(j)];
    const Vector edge = points.col(gap.first + 1) - points.col(gap.first);
    // Figure 3: the nearest point of the surface lies beside A or B, and the gap would stay.
    const double place = edge.dot(fresh.col(j) - points.col(gap.first)) / edge.squaredNorm();  // A = 0, B = 1
    const bool back = place < kBeside || place > 1 - kBeside;
    gap.found = found(j) && !back;
    if (!gap.found) fallen.push_back(j);
  }
  if (!fallen.empty()) {
    const auto again = static_cast<Index>(fallen.size());
    Points in_plane(dim_, again);
    Points axes(dim_, again);
    Vector plane_reach(again);
    for (Index a = 0; a < again; ++a) {
      Gap& gap = gaps[static_cast<std::size_t>(fallen[static_cast<std::size_t>(a)])];
      in_plane.col(a) = (points.col(gap.first) + points.col(gap.first + 1)) / 2;
      axes.col(a) = (points.col(gap.first + 1) - points.col(gap.first)) / gap.width;
      gap.across = !in_one_cell(points.col(gap.first), points.col(gap.first + 1));
      // Within one cell the groove cannot be deeper than the cell.
      const double diagonal = lattice_.size * std::sqrt(static_cast<double>(dim_));
      plane_reach(a) =
          std::max((lattice_.size > 0 ? kPlaneReach : kFreePlaneReach) * gap.width, gap.across ? 0 : diagonal);
    }
    const auto closed = project_in_planes(evaluator_, dim_, codim_, in_plane, axes, plane_reach, tolerance);
    for (Index a = 0; a < again; ++a) {
      const Index j = fallen[static_cast<std::size_t>(a)];
      Gap& gap = gaps[static_cast<std::size_t>(j)];
      if (!closed(a)) continue;
      fresh.col(j) = in_plane.col(a);
      gap.found = gap.in_plane = true;
    }
  }

  Points merged(dim_, points.cols() + count);
  Index out = 0;
  Index next = 0;
  for (Index i = 0; i < points.cols(); ++i) {
    merged.col(out++) = points.col(i);
    if (next == count || gaps[static_cast<std::size_t>(next)].first != i) continue;
    const Gap& gap = gaps[static_cast<std::size_t>(next)];
    if (gap.found) {
      merged.col(out++) = fresh.col(next);
      if (gap.in_plane) {
        ++num_in_plane_;
        if (gap.across) ++num_across_;
      } else {
        ++num_projected_;
      }
    }
    ++next;
  }
  const Index inserted = out - points.cols();
  points = merged.leftCols(out);
  return inserted;
}

}  // namespace taut::detail
