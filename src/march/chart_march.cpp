#include "march/chart_march.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

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
/// An offer that is better by no more than this part of a cell's size is not worth the trouble.
constexpr float kWorthwhile = 0.25F;
/// Square of what no offer can be better than.
constexpr float kNoOffers = -kInfinity;

SurfacePoint point_of(const SurfaceCells& cells, Index i) { return {cells.point(i).data(), cells.normals(i).data()}; }

Eigen::Vector2d unit(const Eigen::Vector2d& v) {
  const double norm = v.norm();
  return norm > 0 ? Eigen::Vector2d(v / norm) : v;
}

Eigen::Vector2d quarter_turn(const Eigen::Vector2d& v) { return {-v(1), v(0)}; }

}  // namespace

SurfaceCharts::SurfaceCharts(const SurfaceCells& cells, const std::vector<std::uint32_t>& first_link,
                             const std::vector<std::uint32_t>& links)
    : cells_(cells), axes_(static_cast<std::size_t>(2 * cells.dim() * cells.num_cells())), first_link_(1, 0) {
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
    const auto none = static_cast<std::uint32_t>(cells.num_cells());
    for (Index x = 0; x < cells.num_cells(); ++x) {
      const std::size_t first = first_link[static_cast<std::size_t>(x)];
      const std::size_t count = first_link[static_cast<std::size_t>(x) + 1] - first;
      const std::size_t in_lanes = (count + kLanes - 1) / kLanes * kLanes;
      most_links_ = std::max(most_links_, in_lanes);
      linked_.resize(linked_.size() + in_lanes, none);
      numbers_.resize(kNumbers * linked_.size(), 0);
      std::uint32_t* linked = linked_.data() + first_link_.back();
      float* numbers = numbers_.data() + kNumbers * first_link_.back();
      first_link_.push_back(static_cast<std::uint32_t>(linked_.size()));
      for (std::size_t l = 0; l < count; ++l) {
        const auto y = static_cast<Index>(links[first + l]);
        make_edge<D, K>(point_of(cells, y), point_of(cells, x), d, k, edge);
        // Parallel transport: the tangent of the edge at y becomes its tangent at x, what is across stays.
        const Eigen::Vector2d there = unit(axes(y).transpose() * edge.chord);
        const Eigen::Vector2d here = unit(axes(x).transpose() * edge.chord);
        const double handed = std::copysign(1.0, (axes(x).transpose() * axes(y)).determinant());
        const double length = edge.length / cell_size();
        const Eigen::Vector2d position = -length * here;
        const Eigen::Matrix2d turn =
            here * there.transpose() + handed * quarter_turn(here) * quarter_turn(there).transpose();
        const double all[kNumbers] = {length, position(0), position(1), turn(0, 0), turn(0, 1), turn(1, 0), turn(1, 1)};
        linked[l] = static_cast<std::uint32_t>(y);
        for (std::size_t n = 0; n < kNumbers; ++n) numbers[n * in_lanes + l] = static_cast<float>(all[n]);
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

ChartMarch::ChartMarch(const SurfaceCharts& charts)
    : charts_(charts),
      front_(charts.num_cells(), 1 / kBucketsPerCell),
      state_(static_cast<std::size_t>(charts.num_cells()) + 1) {
  for (std::vector<float>* entries : {&distance_, &gradient_x_, &gradient_y_, &offered2_, &along_, &miss_}) {
    entries->resize(charts.most_links());
  }
}

void ChartMarch::run(Index source) {
  source_ = source;
  std::fill(state_.begin(), state_.end(), Cell{kInfinity, {0, 0}, kInfinity});
  state_.back().offered2 = kNoOffers;
  front_.clear();
  offer_direct(source);
  while (!front_.empty()) visit(front_.pop());
}

/// Settles cell i and tells its neighbours, unless it has to wait, or cannot be reached after all.
void ChartMarch::visit(Index i) {
  const ChartLinks links = charts_.links(i);
  gather(links);
  Cell& here = cell(i);
  const bool waited = here.offered2 == kNoOffers;  // until nobody else came first, or for the source itself
  if (const auto direct = waited ? charts_.edge(source_, i, kDirectCells) : std::nullopt) {
    const auto& [length, direction] = *direct;
    for (std::size_t j = 0; j < links.count; ++j) {
      if (distance_[j] == kInfinity) offer_direct(links.cell[j]);
    }
    settle(here, {static_cast<float>(length), direction.cast<float>(), true, 0}, links);
    return;
  }
  const std::optional<Arrival<2, float>> arrival = solve(links);
  if (!arrival) return;
  if (arrival->enclosed || waited) {
    settle(here, *arrival, links);
  } else {
    here.offered2 = kNoOffers;
    front_.set(i, arrival->distance);
  }
}

/// The source offers cell j its distance, when j is near enough.
void ChartMarch::offer_direct(Index j) {
  Cell& there = cell(j);
  if (j == charts_.num_cells() || there.offered2 == kNoOffers) return;
  const auto direct = charts_.edge(source_, j, kDirectCells);
  if (!direct) return;
  front_.set(j, static_cast<float>(direct->first));
  there.offered2 = kNoOffers;
}

/// Fills the neighbours.
void ChartMarch::gather(const ChartLinks& links) {
  nearest_ = {};
  for (std::size_t j = 0; j < links.count; j += kLanes) {
    const auto there = [&](std::size_t l) { return load(&cell(links.cell[j + l]).distance); };
    Floats u = there(0);
    Floats there_x = there(1);
    Floats there_y = there(2);
    Floats offered2 = there(3);
    transpose(u, there_x, there_y, offered2);
    const Floats x = load(links.position[0] + j);
    const Floats y = load(links.position[1] + j);
    const Floats length = load(links.length + j);
    const Floats gx = load(links.turn[0][0] + j) * there_x + load(links.turn[0][1] + j) * there_y;
    const Floats gy = load(links.turn[1][0] + j) * there_x + load(links.turn[1][1] + j) * there_y;
    const Floats along = -(gx * x + gy * y);
    nearest_.take(u * (u + 2 * along) + length * length, j);  // as circular_estimate2
    store(u, &distance_[j]);
    store(gx, &gradient_x_[j]);
    store(gy, &gradient_y_[j]);
    store(offered2, &offered2_[j]);
    store(along, &along_[j]);
    store(gy * x - gx * y, &miss_[j]);
  }
}

/// All but its estimate.
Neighbour<2, float> ChartMarch::neighbour(const ChartLinks& links, std::size_t j) const {
  return {{links.position[0][j], links.position[1][j]},
          {gradient_x_[j], gradient_y_[j]},
          distance_[j],
          links.length[j],
          along_[j],
          0,
          0};
}

/// The ray through x passes between two neighbours, one on either side: of those on each side the one whose ray passes
/// x most closely.
std::optional<Arrival<2, float>> ChartMarch::solve(const ChartLinks& links) {
  if (!(nearest_.value() < kInfinity)) return std::nullopt;
  const std::size_t first = nearest_.index();
  const Floats branch_x = all_lanes(gradient_x_[first]);
  const Floats branch_y = all_lanes(gradient_y_[first]);
  const Floats never = all_lanes(kInfinity);
  constexpr auto kBranch = static_cast<float>(kMinBranchCosine);
  constexpr auto kBeside = static_cast<float>(kBehind);
  Least least[2];  // with the ray to the left and to the right of x
  for (std::size_t j = 0; j < links.count; j += kLanes) {
    const Floats along = load(&along_[j]);
    const Floats length = load(links.length + j);
    const Floats miss = load(&miss_[j]);
    // Zero, as their gradient, for those not settled.
    const Floats cosine = load(&gradient_x_[j]) * branch_x + load(&gradient_y_[j]) * branch_y;
    // Those beside or ahead of x only where nobody is behind.
    const Floats penalty = along < kBeside * length ? 4 * length : all_lanes(0);
    Floats measure = (miss < 0 ? -miss : miss) + penalty;
    measure = cosine < kBranch ? never : measure;
    measure = along < -kBeside * length ? never : measure;
    least[0].take(miss < 0 ? never : measure, j);
    least[1].take(miss < 0 ? measure : never, j);
  }
  if (least[0].value() < kInfinity && least[1].value() < kInfinity) {
    const std::size_t left = least[0].index();
    const std::size_t right = least[1].index();
    const Neighbour<2, float> pair[2] = {neighbour(links, left), neighbour(links, right)};
    if (surrounds(pair[0], miss_[left], pair[1], miss_[right])) {
      return arrival_between(pair[0], miss_[left], pair[1], miss_[right]);
    }
  }
  one_by_one_.clear();
  for (std::size_t j = 0; j < links.count; ++j) {
    if (!(distance_[j] < kInfinity)) continue;
    Neighbour<2, float>& y = one_by_one_.emplace_back(neighbour(links, j));
    y.estimate = std::sqrt(circular_estimate2(y.distance, y.along, y.length * y.length));
  }
  return arrival_from_one(one_by_one_, 2);
}

/// The cell offers its neighbours what it makes of the distances there.
void ChartMarch::settle(Cell& here, const Arrival<2, float>& arrival, const ChartLinks& links) {
  here = {arrival.distance, {arrival.gradient(0), arrival.gradient(1)}, kNoOffers};
  const Floats u = all_lanes(here.distance);
  const Floats gx = all_lanes(here.gradient[0]);
  const Floats gy = all_lanes(here.gradient[1]);
  for (std::size_t j = 0; j < links.count; j += kLanes) {
    const Floats length = load(links.length + j);
    const Floats along = gx * load(links.position[0] + j) + gy * load(links.position[1] + j);
    Floats estimate2 = u * (u + 2 * along) + length * length;  // as circular_estimate2
    estimate2 = estimate2 > 0 ? estimate2 : all_lanes(0);
    // Better by kWorthwhile, squared. What came in since they were gathered is the source's own offers.
    unsigned better = bits(estimate2 < load(&offered2_[j]) - 2 * kWorthwhile * u);
    for (; better != 0; better &= better - 1) {
      const auto l = static_cast<std::size_t>(std::countr_zero(better));
      const Index j_there = links.cell[j + l];
      Cell& there = cell(j_there);
      if (there.offered2 == kNoOffers) continue;
      there.offered2 = estimate2[l];
      front_.set(j_there, std::sqrt(estimate2[l]));
    }
  }
}

}  // namespace taut::detail
