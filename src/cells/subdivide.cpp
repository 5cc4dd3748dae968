// The paper's Algorithm I: cells that cover the box, far larger than wanted, are tested and halved on all axes again
// and again, keeping those that the surface may cross. With interval bounds it starts from one cell; without, from
// cells small enough for a Taylor polynomial. The first levels run one after the other; from kCoarseCells cells on,
// blocks of them are refined in parallel and put together in order, so that the cells come out in Morton order on any
// number of threads.
#include "taut/cells/find_cells.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string>
#include <vector>

#include "cells/crossed.hpp"
#include "cells/crossing_pool.hpp"
#include "cells/memory_guard.hpp"
#include "cells/refine.hpp"
#include "core/parallel.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using Cells = std::vector<std::int32_t>;

// Coarse cells to share between threads; a fixed number, so that threads do not change the result's order.
constexpr Index kCoarseCells = 512;
constexpr Index kGrain = 8;
// How far the estimate from the coarse cells may be above the memory before the job is refused without trying.
constexpr double kEstimateSafety = 4;

std::string describe(const Box& box) { return detail::describe(box.lower) + " to " + detail::describe(box.upper); }

/// log2 of how many cells of the wanted size the first cells are wide.
int first_level(const Box& box, double size, bool has_bounds) {
  // Cells at least as wide as the box and two more: at most two of them on an axis.
  const int whole = std::max(0, static_cast<int>(std::ceil(std::log2(box.extent().maxCoeff() / size + 3))));
  if (has_bounds) return whole;
  // A Taylor polynomial says nothing about large cells.
  return std::max(0, whole - (box.dim() <= 4 ? 5 : 3));
}

/// The cells of a level that cover the box with a margin of one cell of level 0, in Morton order.
Cells cover(const CellGrid& lattice, const Box& box, int level) {
  const Index d = box.dim();
  Cells lower(static_cast<std::size_t>(d));
  Cells upper(static_cast<std::size_t>(d));
  lattice.cell_of(box.lower, lower);
  lattice.cell_of(box.upper, upper);
  // Shifts round down, below zero as well.
  for (auto& c : lower) c = (c - 1) >> level;
  for (auto& c : upper) c = (c + 1) >> level;
  CellGrid cells(Vector::Zero(d), 1);
  Cells at = lower;
  for (bool more = true; more;) {
    cells.insert(at);
    more = false;
    for (std::size_t a = 0; a < at.size() && !more; ++a) {
      more = ++at[a] <= upper[a];
      if (!more) at[a] = lower[a];
    }
  }
  const CellGrid sorted = cells.sorted();
  return {sorted.coordinates().begin(), sorted.coordinates().end()};
}

void check_estimate(Index num_coarse, int level, Index d, Index k, double size, std::size_t limit) {
  // A surface of dimension d - k has 2^(d - k) times as many cells at half the size.
  const double num_cells = static_cast<double>(num_coarse) * std::ldexp(1.0, level * static_cast<int>(d - k));
  const double bytes = num_cells * static_cast<double>(4 * d + 12);
  if (bytes <= kEstimateSafety * static_cast<double>(limit)) return;
  throw OutOfMemory("the surface has about " + detail::describe(std::round(num_cells)) + " cells of size " +
                    detail::describe(size) + ", far more than fit into " + std::to_string(limit >> 20) +
                    " MB: take larger cells (option cell) or a smaller box (option box)");
}

void require(const Surface& surface, const SubdivideOptions& options, const Box& box) {
  if (!(options.size > 0) || !std::isfinite(options.size)) {
    throw InvalidArgument("the cell size must be a positive length, not " + detail::describe(options.size));
  }
  if (box.dim() != surface.dim() || box.upper.size() != box.lower.size() || !box.lower.allFinite() ||
      !box.upper.allFinite() || (box.upper.array() < box.lower.array()).any()) {
    throw InvalidArgument("the box must have " + std::to_string(surface.dim()) +
                          " finite lower and upper bounds, lower <= upper");
  }
  if (options.origin && (options.origin->size() != surface.dim())) {
    throw InvalidArgument("the grid's origin must have " + std::to_string(surface.dim()) + " coordinates");
  }
  const double across = box.extent().maxCoeff() / options.size;
  if (across > 0.25 * CellGrid::kMaxCoordinate) {
    throw OutOfMemory("cells of size " + detail::describe(options.size) + " make " + detail::describe(across) +
                      " across the box " + describe(box) + ": take larger cells (option cell)");
  }
}

}  // namespace

CellGrid subdivide(const Surface& surface, const SubdivideOptions& options, const Context& context) {
  const Index d = surface.dim();
  detail::check_halving(d);
  const Box box = options.box ? *options.box : find_box(surface, Points(d, 0), context);
  require(surface, options, box);
  const double size = options.size;
  CellGrid grid(options.origin ? *options.origin : lattice_origin(0.5 * (box.lower + box.upper), size), size);
  const std::size_t limit = detail::memory_limit(context);
  detail::CrossingPool pool(surface.with_box(box), grid.origin(), size);
  context.report("cells", 0);

  // The first levels one after the other, until there is enough to share.
  int level = first_level(box, size, detail::CrossingPool::Loan(pool)->has_bounds());
  Cells coarse = detail::crossed(pool, d, cover(grid, box, level), level, context);
  while (level > 0 && !coarse.empty() && static_cast<Index>(coarse.size()) / d < kCoarseCells) {
    Cells halves;
    detail::append_halves(d, coarse.data(), static_cast<Index>(coarse.size()) / d, halves);
    --level;
    coarse = detail::crossed(pool, d, halves, level, context);
  }
  const Index num_coarse = static_cast<Index>(coarse.size()) / d;
  check_estimate(num_coarse, level, d, surface.codim(), size, limit);

  std::vector<Cells> found(static_cast<std::size_t>((num_coarse + kGrain - 1) / kGrain));
  std::atomic<std::size_t> bytes = 0;
  std::mutex progress_mutex;
  Index num_done = 0;
  detail::parallel_for(context, 0, num_coarse, kGrain, [&](Index first, Index last) {
    const detail::CrossingPool::Loan test(pool);
    Cells& out = found[static_cast<std::size_t>(first / kGrain)];
    const Cells block(coarse.begin() + first * d, coarse.begin() + last * d);
    if (level == 0) {
      out = block;
    } else {
      Cells halves;
      detail::append_halves(d, block.data(), last - first, halves);
      std::size_t counted = 0;
      detail::Refiner(*test, d).refine(halves, level - 1, 0, out, [&] {
        context.check_cancelled();
        const std::size_t held = out.capacity() * sizeof(std::int32_t);
        const std::size_t total = bytes += held - counted;
        counted = held;
        detail::check_memory(total, limit, static_cast<Index>(total) / (4 * d), size);
      });
      out.shrink_to_fit();
      // What shrinking gave back.
      bytes -= counted - out.capacity() * sizeof(std::int32_t);
    }
    if (context.progress) {
      const std::lock_guard lock(progress_mutex);
      num_done += last - first;
      context.report("cells", 0.9 * static_cast<double>(num_done) / static_cast<double>(num_coarse));
    }
  });

  std::size_t num_coordinates = 0;
  for (const Cells& cells : found) num_coordinates += cells.size();
  const Index num_cells = static_cast<Index>(num_coordinates) / d;
  if (num_cells == 0) {
    throw EmptySurface("no cell of size " + detail::describe(size) + " in the box " + describe(box) +
                       " is crossed by the surface inside its domain");
  }
  // The cells, once more as coordinates of the grid, and its hash.
  detail::check_memory(2 * num_coordinates * sizeof(std::int32_t) + static_cast<std::size_t>(num_cells) * 13, limit,
                       num_cells, size);
  grid.reserve(num_cells);
  for (Cells& cells : found) {
    for (std::size_t c = 0; c < cells.size(); c += static_cast<std::size_t>(d)) grid.insert(cells.data() + c);
    cells = {};
  }
  if (options.counts != nullptr) *options.counts = {.num_tests = pool.num_tested()};
  context.report("cells", 1);
  return grid;
}

}  // namespace taut
