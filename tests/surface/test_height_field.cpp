#include "taut/surface/height_field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"

namespace taut {
namespace {

double hills(double x, double y) { return 0.3 * std::sin(2 * x + 0.4) * std::cos(1.5 * y) + 0.1 * x * y; }

/// hills over [-1, 1] x [-0.5, 1], n samples along x and as many as fit along y.
HeightField sampled(Index n) {
  HeightField field;
  field.columns = n;
  field.rows = (3 * (n - 1)) / 4 + 1;
  field.x0 = -1;
  field.y0 = -0.5;
  field.pixel_x = 2 / static_cast<double>(n - 1);
  field.pixel_y = 1.5 / static_cast<double>(field.rows - 1);
  for (Index j = 0; j < field.rows; ++j) {
    for (Index i = 0; i < n; ++i) {
      field.heights.push_back(
          hills(field.x0 + static_cast<double>(i) * field.pixel_x, field.y0 + static_cast<double>(j) * field.pixel_y));
    }
  }
  return field;
}

TEST(HeightField, PassesThroughItsSamplesWithFourthOrderBetweenThem) {
  const auto error = [](Index n) {
    const HeightField field = sampled(n);
    const Surface surface = height_surface(field);
    EXPECT_NEAR(*height_at(surface, field.x0 + 3 * field.pixel_x, field.y0 + 2 * field.pixel_y),
                field.heights[static_cast<std::size_t>(3 + n * 2)], 1e-14);
    double worst = 0;
    for (double x = -1; x <= 1; x += 0.0173) {
      for (double y = -0.5; y <= 1; y += 0.0191)
        worst = std::max(worst, std::abs(*height_at(surface, x, y) - hills(x, y)));
    }
    return worst;
  };
  const double coarse = error(17);
  const double fine = error(33);
  EXPECT_LT(fine, 1e-5);
  EXPECT_GT(std::log2(coarse / fine), 3.5);
}

TEST(HeightField, KeepsTheRulesOfEvaluators) {
  HeightField field = sampled(9);
  const Box box{Eigen::Vector3d(-0.98, -0.49, -1), Eigen::Vector3d(0.98, 0.98, 1)};
  const Surface whole = height_surface(field, {.z_scale = 2});
  // Third derivatives jump at the samples.
  const ConformanceOptions options{.derivative_tolerance = 1e-4};
  EXPECT_TRUE(check_conformance(whole.function(), box, options).ok())
      << check_conformance(whole.function(), box, options).text();
  EXPECT_TRUE(check_conformance(*whole.domain(), box, options).ok());
  field.heights[30] = std::numeric_limits<double>::quiet_NaN();
  const Surface holed = height_surface(field);
  EXPECT_TRUE(check_conformance(*holed.domain(), box, options).ok())
      << check_conformance(*holed.domain(), box, options).text();
}

TEST(HeightField, EndsWithTheGridAndBeforeWhatWasNotMeasured) {
  HeightField field = sampled(21);
  const auto hole = static_cast<std::size_t>(10 + 21 * 8);
  field.heights[hole] = -9999;
  std::string notes;
  Context context;
  context.note = [&](std::string_view note) { notes += note; };
  const Surface surface = height_surface(field, {.z_scale = 3, .no_data = -9999}, context);
  EXPECT_NE(notes.find("1 of 336"), std::string::npos) << notes;
  const auto inside = [&](double x, double y) {
    return surface.inside_domain(Eigen::Vector3d(x, y, 3 * hills(x, y)))(0);
  };
  const double x = field.x0 + 10 * field.pixel_x;
  const double y = field.y0 + 8 * field.pixel_y;
  EXPECT_FALSE(inside(x, y));
  EXPECT_TRUE(inside(x + field.pixel_x, y));
  EXPECT_TRUE(inside(0.99, 0.99));
  EXPECT_FALSE(inside(1.01, 0));
  EXPECT_FALSE(inside(0, -0.51));
  EXPECT_NEAR(*height_at(surface, 0.5, 0.5), 3 * hills(0.5, 0.5), 1e-3);
  EXPECT_FALSE(height_at(surface, 1.5, 0));
}

TEST(HeightField, RefusesWhatMakesNoSurface) {
  HeightField field = sampled(9);
  field.heights.pop_back();
  EXPECT_THROW((void)height_surface(field), InvalidArgument);
  field = sampled(9);
  EXPECT_THROW((void)height_surface(field, {.z_scale = 0}), InvalidArgument);
  field.pixel_x = -1;
  EXPECT_THROW((void)height_surface(field), InvalidArgument);
  field = sampled(9);
  for (std::size_t i = 0; i < 40; ++i) field.heights[i] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)height_surface(field), InvalidArgument);
  field = sampled(9);
  field.columns = 3;
  EXPECT_THROW((void)height_surface(field), InvalidArgument);
}

}  // namespace
}  // namespace taut
