// The march of convergent.cpp for surfaces (d - k = 2) over complete cells, in numbers of two dimensions. Each cell has
// a chart of its tangent plane; the edges from its neighbours are unrolled into it beforehand (surface_charts.hpp). A
// visit turns the neighbours' gradients into the chart, kLanes at a time, and solves the same update as ArrivalSolver.
// Lengths are in cells, in single precision: below the error of a march by far.
//
// The front hands cells out by buckets of 1 / kBucketsPerCell cells, so they are settled in nearly, not exactly, the
// order of their distances. A cell's `offered2` is also its state: kNoOffers once it is settled, has been delayed, or
// was reached by the edge from the source itself. One source, no radius; a goal bounds how far it goes.
#include "march/chart_march.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "march/cell_map.hpp"
#include "march/dimensions.hpp"
#include "march/field_reader.hpp"
#include "march/start.hpp"

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
/// Cells are settled so far past the end, in cells, that all are there that its distance depends on.
constexpr float kPastEnd = 1;
constexpr Index kVisitsPerCheck = 4096;  // about a millisecond

}  // namespace

ChartMarch::ChartMarch(const SurfaceCharts& charts)
    : charts_(charts),
      front_(charts.num_cells(), 1 / kBucketsPerCell),
      state_(static_cast<std::size_t>(charts.num_cells()) + 1) {
  for (std::vector<float>* entries : {&distance_, &gradient_x_, &gradient_y_, &offered2_, &length2_, &along_, &miss_}) {
    entries->resize(charts.most_links());
  }
}

void ChartMarch::run(const SurfacePoint& source, std::span<const Index> around_source, const Context& context,
                     const ChartGoal& goal) {
  source_ = source;
  goal_ = goal;
  reached_ = 0;
  end_ = kInfinity;
  std::fill(state_.begin(), state_.end(), Cell{kInfinity, {0, 0}, kInfinity});
  // The cell past the last, which links are filled up with. It takes no offers, so it never enters the front.
  state_.back().offered2 = kNoOffers;
  front_.clear();
  for (const Index i : around_source) offer_direct(i);
  for (Index visits = 0; !front_.empty() && reached_ <= end_ + kPastEnd; ++visits) {
    if (visits % kVisitsPerCheck == 0) context.check_cancelled();
    visit(front_.pop());
  }
}

/// Settles cell i and tells its neighbours, unless it has to wait, or cannot be reached after all.
void ChartMarch::visit(Index i) {
  const ChartLinks links = charts_.links(i);
  gather(links);
  Cell& here = cell(i);
  const bool waited = here.offered2 == kNoOffers;  // until nobody else came first, or for the source itself
  // A delayed cell near the source may pass for a direct one: then the edge is the better answer as well.
  if (const auto direct = waited ? charts_.edge(source_, i, kDirectCells) : std::nullopt) {
    const auto& [length, direction] = *direct;
    for (std::size_t j = 0; j < links.count; ++j) {
      if (distance_[j] == kInfinity) offer_direct(links.cell[j]);
    }
    settle(i, {length, direction, true, 0}, links);
    return;
  }
  const std::optional<Arrival<2, float>> arrival = solve(links);
  if (!arrival) return;
  // Beside all rays, the distance is known from one neighbour only. The cell waits once behind that longer estimate:
  // cells still in the front may enclose it.
  if (arrival->enclosed || waited) {
    settle(i, *arrival, links);
  } else {
    here.offered2 = kNoOffers;
    front_.set(i, arrival->distance);
  }
}

/// The source offers cell j its distance, when j is near enough.
void ChartMarch::offer_direct(Index j) {
  Cell& there = cell(j);
  // Not a cell, or one that has all it needs.
  if (j == charts_.num_cells() || there.offered2 == kNoOffers) return;
  const auto direct = charts_.edge(source_, j, kDirectCells);
  if (!direct) return;
  front_.set(j, direct->first);
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
    const Floats cosine = load(links.cosine + j);
    const Floats sine = load(links.sine + j);
    // The gradient at y, carried along the edge into this chart.
    const Floats gx = cosine * there_x - sine * there_y;
    const Floats gy = sine * there_x + cosine * there_y;
    const Floats along = -(gx * x + gy * y);
    const Floats length2 = x * x + y * y;
    nearest_.take(u * (u + 2 * along) + length2, j);  // as circular_estimate2
    store(u, &distance_[j]);
    store(gx, &gradient_x_[j]);
    store(gy, &gradient_y_[j]);
    store(offered2, &offered2_[j]);
    store(along, &along_[j]);
    store(length2, &length2_[j]);
    store(gy * x - gx * y, &miss_[j]);
  }
}

/// All but its estimate and its length.
UnrolledNeighbour<2, float> ChartMarch::neighbour(const ChartLinks& links, std::size_t j) const {
  const Eigen::Vector2f position(links.position[0][j], links.position[1][j]);
  return {position, {gradient_x_[j], gradient_y_[j]}, distance_[j], 0, along_[j], 0, 0};
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
  constexpr auto kBeside2 = static_cast<float>(kBehind * kBehind);
  constexpr float kLast = 16;  // more than an edge is long
  Least least[2];              // with the ray to the left and to the right of x
  for (std::size_t j = 0; j < links.count; j += kLanes) {
    const Floats along = load(&along_[j]);
    const Floats length2 = load(&length2_[j]);
    const Floats along2 = along * abs(along);
    const Floats miss = load(&miss_[j]);
    // Zero, as their gradient, for those not settled.
    const Floats cosine = load(&gradient_x_[j]) * branch_x + load(&gradient_y_[j]) * branch_y;
    // Those beside or ahead of x only where nobody is behind.
    const Floats penalty = along2 < kBeside2 * length2 ? kLast + length2 : all_lanes(0);
    Floats measure = abs(miss) + penalty;
    measure = cosine < kBranch ? never : measure;
    measure = along2 < -kBeside2 * length2 ? never : measure;
    least[0].take(miss < 0 ? never : measure, j);
    least[1].take(miss < 0 ? measure : never, j);
  }
  if (least[0].value() < kInfinity && least[1].value() < kInfinity) {
    const std::size_t left = least[0].index();
    const std::size_t right = least[1].index();
    const UnrolledNeighbour<2, float> pair[2] = {neighbour(links, left), neighbour(links, right)};
    if (surrounds(pair[0], miss_[left], pair[1], miss_[right])) {
      return arrival_between(pair[0], miss_[left], pair[1], miss_[right]);
    }
  }
  one_by_one_.clear();
  for (std::size_t j = 0; j < links.count; ++j) {
    if (!(distance_[j] < kInfinity)) continue;
    UnrolledNeighbour<2, float>& y = one_by_one_.emplace_back(neighbour(links, j));
    y.length = y.position.norm();
    y.estimate = std::sqrt(circular_estimate2(y.distance, y.along, y.length * y.length));
  }
  return arrival_from_one(one_by_one_, 2);
}

/// The cell offers its neighbours what it makes of the distances there.
void ChartMarch::settle(Index i, const Arrival<2, float>& arrival, const ChartLinks& links) {
  Cell& here = cell(i);
  here = {arrival.distance, {arrival.gradient(0), arrival.gradient(1)}, kNoOffers};
  reached_ = std::max(reached_, here.distance);
  if (goal_.end) watch(i, here.distance);
  const Floats u = all_lanes(here.distance);
  const Floats gx = all_lanes(here.gradient[0]);
  const Floats gy = all_lanes(here.gradient[1]);
  for (std::size_t j = 0; j < links.count; j += kLanes) {
    const Floats along = gx * load(links.position[0] + j) + gy * load(links.position[1] + j);
    Floats estimate2 = u * (u + 2 * along) + load(&length2_[j]);  // as circular_estimate2
    estimate2 = estimate2 > 0 ? estimate2 : all_lanes(0);
    // Better by kWorthwhile, squared. What came in since they were gathered is the source's own offers.
    unsigned better = bits(estimate2 < load(&offered2_[j]) - 2 * kWorthwhile * u);
    for (; better != 0; better &= better - 1) {
      const auto l = static_cast<std::size_t>(std::countr_zero(better));
      const Index j_there = links.cell[j + l];
      Cell& there = cell(j_there);
      const float estimate = std::sqrt(estimate2[l]);
      if (there.offered2 == kNoOffers || leads_astray(j_there, estimate)) continue;
      there.offered2 = estimate2[l];
      front_.set(j_there, estimate);
    }
  }
}

/// Cell i is settled: by it, the end may be nearer than was known.
void ChartMarch::watch(Index i, float distance) {
  if (std::ranges::find(goal_.around_end, i) == goal_.around_end.end()) return;
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  // The edge's length is the same from either end; its direction is not used.
  if (const auto last = charts_.edge(*goal_.end, i, kAnywhere)) end_ = std::min(end_, distance + last->first);
}

/// Is a path through cell i, that far from the source, too long before it reaches the end.
bool ChartMarch::leads_astray(Index i, float distance) const {
  if (!(goal_.longest < std::numeric_limits<double>::infinity())) return false;
  const Eigen::Map<const Vector> end(goal_.end->x, charts_.cells().dim());
  // The straight line bounds the rest of the way from below, so no path that may be wanted is lost.
  return distance + (charts_.cells().point(i) - end).norm() / charts_.cell_size() > goal_.longest;
}

void march_in_charts(const MarchTask& task, const SurfaceCharts& charts, DistanceField& field) {
  const SurfaceCells& cells = charts.cells();
  const double h = cells.grid().size();
  const SurfacePoint source{field.sources.data(), field.source_normals.data()};
  ChartGoal goal;
  std::vector<Index> around_end;
  if (task.options.target) {
    goal.end = SurfacePoint{task.options.target->data(), task.target_normals.data()};
    around_end = cells_around(cells, *task.options.target);
    goal.around_end = around_end;
    goal.longest = task.options.longest / h;
  }
  ChartMarch march(charts);
  march.run(source, cells_around_source(cells, field.sources.col(0)), task.context, goal);
  const Index n = cells.num_cells();
  field.distance.resize(n);
  field.gradient.setZero(cells.dim(), n);
  field.nearest_source.assign(static_cast<std::size_t>(n), -1);
  for (Index i = 0; i < n; ++i) {
    // From cells to model units; infinity stays infinity.
    field.distance(i) = h * static_cast<double>(march.distance(i));
    if (!(march.distance(i) < kInfinity)) continue;
    ++field.num_reached;
    field.nearest_source[static_cast<std::size_t>(i)] = 0;
    field.gradient.col(i) = (charts.axes(i) * march.gradient(i)).cast<double>();
  }
  if (!task.options.target) return;
  // Read from the finished field as any other point would be, in double precision.
  field.target_distance = with_dimensions(cells.dim(), cells.codim(), [&]<int D, int K>() {
    return FieldReader<D, K>(cells, field, task.map).distance(*goal.end);
  });
}

}  // namespace taut::detail
