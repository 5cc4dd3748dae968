// Where is the surface? Given box and samples answer at once. With interval bounds: a cube of +-2^24 is halved, cells
// that cannot be crossed are dropped, and the box of the rest is halved again, until it fits within a cell in some
// kCellsAcross; that is a proof, also of emptiness. On axes where the surface reaches the end of the cube it is taken
// to have no end, and a window around the points of interest stands for it. Without bounds: starts scattered over cubes
// of growing size are projected, and a box counts as found when three sizes in a row give the same one.
#include "taut/cells/find_cells.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "cells/crossed.hpp"
#include "cells/crossing.hpp"
#include "cells/crossing_pool.hpp"
#include "cells/outermost.hpp"
#include "cells/refine.hpp"
#include "core/parallel.hpp"
#include "surface/describe.hpp"
#include "taut/cells/cell_grid.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr double kReach = 0x1p24;  // model units
// A cube is halved so often, as long as there are few cells; of more, only the outermost are halved. (Cells have 31
// bits.)
constexpr int kMostLevels = 29;
constexpr Index kFewCells = 512;
// Above d = 3 the outermost cells are nearly all, so the cube is rather made smaller and halved again.
constexpr int kMostLevelsAbove3 = 6;
constexpr Index kFewCellsAbove3 = 4096;
constexpr std::int64_t kCellsAcross = 40;  // of the box found, aimed at
constexpr double kTight = 24;              // and enough
constexpr double kSampleMargin = 0.05;     // of the samples' diagonal
constexpr double kDefaultHalfWidth = 5;    // model units: 1.6 periods of a sine
constexpr double kTrialMargin = 0.1;       // of the diagonal
constexpr Index kTrials = 192;             // starts a scale

Box cube(const Vector& centre, double half_width) { return {centre.array() - half_width, centre.array() + half_width}; }

/// A box around the surface, and the size of the cells it is made of.
struct Shrunk {
  Box box;  // empty (d = 0): there is no surface
  double resolution = 0;
};

/// How many cells (d x n coordinates) stand side by side, on the axis where most do.
std::int32_t most_across(Index d, const std::vector<std::int32_t>& cells) {
  const Eigen::Map<const Eigen::MatrixX<std::int32_t>> all(cells.data(), d, static_cast<Index>(cells.size()) / d);
  return (all.rowwise().maxCoeff() - all.rowwise().minCoeff()).maxCoeff() + 1;
}

/// The bounding box of the cells that the surface may cross inside `box`: up to d = 3 of cells so small that some
/// kCellsAcross of them stand side by side, or as small as levels go.
Shrunk shrink_once(const Surface& surface, const Box& box, const Context& context) {
  const Index d = surface.dim();
  const int most_levels = d <= 3 ? kMostLevels : kMostLevelsAbove3;
  const Index few_cells = d <= 3 ? kFewCells : kFewCellsAbove3;
  // A cube off the box's middle, so that a tiny surface there does not sit in the corner of 2^d cells on every level.
  const double half_width = 0.55 * box.extent().maxCoeff() + std::numeric_limits<double>::min();
  Vector origin = 0.5 * (box.lower + box.upper);
  for (Index a = 0; a < d; ++a) origin(a) -= half_width * (1 + 0.08 * std::sin(static_cast<double>(a + 1)));
  // Cells are to be told apart by rounding.
  const double rounding = 0x1p8 * std::numeric_limits<double>::epsilon() * origin.lpNorm<Eigen::Infinity>();
  int level = 0;
  while (level < most_levels && std::ldexp(half_width, -level) > rounding) ++level;
  const CellGrid grid(origin, std::ldexp(2 * half_width, -level));
  detail::CrossingPool pool(surface.with_box(box), grid.origin(), grid.size());
  std::vector<std::int32_t> untested(static_cast<std::size_t>(d), 0);
  std::vector<std::int32_t> cells;
  for (;; --level) {
    cells = detail::crossed(pool, d, untested, level, context);
    if (cells.empty()) return {};
    // Enough to see where the outermost are; the rest of the levels is for those alone.
    if (level == 0 || static_cast<Index>(cells.size()) > few_cells * d) break;
    untested.clear();
    detail::append_halves(d, cells.data(), static_cast<Index>(cells.size()) / d, untested);
  }
  int last_level = level;
  if (d <= 3) {
    for (std::int64_t across = most_across(d, cells); last_level > 0 && across < kCellsAcross; across *= 2)
      --last_level;
  }
  Shrunk found{box, std::ldexp(grid.size(), last_level)};
  std::atomic<bool> empty = false;
  detail::parallel_for(context, 0, 2 * d, 1, [&](Index first, Index) {
    const Index axis = first / 2;
    const int side = first % 2 == 0 ? -1 : 1;
    const detail::CrossingPool::Loan test(pool);
    const auto outermost = detail::outermost_face(*test, d, cells, level, last_level, axis, side);
    if (!outermost) {
      empty = true;
      return;
    }
    const double face = grid.face(axis, *outermost);
    // Each task has a bound of its own to write.
    if (side < 0) found.box.lower(axis) = std::max(box.lower(axis), face);
    if (side > 0) found.box.upper(axis) = std::min(box.upper(axis), face);
  });
  return empty ? Shrunk{} : found;
}

/// Shrinks `box` until it fits the surface; empty (d = 0) when there is none in it.
Box shrink(const Surface& surface, Box box, const Context& context) {
  for (;;) {
    context.check_cancelled();
    const Shrunk smaller = shrink_once(surface, box, context);
    if (smaller.box.dim() == 0) return smaller.box;
    const double rounding =
        0x1p14 * std::numeric_limits<double>::epsilon() *
        std::max(smaller.box.lower.lpNorm<Eigen::Infinity>(), smaller.box.upper.lpNorm<Eigen::Infinity>());
    const double before = box.extent().maxCoeff();
    const double after = smaller.box.extent().maxCoeff();
    box = smaller.box;
    // Once it is many cells wide, or does not shrink; a single point shrinks until rounding ends it.
    if (after >= kTight * smaller.resolution || after > 0.6 * before || after <= rounding ||
        after <= std::numeric_limits<double>::min() * 0x1p60) {
      return box;
    }
  }
}

/// No surface is looked for beyond it.
double reach_about(const PointsIn& near) {
  return near.cols() > 0 ? std::max(kReach, 4 * near.lpNorm<Eigen::Infinity>()) : kReach;
}

/// The box around points of interest on an axis where the surface does not end.
Box around(const PointsIn& near, Index d) {
  if (near.cols() == 0) return cube(Vector::Zero(d), kDefaultHalfWidth);
  const Vector lower = near.rowwise().minCoeff();
  const Vector upper = near.rowwise().maxCoeff();
  double margin = std::max((upper - lower).maxCoeff(), 0.5 * near.lpNorm<Eigen::Infinity>());
  if (margin == 0) margin = kDefaultHalfWidth;
  return {lower.array() - margin, upper.array() + margin};
}

[[noreturn]] void throw_empty(const Surface& surface, const std::string& where) {
  throw EmptySurface(
      "there is no surface: " + std::string(surface.codim() == 1 ? "F = 0 has" : "the equations together have") +
      " no solution " + (surface.domain() != nullptr ? "inside the domain " : "") + where);
}

SurfaceExtent all_in(const Box& box) {
  return {.box = box,
          .window = box,
          .whole = box,
          .endless = Eigen::Array<bool, Eigen::Dynamic, 1>::Constant(box.dim(), false)};
}

SurfaceExtent by_bounds(const Surface& surface, const PointsIn& near, const Context& context) {
  const Index d = surface.dim();
  detail::check_halving(d);
  const double reach = reach_about(near);
  const Box everywhere = cube(Vector::Zero(d), reach);
  SurfaceExtent extent = all_in(everywhere);
  extent.whole = shrink(surface, everywhere, context);
  if (extent.whole.dim() == 0) {
    throw_empty(surface, "within +-" + detail::describe(reach) + " (proved by interval bounds)");
  }
  extent.endless = extent.whole.lower.array() <= -reach || extent.whole.upper.array() >= reach;
  extent.box = extent.whole;
  if (!extent.endless.any()) return extent;

  Box window = around(near, d);
  for (;;) {
    extent.window = {extent.endless.select(window.lower.array(), everywhere.lower.array()),
                     extent.endless.select(window.upper.array(), everywhere.upper.array())};
    extent.box = shrink(surface, intersection(extent.window, extent.whole), context);
    if (extent.box.dim() != 0) return extent;
    if (window.upper.maxCoeff() >= reach) throw_empty(surface, "near the points asked about");
    const Vector middle = 0.5 * (window.lower + window.upper);
    const Vector half = window.extent();  // twice as wide
    window = {middle - half, middle + half};
  }
}

/// Where Newton's iteration takes starts scattered over a cube; its columns are those that arrive in the domain.
Points trial(const Surface& surface, const Vector& centre, double half_width) {
  const Index d = surface.dim();
  Points starts(d, kTrials);
  // Roberts' additive recurrence: well spread in any dimension, and always the same.
  double root = 2;
  for (int i = 0; i < 40; ++i) root = std::pow(1 + root, 1.0 / static_cast<double>(d + 1));
  for (Index j = 0; j < kTrials; ++j) {
    for (Index a = 0; a < d; ++a) {
      const double position = 0.5 + static_cast<double>(j + 1) * std::pow(root, -static_cast<double>(a + 1));
      starts(a, j) = centre(a) + half_width * (2 * (position - std::floor(position)) - 1);
    }
  }
  const auto evaluator = surface.make_evaluator();
  Eigen::Array<bool, Eigen::Dynamic, 1> good =
      project_to_surface(*evaluator, d, surface.codim(), starts, {.tolerance = 1e-9 * half_width, .max_steps = 60});
  good = good && surface.inside_domain(starts, 1e-6 * half_width);
  std::vector<Index> arrived;
  for (Index j = 0; j < kTrials; ++j) {
    if (good(j) && (starts.col(j) - centre).lpNorm<Eigen::Infinity>() <= 4 * half_width) arrived.push_back(j);
  }
  return starts(Eigen::all, arrived);
}

Box bounding_box(const Points& points) { return {points.rowwise().minCoeff(), points.rowwise().maxCoeff()}; }

Box with_margin(const Box& box, double part) {
  const double margin = part * box.diagonal();
  return {box.lower.array() - margin, box.upper.array() + margin};
}

bool about_the_same(const Box& a, const Box& b) {
  const double size = std::max(a.diagonal(), b.diagonal());
  return std::max((a.lower - b.lower).lpNorm<Eigen::Infinity>(), (a.upper - b.upper).lpNorm<Eigen::Infinity>()) <=
         0.15 * size;
}

SurfaceExtent by_trial(const Surface& surface, const PointsIn& near, const Context& context) {
  const Index d = surface.dim();
  const Vector centre = near.cols() > 0 ? Vector(near.rowwise().mean()) : Vector::Zero(d);
  std::vector<Box> boxes;
  bool any = false;
  for (double half_width = 1e-3; half_width <= 2e6; half_width *= 4) {
    context.check_cancelled();
    const Points arrived = trial(surface, centre, half_width);
    any = any || arrived.cols() > 0;
    // A few that arrive by chance tell nothing.
    if (arrived.cols() < kTrials / 16) {
      boxes.clear();
      continue;
    }
    boxes.push_back(bounding_box(arrived));
    const std::size_t n = boxes.size();
    // The starts must reach well beyond what they find.
    if (n >= 3 && about_the_same(boxes[n - 1], boxes[n - 2]) && about_the_same(boxes[n - 1], boxes[n - 3]) &&
        half_width > 4 * boxes[n - 1].diagonal()) {
      Box box = boxes[n - 1];
      for (std::size_t i = n - 3; i < n; ++i) {
        box = {box.lower.cwiseMin(boxes[i].lower), box.upper.cwiseMax(boxes[i].upper)};
      }
      return all_in(with_margin(box, kTrialMargin));
    }
  }
  // Boxes that keep growing with the starts: a surface without end.
  if (!any) throw_empty(surface, "that Newton's iteration finds from anywhere within +-1e6");
  SurfaceExtent extent = all_in(around(near, d));
  extent.whole = cube(Vector::Zero(d), reach_about(near));
  extent.endless.setConstant(true);
  return extent;
}

}  // namespace

SurfaceExtent find_extent(const Surface& surface, const PointsIn& near, const Context& context) {
  if (near.rows() != surface.dim()) {
    throw InvalidArgument("the points of interest have " + std::to_string(near.rows()) + " coordinates, the surface " +
                          std::to_string(surface.dim()) + " dimensions");
  }
  if (!near.allFinite()) throw InvalidArgument("a point of interest is not finite");
  if (surface.box()) return all_in(*surface.box());
  if (surface.samples() != nullptr && surface.samples()->size() > 0) {
    return all_in(with_margin(bounding_box(surface.samples()->points), kSampleMargin));
  }
  const detail::CrossingTest test(surface, Vector::Zero(surface.dim()), 1);
  return test.has_bounds() ? by_bounds(surface, near, context) : by_trial(surface, near, context);
}

Box find_box(const Surface& surface, const PointsIn& near, const Context& context) {
  return find_extent(surface, near, context).box;
}

SurfaceExtent through_window(const Surface& surface, const SurfaceExtent& extent, const Box& window,
                             const Context& context) {
  SurfaceExtent seen = extent;
  seen.window = window;
  seen.box = intersection(window, extent.whole);
  if (detail::CrossingTest(surface, Vector::Zero(surface.dim()), 1).has_bounds()) {
    const Box tight = shrink(surface, seen.box, context);
    if (tight.dim() != 0) seen.box = tight;
  }
  return seen;
}

}  // namespace taut
