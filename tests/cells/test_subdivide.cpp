#include "taut/cells/find_cells.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>
#include <vector>

#include "support/interval_surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

/// Random coefficients of F_i = sum_a (A_ia x_a^2 + B_ia x_a + C_ia sin(2 x_a)) + E_i x_0 x_1 - G_i.
struct RandomEquations {
  Eigen::MatrixXd A, B, C;
  Vector E, G;
  RandomEquations(Index k, Index d, std::mt19937_64& random) : A(k, d), B(k, d), C(k, d), E(k), G(k) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (Index i = 0; i < k; ++i) {
      for (Index a = 0; a < d; ++a) {
        A(i, a) = (i == 0 ? 1.2 : 0.4) + 0.4 * uniform(random);
        B(i, a) = (i == 0 ? 0.3 : 1.0) * uniform(random);
        C(i, a) = 0.5 * uniform(random);
      }
      E(i) = uniform(random);
      G(i) = (i == 0 ? 1.0 : 0.2) + 0.2 * uniform(random);
    }
  }
  template <class X>
  void operator()(const X& x, X& y) const {
    for (Index i = 0; i < A.rows(); ++i) {
      auto& sum = y[static_cast<std::size_t>(i)];
      sum = E(i) * (x[0] * x[1]) - G(i);
      for (Index a = 0; a < A.cols(); ++a) {
        const auto& xa = x[static_cast<std::size_t>(a)];
        sum = sum + A(i, a) * square(xa) + B(i, a) * xa + C(i, a) * sine(2.0 * xa);
      }
    }
  }
  static test::Interval square(const test::Interval& x) { return test::square(x); }
  static test::Dual square(const test::Dual& x) { return test::square(x); }
  static test::Interval sine(const test::Interval& x) { return test::sine(x); }
  static test::Dual sine(const test::Dual& x) { return test::sine(x); }
};

TEST(Subdivide, NoCrossedCellIsEverLost) {
  std::mt19937_64 random(20240607);
  for (Index d = 2; d <= 6; ++d) {
    for (Index k = 1; k <= std::min<Index>(3, d - 1); ++k) {
      for (int repeat = 0; repeat < (d <= 4 ? 4 : 2); ++repeat) {
        const Surface surface = test::generic_surface(d, k, RandomEquations(k, d, random));
        const Box box{Vector::Constant(d, -2.5), Vector::Constant(d, 2.5)};
        const double size = d <= 3 ? 0.07 : d == 4 ? 0.25 : d == 5 ? 0.7 : 0.9;
        CellGrid grid(Vector::Zero(d), size);
        try {
          grid = subdivide(surface, {.size = size, .box = box});
        } catch (const EmptySurface&) {  // checked below: then no point may be found, either
        }
        Points points(d, 300);
        std::uniform_real_distribution<double> uniform(-2.5, 2.5);
        for (auto& c : points.reshaped()) c = uniform(random);
        const auto converged = project_to_surface(*surface.make_evaluator(), d, k, points);
        for (Index j = 0; j < points.cols(); ++j) {
          if (!converged(j) || !box.contains(points.col(j))) continue;
          ASSERT_NE(grid.find_point(points.col(j)), CellGrid::kNone)
              << "d " << d << " k " << k << " repeat " << repeat << " at " << points.col(j).transpose();
        }
      }
    }
  }
}

TEST(Subdivide, NoCrossedCellOfAFormulaIsEverLost) {
  std::mt19937_64 random(20261123);
  for (const char* formula :
       {"x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8", "(x^2+y^2+z^2+0.84)^2 - 4(x^2+y^2)",
        "sin(2x)*cos(2y) + sin(2y)*cos(2z) + sin(2z)*cos(2x)", "(x^2+2.25y^2+z^2-1)^3 - x^2*z^3 - 0.1125y^2*z^3",
        "max(x^2+y^2+z^2-2, min(x+y*z, abs(z-x)-0.3))", "exp(-x^2-y^2-z^2)*(x+2) + x^3/3 - 0.7", "x*abs(x) + y - z^2",
        "cbrt(x*y) + x + 0.3z", "sqrt(x^2-0.5) + x*y - z", "log(x^2+y) + x - z", "x^1.5 + y^2 - x*z - 0.3",
        "tan(x*y) - x + z", "y/(x^2-0.6) + x - z"}) {
    const Box box{Vector::Constant(3, -1.7), Vector::Constant(3, 1.9)};
    for (const double size : {0.31, 0.07}) {
      const Surface surface = parse_surface(formula);
      const CellGrid grid = subdivide(surface, {.size = size, .box = box});
      Points points(3, 2000);
      std::uniform_real_distribution<double> uniform(-1.7, 1.9);
      for (auto& c : points.reshaped()) c = uniform(random);
      const auto converged = project_to_surface(*surface.make_evaluator(), 3, 1, points);
      const Points value = surface.value(points);
      for (Index j = 0; j < points.cols(); ++j) {
        if (!converged(j) || !box.contains(points.col(j)) || std::abs(value(j)) > 1e-9) continue;
        ASSERT_NE(grid.find_point(points.col(j)), CellGrid::kNone) << formula << " at " << points.col(j).transpose();
      }
    }
  }
}

TEST(Subdivide, FewCellsOfAFormulaAreNotCrossed) {
  // Natural interval bounds alone keep 4 to 5 times as many: x occurs twice.
  for (const char* formula : {"x^4 - 5x^2 + y^4 - 5y^2 + z^4 - 5z^2 + 11.8", "(x^2+y^2+z^2+0.84)^2 - 4(x^2+y^2)"}) {
    const Surface surface = parse_surface(formula);
    const CellGrid grid = subdivide(surface, {.size = 0.03});
    Index crossed = 0;
    for (Index i = 0; i < grid.num_cells(); ++i) {
      const Box box = grid.box(i);
      Points corners(3, 8);
      for (Index c = 0; c < 8; ++c) {
        for (Index a = 0; a < 3; ++a) corners(a, c) = ((c >> a) & 1) != 0 ? box.upper(a) : box.lower(a);
      }
      const Points value = surface.value(corners);
      crossed += value.minCoeff() <= 0 && value.maxCoeff() >= 0 ? 1 : 0;
    }
    EXPECT_LE(grid.num_cells(), 1.12 * static_cast<double>(crossed)) << formula;
  }
}

TEST(Subdivide, EveryCellOfASphereIsReallyCrossed) {
  // |x|^2 has tight bounds (no variable occurs twice), so the conservative set is the exact one.
  const CellGrid grid = subdivide(test::bounded_sphere(Vector::Zero(3), 1), {.size = 0.06});
  for (Index i = 0; i < grid.num_cells(); ++i) {
    const Box box = grid.box(i);
    const Vector nearest = Vector::Zero(3).cwiseMax(box.lower).cwiseMin(box.upper);
    const Vector farthest = box.lower.cwiseAbs().cwiseMax(box.upper.cwiseAbs());
    EXPECT_LE(nearest.norm(), 1 + 1e-14);
    EXPECT_GE(farthest.norm(), 1 - 1e-14);
  }
}

TEST(Subdivide, TheTaylorTestFindsTheSameCellsOfQuadricsAndAllOfATorus) {
  for (const double size : {0.11, 0.05}) {
    const CellGrid with = subdivide(test::bounded_sphere(Eigen::Vector3d(0.1, 7, 0), 1), {.size = size});
    const Surface without = test::bounded_sphere(Eigen::Vector3d(0.1, 7, 0), 1, false);
    const CellGrid taylor = subdivide(without, {.size = size, .origin = with.origin()});
    Index found = 0;
    for (Index i = 0; i < with.num_cells(); ++i) found += taylor.find(with.cell(i)) != CellGrid::kNone ? 1 : 0;
    EXPECT_EQ(found, with.num_cells());
    EXPECT_LE(taylor.num_cells(), 1.2 * static_cast<double>(with.num_cells()));
  }
  for (const double r : {0.4, 0.02}) {
    const CellGrid grid = subdivide(test::bounded_torus(1, r, false), {.size = r / 4});
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> angle(-3.2, 3.2);
    for (int repeat = 0; repeat < 2000; ++repeat) {
      const double u = angle(random);
      const double v = angle(random);
      const double rho = 1 + r * std::cos(v);
      const Eigen::Vector3d x(rho * std::cos(u), rho * std::sin(u), r * std::sin(v));
      ASSERT_NE(grid.find_point(x), CellGrid::kNone) << x.transpose();
    }
  }
}

TEST(Subdivide, ClosedCellsHoldASurfaceThatRunsAlongTheirFaces) {
  const Box box{Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)};
  for (const bool with_bounds : {true, false}) {
    const Surface surface = test::generic_surface(
        3, 1, [](const auto& x, auto& y) { y[0] = x[0]; }, with_bounds);
    const CellGrid aligned = subdivide(surface, {.size = 0.25, .box = box, .origin = Vector::Zero(3)});
    for (Index i = 0; i < aligned.num_cells(); ++i) {
      EXPECT_TRUE(aligned.cell(i)[0] == 0 || aligned.cell(i)[0] == -1);
    }
    for (double y = -1; y <= 1; y += 0.125) EXPECT_NE(aligned.find_point(Eigen::Vector3d(0, y, 0.3)), CellGrid::kNone);
    // On the default lattice faces keep off round numbers: one layer.
    const CellGrid single = subdivide(surface, {.size = 0.25, .box = box});
    for (Index i = 0; i < single.num_cells(); ++i) EXPECT_TRUE(single.cell(i)[0] == single.cell(0)[0]);
  }
  // A diagonal plane through edges, a sphere through corners.
  const Surface diagonal = test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = x[0] - x[1]; });
  const CellGrid edges = subdivide(diagonal, {.size = 0.25, .box = box, .origin = Vector::Zero(3)});
  for (double x = -1; x <= 1; x += 0.125) EXPECT_NE(edges.find_point(Eigen::Vector3d(x, x, x)), CellGrid::kNone);
}

TEST(Subdivide, TheDomainCutsWholeCellsOnly) {
  SurfaceExtras extras;
  extras.domain = test::generic_function(3, 1, [](const auto& x, auto& y) { y[0] = x[2] - 0.31; });
  const Surface cap = test::bounded_sphere(Vector::Zero(3), 1, true, extras);
  const Box box{Vector::Constant(3, -1.1), Vector::Constant(3, 1.1)};
  const CellGrid grid = subdivide(cap, {.size = 0.1, .box = box});
  const CellGrid whole = subdivide(test::bounded_sphere(Vector::Zero(3), 1), {.size = 0.1, .box = box});
  Index expected = 0;
  for (Index i = 0; i < whole.num_cells(); ++i) {
    const bool inside = whole.box(i).upper(2) >= 0.31;
    expected += inside ? 1 : 0;
    EXPECT_EQ(grid.find(whole.cell(i)) != CellGrid::kNone, inside);
  }
  EXPECT_EQ(grid.num_cells(), expected);
}

TEST(Subdivide, WorksAtAnySizeAndPlace) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e4, 1e6}) {
    const Eigen::Vector3d centre(2 * scale, -7 * scale, 0);
    const Surface sphere = test::generic_surface(3, 1, [=](const auto& x, auto& y) {
      y[0] = test::square((1 / scale) * (x[0] - centre(0))) + test::square((1 / scale) * (x[1] - centre(1))) +
             test::square((1 / scale) * x[2]) - 1.0;
    });
    const CellGrid grid = subdivide(sphere, {.size = 0.1 * scale});
    EXPECT_NEAR(static_cast<double>(grid.num_cells()), 1880, 60) << scale;
    EXPECT_NE(grid.find_point(centre + scale * Eigen::Vector3d(0.6, 0, 0.8)), CellGrid::kNone);
  }
}

TEST(Subdivide, SkipsWhereAFormulaHasNoValue) {
  // A hemisphere as a graph: F is NaN outside the unit disc's cylinder, most of the box.
  const Surface dome = parse_surface("z = sqrt(1 - x^2 - y^2)");
  const Box box{Vector::Constant(3, -3), Vector::Constant(3, 3)};
  const CellGrid grid = subdivide(dome, {.size = 0.1, .box = box});
  EXPECT_LE(grid.num_cells(), 2000);
  for (const double angle : {0.1, 0.7, 1.3, 1.5}) {
    EXPECT_NE(grid.find_point(Eigen::Vector3d(0.6 * std::sin(angle), 0.8 * std::sin(angle), std::cos(angle))),
              CellGrid::kNone);
  }
}

TEST(Subdivide, FormulasAndHandWrittenBoundsAgree) {
  const Surface formula = parse_surface("(x^2-2.5)^2 + (y^2-2.5)^2 + (z^2-2.5)^2 = 6.95");
  const Box box{Vector::Constant(3, -2.5), Vector::Constant(3, 2.5)};
  const CellGrid a = subdivide(formula, {.size = 0.06, .box = box});
  const CellGrid b = subdivide(test::bounded_tangle_cube(), {.size = 0.06, .box = box});
  EXPECT_EQ(a.num_cells(), b.num_cells());
}

TEST(Subdivide, ThreadsDoNotChangeTheCells) {
  const Surface torus = test::bounded_torus();
  const CellGrid one = subdivide(torus, {.size = 0.03}, {.threads = 1});
  const CellGrid four = subdivide(torus, {.size = 0.03}, {.threads = 4});
  ASSERT_EQ(one.num_cells(), four.num_cells());
  EXPECT_TRUE(std::equal(one.coordinates().begin(), one.coordinates().end(), four.coordinates().begin()));
  for (Index i = 1; i < one.num_cells(); ++i) ASSERT_TRUE(morton_less(one.cell(i - 1), one.cell(i)));
}

TEST(Subdivide, RefusesWhatCannotBe) {
  const Surface sphere = test::bounded_sphere(Vector::Zero(3), 1);
  EXPECT_THROW((void)subdivide(sphere, {.size = 0}), InvalidArgument);
  EXPECT_THROW((void)subdivide(sphere, {.size = -1}), InvalidArgument);
  EXPECT_THROW((void)subdivide(sphere, {.size = std::nan("")}), InvalidArgument);
  EXPECT_THROW((void)subdivide(test::bounded_sphere(Vector::Zero(40), 1), {.size = 0.1}), InvalidArgument);
  const Box flat{Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1)};
  EXPECT_THROW((void)subdivide(sphere, {.size = 0.1, .box = flat}), InvalidArgument);
  const Box inside_out{Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 2, 2)};
  EXPECT_THROW((void)subdivide(sphere, {.size = 0.1, .box = inside_out}), InvalidArgument);
  const Box elsewhere{Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(6, 6, 6)};
  EXPECT_THROW((void)subdivide(sphere, {.size = 0.1, .box = elsewhere}), EmptySurface);
}

TEST(Subdivide, RefusesCellsThatWouldNotFitIntoMemoryAtOnce) {
  const Surface sphere = test::bounded_sphere(Vector::Zero(3), 1);
  for (const double size : {1e-300, 1e-12, 1e-7, 1e-5}) {
    EXPECT_THROW((void)subdivide(sphere, {.size = size}), OutOfMemory) << size;
  }
  EXPECT_THROW((void)subdivide(sphere, {.size = 0.004}, {.memory_limit = 5'000'000}), OutOfMemory);
}

TEST(Subdivide, CanBeCancelledAndTellsHowFarItIs) {
  const Surface sphere = test::bounded_sphere(Vector::Zero(3), 1);
  std::atomic<bool> cancel = false;
  double last = -1;
  Context context;
  context.threads = 2;
  context.cancel = &cancel;
  context.progress = [&](std::string_view, double done) {
    EXPECT_GE(done, last);
    last = done;
  };
  (void)subdivide(sphere, {.size = 0.02}, context);
  EXPECT_EQ(last, 1);
  cancel = true;
  EXPECT_THROW((void)subdivide(sphere, {.size = 0.02}, context), Cancelled);
}

TEST(Subdivide, TheNumberOfCellsFollowsTheSurfacesArea) {
  // N h^(d - k) is constant: halving h multiplies N by 2^(d - k).
  const Surface sphere = test::bounded_sphere(Vector::Zero(3), 1);
  const Surface circle = test::generic_surface(3, 2, [](const auto& x, auto& y) {
    y[0] = test::square(x[0]) + test::square(x[1]) - 1.0;
    y[1] = x[2] - 0.1 * x[0];
  });
  const auto slope = [](const Surface& surface) {
    const auto coarse = static_cast<double>(subdivide(surface, {.size = 0.04}).num_cells());
    return std::log2(static_cast<double>(subdivide(surface, {.size = 0.01}).num_cells()) / coarse) / 2;
  };
  EXPECT_NEAR(slope(sphere), 2, 0.02);
  EXPECT_NEAR(slope(circle), 1, 0.05);
}

}  // namespace
}  // namespace taut
