#include "taut/cells/find_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/interval_surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

TEST(FindBox, FindsSpheresOfAnySizeAndPlace) {
  for (const bool with_bounds : {true, false}) {
    for (const Index d : {2, 3, 4}) {
      for (const double radius : {1e-3, 1.0, 1e4}) {
        for (const double offset : {0.0, 500.0}) {
          const Vector centre = offset * Vector::Unit(d, 0);
          const Surface sphere = test::bounded_sphere(centre, radius, with_bounds);
          const Box box = find_box(sphere, Points(d, 0));
          for (Index a = 0; a < d; ++a) {
            // Holds it all (by trial: nearly all), and is at most 1.6 times as wide.
            EXPECT_LE(box.lower(a), centre(a) - 0.98 * radius) << with_bounds << d << radius << offset;
            EXPECT_GE(box.upper(a), centre(a) + 0.98 * radius) << with_bounds << d << radius << offset;
            EXPECT_LE(box.upper(a) - box.lower(a), 3.2 * radius) << with_bounds << d << radius << offset;
          }
        }
      }
    }
  }
}

TEST(FindBox, ProvesThatTheWholeTorusIsInside) {
  const Box box = find_box(test::bounded_torus(1, 0.1), Points(3, 0));
  EXPECT_TRUE((box.lower.array() <= Eigen::Array3d(-1.1, -1.1, -0.1)).all());
  EXPECT_TRUE((box.upper.array() >= Eigen::Array3d(1.1, 1.1, 0.1)).all());
  EXPECT_LE(box.diagonal(), 6);
}

TEST(FindBox, BoxesTheNeighbourhoodOfThePointsWhereTheSurfaceGoesOn) {
  const Surface cylinder =
      test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[0]) + test::square(x[1]) - 1.0; });
  Points near(3, 2);
  near.col(0) << 1, 0, 20;
  near.col(1) << -1, 0, 24;
  const Box box = find_box(cylinder, near);
  EXPECT_TRUE(box.contains(near.col(0)) && box.contains(near.col(1)));
  EXPECT_LE(box.lower(0), -1);
  EXPECT_GE(box.lower(0), -1.5);
  EXPECT_LE(box.lower(2), 16);
  EXPECT_GE(box.lower(2), 0);
  EXPECT_LE(box.upper(2), 60);
  // A plane that keeps off +-5.
  const Surface plane = test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = x[0] + x[1] - 37.0; });
  EXPECT_GE(find_box(plane, Points(3, 0)).diagonal(), 5);
}

TEST(FindBox, SaysWhereTheSurfaceGoesOnAndLooksFarther) {
  const Surface cylinder =
      test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[0]) + test::square(x[1]) - 1.0; });
  const SurfaceExtent extent = find_extent(cylinder, Eigen::Vector3d(1, 0, 2));
  EXPECT_FALSE(extent.endless(0));
  EXPECT_FALSE(extent.endless(1));
  EXPECT_TRUE(extent.endless(2));
  EXPECT_LE(extent.whole.upper(0), 1e6);
  EXPECT_GE(extent.whole.upper(2), 1e7);
  EXPECT_LE(extent.box.upper(2), 5);
  Box window = extent.window;
  window.upper(2) = 40;
  const SurfaceExtent farther = through_window(cylinder, extent, window);
  EXPECT_GE(farther.box.upper(2), 40 - 1e-9);
  EXPECT_LE(farther.box.upper(0), 1.5);

  const Surface sphere = test::generic_surface(
      3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[0]) + test::square(x[1]) + test::square(x[2]) - 1.0; });
  EXPECT_FALSE(find_extent(sphere, Points(3, 0)).endless.any());
}

TEST(FindBox, LooksAtTheDomainToo) {
  SurfaceExtras extras;
  extras.domain = test::generic_function(2, 1, [](const auto& x, auto& y) { y[0] = 4.0 - test::square(x[1]); });
  const Surface strip = test::generic_surface(
      2, 1, [](const auto& x, auto& y) { y[0] = x[0] - x[1]; }, true, extras);
  const Box box = find_box(strip, Points(2, 0));
  EXPECT_NEAR(box.upper(0), 2, 0.2);
  EXPECT_NEAR(box.lower(1), -2, 0.2);
}

TEST(FindBox, TakesTheSurfacesOwnBoxOrItsSamples) {
  SurfaceExtras extras;
  auto cloud = std::make_shared<PointCloud>();
  cloud->points = Points::Random(3, 50);
  extras.samples = cloud;
  const Surface sphere = test::bounded_sphere(Vector::Zero(3), 1, false, extras);
  const Box box = find_box(sphere, Points(3, 0));
  for (Index j = 0; j < 50; ++j) EXPECT_TRUE(box.contains(cloud->points.col(j)));
  EXPECT_LE(box.diagonal(), 4);
  const Box own{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 2, 3)};
  EXPECT_EQ(find_box(sphere.with_box(own), Points(3, 0)).upper, own.upper);
}

TEST(FindBox, SaysWhenThereIsNothing) {
  for (const bool with_bounds : {true, false}) {
    const Surface empty = test::generic_surface(
        3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[0]) + test::square(x[1]) + test::square(x[2]) + 1.0; },
        with_bounds);
    EXPECT_THROW((void)find_box(empty, Points(3, 0)), EmptySurface);
  }
  const Surface point = test::generic_surface(
      3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[0]) + test::square(x[1]) + test::square(x[2] - 3.0); });
  EXPECT_LE(find_box(point, Points(3, 0)).diagonal(), 1e-6);  // a single point is not nothing
  EXPECT_THROW((void)find_box(point, Points(2, 0)), InvalidArgument);
  EXPECT_THROW((void)find_box(point, Points::Constant(3, 1, std::nan(""))), InvalidArgument);
}

}  // namespace
}  // namespace taut
