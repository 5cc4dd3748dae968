// Distances on the surface itself: the eikonal equation |grad_S u| = 1 at the projected points of the cells, upwind
// over all 3^d - 1 neighbours that an edge on one smooth sheet joins (edge.hpp). Cells are settled in the order of
// their distances, as in fast marching (Sethian 1996; on triangulated surfaces Kimmel and Sethian 1998). Their update
// (arrival.hpp) carries gradients along with distances, which makes it second order in the cells' size.
//
// Three cases of a cell that comes first:
// 1. It lies within kDirectCells of a source: its distance is the length of the edge from there, for the front is
//    bent most strongly near its source.
// 2. Its neighbours lie on both sides of its ray: it is solved for, and settled.
// 3. They do not. It waits once, behind the longer way over an edge, for cells still in the front to enclose it. At an
//    edge of the surface and on the cut locus none comes, and it is settled with that.
// Cells are left infinite where no edge reaches them. Lazy cells grow as the front passes. Cost: O(3^d) edges a cell at
// most, in fact mostly two that are unrolled where d - k = 2, and O(log N) for the heap.
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "march/arrival.hpp"
#include "march/cell_map.hpp"
#include "march/dimensions.hpp"
#include "march/field_reader.hpp"
#include "march/growing_field.hpp"
#include "march/methods.hpp"
#include "march/start.hpp"
#include "march/target_watch.hpp"

namespace taut::detail {
namespace {

/// One march. A cell waits in the front with an estimate made from single neighbours; when it comes first, its distance
/// is solved for once from all neighbours that have theirs, which are those behind it, and it passes estimates on.
template <int D, int K>
class ConvergentMarch {
 public:
  ConvergentMarch(const MarchTask& task, DistanceField& field)
      : cells_(task.cells),
        d_(field.sources.rows()),
        k_(field.source_normals.rows() / d_),
        direct_radius_(kDirectCells * cells_.grid().size()),
        longest_(task.options.target ? task.options.longest : std::numeric_limits<double>::infinity()),
        end_(task.options.target.value_or(Vector())),
        field_(task, field),
        target_(task, field),
        solver_(d_, k_),
        frame_(d_, k_),
        neighbours_(task.map == nullptr ? nullptr : static_cast<const NeighbourIndex<D>*>(task.map->neighbours.get())),
        flags_(static_cast<std::size_t>(cells_.num_cells()), 0) {
    if (neighbours_ == nullptr) neighbours_ = &own_neighbours_.emplace(cells_);
    for (Index s = 0; s < field.sources.cols(); ++s) {
      for (const Index i : cells_around_source(cells_, field.sources.col(s))) offer_direct(i, s);
    }
  }

  void run() {
    Front& front = field_.front();
    while (!front.empty() && !target_.is_final(front.min_key())) {
      const Index i = field_.pop();
      if (cells_.num_cells() > static_cast<Index>(flags_.size())) {
        flags_.resize(static_cast<std::size_t>(cells_.num_cells()), 0);
        own_neighbours_->update();
      }
      if (visit(i)) target_.settled(cells_.grid().cell(i));
    }
    field_.finish(target_.distance());
  }

 private:
  enum Flag : std::uint8_t {
    kDirect = 1,   // the estimate is the edge from the source itself
    kDelayed = 2,  // has come first before, without neighbours on both sides of its ray
  };

  [[nodiscard]] SurfacePoint point(Index i) const { return {cells_.point(i).data(), cells_.normals(i).data()}; }
  [[nodiscard]] std::uint8_t& flags(Index i) { return flags_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] bool is_direct(Index i) { return (flags(i) & kDirect) != 0; }
  [[nodiscard]] bool is_delayed(Index i) { return (flags(i) & kDelayed) != 0; }

  /// Of a cell that is soon to be visited: what only its visit reads.
  void prefetch(Index i) const {
    __builtin_prefetch(cells_.normals(i).data());
    __builtin_prefetch(cells_.grid().cell(i).data());
  }

  /// Settles cell i and tells its neighbours. False when it has to wait, or cannot be reached after all.
  bool visit(Index i) {
    const bool direct = is_direct(i);
    solver_.begin(point(i));
    waiting_.clear();
    neighbours_->around(i, around_);
    for (const Index j : around_) {
      if (!field_.settled(j)) {
        if (j != i) waiting_.push_back(j);
      } else if (!direct) {
        solver_.add(point(j), field_.distance(j), field_.gradient(j), field_.source(j));
      }
    }
    if (direct) {
      const Index s = field_.source(i);
      // Made once more rather than stored for all cells: it succeeded when it was offered.
      const auto [length, direction] = *direct_from_source<D, K>(field_.field(), s, point(i), direct_radius_, frame_);
      settle(i, length, direction, s);
      for (const Index j : waiting_) offer_direct(j, s);
    } else {
      const std::optional<Arrival<D>> arrival = solver_.solve();
      if (!arrival) return false;
      if (!arrival->enclosed && !is_delayed(i)) {
        flags(i) |= kDelayed;
        // set(), not offer(): the key it waits with may be larger than the one it came first with.
        field_.set(i, arrival->distance, arrival->source);
        return false;
      }
      settle(i, arrival->distance, arrival->gradient, arrival->source);
    }
    for (const Index j : waiting_) offer(j, i);
    return true;
  }

  void settle(Index i, double distance, const SmallVector<D>& gradient, Index source) {
    Eigen::Map<SmallVector<D>>(field_.gradient(i), d_) = gradient;
    field_.settle(i, distance, source);
  }

  /// Source s offers cell j its distance, when j is near enough.
  void offer_direct(Index j, Index s) {
    if (is_direct(j) && field_.source(j) == s) return;
    const auto direct = direct_from_source<D, K>(field_.field(), s, point(j), direct_radius_, frame_);
    if (!direct) return;
    // The edge from the source replaces what was estimated over other cells from the same source, even where that is
    // less.
    const bool same_source = field_.front().contains(j) && field_.source(j) == s;
    if (same_source) {
      field_.set(j, direct->first, s);
    } else if (!field_.offer(j, direct->first, s)) {
      return;
    }
    flags(j) |= kDirect;
  }

  /// Cell i, just settled, offers j what it makes of the distance there. Whether an edge joins them is left to
  /// visit(j).
  void offer(Index j, Index i) {
    const Index s = field_.source(i);
    if (is_direct(j) && field_.source(j) == s) return;
    using Map = Eigen::Map<const SmallVector<D>>;
    const SmallVector<D> chord = Map(cells_.point(j).data(), d_) - Map(cells_.point(i).data(), d_);
    const double u = field_.distance(i);
    const double along = Map(field_.gradient(i), d_).dot(chord);
    const double chord2 = chord.squaredNorm();
    // A delayed cell lies beside the rays: a circle about the source would promise it too little, the edge does not.
    const double estimate2 = is_delayed(j) ? std::pow(u + std::sqrt(chord2), 2) : circular_estimate2(u, along, chord2);
    if (!field_.front().contains(j)) {
      prefetch(j);
    } else if (!(estimate2 < std::pow(field_.front().key(j), 2))) {
      return;
    }
    const double estimate = std::sqrt(estimate2);
    if (leads_astray(j, estimate)) return;
    field_.set(j, estimate, s);
    // It may have had a direct estimate from another source, which this one beats.
    flags(j) &= static_cast<std::uint8_t>(~kDirect);
  }

  /// Is a path through cell j, that far from its source, too long before it reaches the target.
  [[nodiscard]] bool leads_astray(Index j, double distance) const {
    // The straight line bounds the rest of the way from below.
    return longest_ < std::numeric_limits<double>::infinity() && distance + (cells_.point(j) - end_).norm() > longest_;
  }

  SurfaceCells& cells_;
  Index d_;
  Index k_;
  double direct_radius_;
  double longest_;
  Vector end_;  // the target
  GrowingField field_;
  TargetWatch<D, K> target_;
  ArrivalSolver<D, K> solver_;
  TangentCoordinates<D, K> frame_;
  std::optional<NeighbourIndex<D>> own_neighbours_;  // of cells that may grow, or whose index nobody has
  const NeighbourIndex<D>* neighbours_;
  std::vector<Index> around_;
  std::vector<Index> waiting_;
  std::vector<std::uint8_t> flags_;
};

}  // namespace

void march_convergent(const MarchTask& task, DistanceField& field) {
  with_dimensions(field.sources.rows(), field.source_normals.rows() / field.sources.rows(),
                  [&]<int D, int K>() { ConvergentMarch<D, K>(task, field).run(); });
}

}  // namespace taut::detail
