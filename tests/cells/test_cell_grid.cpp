#include "taut/cells/cell_grid.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>
#include <vector>

#include "taut/core/error.hpp"

namespace taut {
namespace {

using Cell = std::vector<std::int32_t>;

TEST(CellGrid, AgreesWithAMapUnderRandomInserts) {
  std::mt19937_64 random(5);
  for (const Index d : {1, 2, 3, 4, 5, 7, 20}) {
    std::uniform_int_distribution<std::int32_t> near(-4, 4);
    CellGrid grid(Vector::Zero(d), 0.5);
    std::map<Cell, Index> truth;
    for (int repeat = 0; repeat < 3000; ++repeat) {
      Cell cell(static_cast<std::size_t>(d));
      for (auto& c : cell) c = near(random) * (repeat % 3 == 0 ? 100'000'003 : 1);
      const auto known = truth.find(cell);
      EXPECT_EQ(grid.find(cell), known == truth.end() ? CellGrid::kNone : known->second);
      truth.emplace(cell, grid.num_cells());
      EXPECT_EQ(grid.insert(cell), truth.at(cell));
    }
    ASSERT_EQ(grid.num_cells(), static_cast<Index>(truth.size()));
    for (const auto& [cell, i] : truth) {
      EXPECT_EQ(grid.find(cell), i);
      EXPECT_EQ(Cell(grid.cell(i).begin(), grid.cell(i).end()), cell);
    }
  }
}

TEST(CellGrid, AtMostFortyBytesACellInSpaceHoweverItGrew) {
  CellGrid grid(Vector::Zero(3), 1);
  for (std::int32_t i = 0; i < 300'000; ++i) {
    grid.insert(std::array{i % 600, i / 600, (i % 11) * (i % 13) % 7});
    if (i > 10'000 && i % 1000 == 0) {
      EXPECT_LE(grid.bytes(), static_cast<std::size_t>(40 * grid.num_cells())) << i;
    }
  }
}

TEST(CellGrid, PutsEveryPointIntoTheBoxThatHoldsIt) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double size : {0.1, 1.0 / 3, 1e-7, 77.7}) {
    CellGrid grid(Eigen::Vector2d(0.1 * size, 1234.5), size);
    for (int repeat = 0; repeat < 2000; ++repeat) {
      Eigen::Vector2d x(size * 1000 * uniform(random), 1234.5 + size * 1000 * uniform(random));
      if (repeat % 2 == 0) x(0) = grid.face(0, repeat - 1000);  // on a face, to the last bit
      Cell cell(2);
      grid.cell_of(x, cell);
      const Box box = grid.box(grid.insert(cell));
      EXPECT_TRUE(box.contains(x));
      EXPECT_LT(x(0), box.upper(0));
      EXPECT_EQ(grid.find_point(x), grid.find(cell));
    }
  }
}

TEST(CellGrid, NeighboursComeInTheOrderOfTheirOffsets) {
  for (const Index d : {1, 2, 3, 4, 5}) {
    CellGrid grid(Vector::Zero(d), 1);
    const Cell centre(static_cast<std::size_t>(d), -7);
    const Index i = grid.insert(centre);
    Cell offset(static_cast<std::size_t>(d));
    for (Index m = 0; m < grid.num_neighbours(); m += 2) {
      grid.neighbour_offset(m, offset);
      for (auto& c : offset) c -= 7;
      grid.insert(offset);
    }
    std::vector<Index> found(static_cast<std::size_t>(grid.num_neighbours()));
    grid.neighbours(i, found);
    for (Index m = 0; m < grid.num_neighbours(); ++m) {
      const Index neighbour = found[static_cast<std::size_t>(m)];
      EXPECT_EQ(neighbour == CellGrid::kNone, m % 2 == 1);
      if (neighbour == CellGrid::kNone) continue;
      grid.neighbour_offset(m, offset);
      Cell opposite(static_cast<std::size_t>(d));
      grid.neighbour_offset(grid.num_neighbours() - 1 - m, opposite);
      for (std::size_t a = 0; a < offset.size(); ++a) {
        EXPECT_EQ(grid.cell(neighbour)[a], -7 + offset[a]);
        EXPECT_EQ(opposite[a], -offset[a]);
      }
    }
  }
}

TEST(CellGrid, SortsAlongTheZCurve) {
  CellGrid grid(Vector::Zero(2), 1);
  for (std::int32_t i = 0; i < 64; ++i) grid.insert(std::array{i * 37 % 8 - 4, i * 37 / 8 % 8 - 4});
  const CellGrid sorted = grid.sorted();
  ASSERT_EQ(sorted.num_cells(), grid.num_cells());
  for (Index i = 1; i < sorted.num_cells(); ++i) EXPECT_TRUE(morton_less(sorted.cell(i - 1), sorted.cell(i)));
  EXPECT_EQ(sorted.cell(0)[0], -4);
  EXPECT_EQ(sorted.cell(1)[0], -3);
  EXPECT_EQ(sorted.cell(2)[1], -3);
}

TEST(CellGrid, RefusesWhatIntegersCannotHold) {
  EXPECT_THROW(CellGrid(Vector::Zero(3), 0), InvalidArgument);
  EXPECT_THROW(CellGrid(Vector::Zero(3), -1), InvalidArgument);
  EXPECT_THROW(CellGrid(Vector::Zero(3), std::nan("")), InvalidArgument);
  EXPECT_THROW(CellGrid(Vector::Zero(0), 1), InvalidArgument);
  EXPECT_THROW(CellGrid(Vector::Constant(3, 1e6), 1e-12), InvalidArgument);
  CellGrid grid(Vector::Zero(2), 1);
  Cell cell(2);
  EXPECT_THROW(grid.cell_of(Eigen::Vector2d(0, 2e9), cell), InvalidArgument);
  EXPECT_THROW(grid.cell_of(Eigen::Vector2d(0, std::nan("")), cell), InvalidArgument);
  EXPECT_EQ(grid.find_point(Eigen::Vector2d(0, 1e300)), CellGrid::kNone);
  EXPECT_THROW(grid.insert(std::array{0, (1 << 30) + 1}), InvalidArgument);
  EXPECT_THROW((void)CellGrid(Vector::Zero(13), 1).num_neighbours(), InvalidArgument);
}

TEST(CellGrid, TheLatticeIsTheSameForNeighbouringPointsAndNearFarOnes) {
  const Vector a = lattice_origin(Eigen::Vector3d(0.3, -5, 2), 0.01);
  EXPECT_EQ(a, lattice_origin(Eigen::Vector3d(-70, 5000, 0), 0.01));
  EXPECT_LE(a.lpNorm<Eigen::Infinity>(), 0.01);
  const Eigen::Vector3d far(1e9, -3e7, 0);
  EXPECT_LE((lattice_origin(far, 1e-3) - far).lpNorm<Eigen::Infinity>(), 1e-3 * 0x1p28);
}

}  // namespace
}  // namespace taut
