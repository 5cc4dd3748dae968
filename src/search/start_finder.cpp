// Starts between two points, four ways. By the table of landmarks (many pairs on a surface); by distance fields from
// both ends over cells, with all rivals; by one field and a descent, where rivals are
// not asked for; by walks, where there are no cells. A table is made where it costs less than marching for the pairs to
// come: on cells as coarse as the bends allow, with as few landmarks as tell ways apart, and it is believed only as far
// as sampled geodesics bear it out.
#include "search/start_finder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "curve/polyline.hpp"
#include "search/march_check.hpp"
#include "search/normal_turns.hpp"
#include "search/start_rules.hpp"
#include "taut/curve/newton.hpp"
#include "taut/march/march.hpp"
#include "walk/find_ways.hpp"

namespace taut::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Do p and q lie in cells with different labels.
bool in_two(SurfaceCells& cells, const std::vector<std::int32_t>& label, const Vector& p, const Vector& q) {
  const Index i = cells.cell_at(p);
  const Index j = cells.cell_at(q);
  if (i == CellGrid::kNone || j == CellGrid::kNone) return false;
  return label[static_cast<std::size_t>(i)] != label[static_cast<std::size_t>(j)];
}

/// Centres of the cells that one of the fields has come to.
Points walked_cells(const CellGrid& grid, const DistanceField& from_p, const std::optional<DistanceField>& from_q) {
  const auto reached = [](const DistanceField& field, Index i) {
    return i < field.distance.size() && std::isfinite(field.distance(i));
  };
  std::vector<Index> walked;
  for (Index i = 0; i < grid.num_cells(); ++i) {
    if (reached(from_p, i) || (from_q && reached(*from_q, i))) walked.push_back(i);
  }
  Points centres(grid.dim(), static_cast<Index>(walked.size()));
  for (std::size_t j = 0; j < walked.size(); ++j) centres.col(static_cast<Index>(j)) = grid.centre(walked[j]);
  return centres;
}

}  // namespace

StartFinder::StartFinder(const Surface& surface, const PathOptions& options, const Context& context)
    : surface_(surface),
      options_(options),
      context_(context),
      levels_(surface, {options.grid, options.cell, options.seeds}, context) {}

Ground StartFinder::ground(int level, const PointsIn& seeds) const {
  if (options_.envelope != 0) return {levels_.envelope(level, options_.envelope), nullptr, nullptr};
  std::shared_ptr<SurfaceCells> cells = levels_.cells(level, seeds);
  return {std::move(cells), levels_.map(level), levels_.sharp_bends(level)};
}

bool StartFinder::bends_sharply(int level, const Points& curve) const {
  const std::shared_ptr<const SharpBends> bends = levels_.sharp_bends(level);
  return bends && bends->along(curve);
}

void StartFinder::tabulate(Index num_pairs) {
  if (!levels_.exist()) return;
  const Index dim = surface_.dim() - surface_.codim();
  const bool suits = dim == 2 && options_.march == MarchMethod::convergent && !options_.all && options_.cell == 0 &&
                     options_.method != CorrectionMethod::grid && !options_.keep_cells;
  if (levels_.lazy()) return;
  const std::shared_ptr<SurfaceCells> fine = levels_.cells(0, Points(surface_.dim(), 0));
  if (table_ || !suits) return;
  const auto num_fine = static_cast<double>(fine->num_valid());
  // Two marches a pair, each over about all cells; a table takes one march of its own cells a landmark.
  const double most_work = kTableRules.worthwhile * static_cast<double>(num_pairs) * 2 * num_fine;
  std::optional<MarchCheck> check;
  // As coarse as it may be: the turn need not grow with the cells' size, where a rim is involved it jumps.
  for (double coarser = std::max(1.0, std::sqrt(num_fine / kTableRules.fewest_cells)); !table_;
       coarser /= kTableRules.refinement) {
    const bool finest = coarser <= 1;
    std::shared_ptr<SurfaceCells> cells = levels_.subdivided(std::max(1.0, coarser) * levels_.size(0));
    if (!cells) return;
    NormalTurns turns(*cells, context_);
    const double turn = turns.quantile(kTableRules.turn_quantile);
    if ((turn > kTableRules.turn || !turns.make_a_sheet()) && !finest) continue;
    if (!turns.make_a_sheet()) return;
    if (!finest) {
      if (!check) check.emplace(surface_, *fine, context_);
      if (check->quantile(*cells, kTableRules.checked_part) > kTableRules.wrong) continue;
    }
    const auto num_cells = static_cast<double>(cells->num_valid());
    const double num_landmarks = std::clamp(kTableRules.landmarks_per_turn2 * num_cells * turn * turn,
                                            std::min(kTableRules.fewest_landmarks, num_cells), num_cells);
    if (num_landmarks * num_cells > most_work) return;
    DistanceTable table(surface_, std::move(*cells), static_cast<Index>(num_landmarks), context_);
    const TableError error = measure_error(table);
    const double wrong = std::max(error.too_long, error.too_short);
    // On the finest cells the table is kept with the error it has: nothing better is to be had.
    if (wrong > kTableRules.wrong && !finest) continue;
    table_ = std::move(table);
    table_error_ = std::clamp(kTableRules.safety * wrong, kTableRules.wrong, kRivalRules.excess);
    table_doubt_ = std::clamp(kTableRules.doubt_safety * error.too_short, kTableRules.least_doubt, kTableRules.wrong);
  }
}

/// How wrong a table is: the worst of some ways between landmarks far apart.
StartFinder::TableError StartFinder::measure_error(const DistanceTable& table) const {
  NewtonSolver newton(surface_, {.tolerance = kTableRules.ways_tolerance});
  const Index n = table.num_landmarks();
  TableError worst;
  for (Index way = 0; way < kTableRules.ways; ++way) {
    const Index from = way * n / kTableRules.ways;
    for (Index other = 0; other < kTableRules.ways; ++other) {  // until one lies on the same component, and far enough
      const Index to = (from + n / 2 + other * n / kTableRules.ways) % n;
      const std::vector<StartPath> starts =
          table.start_paths(table.landmark(from), table.landmark(to), {.excess = kTableRules.wrong, .max_paths = 1});
      if (starts.empty()) continue;
      const NewtonResult geodesic = newton.solve(starts.front().points, context_);
      if (geodesic.status != Status::ok) continue;
      const double error = starts.front().length / geodesic.length - 1;
      worst.too_long = std::max(worst.too_long, error);
      worst.too_short = std::max(worst.too_short, -error);
      break;
    }
  }
  return worst;
}

Starts StartFinder::find_by_table(const Vector& p, const Vector& q) const {
  Starts starts;
  if (!table_) return starts;
  const Stopwatch watch;
  starts.paths = table_->start_paths(p, q, {.excess = table_error_, .max_paths = kRivalRules.most});
  starts.cell = table_->cells().grid().size();
  starts.doubt = table_doubt_;
  starts.seconds.march = watch.seconds();
  return starts;
}

Starts StartFinder::walk(const Vector& p, const Vector& q) const {
  const Stopwatch watch;
  Starts starts;
  Ways ways = find_ways(surface_, p, q, options_.all, context_);
  if (ways.sought == Ways::Sought::any) starts.doubts.add(Doubt::rivals_not_sought);
  if (ways.sought == Ways::Sought::at_random) starts.doubts.add(Doubt::random_search);
  starts.error = kInfinity;  // how long a walk is says little
  for (Points& way : ways.paths) {
    const double length = polyline_length(way);
    starts.paths.push_back({length, std::move(way)});
  }
  std::ranges::sort(starts.paths, {}, &StartPath::length);
  starts.seconds.march = watch.seconds();
  return starts;
}

Starts StartFinder::find(const Vector& p, const Vector& q, int level) const {
  if (!levels_.exist()) return walk(p, q);
  const Stopwatch watch;
  const Ground ground = this->ground(level, chord(p, q));
  const double cells_seconds = watch.seconds();
  // No rival is longer than this, by the table.
  double longest = kInfinity;
  if (table_) {
    const double bound = table_->upper_bound(p, q);
    longest =
        (1 + kRivalRules.excess) * (1 + table_error_) * bound + kRivalRules.margin_cells * ground.cells->grid().size();
  }
  Starts starts = find_within(longest, ground, p, q);
  // What the table's coarse cells took for a way may be none.
  if (starts.paths.empty() && longest < kInfinity) starts = find_within(kInfinity, ground, p, q);
  starts.seconds.cells += cells_seconds;
  return starts;
}

Starts StartFinder::find_within(double longest, const Ground& ground, const Vector& p, const Vector& q) const {
  const Stopwatch watch;
  DistanceField from_p;
  std::optional<DistanceField> from_q;
  if (seeks_rivals() && !ground.cells->is_lazy() &&
      (p - q).norm() > kRivalRules.near_cells * ground.cells->grid().size()) {
    from_q.emplace();
    parallel_for(context_, 0, 2, 1, [&](Index first, Index last) {
      // A range may hold both: first = 0, last = 2 on one thread.
      if (first == 0) from_p = march_towards(ground, p, q, longest);
      if (last == 2) from_q = march_towards(ground, q, p, longest);
    });
  } else {
    from_p = march_towards(ground, p, q, longest);
  }
  const double march_seconds = watch.seconds();
  Starts starts = continue_to(ground, from_p, q, std::move(from_q));
  starts.seconds.march += march_seconds;
  return starts;
}

bool StartFinder::seeks_rivals() const {
  return options_.march == MarchMethod::convergent && options_.method != CorrectionMethod::grid;
}

DistanceField StartFinder::march_towards(const Ground& ground, const Vector& source, const Vector& target,
                                         double longest) const {
  MarchOptions march_options{.method = options_.march, .longest = longest};
  if (!options_.all) march_options.target = target;
  return march_over(surface_, *ground.cells, ground.map.get(), source, march_options, context_);
}

DistanceField StartFinder::march_all(const Ground& ground, const Vector& p) const {
  return march(surface_, *ground.cells, p, MarchOptions{.method = options_.march}, context_);
}

Starts StartFinder::continue_to(const Ground& ground, const DistanceField& from_p, const Vector& q,
                                std::optional<DistanceField> from_q) const {
  const Stopwatch watch;
  SurfaceCells& cells = *ground.cells;
  Starts starts;
  starts.cell = cells.grid().size();
  const Vector p = from_p.sources.col(0);
  const double distance = distance_at(surface_, cells, from_p, q)(0);
  const bool arrives = std::isfinite(distance);
  starts.marched = distance;
  if (from_p.at_centres) starts.doubt = kInfinity;  // such distances are too long or too short by far
  const bool rivals = arrives && seeks_rivals() && (options_.all || distance > kRivalRules.near_cells * starts.cell);
  if (!arrives || !seeks_rivals()) starts.doubts.add(Doubt::rivals_not_sought);
  if (rivals) {
    if (!from_q) from_q = march_towards(ground, q, p, kInfinity);
    StartPathOptions options{.excess = kRivalRules.excess, .max_paths = kRivalRules.most};
    if (options_.all) options = {.excess = kInfinity, .max_paths = kRivalRules.most_of_all};
    if (ground.bends && ground.bends->any()) options.spread = kRivalRules.spread_over_bends;
    starts.paths = start_paths_over(surface_, cells, ground.map.get(), from_p, *from_q, options, context_);
  }
  if (arrives && starts.paths.empty()) {
    Points descent = descend_over(surface_, cells, ground.map.get(), from_p, q);
    if (descent.cols() >= 2) starts.paths.push_back({distance, std::move(descent)});
  }
  if (starts.paths.empty()) starts.barrier = find_barrier(cells, from_p, q);
  starts.cells = ground.cells;
  if (options_.keep_cells) starts.walked = walked_cells(cells.grid(), from_p, from_q);
  starts.seconds.march = watch.seconds();
  return starts;
}

bool StartFinder::apart(SurfaceCells& cells, int level, const Vector& p, const Vector& q) const {
  if (!cells.is_lazy()) return in_two(*levels_.cells(level, chord(p, q)), *levels_.components(level), p, q);
  return true;  // lazy cells have grown until there were no more
}

bool StartFinder::known_to_be_apart(int level, const Vector& p, const Vector& q) const {
  const std::shared_ptr<const std::vector<std::int32_t>> labels = levels_.known_components(level);
  return labels && in_two(*levels_.cells(level, chord(p, q)), *labels, p, q);
}

}  // namespace taut::detail
