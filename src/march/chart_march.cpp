#include "march/chart_march.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "march/dimensions.hpp"
#include "march/edge.hpp"
#include "march/field_reader.hpp"
#include "march/lanes.hpp"
#include "march/tangent_frame.hpp"

namespace taut::detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Cells this part of a cell's size apart in distance may be settled in any order. Edges are shorter than the reach of
/// the front.
constexpr float kBucketsPerCell = 16;
/// Farther than anything, and its square a number.
constexpr float kNever = 1e18F;

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
  for (Index i = 0; i < cells.num_cells(); ++i) most_links_ = std::max(most_links_, this->links(i).size());
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
        const double length = edge.length / cell_size();
        const Eigen::Vector2d position = -length * here;
        const Eigen::Matrix2d turn =
            here * there.transpose() + handed * quarter_turn(here) * quarter_turn(there).transpose();
        links_[l] = {links[l], static_cast<float>(length), position.cast<float>(), turn.cast<float>()};
      }
    }
  });
}

std::optional<std::pair<double, Eigen::Vector2d>> SurfaceCharts::edge(Index source, Index x, double radius) const {
  return with_dimensions(
      cells_.dim(), cells_.codim(), [&]<int D, int K>() -> std::optional<std::pair<double, Eigen::Vector2d>> {
        Edge<D> edge;
        if (!make_edge<D, K>(point_of(cells_, source), point_of(cells_, x), cells_.dim(), cells_.codim(), edge) ||
            edge.chord.norm() > radius * cell_size()) {
          return std::nullopt;
        }
        return std::pair(edge.length / cell_size(), unit(axes(x).transpose() * edge.chord));
      });
}

ChartMarch::Neighbours::Neighbours(std::size_t most) {
  for (std::vector<float>* entries :
       {&position_x, &position_y, &gradient_x, &gradient_y, &distance, &length, &along, &estimate2, &miss}) {
    entries->resize(most + kLanes);
  }
}

void ChartMarch::Neighbours::set(std::size_t n, const Eigen::Vector2f& position_of, const Eigen::Vector2f& gradient_of,
                                 float distance_of, float length_of) {
  position_x[n] = position_of(0);
  position_y[n] = position_of(1);
  gradient_x[n] = gradient_of(0);
  gradient_y[n] = gradient_of(1);
  distance[n] = distance_of;
  length[n] = length_of;
}

Neighbour<2, float> ChartMarch::Neighbours::operator[](std::size_t n) const {
  return {{position_x[n], position_y[n]},
          {gradient_x[n], gradient_y[n]},
          distance[n],
          length[n],
          along[n],
          std::sqrt(estimate2[n]),
          0};
}

ChartMarch::ChartMarch(const SurfaceCharts& charts)
    : charts_(charts),
      front_(charts.num_cells(), 1 / kBucketsPerCell),
      state_(static_cast<std::size_t>(charts.num_cells())),
      settled_(charts.most_links()),
      waiting_(charts.most_links()),
      neighbours_(charts.most_links()) {}

void ChartMarch::run(Index source) {
  source_ = source;
  std::fill(state_.begin(), state_.end(), Cell{kInfinity, Eigen::Vector2f::Zero(), kInfinity, false, false});
  front_.clear();
  offer_direct(source);
  while (!front_.empty()) visit(front_.pop());
}

/// Settles cell i and tells its neighbours, unless it has to wait, or cannot be reached after all.
void ChartMarch::visit(Index i) {
  sort_links(i);
  const std::span waiting(waiting_.data(), num_waiting_);
  Cell& here = cell(i);
  if (here.direct) {
    const auto [length, direction] = *charts_.edge(source_, i, kDirectCells);
    here.distance = static_cast<float>(length);
    here.gradient = direction.cast<float>();
    for (const ChartLink* link : waiting) offer_direct(link->cell);
  } else {
    const std::optional<Arrival<2, float>> arrival = solve(gather());
    if (!arrival) return;
    if (!arrival->enclosed && !here.delayed) {
      here.delayed = true;
      here.offered2 = arrival->distance * arrival->distance;
      front_.set(i, arrival->distance);
      return;
    }
    here.distance = arrival->distance;
    here.gradient = arrival->gradient;
  }
  for (const ChartLink* link : waiting) offer(*link, here);
}

/// Which of the neighbours are settled is as good as random: no branches.
void ChartMarch::sort_links(Index i) {
  num_settled_ = 0;
  num_waiting_ = 0;
  for (const ChartLink& link : charts_.links(i)) {
    const bool settled = cell(link.cell).distance < kInfinity;
    settled_[num_settled_] = &link;
    waiting_[num_waiting_] = &link;
    num_settled_ += settled ? 1 : 0;
    num_waiting_ += settled ? 0 : 1;
  }
}

/// Fills the neighbours; returns the one with the least estimate.
std::size_t ChartMarch::gather() {
  Neighbours& n = neighbours_;
  n.count = num_settled_;
  for (std::size_t j = 0; j < n.count; ++j) {
    const ChartLink& link = *settled_[j];
    const Cell& there = cell(link.cell);
    n.set(j, link.position, link.turn * there.gradient, there.distance, link.length);
  }
  const Eigen::Vector2f zero = Eigen::Vector2f::Zero();
  for (std::size_t j = n.count; j % kLanes != 0; ++j) n.set(j, zero, zero, kNever, 0);
  Least least;
  for (std::size_t j = 0; j < n.count; j += kLanes) {
    const Floats x = load(n.position_x, j);
    const Floats y = load(n.position_y, j);
    const Floats gx = load(n.gradient_x, j);
    const Floats gy = load(n.gradient_y, j);
    const Floats u = load(n.distance, j);
    const Floats length = load(n.length, j);
    const Floats along = -(gx * x + gy * y);
    const Floats estimate2 = u * (u + 2 * along) + length * length;  // as circular_estimate2
    store(along, n.along, j);
    store(gy * x - gx * y, n.miss, j);
    store(estimate2 > 0 ? estimate2 : all_lanes(0), n.estimate2, j);
    least.take(estimate2, j);
  }
  return least.index();
}

/// The source offers cell j its distance, when j is near enough.
void ChartMarch::offer_direct(Index j) {
  if (cell(j).direct) return;
  const auto direct = charts_.edge(source_, j, kDirectCells);
  if (!direct) return;
  front_.set(j, static_cast<float>(direct->first));
  cell(j).direct = true;
  cell(j).offered2 = -kInfinity;
}

/// A cell, just settled, offers its neighbour what it makes of the distance there.
void ChartMarch::offer(const ChartLink& link, const Cell& here) {
  Cell& there = cell(link.cell);
  const float along = here.gradient.dot(link.position);
  float estimate2 = circular_estimate2(here.distance, along, link.length * link.length);
  if (there.delayed) estimate2 = (here.distance + link.length) * (here.distance + link.length);
  if (!(estimate2 < there.offered2)) return;
  there.offered2 = estimate2;
  front_.set(link.cell, std::sqrt(estimate2));
}

/// The ray through x passes between two neighbours, one on either side: of those on each side the one whose ray passes
/// x most closely.
std::optional<Arrival<2, float>> ChartMarch::solve(std::size_t first) {
  const Neighbours& n = neighbours_;
  if (n.count == 0) return std::nullopt;
  const Floats branch_x = all_lanes(n.gradient_x[first]);
  const Floats branch_y = all_lanes(n.gradient_y[first]);
  const Floats never = all_lanes(kInfinity);
  constexpr auto kBranch = static_cast<float>(kMinBranchCosine);
  constexpr auto kBeside = static_cast<float>(kBehind);
  Least least[2];  // with the ray to the left and to the right of x
  for (std::size_t j = 0; j < n.count; j += kLanes) {
    const Floats along = load(n.along, j);
    const Floats length = load(n.length, j);
    const Floats miss = load(n.miss, j);
    const Floats cosine = load(n.gradient_x, j) * branch_x + load(n.gradient_y, j) * branch_y;
    // Those beside or ahead of x only where nobody is behind.
    const Floats penalty = along < kBeside * length ? 4 * length : all_lanes(0);
    Floats measure = (miss < 0 ? -miss : miss) + penalty;
    measure = cosine < kBranch ? never : measure;
    measure = along < -kBeside * length ? never : measure;
    least[0].take(miss < 0 ? never : measure, j);
    least[1].take(miss < 0 ? measure : never, j);
  }
  const std::size_t left = least[0].index();
  const std::size_t right = least[1].index();
  if (least[0].value() < kInfinity && least[1].value() < kInfinity) {
    const Neighbour<2, float> pair[2] = {n[left], n[right]};
    if (surrounds(pair[0], n.miss[left], pair[1], n.miss[right])) {
      return arrival_between(pair[0], n.miss[left], pair[1], n.miss[right]);
    }
  }
  one_by_one_.clear();
  for (std::size_t j = 0; j < n.count; ++j) one_by_one_.push_back(n[j]);
  return arrival_from_one(one_by_one_, 2);
}

}  // namespace taut::detail
