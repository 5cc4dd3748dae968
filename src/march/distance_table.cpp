// Starts for all ways between two points from a table instead of two fields. With u_l the marched distance from
// landmark l, u_l(p) + u_l(q) >= d(p, q), and it is hardly more where l lies beside a shortest path: landmarks with
// small sums name the ways. Each is then walked down the landmark's distances, cell by cell, from both ends.
//
// A way with arms a and b to a point that lies e beside it is longer by e^2 / 2 (1 / a + 1 / b), to leading order. With
// e of kOffset spacings this is what the sum of the best landmark of a way may exceed its length by. Whether two
// landmarks stand for one way is a matter of how far they lie apart (kSameWay...), and in doubt of the walk itself.
//
// Marched distances of coarse cells can be too long across a narrow place. A landmark beyond it has reached both sides
// by another front: the least u_m(x) + u_m(l) over landmarks m near the ways (a shortcut) mends that.
#include "march/distance_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "core/memory_limit.hpp"
#include "core/parallel.hpp"
#include "march/cell_map.hpp"
#include "march/chart_march.hpp"
#include "march/dimensions.hpp"
#include "march/edge.hpp"
#include "march/stencil.hpp"
#include "surface/normal_angle.hpp"
#include "taut/core/error.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {
namespace {

/// Landmarks lie no farther than this from any way, in spacings.
constexpr double kOffset = 0.7;
/// Landmarks this close to an end, in spacings, say nothing about ways.
constexpr double kEndSpacings = 1;
/// Between ends this close, in spacings, ways may differ that pass the same landmarks.
constexpr double kClose = 5;
/// Landmarks this close to a start, in spacings or relative to the distance to the nearer end, lie on the same way.
constexpr double kSameWaySpacings = 0.8;
constexpr double kSameWay = 0.15;
/// Closer than this part of that they surely do. Between, the walk past the landmark tells: where it is the same way,
/// it strays from the start no farther than the landmark does, by this factor and this many cells.
constexpr double kSurelySame = 0.5;
constexpr double kSameStraying = 1.25;
constexpr double kWalkNoise = 0.5;
constexpr Index kMostUnsure = 4;  // so many landmarks of a pair are worth the walk
/// Where cells are too coarse, a march may take a detour. A way past another landmark that is shorter than the marched
/// one by more than this part tells.
constexpr float kShortcut = 0.003F;
/// Shortcuts run past landmarks that are on ways longer than the shortest by no more than this part.
constexpr float kNearWays = 0.25F;

/// Landmarks that share the memory of a march, and a cache line of the table.
constexpr Index kLandmarksAtATime = 16;

constexpr float kFar = std::numeric_limits<float>::infinity();

}  // namespace

struct DistanceTable::View {
  Vector x;
  Index cell = CellGrid::kNone;
  std::vector<float> marched;   // the distance of every landmark
  std::vector<float> distance;  // the same with shortcuts
};

DistanceTable::DistanceTable(const Surface& surface, SurfaceCells cells, Index num_landmarks, const Context& context)
    : cells_(std::move(cells)) {
  if (cells_.is_lazy() || cells_.dim() != surface.dim() || num_landmarks < 1) {
    throw InvalidArgument("a distance table needs complete cells of the surface and at least one landmark");
  }
  choose_landmarks(num_landmarks);
  link_cells();
  const std::size_t size =
      static_cast<std::size_t>(cells_.num_cells()) * landmarks_.size() * static_cast<std::size_t>(cells_.dim() + 1);
  if (size * sizeof(float) > detail::memory_limit(context))
    throw OutOfMemory("the distance table does not fit the memory");
  table_.resize(size);
  fill(surface, context);
  const auto size_of_cells = static_cast<float>(cells_.grid().size());
  for (const Index landmark : landmarks_) {
    for (std::size_t l = 0; l < landmarks_.size(); ++l) between_.push_back(size_of_cells * row(landmark)[l]);
  }
}

/// Cells no closer to each other than the spacing, which is adapted until their number fits.
void DistanceTable::choose_landmarks(Index count) {
  spacing_ = cells_.grid().size();
  for (;;) {
    landmarks_.clear();
    for (Index i = 0; i < cells_.num_cells(); ++i) {
      if (!cells_.valid(i)) continue;
      const auto near = [&](Index other) {
        return (cells_.point(i) - cells_.point(other)).squaredNorm() < spacing_ * spacing_ &&
               detail::same_side(cells_.normals(i), cells_.normals(other));
      };
      if (std::none_of(landmarks_.begin(), landmarks_.end(), near)) landmarks_.push_back(i);
    }
    if (num_landmarks() <= count) return;
    const double dim = static_cast<double>(cells_.dim() - cells_.codim());
    // Their number falls with the power n = d - k of the spacing, roughly; 5 % at the least, so that it comes to an
    // end.
    spacing_ *= std::max(1.05, std::pow(static_cast<double>(num_landmarks()) / static_cast<double>(count), 1 / dim));
  }
}

void DistanceTable::link_cells() {
  const Index d = cells_.dim();
  first_link_.assign(1, 0);
  detail::Stencil stencil(d);
  detail::with_dimensions(d, cells_.codim(), [&]<int D, int K>() {
    detail::Edge<D> edge;
    const auto point = [&](Index i) { return detail::SurfacePoint{cells_.point(i).data(), cells_.normals(i).data()}; };
    for (Index i = 0; i < cells_.num_cells(); ++i) {
      if (cells_.valid(i)) {
        for (const Index j : stencil.block(cells_.grid(), cells_.grid().cell(i))) {
          if (j == i || !cells_.valid(j) || !detail::make_edge<D, K>(point(j), point(i), d, cells_.codim(), edge))
            continue;
          links_.push_back(static_cast<std::uint32_t>(j));
        }
      }
      first_link_.push_back(static_cast<std::uint32_t>(links_.size()));
    }
  });
}

void DistanceTable::fill(const Surface& surface, const Context& context) {
  const auto d = static_cast<std::size_t>(cells_.dim());
  const auto num_cells = static_cast<std::size_t>(cells_.num_cells());
  // Shared by all marches of this table only.
  const std::shared_ptr<const detail::CellMap> map = detail::map_cells(cells_, context);
  const detail::SurfaceCharts* charts = map->charts.get();
  Context inner = context;
  inner.progress = nullptr;
  std::mutex progress;
  Index done = 0;
  detail::parallel_for(context, 0, num_landmarks(), kLandmarksAtATime, [&](Index first, Index last) {
    // What each landmark says of all cells, then a part of each cell's row at a time.
    const auto count = static_cast<std::size_t>(last - first);
    std::vector<float> columns(count * num_cells * (d + 1));
    float* to = columns.data();
    std::optional<detail::ChartMarch> chart_march;
    if (charts != nullptr) chart_march.emplace(*charts);
    for (Index l = first; l < last; ++l) {
      const Index landmark = landmarks_[static_cast<std::size_t>(l)];
      DistanceField field;
      if (chart_march) {
        const detail::SurfacePoint source{cells_.point(landmark).data(), cells_.normals(landmark).data()};
        chart_march->run(source, std::span(&landmark, 1), context);
      } else {
        field = march(surface, cells_, cells_.point(landmark), {}, inner);
      }
      for (Index i = 0; i < cells_.num_cells(); ++i, to += d + 1) {
        to[0] = chart_march ? chart_march->distance(i) : static_cast<float>(field.distance(i) / cells_.grid().size());
        Eigen::Map<Eigen::VectorXf> gradient(to + 1, cells_.dim());
        if (chart_march) {
          gradient.noalias() = charts->axes(i) * chart_march->gradient(i);
        } else {
          gradient = field.gradient.col(i).cast<float>();
        }
      }
    }
    // Transposed: marches write a landmark's column, questions read a cell's row.
    for (std::size_t i = 0; i < num_cells * (d + 1); ++i) {
      float* row = table_.data() + i * landmarks_.size() + static_cast<std::size_t>(first);
      for (std::size_t l = 0; l < count; ++l) row[l] = columns[l * num_cells * (d + 1) + i];
    }
    const std::lock_guard lock(progress);
    context.report("table", static_cast<double>(done += last - first) / static_cast<double>(num_landmarks()));
  });
}

std::size_t DistanceTable::bytes() const {
  return (table_.capacity() + between_.capacity()) * sizeof(float) +
         (links_.capacity() + first_link_.capacity()) * sizeof(std::uint32_t) + landmarks_.capacity() * sizeof(Index) +
         cells_.bytes();
}

/// The valid cell around x whose point is nearest.
Index DistanceTable::nearest_cell(const VectorIn& x) const {
  std::vector<std::int32_t> cell(static_cast<std::size_t>(cells_.dim()));
  cells_.grid().cell_of(x, cell);
  detail::Stencil stencil(cells_.dim());
  Index nearest = CellGrid::kNone;
  double least = std::numeric_limits<double>::infinity();
  for (const Index i : stencil.block(cells_.grid(), cell)) {
    const double distance = (cells_.point(i) - x).squaredNorm();
    if (!cells_.valid(i) || !(distance < least)) continue;
    least = distance;
    nearest = i;
  }
  return nearest;
}

DistanceTable::View DistanceTable::look(const VectorIn& x) const {
  View view{x, nearest_cell(x), {}, {}};
  if (view.cell == CellGrid::kNone) return view;
  const std::size_t n = landmarks_.size();
  const float* distance = row(view.cell);
  const double size = cells_.grid().size();
  const Eigen::VectorXf step = ((x - cells_.point(view.cell)) / size).cast<float>();
  std::vector<float>& marched = view.marched;
  marched.assign(n, 0);
  for (Index axis = 0; axis < cells_.dim(); ++axis) {
    const float* gradient = distance + static_cast<std::size_t>(axis + 1) * n;
    for (std::size_t l = 0; l < n; ++l) marched[l] += step(axis) * gradient[l];
  }
  // Exact for a point source in the plane.
  const float step2 = step.squaredNorm();
  for (std::size_t l = 0; l < n; ++l) {
    const float u = distance[l];
    const float cells = u < kFar ? std::sqrt(std::max(0.0F, u * u + 2 * u * marched[l] + step2)) : kFar;
    marched[l] = static_cast<float>(size) * cells;
  }
  view.distance = marched;
  return view;
}

/// Of two points at once, since only landmarks near the ways between them matter. False where there is no such way.
bool DistanceTable::take_shortcuts(View& from, View& to) const {
  if (from.marched.empty() || to.marched.empty()) return false;
  const std::size_t n = landmarks_.size();
  const float near = (1 + kNearWays) * least_sum(from, to);
  if (!(near < kFar)) return false;
  for (std::size_t m = 0; m < n; ++m) {
    if (!(from.marched[m] + to.marched[m] <= near)) continue;
    const float* onwards = between_.data() + m * n;
    for (View* view : {&from, &to}) {
      const float here = view->marched[m];
      float* distance = view->distance.data();
      for (std::size_t l = 0; l < n; ++l) {
        distance[l] = std::min(distance[l], (1 + kShortcut) * (here + onwards[l]));
      }
    }
  }
  return true;
}

/// Steepest descent from a cell to a landmark, from cell to cell.
void DistanceTable::walk(Index cell, std::size_t landmark, Way& way) const {
  way.push_back(cell);
  for (;;) {
    const auto links = std::span(links_).subspan(
        first_link_[static_cast<std::size_t>(cell)],
        first_link_[static_cast<std::size_t>(cell) + 1] - first_link_[static_cast<std::size_t>(cell)]);
    const float here = row(cell)[landmark];
    double least = std::numeric_limits<double>::infinity();
    Index next = CellGrid::kNone;
    for (const Index j : links) {
      const float there = row(j)[landmark];
      // Distances fall strictly, so the walk ends: at the landmark, or in a hollow of rounding.
      if (!(there < here)) continue;
      // The best next cell by Fermat's principle, not the lowest: else diagonal steps would always win.
      const double length = there * cells_.grid().size() + (cells_.point(j) - cells_.point(cell)).norm();
      if (length < least) {
        least = length;
        next = j;
      }
    }
    if (next == CellGrid::kNone) return;
    way.push_back(next);
    cell = next;
  }
}

/// The cells of the way from a point to a landmark, by a shortcut if there is one; empty when there is no way.
DistanceTable::Way DistanceTable::way_to(std::size_t landmark, const View& from) const {
  Way way;
  Index cell = from.cell;
  // A shortcut beat the march: first to the landmark it runs past, then on from there.
  if (from.distance[landmark] < from.marched[landmark]) {
    const std::size_t n = landmarks_.size();
    const auto length = [&](std::size_t m) { return from.marched[m] + between_[m * n + landmark]; };
    std::size_t past = 0;
    for (std::size_t m = 1; m < n; ++m) {
      if (length(m) < length(past)) past = m;
    }
    cell = landmarks_[past];
    walk(from.cell, past, way);
    if (way.back() != cell) return {};
    // The second walk begins with the same cell.
    way.pop_back();
  }
  walk(cell, landmark, way);
  return way.back() == landmarks_[landmark] ? way : Way();
}

/// The cells of the way from one point past a landmark to the other; empty when there is none.
DistanceTable::Way DistanceTable::way_past(const View& from, const View& to, std::size_t landmark) const {
  Way there = way_to(landmark, from);
  const Way back = way_to(landmark, to);
  if (there.empty() || back.empty()) return {};
  // The landmark's cell is in both halves.
  there.insert(there.end(), back.rbegin() + 1, back.rend());
  return there;
}

/// Distance from cell i to the nearest of the ways that runs past it on the same side of the surface.
double DistanceTable::distance_to(const std::vector<Way>& ways, Index i) const {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (const Way& way : ways) {
    for (const Index j : way) {
      const double distance2 = (cells_.point(i) - cells_.point(j)).squaredNorm();
      if (distance2 < nearest2 && detail::same_side(cells_.normals(i), cells_.normals(j))) nearest2 = distance2;
    }
  }
  return std::sqrt(nearest2);
}

/// How far a way strays from those known.
double DistanceTable::straying(const Way& way, const std::vector<Way>& known) const {
  double most = 0;
  for (const Index i : way) most = std::max(most, distance_to(known, i));
  return most;
}

double DistanceTable::upper_bound(const VectorIn& p, const VectorIn& q) const {
  View from = look(p);
  View to = look(q);
  return take_shortcuts(from, to) ? least_sum(from, to) : kFar;
}

float DistanceTable::least_sum(const View& from, const View& to) const {
  float least = kFar;
  for (std::size_t l = 0; l < landmarks_.size(); ++l) least = std::min(least, from.distance[l] + to.distance[l]);
  return least;
}

std::vector<StartPath> DistanceTable::start_paths(const VectorIn& p, const VectorIn& q,
                                                  const StartPathOptions& options) const {
  std::vector<StartPath> paths;
  View from = look(p);
  View to = look(q);
  if (!take_shortcuts(from, to)) return paths;
  struct Passing {
    float length;
    std::size_t landmark;
  };
  // Landmarks on the way, the middle ones of most use.
  const double near_end = kEndSpacings * spacing_;
  std::vector<Passing> passing;
  const float shortest = least_sum(from, to);
  if (shortest < kClose * spacing_) return paths;
  for (std::size_t l = 0; l < landmarks_.size(); ++l) {
    const double a = from.distance[l];
    const double b = to.distance[l];
    // Close to an end every way passes the same landmarks.
    if (!(std::min(a, b) > near_end) || !(a + b < kFar)) continue;
    // What the place of the landmark beside the way may have added.
    const double detour = std::pow(kOffset * spacing_, 2) / 2 * (1 / a + 1 / b);
    if (a + b - detour <= (1 + options.excess) * shortest) passing.push_back({static_cast<float>(a + b), l});
  }
  std::sort(passing.begin(), passing.end(), [](const Passing& a, const Passing& b) {
    return a.length < b.length || (a.length == b.length && a.landmark < b.landmark);
  });
  std::vector<Way> ways;
  Index unsure = 0;
  for (const Passing& candidate : passing) {
    if (static_cast<Index>(paths.size()) >= options.max_paths) break;
    const double lever = std::min(from.distance[candidate.landmark], to.distance[candidate.landmark]);
    const double same = std::max(kSameWaySpacings * spacing_, kSameWay * lever);
    const Index landmark = landmarks_[candidate.landmark];
    const double off = distance_to(ways, landmark);
    if (off < kSurelySame * same) continue;
    // Between surely the same and surely another: worth a walk, a few times.
    if (off < same && ++unsure > kMostUnsure) continue;
    Way way = way_past(from, to, candidate.landmark);
    if (way.empty()) continue;
    if (off < same && straying(way, ways) < kSameStraying * off + kWalkNoise * cells_.grid().size()) continue;
    // The cells of the ends themselves may lie behind them.
    Points points(cells_.dim(), std::max<Index>(2, static_cast<Index>(way.size())));
    for (Index i = 1; i + 1 < points.cols(); ++i) points.col(i) = cells_.point(way[static_cast<std::size_t>(i)]);
    points.col(0) = p;
    points.col(points.cols() - 1) = q;
    paths.push_back({candidate.length, std::move(points)});
    ways.push_back(std::move(way));
  }
  return paths;
}

}  // namespace taut::detail
