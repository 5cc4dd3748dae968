// A set of cells of one size: integer coordinates in the order they came, and a hash of them (open addressing, linear
// probing, the cells' numbers in the slots). A face lies at origin + size c, computed in one way everywhere, and a
// point belongs to the cell whose faces say so. Sizes: 4 d bytes a cell and 6.4 to 12.8 for the table.
#include "taut/cells/cell_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "cells/cell_hash.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

constexpr std::size_t kMinSlots = 64;
constexpr Index kMaxNeighbourDim = 12;

/// The table grows once it is fuller than 5/8: 4 bytes a slot then make 6.4 to 12.8 a cell.
bool too_full(Index num_cells, std::size_t num_slots) {
  return static_cast<std::size_t>(num_cells) * 8 > num_slots * 5;
}

template <int D>
bool same(Index dim, const std::int32_t* a, const std::int32_t* b) {
  const Index d = D > 0 ? D : dim;
  for (Index axis = 0; axis < d; ++axis) {
    if (a[axis] != b[axis]) return false;
  }
  return true;
}

/// The slot of a cell, or the free slot where it belongs.
template <int D>
std::size_t probe(Index dim, const std::int32_t* cell, const std::vector<std::uint32_t>& slots,
                  const std::int32_t* coordinates) {
  const Index d = D > 0 ? D : dim;
  const std::size_t mask = slots.size() - 1;
  std::size_t slot = detail::hash_cell<D>(d, cell) & mask;
  while (slots[slot] != 0 && !same<D>(d, coordinates + (slots[slot] - 1) * static_cast<std::size_t>(d), cell)) {
    slot = (slot + 1) & mask;
  }
  return slot;
}

template <int D>
void find_neighbours(Index dim, const std::int32_t* cell, const std::vector<std::uint32_t>& slots,
                     const std::int32_t* coordinates, std::span<Index> out) {
  const Index d = D > 0 ? D : dim;
  std::int32_t at[kMaxNeighbourDim];
  for (Index axis = 0; axis < d; ++axis) at[axis] = cell[axis] - 1;
  const std::size_t middle = out.size() / 2;
  for (std::size_t m = 0; m <= out.size(); ++m) {
    if (m != middle) {
      out[m - (m > middle ? 1 : 0)] = Index{slots[probe<D>(d, at, slots, coordinates)]} - 1;
    }
    for (Index axis = 0; axis < d; ++axis) {
      if (++at[axis] <= cell[axis] + 1) break;
      // Carries to the next axis, like an odometer.
      at[axis] = cell[axis] - 1;
    }
  }
}

}  // namespace

CellGrid::CellGrid(Vector origin, double size) : origin_(std::move(origin)), size_(size), slots_(kMinSlots, 0) {
  if (dim() < 1) throw InvalidArgument("a grid needs at least 1 dimension");
  if (!(size > 0) || !std::isfinite(size)) {
    throw InvalidArgument("the cell size must be a positive length, not " + detail::describe(size));
  }
  if (!origin_.allFinite()) throw InvalidArgument("the grid's origin is not finite");
  // Faces must differ by more than rounding, or points would fall between cells.
  if (size < 64 * std::numeric_limits<double>::epsilon() * origin_.lpNorm<Eigen::Infinity>()) {
    throw InvalidArgument("cells of size " + detail::describe(size) + " cannot be told apart by rounding at " +
                          detail::describe(origin_) + ": take larger cells");
  }
}

Vector CellGrid::centre(Index i) const {
  const Box b = box(i);
  return 0.5 * (b.lower + b.upper);
}

Box CellGrid::box(Index i) const {
  const auto c = cell(i);
  Box b{Vector(dim()), Vector(dim())};
  for (Index axis = 0; axis < dim(); ++axis) {
    b.lower(axis) = face(axis, c[static_cast<std::size_t>(axis)]);
    b.upper(axis) = face(axis, c[static_cast<std::size_t>(axis)] + 1);
  }
  return b;
}

void CellGrid::cell_of(const VectorIn& x, std::span<std::int32_t> cell) const {
  for (Index axis = 0; axis < dim(); ++axis) {
    const double position = std::floor((x(axis) - origin_(axis)) / size_);
    // Written so that NaN is refused, too.
    if (!(std::abs(position) < kMaxCoordinate)) {
      throw InvalidArgument("coordinate " + std::to_string(axis + 1) + " of a point, " + detail::describe(x(axis)) +
                            ", lies more than 2^30 cells of size " + detail::describe(size_) +
                            " from the grid's origin: take larger cells");
    }
    // The division may round across a face; the faces as computed decide.
    auto c = static_cast<std::int32_t>(position);
    while (x(axis) < face(axis, c)) --c;
    while (x(axis) >= face(axis, c + 1)) ++c;
    cell[static_cast<std::size_t>(axis)] = c;
  }
}

Index CellGrid::find_point(const VectorIn& x) const {
  for (Index axis = 0; axis < dim(); ++axis) {
    // Asking about a point far away is no mistake: there is no cell.
    if (!(std::abs((x(axis) - origin_(axis)) / size_) < kMaxCoordinate - 1)) return kNone;
  }
  std::vector<std::int32_t> cell(static_cast<std::size_t>(dim()));
  cell_of(x, cell);
  return find(cell);
}

std::size_t CellGrid::slot_of(const std::int32_t* cell) const {
  switch (dim()) {
    case 2: return probe<2>(2, cell, slots_, coordinates_.data());
    case 3: return probe<3>(3, cell, slots_, coordinates_.data());
    case 4: return probe<4>(4, cell, slots_, coordinates_.data());
    default: return probe<Eigen::Dynamic>(dim(), cell, slots_, coordinates_.data());
  }
}

Index CellGrid::find(const std::int32_t* cell) const { return Index{slots_[slot_of(cell)]} - 1; }

Index CellGrid::insert(const std::int32_t* cell) {
  std::size_t slot = slot_of(cell);
  if (slots_[slot] != 0) return Index{slots_[slot]} - 1;
  if (num_cells_ == kMaxCells) throw OutOfMemory("a grid holds at most 4,294,967,294 cells: take larger cells");
  for (Index axis = 0; axis < dim(); ++axis) {
    if (cell[axis] < -kMaxCoordinate || cell[axis] > kMaxCoordinate) {
      throw InvalidArgument("cell coordinate " + std::to_string(cell[axis]) + " is beyond +-2^30: take larger cells");
    }
  }
  if (too_full(num_cells_ + 1, slots_.size())) {
    rehash(2 * slots_.size());
    slot = slot_of(cell);
  }
  coordinates_.insert(coordinates_.end(), cell, cell + dim());
  slots_[slot] = static_cast<std::uint32_t>(++num_cells_);
  return num_cells_ - 1;
}

void CellGrid::rehash(std::size_t num_slots) {
  slots_ = {};  // give the old table back first: the cells themselves say all
  slots_.resize(num_slots, 0);
  for (Index i = 0; i < num_cells_; ++i) {
    slots_[slot_of(coordinates_.data() + i * dim())] = static_cast<std::uint32_t>(i + 1);
  }
}

void CellGrid::reserve(Index num_cells) {
  coordinates_.reserve(static_cast<std::size_t>(num_cells * dim()));
  std::size_t num_slots = slots_.size();
  while (too_full(num_cells, num_slots)) num_slots *= 2;
  if (num_slots > slots_.size()) rehash(num_slots);
}

Index CellGrid::num_neighbours() const {
  if (dim() > kMaxNeighbourDim) {
    throw InvalidArgument("the 3^d - 1 neighbours of a cell are listed up to d = 12, not for d = " +
                          std::to_string(dim()));
  }
  Index count = 1;
  for (Index axis = 0; axis < dim(); ++axis) count *= 3;
  return count - 1;
}

void CellGrid::neighbour_offset(Index m, std::span<std::int32_t> offset) const {
  Index code = m + (m >= num_neighbours() / 2 ? 1 : 0);
  for (Index axis = 0; axis < dim(); ++axis) {
    offset[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(code % 3) - 1;
    code /= 3;
  }
}

void CellGrid::neighbours(Index i, std::span<Index> out) const {
  const std::int32_t* at = coordinates_.data() + i * dim();
  out = out.first(static_cast<std::size_t>(num_neighbours()));
  switch (dim()) {
    case 2: return find_neighbours<2>(2, at, slots_, coordinates_.data(), out);
    case 3: return find_neighbours<3>(3, at, slots_, coordinates_.data(), out);
    case 4: return find_neighbours<4>(4, at, slots_, coordinates_.data(), out);
    default: return find_neighbours<Eigen::Dynamic>(dim(), at, slots_, coordinates_.data(), out);
  }
}

CellGrid CellGrid::sorted() const {
  std::vector<std::uint32_t> order(static_cast<std::size_t>(num_cells_));
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return morton_less(cell(Index{a}), cell(Index{b})); });
  CellGrid result(origin_, size_);
  result.reserve(num_cells_);
  for (const std::uint32_t i : order) result.insert(cell(Index{i}));
  return result;
}

std::size_t CellGrid::bytes() const {
  return sizeof *this + coordinates_.capacity() * sizeof(std::int32_t) + slots_.capacity() * sizeof(std::uint32_t) +
         static_cast<std::size_t>(origin_.size()) * sizeof(double);
}

void CellGrid::trim() { coordinates_.shrink_to_fit(); }

bool morton_less(std::span<const std::int32_t> a, std::span<const std::int32_t> b) {
  // The axis whose coordinates differ in the highest bit decides (Chan 2002); flipping the sign bit orders Z.
  std::uint32_t highest = 0;
  std::size_t axis = a.size();
  for (std::size_t i = a.size(); i-- > 0;) {
    const std::uint32_t difference = static_cast<std::uint32_t>(a[i]) ^ static_cast<std::uint32_t>(b[i]);
    // The second condition: the highest bit of `difference` is above that of `highest`.
    if (highest < difference && highest < (highest ^ difference)) {
      highest = difference;
      axis = i;
    }
  }
  return axis < a.size() && a[axis] < b[axis];
}

Vector lattice_origin(const VectorIn& x, double size) {
  // Origins of grids of one size near each other are the same, so that their cells are. Off by the golden ratio, since
  // surfaces like to lie on round coordinates, where cells would touch them with their faces.
  const double lattice = size * 0x1p28;
  Vector origin(x.size());
  for (Index axis = 0; axis < x.size(); ++axis) {
    const double golden = 0.6180339887498949 * static_cast<double>(axis + 1);
    origin(axis) = lattice * std::round(x(axis) / lattice) - size * (golden - std::floor(golden));
  }
  return origin;
}

}  // namespace taut
