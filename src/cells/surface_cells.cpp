// Cells with a point of the surface each: the projection of the centre (d) and an orthonormal basis of the normal space
// there (d x k). A cell whose centre does not come to rest near by is tried from 2 d places around it, and is not valid
// if none of them does. Complete cells are projected once, in parallel; lazy ones grow by tiles as they are asked for.
#include "taut/cells/surface_cells.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "cells/crossing.hpp"
#include "cells/domain_edge.hpp"
#include "cells/memory_guard.hpp"
#include "cells/refine.hpp"
#include "core/parallel.hpp"
#include "surface/describe.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr Index kGrain = 256;
// A projected centre stands for its cell while it stays in the 3^d block around it...
constexpr double kReach = 1.5;
// ... and, for one equation, while it is no farther away, on any axis, than that of a cell that a plane crosses: at
// most max |n_i| (|n_1| + ... + |n_d|) / 2 = (1 + sqrt d) / 4 of a cell; curved surfaces need a little more. Interval
// bounds keep many cells beside the surface that would only crowd the march.
constexpr double kReachSlack = 0.1;
// Of a cell: the centre's projection may stop here, far below what marching sees.
constexpr double kTolerance = 1e-12;
// Of a cell: how far outside the domain a point on its edge may lie by rounding.
constexpr double kEdgeSlack = 1e-9;
// Of a cell: where a projection starts again that failed from the centre (two thin sheets meet in one cell, and the
// gradient vanishes between them).
constexpr double kRetryOffset = 0.25;

// What has been done for a lazy cell.
constexpr std::uint8_t kFaces = 1;  // its neighbours across faces are present
constexpr std::uint8_t kAll = 2;    // all neighbours are

std::size_t idx(Index i) { return static_cast<std::size_t>(i); }

/// Projects the centres of cells and judges the results. One a thread.
class CentreProjector {
 public:
  CentreProjector(const Surface& surface, double size)
      : surface_(surface),
        evaluator_(surface.make_evaluator()),
        d_(surface.dim()),
        size_(size),
        reach_(surface.codim() == 1 ? (1 + std::sqrt(static_cast<double>(d_))) / 4 + kReachSlack : kReach),
        options_{.tolerance = kTolerance * size, .max_steps = 30} {
    if (surface.domain() != nullptr) edge_.emplace(surface);
    options_.max_distance = 2 * kReach * size * std::sqrt(static_cast<double>(d_));
  }

  /// Cells [first, last) of the grid, into the slots of the whole arrays.
  void run(const CellGrid& grid, Index first, Index last, double* points, double* normals, std::uint8_t* valid) {
    const Index n = last - first;
    centres_.resize(d_, n);
    for (Index j = 0; j < n; ++j) {
      const auto cell = grid.cell(first + j);
      for (Index a = 0; a < d_; ++a) {
        const std::int32_t c = cell[idx(a)];
        centres_(a, j) = 0.5 * (grid.face(a, c) + grid.face(a, c + 1));
      }
    }
    project(centres_);
    failed_.clear();
    for (Index j = 0; j < n; ++j) {
      valid[first + j] = good_(j) ? 1 : 0;
      if (good_(j)) {
        store(j, first + j, points, normals);
      } else {
        std::copy_n(centres_.col(j).data(), d_, points + (first + j) * d_);
        std::fill_n(normals + (first + j) * normals_.rows(), normals_.rows(), 0.0);
        failed_.push_back(j);
      }
    }
    if (!failed_.empty()) retry(first, points, normals, valid);
  }

 private:
  /// Fills moved_, normals_ and good_ from `starts` (d x n); `good_` where the result also stays near its start and
  /// inside the domain.
  void project(const Eigen::MatrixXd& starts) {
    moved_ = starts;
    good_ = project_to_surface(*evaluator_, d_, surface_.codim(), moved_, options_, &normals_);
    if (edge_) pull_into_domain();
    // A point pulled to the domain's edge may be farther from its centre than the surface is.
    const double reach = edge_ ? kReach : reach_;
    for (Index j = 0; j < starts.cols(); ++j) {
      if ((moved_.col(j) - starts.col(j)).lpNorm<Eigen::Infinity>() > reach * size_) good_(j) = false;
    }
  }

  /// A centre that projects outside the domain is represented by a point on its edge, so that the rim is not frayed.
  void pull_into_domain() {
    const Eigen::Array<bool, Eigen::Dynamic, 1> inside = surface_.inside_domain(moved_);
    for (Index j = 0; j < moved_.cols(); ++j) {
      if (!good_(j) || inside(j)) continue;
      Eigen::MatrixXd normal;
      Eigen::MatrixXd point = moved_.col(j);
      good_(j) = edge_->pull(point, options_, kEdgeSlack * size_) &&
                 project_to_surface(*evaluator_, d_, surface_.codim(), point, options_, &normal)(0);
      if (!good_(j)) continue;
      moved_.col(j) = point;
      normals_.col(j) = normal;
    }
  }

  void store(Index from, Index to, double* points, double* normals) const {
    std::copy_n(moved_.col(from).data(), d_, points + to * d_);
    std::copy_n(normals_.col(from).data(), normals_.rows(), normals + to * normals_.rows());
  }

  /// From 2 d points about the failed centres; the result nearest to the centre counts.
  void retry(Index first, double* points, double* normals, std::uint8_t* valid) {
    const Index num_failed = static_cast<Index>(failed_.size());
    Eigen::MatrixXd starts(d_, 2 * d_ * num_failed);
    for (Index f = 0; f < num_failed; ++f) {
      for (Index s = 0; s < 2 * d_; ++s) {
        auto start = starts.col(2 * d_ * f + s);
        start = centres_.col(failed_[idx(f)]);
        start(s / 2) += (s % 2 == 0 ? kRetryOffset : -kRetryOffset) * size_;
      }
    }
    project(starts);
    for (Index f = 0; f < num_failed; ++f) {
      const Index j = failed_[idx(f)];
      double nearest = kReach * size_;
      for (Index s = 2 * d_ * f; s < 2 * d_ * (f + 1); ++s) {
        const double distance = (moved_.col(s) - centres_.col(j)).lpNorm<Eigen::Infinity>();
        if (!good_(s) || distance >= nearest) continue;
        nearest = distance;
        store(s, first + j, points, normals);
        valid[first + j] = 1;
      }
    }
  }

  const Surface& surface_;
  std::unique_ptr<Evaluator> evaluator_;
  Index d_;
  double size_;
  double reach_;  // of a cell
  ProjectionOptions options_;
  std::optional<detail::DomainEdge> edge_;
  Eigen::MatrixXd centres_, moved_, normals_;
  Eigen::Array<bool, Eigen::Dynamic, 1> good_;
  std::vector<Index> failed_;
};

/// Lazy growth goes by aligned tiles of about 64 cells (4^3 in space), so that tests come in batches.
int tile_level(Index dim, bool has_bounds) {
  // Without bounds, cells larger than asked for cannot be refused safely, so tiles do not pay above d = 3.
  if (dim > 6 || (!has_bounds && dim > 3)) return 0;
  return dim <= 2 ? 3 : dim == 3 ? 2 : 1;
}

}  // namespace

struct SurfaceCells::Growth {
  Growth(const Surface& surface_in, const CellGrid& grid, const Context& context_in)
      : surface(surface_in),
        context(context_in),
        test(surface, grid.origin(), grid.size()),
        level(tile_level(surface.dim(), test.has_bounds())),
        tiles(Vector::Zero(surface.dim()), 1.0),
        limit(detail::memory_limit(context_in)) {}

  /// Notes the tile of a cell for the next resolve_tiles(), unless it has been there.
  void want_tile(const std::int32_t* tile) {
    const Index before = tiles.num_cells();
    if (tiles.insert(tile) == before) pending.insert(pending.end(), tile, tile + surface.dim());
  }

  Surface surface;
  Context context;
  detail::CrossingTest test;
  int level;          // a tile is 2^level cells wide
  CellGrid tiles;     // those resolved or pending
  std::size_t limit;  // bytes
  Index most_cells = CellGrid::kMaxCells;
  std::vector<std::int32_t> pending;   // d each
  std::vector<std::int32_t> found;     // d each
  std::vector<std::uint8_t> expanded;  // by cell: 0, kFaces or kAll
};

SurfaceCells::~SurfaceCells() = default;
SurfaceCells::SurfaceCells(SurfaceCells&&) noexcept = default;
SurfaceCells& SurfaceCells::operator=(SurfaceCells&&) noexcept = default;

SurfaceCells::SurfaceCells(CellGrid grid, Index codim, std::unique_ptr<Growth> growth)
    : grid_(std::move(grid)), codim_(codim), growth_(std::move(growth)) {}

SurfaceCells::SurfaceCells(const Surface& surface, CellGrid grid, const Context& context)
    : SurfaceCells(std::move(grid), surface.codim(), nullptr) {
  if (surface.dim() != dim()) {
    throw InvalidArgument("the cells have " + std::to_string(dim()) + " dimensions, the surface " +
                          std::to_string(surface.dim()));
  }
  const std::size_t bytes_a_cell = static_cast<std::size_t>(dim() * (1 + codim_)) * sizeof(double) + 1;
  detail::check_memory(grid_.bytes() + idx(num_cells()) * bytes_a_cell, detail::memory_limit(context), num_cells(),
                       grid_.size());
  project_new(surface, context);
  if (num_valid_ == 0) {
    throw EmptySurface("none of the " + std::to_string(num_cells()) + " cells of size " +
                       detail::describe(grid_.size()) +
                       " has a surface point: take smaller cells, or the surface is empty or singular everywhere");
  }
}

SurfaceCells SurfaceCells::lazy(const Surface& surface, const PointsIn& seeds, double size, const Context& context,
                                Index most_cells) {
  if (seeds.rows() != surface.dim() || seeds.cols() == 0) {
    throw InvalidArgument("growing needs at least one seed with the surface's " + std::to_string(surface.dim()) +
                          " coordinates");
  }
  CellGrid grid(lattice_origin(seeds.col(0), size), size);
  auto growth = std::make_unique<Growth>(surface, grid, context);
  growth->most_cells = most_cells;
  SurfaceCells cells(std::move(grid), surface.codim(), std::move(growth));
  std::vector<std::int32_t> cell(idx(surface.dim()));
  for (Index j = 0; j < seeds.cols(); ++j) {
    cells.grid_.cell_of(seeds.col(j), cell);
    for (auto& c : cell) c >>= cells.growth_->level;
    cells.growth_->want_tile(cell.data());
  }
  cells.resolve_tiles();
  bool found = false;
  for (Index j = 0; j < seeds.cols() && !found; ++j) found = cells.grid_.find_point(seeds.col(j)) != CellGrid::kNone;
  if (!found || cells.num_valid_ == 0) {
    throw EmptySurface("no surface crosses the cells of size " + detail::describe(size) +
                       " that hold the seeds, such as " + detail::describe(seeds.col(0)));
  }
  return cells;
}

SurfaceCells SurfaceCells::thickened(Index layers, const Context& context) const {
  if (is_lazy()) throw InvalidArgument("only complete cells can be thickened");
  SurfaceCells thick(thicken(grid_, layers, context), codim_, nullptr);
  const Index n = thick.num_cells();
  thick.num_valid_ = num_valid_;
  thick.num_layers_ = layers;
  const std::size_t bytes_a_cell = static_cast<std::size_t>(dim() * (1 + codim_)) * sizeof(double) + 1;
  detail::check_memory(thick.grid_.bytes() + idx(n) * bytes_a_cell, detail::memory_limit(context), n, grid_.size());
  thick.points_ = points_;
  thick.normals_ = normals_;
  thick.valid_ = valid_;
  thick.points_.resize(idx(n * dim()));
  thick.normals_.resize(idx(n * dim() * codim_), 0.0);
  thick.valid_.resize(idx(n), 0);
  for (Index i = num_cells(); i < n; ++i) {
    Eigen::Map<Vector>(thick.points_.data() + i * dim(), dim()) = thick.grid_.centre(i);
  }
  return thick;
}

void SurfaceCells::project_new(const Surface& surface, const Context& context) {
  const Index begin = static_cast<Index>(valid_.size());
  const Index end = num_cells();
  points_.resize(idx(end * dim()));
  normals_.resize(idx(end * dim() * codim_));
  valid_.resize(idx(end));
  detail::parallel_for(context, begin, end, kGrain, [&](Index first, Index last) {
    CentreProjector(surface, grid_.size()).run(grid_, first, last, points_.data(), normals_.data(), valid_.data());
  });
  num_valid_ += std::count(valid_.begin() + begin, valid_.end(), std::uint8_t{1});
}

void SurfaceCells::resolve_tiles() {
  Growth& growth = *growth_;
  if (growth.pending.empty()) return;
  growth.context.check_cancelled();
  growth.found.clear();
  detail::Refiner refiner(growth.test, dim());
  // With bounds a tile is refused as a whole; without, a Taylor polynomial is trusted on cells of the wanted size only.
  if (growth.test.has_bounds()) {
    refiner.refine(growth.pending, growth.level, 0, growth.found);
  } else {
    std::vector<std::int32_t> all = growth.pending;
    for (int level = growth.level; level > 0; --level) {
      std::vector<std::int32_t> halves;
      detail::append_halves(dim(), all.data(), static_cast<Index>(all.size()) / dim(), halves);
      all.swap(halves);
    }
    refiner.refine(all, 0, 0, growth.found);
  }
  growth.pending.clear();
  for (std::size_t c = 0; c < growth.found.size(); c += idx(dim())) grid_.insert(growth.found.data() + c);
  growth.expanded.resize(idx(num_cells()), 0);
  detail::check_memory(bytes(), growth.limit, num_cells(), grid_.size());
  if (num_cells() > growth.most_cells) {
    throw OutOfMemory("the way was not found on " + std::to_string(growth.most_cells) + " cells of size " +
                      detail::describe(grid_.size()) + ", and no more are grown: take larger cells (option cell)");
  }
  Context serial = growth.context;
  serial.threads = 1;  // too little work at a time to share
  project_new(growth.surface, serial);
}

void SurfaceCells::expand(std::span<const Index> cells) {
  if (!growth_) return;
  const Index d = dim();
  const int level = growth_->level;
  std::vector<std::int32_t> first(idx(d)), last(idx(d)), tile(idx(d));
  static_cast<void>(grid_.num_neighbours());  // refuses dimensions where neighbours cannot be listed
  for (const Index i : cells) {
    if (growth_->expanded[idx(i)] == kAll) continue;
    growth_->expanded[idx(i)] = kAll;
    const auto cell = grid_.cell(i);
    for (Index a = 0; a < d; ++a) {
      first[idx(a)] = (cell[idx(a)] - 1) >> level;
      last[idx(a)] = (cell[idx(a)] + 1) >> level;
    }
    tile = first;
    for (bool more = true; more;) {
      growth_->want_tile(tile.data());
      more = false;
      for (Index a = 0; a < d && !more; ++a) {
        more = ++tile[idx(a)] <= last[idx(a)];
        if (!more) tile[idx(a)] = first[idx(a)];
      }
    }
  }
  resolve_tiles();
}

void SurfaceCells::expand_faces(Index i) {
  if (!growth_ || growth_->expanded[idx(i)] != 0) return;
  growth_->expanded[idx(i)] = kFaces;
  const auto cell = grid_.cell(i);
  std::vector<std::int32_t> tile(cell.begin(), cell.end());
  for (auto& c : tile) c >>= growth_->level;
  for (std::size_t a = 0; a < tile.size(); ++a) {
    const std::int32_t centre = tile[a];
    for (const std::int32_t side : {cell[a] - 1, cell[a] + 1}) {
      tile[a] = side >> growth_->level;
      growth_->want_tile(tile.data());
    }
    tile[a] = centre;
  }
  resolve_tiles();
}

Index SurfaceCells::cell_at(const VectorIn& x) {
  if (!growth_) return grid_.find_point(x);
  std::vector<std::int32_t> cell(idx(dim()));
  grid_.cell_of(x, cell);
  std::vector<std::int32_t> tile = cell;
  for (auto& c : tile) c >>= growth_->level;
  growth_->want_tile(tile.data());
  resolve_tiles();
  return grid_.find(cell);
}

std::size_t SurfaceCells::bytes() const {
  std::size_t sum = grid_.bytes() + (points_.capacity() + normals_.capacity()) * sizeof(double) + valid_.capacity();
  if (growth_) sum += growth_->tiles.bytes() + growth_->expanded.capacity();
  return sum;
}

}  // namespace taut
