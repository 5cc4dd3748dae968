// Distances between many points.
//
// Cells are made once, for the size of the fans' panels and for the components; then every row is a fan of its own, on
// a thread of its own. What fans leave open is answered path by path, block by block, over one table of starts.

#include "taut/query/distance_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "fan/fan_answers.hpp"
#include "fan/geodesic_fan.hpp"
#include "search/cell_levels.hpp"
#include "strata/faceted_surface.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"

namespace taut {

using detail::GeodesicFan;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostMessages = 5;
/// Paths that are held at a time.
constexpr std::size_t kPathsAtOnce = 4096;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

}  // namespace

struct DistanceMatrix::Impl {
  Surface surface;
  MatrixOptions options;
  Context context;
  Points points, targets;  // on the surface
  bool symmetric;
  double panel = 0;                                   // 0: no fans
  std::vector<std::int32_t> point_part, target_part;  // components; -1 = not known
  std::optional<PathSolver> paths;
  std::vector<std::string> messages;

  struct Pair {
    std::size_t row;   // of the block
    std::size_t slot;  // in the row
  };

  Impl(Surface s, const PointsIn& from, const PointsIn* to, const MatrixOptions& o, Context c)
      : surface(std::move(s)), options(o), context(std::move(c)), symmetric(to == nullptr) {
    (void)DistanceSolver(surface, from.leftCols(std::min<Index>(1, from.cols())), {}, options.distance,
                         context);  // checks
    if (options.k_nearest < 0) throw InvalidArgument("k_nearest must not be negative");
    if (to != nullptr && to->rows() != surface.dim()) {
      throw InvalidArgument(
          fmt::format("the targets have {} coordinates, the surface lies in {} dimensions", to->rows(), surface.dim()));
    }
    detail::CellLevels levels(surface, {options.distance.grid, options.distance.cell, options.distance.seeds}, context);
    Points all(from.rows(), from.cols() + (to != nullptr ? to->cols() : 0));
    all.leftCols(from.cols()) = from;
    if (to != nullptr) all.rightCols(to->cols()) = *to;
    for (Index j = 0; j < all.cols(); ++j) detail::check_point(surface, all.col(j), "point");
    levels.prepare(all);
    for (Index j = 0; j < all.cols(); ++j) {
      const bool target = j >= from.cols();
      const std::string name = fmt::format("{} {}", target ? "target" : "point", target ? j - from.cols() : j);
      all.col(j) = levels.on_surface(all.col(j), name.c_str());
    }
    points = all.leftCols(from.cols());
    targets = to != nullptr ? Points(all.rightCols(to->cols())) : points;
    if (surface.dim() == 3 && surface.codim() == 1 && !detail::is_kinked(surface)) find_panel(levels);
  }

  void find_panel(detail::CellLevels& levels) {
    const std::shared_ptr<SurfaceCells> cells = levels.cells(0, points);
    panel = detail::kPanelCells * levels.size(0);
    const std::shared_ptr<const std::vector<std::int32_t>> label = levels.components(0);
    const auto parts = [&](const Points& x) {
      std::vector<std::int32_t> result(at(x.cols()), -1);
      for (Index j = 0; j < x.cols(); ++j) {
        const Index cell = cells->grid().find_point(x.col(j));
        if (cell != CellGrid::kNone) result[at(j)] = (*label)[at(cell)];
      }
      return result;
    };
    point_part = parts(points);
    target_part = symmetric ? point_part : parts(targets);
  }

  /// On another component: there is no path, that is proved.
  [[nodiscard]] bool apart(Index i, Index j) const {
    return panel > 0 && point_part[at(i)] >= 0 && target_part[at(j)] >= 0 && point_part[at(i)] != target_part[at(j)];
  }

  /// The columns a row may hold.
  [[nodiscard]] std::vector<Index> columns(Index i) const {
    std::vector<Index> result;
    const bool upper = symmetric && options.k_nearest == 0;
    for (Index j = upper ? i + 1 : 0; j < targets.cols(); ++j) {
      if (!(symmetric && j == i)) result.push_back(j);
    }
    return result;
  }

  /// By a fan; NaN where it leaves a target open. With k_nearest, targets that are certainly not among them are left
  /// out.
  [[nodiscard]] MatrixRow by_fan(Index i, const Context& own) const {
    MatrixRow row{.row = i, .column = columns(i), .distance = {}, .error = {}};
    row.distance.assign(row.column.size(), kNaN);
    row.error.assign(row.column.size(), kInfinity);
    if (panel == 0) return row;
    GeodesicFan fan(surface, points.col(i), Vector::Zero(1),
                    {.tolerance = options.distance.tolerance,
                     .max_panel = panel,
                     .max_patches = options.distance.max_patches,
                     .max_evaluated = detail::most_evaluated(surface)});
    std::vector<std::size_t> asked;
    for (std::size_t s = 0; s < row.column.size(); ++s) {
      if (apart(i, row.column[s]) || straight(i, row.column[s]) > options.distance.max_distance) {
        row.distance[s] = kInfinity;
      } else {
        asked.push_back(s);
      }
    }
    double limit = options.distance.max_distance;
    const std::size_t k = at(options.k_nearest);
    if (k > 0 && k < asked.size()) limit = std::min(limit, kth_straight(i, row, asked, k));
    while (true) {
      const std::vector<detail::FanAnswer> answers = ask(fan, i, row, asked, limit, own);
      std::size_t near = 0;
      bool open = false;
      for (std::size_t a = 0; a < asked.size(); ++a) {
        const std::size_t s = asked[a];
        row.distance[s] = kNaN;
        row.error[s] = kInfinity;
        if (answers[a].kind == detail::FanAnswer::Kind::proved) {
          row.distance[s] = answers[a].hit.distance;
          row.error[s] = answers[a].hit.error;
          ++near;
        } else if (answers[a].kind == detail::FanAnswer::Kind::beyond) {
          row.distance[s] = kInfinity;
        } else {
          open = true;
        }
      }
      constexpr double kGrowth = 1.3;
      if (k == 0 || near >= std::min(k, asked.size()) || open || !(limit < options.distance.max_distance)) break;
      limit = std::min(options.distance.max_distance, kGrowth * limit);
    }
    if (k > 0) drop_far(i, row, k);
    return row;
  }

  [[nodiscard]] double straight(Index i, Index j) const { return (targets.col(j) - points.col(i)).norm(); }

  /// What a fan left open and is farther even straight than k others is none of the k nearest.
  void drop_far(Index i, MatrixRow& row, std::size_t k) const {
    std::vector<double> known;
    for (const double u : row.distance) {
      if (std::isfinite(u)) known.push_back(u);
    }
    if (known.size() < k) return;
    std::ranges::nth_element(known, known.begin() + static_cast<std::ptrdiff_t>(k) - 1);
    for (std::size_t s = 0; s < row.column.size(); ++s) {
      if (std::isnan(row.distance[s]) && straight(i, row.column[s]) > known[k - 1]) row.distance[s] = kInfinity;
    }
  }

  /// No k targets are nearer than this: distances are at least straight ones.
  [[nodiscard]] double kth_straight(Index i, const MatrixRow& row, const std::vector<std::size_t>& asked,
                                    std::size_t k) const {
    std::vector<double> chord;
    for (const std::size_t s : asked) chord.push_back(straight(i, row.column[s]));
    std::ranges::nth_element(chord, chord.begin() + static_cast<std::ptrdiff_t>(k) - 1);
    constexpr double kBent = 1.1;
    return std::max(kBent * chord[k - 1], std::numeric_limits<double>::min());
  }

  [[nodiscard]] std::vector<detail::FanAnswer> ask(GeodesicFan& fan, Index i, const MatrixRow& row,
                                                   const std::vector<std::size_t>& asked, double limit,
                                                   const Context& own) const {
    Points x(3, static_cast<Index>(asked.size()));
    for (Index a = 0; a < x.cols(); ++a) x.col(a) = targets.col(row.column[asked[at(a)]]);
    return detail::ask_fan(fan, surface, points.col(i), Vector::Zero(1), x, limit, own);
  }

  /// Corrected paths for what is still NaN.
  void by_paths(std::vector<MatrixRow>& block) {
    std::vector<Pair> open;
    for (std::size_t r = 0; r < block.size(); ++r) {
      for (std::size_t s = 0; s < block[r].column.size(); ++s) {
        if (std::isnan(block[r].distance[s])) open.push_back({r, s});
      }
    }
    if (open.empty() || !options.distance.paths) return;
    if (!paths) {
      paths.emplace(surface,
                    PathOptions{.march = options.distance.march,
                                .grid = options.distance.grid,
                                .cell = options.distance.cell,
                                .seeds = options.distance.seeds,
                                .tolerance = options.distance.tolerance},
                    context);
      // As if all were to be asked for, so that it does not matter which rows are.
      Points all(points.rows(), points.cols() + (symmetric ? 0 : targets.cols()));
      all.leftCols(points.cols()) = points;
      if (!symmetric) all.rightCols(targets.cols()) = targets;
      paths->expect(all, points.cols() * targets.cols());
    }
    for (std::size_t begin = 0; begin < open.size(); begin += kPathsAtOnce) {
      const std::size_t end = std::min(open.size(), begin + kPathsAtOnce);
      Points from(points.rows(), static_cast<Index>(end - begin));
      Points to = from;
      for (std::size_t p = begin; p < end; ++p) {
        const MatrixRow& row = block[open[p].row];
        from.col(static_cast<Index>(p - begin)) = points.col(row.row);
        to.col(static_cast<Index>(p - begin)) = targets.col(row.column[open[p].slot]);
      }
      const std::vector<PathResult> found = paths->solve_pairs(from, to);
      for (std::size_t p = begin; p < end; ++p) {
        MatrixRow& row = block[open[p].row];
        const PathResult& path = found[p - begin];
        double& distance = row.distance[open[p].slot];
        if (path.status == Status::ok) {
          distance = path.length;
          row.error[open[p].slot] = path.length_error;
        } else {
          if (path.status == Status::disconnected) distance = kInfinity;
          if (messages.size() < kMostMessages) {
            messages.push_back(fmt::format("row {}, column {}: {}", row.row, row.column[open[p].slot], path.message));
          }
        }
      }
    }
  }

  /// Leaves out what was not asked for.
  void thin(MatrixRow& row) const {
    std::vector<std::size_t> kept;
    std::vector<std::size_t> unknown;  // might belong there: they stay, as NaN
    for (std::size_t s = 0; s < row.column.size(); ++s) {
      if (std::isnan(row.distance[s])) unknown.push_back(s);
      if (std::isfinite(row.distance[s]) && row.distance[s] <= options.distance.max_distance) kept.push_back(s);
    }
    if (options.k_nearest > 0) {
      std::ranges::stable_sort(kept, {}, [&](std::size_t s) { return row.distance[s]; });
      if (kept.size() > at(options.k_nearest)) kept.resize(at(options.k_nearest));
    }
    kept.insert(kept.end(), unknown.begin(), unknown.end());
    MatrixRow thinned{.row = row.row, .column = {}, .distance = {}, .error = {}};
    for (const std::size_t s : kept) {
      thinned.column.push_back(row.column[s]);
      thinned.distance.push_back(row.distance[s]);
      thinned.error.push_back(row.error[s]);
    }
    row = std::move(thinned);
  }
};

DistanceMatrix::DistanceMatrix(Surface surface, const PointsIn& points, const MatrixOptions& options, Context context)
    : impl_(std::make_unique<Impl>(std::move(surface), points, nullptr, options, std::move(context))) {}

DistanceMatrix::DistanceMatrix(Surface surface, const PointsIn& points, const PointsIn& targets,
                               const MatrixOptions& options, Context context)
    : impl_(std::make_unique<Impl>(std::move(surface), points, &targets, options, std::move(context))) {}

DistanceMatrix::~DistanceMatrix() = default;
DistanceMatrix::DistanceMatrix(DistanceMatrix&&) noexcept = default;
DistanceMatrix& DistanceMatrix::operator=(DistanceMatrix&&) noexcept = default;

Index DistanceMatrix::num_rows() const { return impl_->points.cols(); }
Index DistanceMatrix::num_columns() const { return impl_->targets.cols(); }
bool DistanceMatrix::symmetric() const { return impl_->symmetric; }
const std::vector<std::string>& DistanceMatrix::messages() const { return impl_->messages; }

std::vector<MatrixRow> DistanceMatrix::rows(Index first, Index count) {
  Impl& impl = *impl_;
  if (first < 0 || count < 0 || first + count > num_rows()) {
    throw InvalidArgument(fmt::format("rows {} to {} of {}", first, first + count, num_rows()));
  }
  std::vector<MatrixRow> block(at(count));
  detail::parallel_for(impl.context, 0, count, 1, [&](Index begin, Index end) {
    Context own = impl.context;
    own.threads = 1;
    own.progress = nullptr;
    for (Index r = begin; r < end; ++r) block[at(r)] = impl.by_fan(first + r, own);
  });
  impl.by_paths(block);
  if (impl.options.k_nearest > 0 || std::isfinite(impl.options.distance.max_distance)) {
    for (MatrixRow& row : block) impl.thin(row);
  }
  return block;
}

Eigen::MatrixXd distance_matrix(const Surface& surface, const PointsIn& points, const MatrixOptions& options,
                                const Context& context) {
  if (options.k_nearest > 0 || std::isfinite(options.distance.max_distance)) {
    throw InvalidArgument("a whole matrix has no k_nearest and no max_distance: ask for its rows");
  }
  DistanceMatrix solver(surface, points, options, context);
  const Index n = points.cols();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  constexpr Index kBlock = 64;
  for (Index first = 0; first < n; first += kBlock) {
    for (const MatrixRow& row : solver.rows(first, std::min(kBlock, n - first))) {
      for (std::size_t s = 0; s < row.column.size(); ++s) {
        matrix(row.row, row.column[s]) = matrix(row.column[s], row.row) = row.distance[s];
      }
    }
  }
  return matrix;
}

}  // namespace taut
