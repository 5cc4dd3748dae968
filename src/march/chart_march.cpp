#include "march/chart_march.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "march/dimensions.hpp"
#include "march/edge.hpp"
#include "march/field_reader.hpp"
#include "march/tangent_frame.hpp"

namespace taut::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SurfacePoint point_of(const SurfaceCells& cells, Index i) { return {cells.point(i).data(), cells.normals(i).data()}; }

Eigen::Vector2d unit(const Eigen::Vector2d& v) {
  const double norm = v.norm();
  return norm > 0 ? Eigen::Vector2d(v / norm) : v;
}

Eigen::Vector2d quarter_turn(const Eigen::Vector2d& v) { return {-v(1), v(0)}; }

}  // namespace

SurfaceCharts::SurfaceCharts(const SurfaceCells& cells, const std::vector<std::uint32_t>& first_link,
                             const std::vector<std::uint32_t>& links)
    : cells_(cells), axes_(static_cast<std::size_t>(2 * cells.dim() * cells.num_cells())), first_link_(first_link) {
  links_.resize(links.size());
  with_dimensions(cells.dim(), cells.codim(), [&]<int D, int K>() {
    const Index d = cells.dim();
    const Index k = cells.codim();
    TangentFrame<D, K> frame(d, k);
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (!cells.valid(i)) continue;
      frame.set(cells.normals(i).data());
      for (Index axis = 0; axis < 2; ++axis) {
        const SmallVector<D> lifted = frame.lift(SmallVector<D>(SmallVector<D>::Unit(d, k + axis)));
        std::copy_n(lifted.data(), d, axes_.data() + (2 * i + axis) * d);
      }
    }
    Edge<D> edge;
    for (Index x = 0; x < cells.num_cells(); ++x) {
      for (std::uint32_t l = first_link_[static_cast<std::size_t>(x)]; l < first_link_[static_cast<std::size_t>(x) + 1];
           ++l) {
        const auto y = static_cast<Index>(links[l]);
        make_edge<D, K>(point_of(cells, y), point_of(cells, x), d, k, edge);
        // Parallel transport: the tangent of the edge at y becomes its tangent at x, what is across stays.
        const Eigen::Vector2d there = unit(axes(y).transpose() * edge.chord);
        const Eigen::Vector2d here = unit(axes(x).transpose() * edge.chord);
        const double handed = std::copysign(1.0, (axes(x).transpose() * axes(y)).determinant());
        const Eigen::Vector2d position = -edge.length * here;
        const Eigen::Matrix2d turn =
            here * there.transpose() + handed * quarter_turn(here) * quarter_turn(there).transpose();
        links_[l] = {links[l], static_cast<float>(edge.length), position.cast<float>(), turn.cast<float>()};
      }
    }
  });
}

std::optional<std::pair<double, Eigen::Vector2d>> SurfaceCharts::edge(Index source, Index x, double radius) const {
  return with_dimensions(
      cells_.dim(), cells_.codim(), [&]<int D, int K>() -> std::optional<std::pair<double, Eigen::Vector2d>> {
        Edge<D> edge;
        if (!make_edge<D, K>(point_of(cells_, source), point_of(cells_, x), cells_.dim(), cells_.codim(), edge) ||
            edge.chord.squaredNorm() > radius * radius) {
          return std::nullopt;
        }
        return std::pair(edge.length, unit(axes(x).transpose() * edge.chord));
      });
}

ChartMarch::ChartMarch(const SurfaceCharts& charts)
    : charts_(charts),
      radius_(kDirectCells * charts.cell_size()),
      state_(static_cast<std::size_t>(charts.num_cells())) {
  front_.resize(charts.num_cells());
}

void ChartMarch::run(Index source) {
  source_ = source;
  std::fill(state_.begin(), state_.end(), Cell{kInfinity, Eigen::Vector2d::Zero(), false, false});
  offer_direct(source);
  while (!front_.empty()) visit(front_.pop());
}

/// Settles cell i and tells its neighbours, unless it has to wait, or cannot be reached after all.
void ChartMarch::visit(Index i) {
  gather(i);
  Cell& here = cell(i);
  if (here.direct) {
    std::tie(here.distance, here.gradient) = *charts_.edge(source_, i, radius_);
    for (const ChartLink* link : waiting_) offer_direct(link->cell);
  } else {
    const std::optional<Arrival<2>> arrival = solve();
    if (!arrival) return;
    if (!arrival->enclosed && !here.delayed) {
      here.delayed = true;
      front_.set(i, arrival->distance);
      return;
    }
    here.distance = arrival->distance;
    here.gradient = arrival->gradient;
  }
  for (const ChartLink* link : waiting_) offer(*link, here);
}

void ChartMarch::gather(Index i) {
  neighbours_.clear();
  waiting_.clear();
  const bool direct = cell(i).direct;
  for (const ChartLink& link : charts_.links(i)) {
    const Cell& there = cell(link.cell);
    if (!(there.distance < kInfinity)) {
      waiting_.push_back(&link);
    } else if (!direct) {
      const Eigen::Vector2d position = link.position.cast<double>();
      const Eigen::Vector2d gradient = link.turn.cast<double>() * there.gradient;
      const double length = link.length;
      const double along = -gradient.dot(position);
      neighbours_.push_back({position, gradient, there.distance, length, along,
                             circular_estimate2(there.distance, along, length * length), 0});
    }
  }
}

/// The source offers cell j its distance, when j is near enough.
void ChartMarch::offer_direct(Index j) {
  if (cell(j).direct) return;
  const auto direct = charts_.edge(source_, j, radius_);
  if (!direct) return;
  front_.set(j, direct->first);
  cell(j).direct = true;
}

/// A cell, just settled, offers its neighbour what it makes of the distance there.
void ChartMarch::offer(const ChartLink& link, const Cell& here) {
  const Cell& there = cell(link.cell);
  if (there.direct) return;
  const double length = link.length;
  double estimate2 = std::pow(here.distance + length, 2);
  if (!there.delayed) {
    const double along = here.gradient.dot(link.position.cast<double>());
    estimate2 = circular_estimate2(here.distance, along, length * length);
  }
  if (front_.contains(link.cell) && estimate2 >= std::pow(front_.key(link.cell), 2)) return;
  front_.set(link.cell, std::sqrt(estimate2));
}

/// The ray through x passes between two neighbours, one on either side: of those on each side the one whose ray passes
/// x most closely.
std::optional<Arrival<2>> ChartMarch::solve() {
  if (neighbours_.empty()) return std::nullopt;
  const Eigen::Vector2d branch = best_of<2>(neighbours_).gradient;
  const Neighbour<2>* pair[2] = {nullptr, nullptr};  // with the ray to the left and to the right of x
  double miss[2] = {0, 0};
  double least[2] = {kInfinity, kInfinity};
  for (const Neighbour<2>& y : neighbours_) {
    if (y.gradient.dot(branch) < kMinBranchCosine) continue;
    // Those beside or ahead of x only where nobody is behind.
    if (y.along < -kBehind * y.length) continue;
    const double missed = y.gradient(1) * y.position(0) - y.gradient(0) * y.position(1);
    const double measure = std::abs(missed) + (y.along < kBehind * y.length ? 4 * y.length : 0.0);
    const int side = missed >= 0 ? 0 : 1;
    if (measure >= least[side]) continue;
    least[side] = measure;
    miss[side] = missed;
    pair[side] = &y;
  }
  if (pair[0] != nullptr && pair[1] != nullptr && surrounds(*pair[0], miss[0], *pair[1], miss[1])) {
    return arrival_between(*pair[0], miss[0], *pair[1], miss[1]);
  }
  for (Neighbour<2>& y : neighbours_) y.estimate = std::sqrt(y.estimate);
  return arrival_from_one(neighbours_, 2);
}

}  // namespace taut::detail
