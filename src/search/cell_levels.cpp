// Which cells a question is answered on. The size h of level 0 is asked for, or chosen from the box or the samples
// (cell_size.cpp) and, in space, halved until the normal turns moderately from cell to cell. Level l has h / 2^l. Cells
// are made by Algorithm I (subdivide) or II (grow), once a level, under one lock; everything derived of them likewise.
// Above kMostDimensions there are none, unless they grow lazily where a march goes.
#include "search/cell_levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <utility>

#include "search/cell_size.hpp"
#include "search/normal_turns.hpp"
#include "surface/point_text.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"
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
/// Half-way to the next level.
constexpr double kClearlyCoarser = 1.5;
constexpr int kMostRefinements = 12;
constexpr Index kMostRefinedCells = 200'000;
/// Without cells, what stands for their size: this part of the points' extent.
constexpr double kPointsPerSide = 16;
/// Lazy cells in so many dimensions: along the largest coordinate.
constexpr double kLazyCellsPerRadius = 3;

/// The nearest of the surface points that are found from points around x (d), at distances of reach / 2^i. From x
/// itself Newton's method can stall where F is flat (a power of a polynomial) or has a hollow.
std::optional<ProjectionResult> project_from_around(const Surface& surface, const VectorIn& x, double reach) {
  constexpr int kShells = 7;
  constexpr Index kDirections = 32;  // a shell, the same in every run
  const Index d = surface.dim();
  // A fixed seed: the same directions in every run.
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Points from(d, kShells * kDirections);
  for (Index j = 0; j < from.cols(); ++j) {
    Vector direction(d);
    for (double& c : direction) c = normal(random);
    from.col(j) = x + std::ldexp(reach, -static_cast<int>(j / kDirections)) * direction.normalized();
  }
  const auto evaluator = surface.make_evaluator();
  const auto found = project_to_surface(*evaluator, d, surface.codim(), from);
  std::optional<ProjectionResult> nearest;
  for (Index j = 0; j < from.cols(); ++j) {
    const double distance = (from.col(j) - x).norm();
    if (!found(j) || (nearest && distance >= nearest->distance)) continue;
    nearest = ProjectionResult{.point = from.col(j), .distance = distance, .converged = true};
  }
  return nearest;
}

}  // namespace

CellLevels::CellLevels(Surface surface, CellRequest request, Context context)
    : surface_(std::move(surface)),
      request_(std::move(request)),
      context_(std::move(context)),
      seeds_(surface_.dim(), 0) {
  if (!(request_.size >= 0) || !std::isfinite(request_.size)) {
    throw InvalidArgument(fmt::format("cell size {}: must be positive, or 0 to have it chosen", request_.size));
  }
  if (request_.seeds.cols() > 0) {
    if (!grows_from_ends()) {
      throw InvalidArgument(
          "seeds are for Algorithm II on a surface that brings no samples: give them with GridMethod::grow only");
    }
    if (request_.seeds.rows() != surface_.dim() || !request_.seeds.allFinite()) {
      throw InvalidArgument(fmt::format("seeds: each must be {} finite numbers", surface_.dim()));
    }
  }
  if (surface_.dim() > kMostDimensions && request_.method == GridMethod::subdivide) {
    throw InvalidArgument(
        fmt::format("cells are subdivided in up to {} dimensions, not in {}: grow them (Algorithm II)", kMostDimensions,
                    surface_.dim()));
  }
}

bool CellLevels::fitted() const { return surface_.samples() != nullptr && surface_.samples()->size() > 0; }

double CellLevels::size(int level) const { return std::ldexp(size_, -level); }

double CellLevels::chosen_size() const {
  return fitted() ? cell_size_for_samples(*surface_.samples()) : cell_size_for_box(box());
}

bool CellLevels::coarser_than_chosen(int level) const {
  return request_.size > 0 && surface_.dim() <= kMostDimensions && size(level) > kClearlyCoarser * chosen_size();
}

bool CellLevels::prepare(const PointsIn& near) {
  const bool again = size_ > 0;
  if (again) {
    bool inside = true;
    for (Index j = 0; j < near.cols(); ++j) inside = inside && extent_.window.contains(near.col(j));
    // A box that the user gave is not made larger for points beyond it.
    if (inside || surface_.box()) {
      if (!plant(near)) return false;
      complete_.clear();
      return true;
    }
    complete_.clear();
  }
  if (surface_.dim() > kMostDimensions) {
    if (near.cols() == 0) return again;  // nothing to judge by yet
    // Nothing is looked for in this box: it gives distances a scale.
    extent_.box = extent_.window = {near.rowwise().minCoeff(), near.rowwise().maxCoeff()};
    const double extent = std::max(box().extent().maxCoeff(), near.cwiseAbs().maxCoeff());
    size_ = request_.size > 0 ? request_.size : extent / (lazy() ? kLazyCellsPerRadius : kPointsPerSide);
    return again;
  }
  extent_ = find_extent(surface_, near, context_);
  size_ = request_.size;
  if (size_ == 0) size_ = chosen_size();
  (void)plant(near);
  return again;
}

/// Adds seeds where Algorithm II has to begin for the points near (d x n). True where there are cells that do not hold
/// all of them.
bool CellLevels::plant(const PointsIn& near) {
  if (!grows_from_ends() || lazy()) return false;
  Points planted(surface_.dim(), request_.seeds.cols() + near.cols());
  if (request_.seeds.cols() > 0) planted.leftCols(request_.seeds.cols()) = request_.seeds;
  planted.rightCols(near.cols()) = near;
  const auto evaluator = surface_.make_evaluator();
  const auto found = project_to_surface(*evaluator, surface_.dim(), surface_.codim(), planted);
  const bool made = !complete_.empty() && complete_.front().cells;
  bool missing = false;
  std::vector<Index> kept;
  for (Index j = 0; j < planted.cols(); ++j) {
    if (!found(j)) continue;
    // A point in a cell that is there adds nothing: growth would have come the same way.
    if (made && complete_.front().cells->grid().find_point(planted.col(j)) != CellGrid::kNone) continue;
    missing = true;
    kept.push_back(j);
  }
  if (!missing) return false;
  const auto num_kept = static_cast<Index>(kept.size());
  seeds_.conservativeResize(surface_.dim(), seeds_.cols() + num_kept);
  seeds_.rightCols(num_kept) = planted(Eigen::all, kept);
  return made;
}

bool CellLevels::grows() const {
  return request_.method == GridMethod::grow || (request_.method == GridMethod::automatic && fitted());
}

CellGrid CellLevels::grid_of(double h, CellCounts* counts) const {
  if (!grows()) return subdivide(surface_, {.size = h, .box = box(), .origin = {}, .counts = counts}, context_);
  const GrowOptions options{.size = h, .origin = {}, .counts = counts};
  if (fitted()) return grow(surface_, surface_.samples()->points, options, context_);
  if (seeds_.cols() == 0) {
    throw InvalidArgument(
        "Algorithm II grows cells from points of the surface: give it some (option samples), or "
        "subdivide (option grid)");
  }
  return grow(surface_.with_box(box()), seeds_, options, context_);
}

std::shared_ptr<SurfaceCells> CellLevels::complete(double h, CellCounts* counts) const {
  return std::make_shared<SurfaceCells>(surface_, grid_of(h, counts), context_);
}

std::shared_ptr<SurfaceCells> CellLevels::subdivided(double h) const {
  return grows() ? nullptr : complete(h, nullptr);
}

/// Finds out whether the surface bends too much from one of the coarsest cells to the next for marched distances to
/// tell ways apart, and makes them finer if it does, where that costs little (d = 3, subdivided, of no given size).
void CellLevels::refine_to_curvature() {
  Complete& coarsest = complete_.front();
  const bool refines = surface_.dim() == 3 && request_.size == 0 && !grows();
  for (int i = 0; i < kMostRefinements; ++i) {
    const NormalTurns turns(*coarsest.cells, context_);
    mostly_resolved_ = turns.make_a_sheet() && turns.mostly_within(kMostTurn, kTypically);
    const bool nearly_everywhere = turns.mostly_within(kMostTurn, kNearlyEverywhere);
    // Of a size that was asked for no rims will be refined.
    resolved_ = mostly_resolved_ && (request_.size == 0 || nearly_everywhere);
    const bool enough = resolved_ && (i >= kRefinementsForRims || nearly_everywhere);
    // Half the size has four times the cells.
    if (enough || !refines || 4 * coarsest.cells->num_cells() > kMostRefinedCells) return;
    size_ /= 2;
    coarsest.cells = complete(size_, &coarsest.counts);
  }
}

std::shared_ptr<SurfaceCells> CellLevels::cells(int level, const PointsIn& seeds) {
  if (lazy()) {
    return std::make_shared<SurfaceCells>(SurfaceCells::lazy(surface_, seeds, size(level), context_, kMostLazyCells));
  }
  const std::lock_guard lock(mutex_);
  complete_.resize(std::max(complete_.size(), static_cast<std::size_t>(level) + 1));
  Complete& slot = complete_[static_cast<std::size_t>(level)];
  if (slot.cells) return slot.cells;
  slot.cells = complete(size(level), &slot.counts);
  if (level == 0) refine_to_curvature();
  return slot.cells;
}

std::shared_ptr<SurfaceCells> CellLevels::envelope(int level, Index layers) {
  if (lazy()) throw InvalidArgument("cells that grow where the march goes have no envelope");
  const std::shared_ptr<SurfaceCells> bare = cells(level, Points(surface_.dim(), 0));
  const std::lock_guard lock(mutex_);
  std::shared_ptr<SurfaceCells>& slot = complete_.at(static_cast<std::size_t>(level)).envelope;
  if (!slot) {
    slot = std::make_shared<SurfaceCells>(
        bare->thickened(layers == kEnvelopeByLaw ? envelope_layers(bare->grid()) : layers, context_));
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
  // Samples' noise would pass for bends.
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
  ProjectionResult projected = project_to_surface(surface_, x);
  if (!projected.converged) {
    if (const auto around = project_from_around(surface_, x, kMostCellsOff * size_)) projected = *around;
  }
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

double first_cell_size(const Surface& surface, const CellRequest& request, const PointsIn& near,
                       const Context& context) {
  CellLevels levels(surface, request, context);
  levels.prepare(near);
  return levels.size(0);
}

}  // namespace taut::detail
