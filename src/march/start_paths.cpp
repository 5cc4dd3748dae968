// All ways from p to q, from their two distance fields. s = u_p + u_q is the length of the shortest path through a
// point; along a slice u_p - u_q = const between the ends, ways cross where s has a minimum. Minima are found as in a
// flood: cells of the slice are taken from the lowest up, pools grow together over edges, and a pool that runs over
// into a lower one was as deep as the water rose in it. Hollows less deep than the noise of the fields are none. A way
// found on one slice is not added again on another: it passes within `spread` of the crossing, on the same side of the
// body.
//
// Limits: both halves of a way must be shortest paths; ends within a few cells of each other have no slice. Cost: one
// pass over the cells a slice, and two descents a way, in parallel.
#include "march/start_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include "core/disjoint_sets.hpp"
#include "core/parallel.hpp"
#include "march/dimensions.hpp"
#include "march/edge.hpp"
#include "march/march_over.hpp"
#include "march/point_normals.hpp"
#include "march/surroundings.hpp"
#include "surface/normal_angle.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// The slices between p and q on which ways are told apart, by the part of the way that lies behind: in the middle, and
/// closer to the ends, since two ways may run together for long.
constexpr std::array<double, 5> kSlices = {0.5, 0.25, 0.75, 0.125, 0.875};
/// u_p - u_q differs by at most this many cells from its value on the slice: a band of cells without holes.
constexpr double kBandCells = 2;
/// Slices this many cells from an end are left out.
constexpr double kEndCells = 4;
/// The following are relative to the distance from the slice to the nearer end.
/// Accuracy of s: hollows of s less deep are noise.
constexpr double kNoise = 2e-3;
/// Where s rises by no more than this, further crossings are tried. On a plane, s rises by more within the usual
/// spread.
constexpr double kFlat = 0.008;

/// Crossings closer to each other than so many cells are one way.
constexpr double kSpreadCells = 0.8;

/// A cell of a slice.
struct BandCell {
  Index cell;
  double length;  // s = u_p + u_q
};

/// The cells with u_p - u_q about `difference`, those with the least s first.
std::vector<BandCell> slice(const SurfaceCells& cells, const DistanceField& from_p, const DistanceField& from_q,
                            double difference) {
  std::vector<BandCell> band;
  const double width = kBandCells * cells.grid().size();
  const Index n = std::min(from_p.distance.size(), from_q.distance.size());
  for (Index i = 0; i < n; ++i) {
    const double u_p = from_p.distance(i);
    const double u_q = from_q.distance(i);
    if (!std::isfinite(u_p) || !std::isfinite(u_q) || std::abs(u_p - u_q - difference) > width) continue;
    band.push_back({i, u_p + u_q});
  }
  std::sort(band.begin(), band.end(), [](const BandCell& a, const BandCell& b) {
    return a.length < b.length || (a.length == b.length && a.cell < b.cell);
  });
  return band;
}

/// The lowest cell of every hollow at least `depth` deep, lowest first. A hollow ends where it runs over into a lower
/// one. `place`: a cell's number in the band; all -1 before and after.
template <int D, int K>
std::vector<std::size_t> hollows(const SurfaceCells& cells, Surroundings<D>& surroundings,
                                 const std::vector<BandCell>& band, double depth, std::vector<std::int32_t>& place) {
  const Index d = cells.dim();
  DisjointSets flood(band.size());  // cells are numbered from the lowest up: a hollow is known by its lowest
  std::vector<std::uint8_t> deep(band.size(), 0);
  Edge<D> edge;
  const auto point = [&](Index i) { return SurfacePoint{cells.point(i).data(), cells.normals(i).data()}; };
  for (std::size_t b = 0; b < band.size(); ++b) {
    const Index i = band[b].cell;
    place[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(b);
    for (const Index j : surroundings.around(cells.grid().cell(i))) {
      const std::int32_t other = place[static_cast<std::size_t>(j)];
      if (other < 0 || j == i || !make_edge<D, K>(point(j), point(i), d, cells.codim(), edge)) continue;
      // Cell b touches two pools, or its own new one and another: the one whose lowest cell is higher ends here.
      const std::uint32_t a = flood.find(static_cast<std::uint32_t>(other));
      const std::uint32_t c = flood.find(static_cast<std::uint32_t>(b));
      const std::size_t higher = std::max(a, c);
      if (flood.unite(a, c) && band[b].length - band[higher].length >= depth) deep[higher] = 1;
    }
  }
  std::vector<std::size_t> found;
  for (std::size_t b = 0; b < band.size(); ++b) {
    place[static_cast<std::size_t>(band[b].cell)] = -1;
    if (deep[b] != 0 || flood.find(static_cast<std::uint32_t>(b)) == b) found.push_back(b);
  }
  return found;
}

/// Collects one start for each way.
template <int D, int K>
class Ways {
 public:
  Ways(const Surface& surface, const SurfaceCells& cells, const CellMap* map, const DistanceField& from_p,
       const DistanceField& from_q, const StartPathOptions& options, const Context& context)
      : surface_(surface),
        cells_(cells),
        map_(map),
        surroundings_(cells, map),
        from_p_(from_p),
        from_q_(from_q),
        options_(options),
        context_(context),
        place_(static_cast<std::size_t>(cells.num_cells()), -1) {}

  std::vector<StartPath> find() && {
    for (const double part : kSlices) {
      // The first slice is the bisector, which needs no length; the others are placed by the least s found there.
      const double shortest = paths_.empty() ? 0 : least_;
      const double lever = std::min(part, 1 - part) * shortest;
      if (part == kSlices.front() || lever > kEndCells * cells_.grid().size()) cross((2 * part - 1) * shortest);
      if (paths_.empty()) break;
    }
    std::stable_sort(paths_.begin(), paths_.end(),
                     [](const StartPath& a, const StartPath& b) { return a.length < b.length; });
    if (static_cast<Index>(paths_.size()) > options_.max_paths) {
      paths_.resize(static_cast<std::size_t>(options_.max_paths));
    }
    return std::move(paths_);
  }

 private:
  /// Adds the ways that cross one slice and are new.
  void cross(double difference) {
    const std::vector<BandCell> band = slice(cells_, from_p_, from_q_, difference);
    if (band.empty()) return;
    const bool first = paths_.empty();
    if (first) least_ = band.front().length;
    // On a shortest way this is min(u_p, u_q): the distance from the slice to the nearer end.
    const double lever = (least_ - std::abs(difference)) / 2;
    const double spread = std::max(options_.spread * lever, kSpreadCells * cells_.grid().size());
    std::vector<BandCell> lowest;  // of the hollows
    for (const std::size_t b : hollows<D, K>(cells_, surroundings_, band, kNoise * lever, place_)) {
      if (band[b].length > (1 + options_.excess) * least_) break;
      lowest.push_back(band[b]);
    }
    if (first) {
      descend_from(lowest);  // all are new
    } else {
      for (const BandCell& crossing : lowest) add(crossing, spread);
    }
    // Near the cut locus s is level over a wide part, in one hollow: crossings all over that part are tried.
    for (const BandCell& crossing : band) {
      if (crossing.length > band.front().length + kFlat * lever) break;
      add(crossing, spread);
    }
  }

  /// One that may be new.
  void add(const BandCell& crossing, double spread) {
    for (std::size_t w = 0; w < paths_.size(); ++w) {
      // A longer way may share this part of a shorter one.
      if (paths_[w].length > crossing.length + kNoise * least_) continue;
      if (passes(paths_[w].points, normals_[w], crossing.cell, spread)) return;
    }
    descend_from({&crossing, 1});
  }

  /// Adds the ways through crossings down to both ends, where there is a way down.
  void descend_from(std::span<const BandCell> crossings) {
    std::vector<Points> halves(2 * crossings.size());
    parallel_for(context_, 0, static_cast<Index>(halves.size()), 1, [&](Index first, Index last) {
      for (Index i = first; i < last; ++i) {
        const auto at = static_cast<std::size_t>(i);
        halves[at] =
            descend_over(surface_, cells_, map_, i % 2 == 0 ? from_p_ : from_q_, cells_.point(crossings[at / 2].cell));
      }
    });
    for (std::size_t c = 0; c < crossings.size(); ++c) {
      const Points& there = halves[2 * c];
      const Points& back = halves[2 * c + 1];
      if (there.cols() < 2 || back.cols() < 2) continue;
      Points points(surface_.dim(), there.cols() + back.cols() - 1);
      points << there, back.leftCols(back.cols() - 1).rowwise().reverse();
      normals_.push_back(normals_at(surface_, points));
      paths_.push_back({crossings[c].length, std::move(points)});
    }
  }

  /// Does a way run past the cell within a distance, on the same side of the body: round a tube, ways may differ that
  /// are as close to each other as the tube is thin.
  [[nodiscard]] bool passes(const Points& points, const Points& normals, Index cell, double distance) const {
    for (Index j = 0; j < points.cols(); ++j) {
      if ((points.col(j) - cells_.point(cell)).squaredNorm() >= distance * distance) continue;
      const Eigen::Map<const Points> there(normals.col(j).data(), cells_.dim(), cells_.codim());
      if (same_side(there, cells_.normals(cell))) return true;
    }
    return false;
  }

  const Surface& surface_;
  const SurfaceCells& cells_;
  const CellMap* map_;
  Surroundings<D> surroundings_;
  const DistanceField& from_p_;
  const DistanceField& from_q_;
  const StartPathOptions& options_;
  const Context& context_;
  std::vector<std::int32_t> place_;
  std::vector<StartPath> paths_;
  std::vector<Points> normals_;  // of the paths' points, (d k) x n
  double least_ = 0;
};

}  // namespace

std::vector<StartPath> start_paths_over(const Surface& surface, const SurfaceCells& cells, const CellMap* map,
                                        const DistanceField& from_p, const DistanceField& from_q,
                                        const StartPathOptions& options, const Context& context) {
  if (from_p.method != MarchMethod::convergent || from_q.method != MarchMethod::convergent ||
      from_p.sources.cols() != 1 || from_q.sources.cols() != 1 || surface.dim() != cells.dim() ||
      from_p.distance.size() > cells.num_cells() || from_q.distance.size() > cells.num_cells()) {
    throw InvalidArgument("start_paths: needs two convergent fields of one source each on the cells given");
  }
  if (!(options.excess >= 0) || options.max_paths < 1 || !(options.spread > 0)) {
    throw InvalidArgument("start_paths: excess must not be negative, spread positive, and at least one path asked for");
  }
  return with_dimensions(surface.dim(), surface.codim(), [&]<int D, int K>() {
    return Ways<D, K>(surface, cells, map, from_p, from_q, options, context).find();
  });
}

std::vector<StartPath> start_paths(const Surface& surface, const SurfaceCells& cells, const DistanceField& from_p,
                                   const DistanceField& from_q, const StartPathOptions& options,
                                   const Context& context) {
  return start_paths_over(surface, cells, nullptr, from_p, from_q, options, context);
}

}  // namespace taut::detail
