#include <limits>

#include "march/support.hpp"

namespace taut {
namespace {

using test::Errors;

TEST(ConvergentMarch, SphereIsSecondOrder) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(0.36, -0.48, 0.8);
  std::vector<std::pair<double, double>> errors;
  for (const double h : {0.14, 0.07, 0.035, 0.0175}) {
    SurfaceCells cells = test::all_cells(sphere, source, h);
    const DistanceField field = march(sphere, cells, source);
    EXPECT_EQ(field.num_reached, cells.num_valid());
    errors.emplace_back(h, test::sphere_errors(cells, field, source).mean);
  }
  EXPECT_LT(errors.front().second, 5e-4);  // about 1,000 cells
  EXPECT_LT(errors.back().second, 1e-5);   // about 60,000 cells
  EXPECT_GT(test::order(errors), 1.7);
}

TEST(ConvergentMarch, TorusAgreesWithReferences) {
  const Surface torus = test::torus(1, 0.4);
  const std::vector<test::DistanceRow> rows = test::read_distances("torus_distances.csv", 3);
  ASSERT_EQ(rows.size(), 125U);
  std::vector<std::pair<double, double>> means;
  for (const double h : {0.16, 0.08, 0.04}) {
    SurfaceCells cells = test::all_cells(torus, rows.front().p, h);
    Errors errors;
    for (const test::DistanceRow& row : rows) {
      const DistanceField field = march(torus, cells, row.p);
      errors.add(distance_at(torus, cells, field, row.q)(0), row.distance);
    }
    EXPECT_LT(errors.max, 0.03) << h;
    means.emplace_back(h, errors.mean);
  }
  EXPECT_LT(means.front().second, 3e-3);  // about 1,000 cells
  EXPECT_LT(means.back().second, 3e-4);   // about 15,000 cells
  EXPECT_GT(test::order(means), 1.5);
}

TEST(ConvergentMarch, StopsAtTheTargetWithItsFinalDistance) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(1, 0, 0);
  const Vector target = Eigen::Vector3d(0.6, 0.64, 0.48);
  SurfaceCells cells = test::all_cells(sphere, source, 0.05);
  const DistanceField all = march(sphere, cells, source);
  const DistanceField some = march(sphere, cells, source, {.target = target});
  EXPECT_EQ(some.target_distance, distance_at(sphere, cells, all, target)(0));
  EXPECT_EQ(some.target_distance, distance_at(sphere, cells, some, target)(0));
  EXPECT_NEAR(some.target_distance, test::sphere_distance(source, target), 1e-4);
  EXPECT_LT(some.num_reached, all.num_reached / 2);
  for (Index i = 0; i < all.distance.size(); ++i) {
    if (!std::isfinite(some.distance(i))) continue;
    EXPECT_EQ(some.distance(i), all.distance(i));
  }
}

TEST(ConvergentMarch, LazyCellsGrowOnlyBehindTheFront) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(1, 0, 0);
  const Vector target = Eigen::Vector3d(0.8, 0.6, 0);
  SurfaceCells lazy = SurfaceCells::lazy(sphere, source, 0.05);
  const DistanceField field = march(sphere, lazy, source, {.target = target});
  EXPECT_NEAR(field.target_distance, test::sphere_distance(source, target), 1e-4);
  SurfaceCells complete = test::all_cells(sphere, source, 0.05);
  EXPECT_LT(lazy.num_cells(), complete.num_cells() / 4);
  const DistanceField same = march(sphere, complete, source, {.target = target});
  EXPECT_EQ(field.target_distance, same.target_distance);
}

TEST(ConvergentMarch, SeveralSourcesGiveTheMinimum) {
  const Surface sphere = test::unit_sphere();
  Points sources(3, 3);
  sources << 1, 0, -0.6, 0, 0.6, 0, 0, 0.8, 0.8;
  constexpr double kCell = 0.06;
  SurfaceCells cells = test::all_cells(sphere, sources.col(0), kCell);
  const DistanceField field = march(sphere, cells, sources);
  Errors errors;
  Index wrong_source = 0;
  for (Index i = 0; i < cells.num_cells(); ++i) {
    if (!cells.valid(i)) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index s = 0; s < 3; ++s) nearest = std::min(nearest, test::sphere_distance(sources.col(s), cells.point(i)));
    errors.add(field.distance(i), nearest);
    const Vector mine = sources.col(field.nearest_source[static_cast<std::size_t>(i)]);
    if (test::sphere_distance(mine, cells.point(i)) > nearest + 0.12) ++wrong_source;
  }
  EXPECT_LT(errors.mean, 1e-4);
  EXPECT_LT(errors.max, kCell);  // where the territories of the sources meet the march is of first order
  EXPECT_EQ(wrong_source, 0);
}

TEST(ConvergentMarch, NeverBelowTheChordAndExactlyZeroAtTheSource) {
  for (const Surface& surface : {test::torus(1, 0.4), test::ellipsoid(1, 1, 0.5), test::tangle_cube()}) {
    SCOPED_TRACE(surface.dim());
    Vector source = Eigen::Vector3d(1.4, 0, 0);
    if (std::abs(surface.value(source)(0, 0)) > 1e-12) source = Eigen::Vector3d(1, 0, 0);
    if (std::abs(surface.value(source)(0, 0)) > 1e-12) {
      source = Eigen::Vector3d(std::sqrt((5 + std::sqrt(25 - 4 * 11.8 / 3)) / 2), 0, 0);
      source.setConstant(source(0));
    }
    SurfaceCells cells = test::all_cells(surface, source, 0.1);
    const DistanceField field = march(surface, cells, source);
    EXPECT_EQ(distance_at(surface, cells, field, source)(0), 0);
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (!cells.valid(i)) continue;
      ASSERT_TRUE(std::isfinite(field.distance(i)));
      EXPECT_GE(field.distance(i), (cells.point(i) - source).norm() * (1 - 1e-12));
    }
  }
}

TEST(ConvergentMarch, SameInputSameBits) {
  const Surface torus = test::torus();
  const Vector source = Eigen::Vector3d(1.4, 0, 0);
  SurfaceCells cells = test::all_cells(torus, source, 0.08);
  const DistanceField a = march(torus, cells, source);
  const DistanceField b = march(torus, cells, source);
  EXPECT_TRUE((a.distance.array() == b.distance.array()).all());
}

TEST(March, RefusesWrongRequests) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(1, 0, 0);
  SurfaceCells cells = test::all_cells(sphere, source, 0.2);
  EXPECT_THROW((void)march(sphere, cells, Points(3, 0)), InvalidArgument);
  EXPECT_THROW((void)march(sphere, cells, Eigen::Vector2d(1, 0)), InvalidArgument);
  EXPECT_THROW((void)march(sphere, cells, Eigen::Vector3d(1, 0, std::nan(""))), InvalidArgument);
  EXPECT_THROW((void)march(sphere, cells, Eigen::Vector3d(9, 0, 0)), InvalidArgument);
  EXPECT_THROW((void)march(sphere, cells, Eigen::Vector3d(0, 0, 0)), SingularPoint);
  EXPECT_THROW((void)march(sphere, cells, source, {.target = Eigen::Vector2d(1, 0)}), InvalidArgument);
  EXPECT_THROW((void)march(sphere, cells, source, {.radius = std::nan("")}), InvalidArgument);
}

TEST(March, IsCancelled) {
  const Surface sphere = test::unit_sphere();
  const Vector source = Eigen::Vector3d(1, 0, 0);
  SurfaceCells cells = test::all_cells(sphere, source, 0.2);
  const std::atomic<bool> cancel{true};
  EXPECT_THROW((void)march(sphere, cells, source, {}, {.cancel = &cancel}), Cancelled);
}

}  // namespace
}  // namespace taut
