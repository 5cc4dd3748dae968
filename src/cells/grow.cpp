// The paper's Algorithm II: cells that hold seeds are tested, and crossed ones pass the question on to their 2 d
// neighbours across faces, front by front, until nothing new is found. Every cell is tested once, so the work is O(d)
// tests a crossed cell whatever the size of the box. It finds the components that hold seeds, and no others.
#include "taut/cells/find_cells.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "cells/crossing_pool.hpp"
#include "cells/memory_guard.hpp"
#include "core/parallel.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using Cells = std::vector<std::int32_t>;

constexpr Index kGrain = 2048;
// A seed may stand this many cells off the surface.
constexpr double kSeedReach = 2;

/// Grows a patch front by front.
class Growth {
 public:
  Growth(const Surface& surface, const Vector& origin, double size, const Context& context)
      : pool_(surface, origin, size),
        context_(context),
        limit_(detail::memory_limit(context)),
        d_(surface.dim()),
        tested_(origin, size) {}

  /// Adds the crossed cells that hold seeds (d x n) to the front. Returns the seeds whose cells are not crossed.
  std::vector<Index> seed(const PointsIn& seeds) {
    Cells cell(static_cast<std::size_t>(d_));
    std::vector<Index> cells;
    // Many samples share a cell: inserting says which.
    for (Index j = 0; j < seeds.cols(); ++j) {
      tested_.cell_of(seeds.col(j), cell);
      cells.push_back(tested_.insert(cell));
    }
    test_new();
    std::vector<Index> beside;
    for (Index j = 0; j < seeds.cols(); ++j) {
      if (crossed_[static_cast<std::size_t>(cells[static_cast<std::size_t>(j)])] == 0) beside.push_back(j);
    }
    return beside;
  }

  [[nodiscard]] bool empty() const { return num_crossed_ == 0; }

  void run(Index most_cells) {
    Cells neighbour(static_cast<std::size_t>(d_));
    std::vector<Index> front;
    while (!front_.empty() && (most_cells == 0 || num_crossed_ < most_cells)) {
      front.clear();
      front.swap(front_);
      for (const Index i : front) {
        const auto cell = tested_.cell(i);
        std::copy(cell.begin(), cell.end(), neighbour.begin());
        for (auto& c : neighbour) {
          const std::int32_t centre = c;
          for (const std::int32_t side : {centre - 1, centre + 1}) {
            c = side;
            tested_.insert(neighbour);
            ++num_lookups_;
          }
          c = centre;
        }
      }
      test_new();
      context_.report("cells", -1);
    }
  }

  /// Each cell ever looked at was tested once.
  [[nodiscard]] CellCounts counts() const {
    return {.num_tests = tested_.num_cells(), .num_lookups = num_lookups_, .complete = front_.empty()};
  }

  [[nodiscard]] CellGrid crossed() const {
    CellGrid grid(tested_.origin(), tested_.size());
    for (Index i = 0; i < tested_.num_cells(); ++i) {
      if (crossed_[static_cast<std::size_t>(i)] != 0) grid.insert(tested_.cell(i));
    }
    return grid;
  }

 private:
  /// Tests the cells inserted since the last time; the crossed ones join the front.
  void test_new() {
    context_.check_cancelled();
    const Index begin = static_cast<Index>(crossed_.size());
    const Index end = tested_.num_cells();
    detail::check_memory(tested_.bytes() + crossed_.capacity(), limit_, num_crossed_, tested_.size());
    crossed_.resize(static_cast<std::size_t>(end));
    detail::parallel_for(context_, begin, end, kGrain, [&](Index first, Index last) {
      const detail::CrossingPool::Loan test(pool_);
      test->test(tested_.coordinates().subspan(static_cast<std::size_t>(first * d_),
                                               static_cast<std::size_t>((last - first) * d_)),
                 0, {crossed_.data() + first, static_cast<std::size_t>(last - first)});
    });
    for (Index i = begin; i < end; ++i) {
      if (crossed_[static_cast<std::size_t>(i)] == 0) continue;
      front_.push_back(i);
      ++num_crossed_;
    }
  }

  detail::CrossingPool pool_;
  const Context& context_;
  std::size_t limit_;
  Index d_;
  CellGrid tested_;                    // all cells ever looked at
  std::vector<std::uint8_t> crossed_;  // by tested cell
  std::vector<Index> front_;           // crossed cells whose neighbours have not been looked at
  Index num_crossed_ = 0;
  Index num_lookups_ = 0;
};

}  // namespace

CellGrid grow(const Surface& surface, const PointsIn& seeds, const GrowOptions& options, const Context& context) {
  if (seeds.rows() != surface.dim() || seeds.cols() == 0) {
    throw InvalidArgument("growing needs at least one seed with the surface's " + std::to_string(surface.dim()) +
                          " coordinates");
  }
  if (!seeds.allFinite()) throw InvalidArgument("a seed is not finite");
  if (options.origin && options.origin->size() != surface.dim()) {
    throw InvalidArgument("the grid's origin must have " + std::to_string(surface.dim()) + " coordinates");
  }
  const Vector middle = 0.5 * (seeds.rowwise().minCoeff() + seeds.rowwise().maxCoeff());
  const CellGrid lattice(options.origin ? *options.origin : lattice_origin(middle, options.size), options.size);
  Growth growth(surface, lattice.origin(), lattice.size(), context);
  const std::vector<Index> beside = growth.seed(seeds);
  if (!beside.empty()) {
    // Off the surface by rounding, or by what a fit left of the noise.
    Points moved = seeds(Eigen::all, beside);
    const auto evaluator = surface.make_evaluator();
    (void)project_to_surface(*evaluator, surface.dim(), surface.codim(), moved,
                             {.max_distance = kSeedReach * options.size});
    (void)growth.seed(moved);
  }
  if (growth.empty()) {
    throw EmptySurface("no surface crosses the cells of size " + detail::describe(options.size) +
                       " that hold the seeds, such as " + detail::describe(seeds.col(0)));
  }
  growth.run(options.most_cells);
  if (options.counts != nullptr) *options.counts = growth.counts();
  // In Morton order, as Algorithm I gives them: near in space is near in memory.
  return growth.crossed().sorted();
}

}  // namespace taut
