#include "query/cell_levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "query/cell_size.hpp"
#include "query/normal_turns.hpp"
#include "taut/cells/components.hpp"
#include "taut/cells/grow.hpp"
#include "taut/cells/subdivide.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

/// A point this many cells off the surface is a mistake, not a rounded coordinate.
constexpr double kMostCellsOff = 10;
/// The normal should turn by no more than this from one cell to the next, radians, as long as there are not too many:
/// nearly everywhere after so many refinements, else where the surface is typical (a flat body bends at its rim only).
constexpr double kMostTurn = 0.7;
constexpr double kNearlyEverywhere = 0.95;
constexpr double kTypically = 0.75;
constexpr int kRefinementsForRims = 2;
constexpr int kMostRefinements = 12;
constexpr Index kMostRefinedCells = 200'000;
/// Without cells, what stands for their size: this part of the points' extent.
constexpr double kPointsPerSide = 16;

}  // namespace

std::string text_of(const VectorIn& x) {
  std::string text;
  for (Index i = 0; i < x.size(); ++i) text += fmt::format("{}{}", i > 0 ? "," : "", x(i));
  return text;
}

std::string text_of(const Box& box) {
  std::string text;
  for (Index a = 0; a < box.dim(); ++a) {
    text += fmt::format("{}[{:.4g}, {:.4g}]", a > 0 ? " x " : "", box.lower(a), box.upper(a));
  }
  return text;
}

void check_point(const Surface& surface, const VectorIn& x, const char* name) {
  if (x.size() != surface.dim()) {
    throw InvalidArgument(fmt::format("{} point {}: has {} coordinates, the surface lies in {} dimensions", name,
                                      text_of(x), x.size(), surface.dim()));
  }
  if (!x.allFinite()) throw InvalidArgument(fmt::format("{} point {}: coordinates must be finite", name, text_of(x)));
}

CellLevels::CellLevels(Surface surface, GridMethod grid, double cell, Context context)
    : surface_(std::move(surface)), grid_(grid), context_(std::move(context)), cell_(cell) {
  if (!(cell >= 0) || !std::isfinite(cell)) {
    throw InvalidArgument(fmt::format("cell size {}: must be positive, or 0 to have it chosen", cell));
  }
}

bool CellLevels::fitted() const { return surface_.samples() != nullptr && surface_.samples()->size() > 0; }

double CellLevels::size(int level) const { return std::ldexp(size_, -level); }

bool CellLevels::prepare(const PointsIn& near) {
  const bool again = size_ > 0;
  if (again) {
    bool inside = true;
    for (Index j = 0; j < near.cols(); ++j) inside = inside && extent_.window.contains(near.col(j));
    if (inside || surface_.box()) return false;
    complete_.clear();
  }
  if (!exist()) {
    if (near.cols() == 0) return again;  // nothing to judge by yet
    extent_.box = extent_.window = {near.rowwise().minCoeff(), near.rowwise().maxCoeff()};
    size_ = std::max(box().extent().maxCoeff(), near.cwiseAbs().maxCoeff()) / kPointsPerSide;
    return again;
  }
  extent_ = find_extent(surface_, near, context_);
  size_ = cell_;
  if (size_ == 0) size_ = fitted() ? cell_size_for_samples(*surface_.samples()) : cell_size_for_box(box());
  return again;
}

bool CellLevels::grows() const { return grid_ == GridMethod::grow || (grid_ == GridMethod::automatic && fitted()); }

std::shared_ptr<SurfaceCells> CellLevels::subdivided(double h) const {
  if (grows()) return nullptr;
  return std::make_shared<SurfaceCells>(
      surface_, subdivide(surface_, {.size = h, .box = box(), .origin = {}}, context_), context_);
}

/// Finds out whether the surface bends too much from one of the coarsest cells to the next for marched distances to
/// tell ways apart, and makes them finer if it does, where that costs little (d = 3).
void CellLevels::refine_to_curvature() {
  std::shared_ptr<SurfaceCells>& coarsest = complete_.front().cells;
  for (int i = 0; i < kMostRefinements; ++i) {
    const NormalTurns turns(*coarsest, context_);
    resolved_ = turns.make_a_sheet() && turns.mostly_within(kMostTurn, kTypically);
    const bool enough = resolved_ && (i >= kRefinementsForRims || turns.mostly_within(kMostTurn, kNearlyEverywhere));
    if (enough || surface_.dim() != 3 || 4 * coarsest->num_cells() > kMostRefinedCells) return;
    size_ /= 2;
    coarsest = subdivided(size_);
  }
}

std::shared_ptr<SurfaceCells> CellLevels::cells(int level, const PointsIn& seeds) {
  if (lazy()) {
    return std::make_shared<SurfaceCells>(SurfaceCells::lazy(surface_, seeds, size(level), context_));
  }
  const std::lock_guard lock(mutex_);
  complete_.resize(std::max(complete_.size(), static_cast<std::size_t>(level) + 1));
  std::shared_ptr<SurfaceCells>& slot = complete_[static_cast<std::size_t>(level)].cells;
  if (slot) return slot;
  if (grows()) {
    slot = std::make_shared<SurfaceCells>(surface_, grow(surface_, surface_.samples()->points, size(level), context_),
                                          context_);
  } else {
    slot = subdivided(size(level));
    if (level == 0 && cell_ == 0) refine_to_curvature();
  }
  return slot;
}

std::shared_ptr<const CellMap> CellLevels::map(int level) {
  if (lazy()) return nullptr;
  const std::lock_guard lock(mutex_);
  Complete& slot = complete_.at(static_cast<std::size_t>(level));
  if (!slot.map) slot.map = map_cells(*slot.cells, context_);
  return slot.map;
}

std::shared_ptr<const std::vector<std::int32_t>> CellLevels::components(int level) {
  const std::lock_guard lock(mutex_);
  Complete& slot = complete_.at(static_cast<std::size_t>(level));
  if (!slot.components) {
    slot.components = std::make_shared<std::vector<std::int32_t>>(taut::components(slot.cells->grid()).label);
  }
  return slot.components;
}

std::shared_ptr<const std::vector<std::int32_t>> CellLevels::known_components(int level) {
  const std::lock_guard lock(mutex_);
  const auto at = static_cast<std::size_t>(level);
  return at < complete_.size() ? complete_[at].components : nullptr;
}

std::shared_ptr<const SharpBends> CellLevels::sharp_bends(int level) {
  if (surface_.dim() != 3 || surface_.codim() != 1 || lazy() || fitted()) return nullptr;
  const std::shared_ptr<const CellMap> known = map(level);
  const std::lock_guard lock(mutex_);
  Complete& slot = complete_.at(static_cast<std::size_t>(level));
  if (!slot.sharp_bends) {
    const auto& neighbours = static_cast<const NeighbourIndex<3>&>(*known->neighbours);
    slot.sharp_bends = std::make_shared<SharpBends>(surface_, *slot.cells, neighbours, context_);
  }
  return slot.sharp_bends;
}

Vector CellLevels::on_surface(const VectorIn& x, const char* name) const {
  const ProjectionResult projected = project_to_surface(surface_, x);
  if (!projected.converged) {
    throw InvalidArgument(
        fmt::format("{} point {}: no point of the surface was found near it; give one closer", name, text_of(x)));
  }
  if (projected.distance > kMostCellsOff * size_) {
    throw InvalidArgument(
        fmt::format("{} point {}: lies {:.3g} off the surface, more than {:g} cells of {:.3g}; the "
                    "surface point found is {}",
                    name, text_of(x), projected.distance, kMostCellsOff, size_, text_of(projected.point)));
  }
  if (projected.distance > size_) {
    context_.tell(fmt::format("{} point {} moved by {:.3g} onto the surface, to {}", name, text_of(x),
                              projected.distance, text_of(projected.point)));
  }
  if (!surface_.inside_domain(projected.point, size_)(0)) {
    throw InvalidArgument(fmt::format("{} point {}: the surface does not reach there, it is cut off by its domain",
                                      name, text_of(projected.point)));
  }
  return projected.point;
}

}  // namespace taut::detail
