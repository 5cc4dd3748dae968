#include "taut/query/tangent_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "support/surfaces.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

TEST(Ray, AgreesWithTheMapAndNamesItsStart) {
  const Surface surface = test::torus();
  RaySolver solver(surface);
  const RayResult ray = solver.solve(Eigen::Vector3d(1.4, 0, 0), Eigen::Vector3d(0, 1, 1), 3);
  const ExponentialResult same =
      exponential_map(surface, Vector(Eigen::Vector3d(1.4, 0, 0)), Vector(Eigen::Vector3d(0, 1, 1)), 3);
  EXPECT_EQ(ray.status, Status::ok);
  EXPECT_TRUE(ray.message.empty());
  EXPECT_EQ(ray.point, same.point);
  EXPECT_EQ(ray.from, Vector(Eigen::Vector3d(1.4, 0, 0)));
}

TEST(Ray, TellsWhatItChangedAndRefusesWhatIsFarOff) {
  std::vector<std::string> notes;
  Context context;
  context.note = [&](std::string_view note) { notes.emplace_back(note); };
  RaySolver solver(test::unit_sphere(), {}, context);
  (void)solver.solve(Eigen::Vector3d(1 + 1e-9, 0, 0), Eigen::Vector3d(1e-3, 1, 0), 1);
  EXPECT_TRUE(notes.empty());
  (void)solver.solve(Eigen::Vector3d(1.2, 0, 0), Eigen::Vector3d(1, 1, 0), 1);
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_NE(notes[0].find("moved by 0.2"), std::string::npos) << notes[0];
  EXPECT_NE(notes[1].find("45 degrees"), std::string::npos) << notes[1];
  EXPECT_THROW((void)solver.solve(Eigen::Vector3d(50, 0, 0), Eigen::Vector3d(0, 1, 0), 1), InvalidArgument);
  EXPECT_THROW((void)solver.solve(Eigen::Vector3d(1, 0, 0), Eigen::Vector2d(0, 1), 1), InvalidArgument);
  RaySolver half(parse_surface("x^2+y^2+z^2=1", {.domain = {"z>=0"}}));
  EXPECT_THROW((void)half.solve(Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 1, 0), 1), InvalidArgument);
}

TEST(Ray, ManyAreAnsweredInPlaceOnAnyNumberOfThreads) {
  constexpr Index kRays = 200;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Points from(3, kRays);
  Points directions(3, kRays);
  Vector lengths(kRays);
  for (Index j = 0; j < kRays; ++j) {
    from.col(j) << std::cos(0.1 * static_cast<double>(j)), std::sin(0.1 * static_cast<double>(j)), 0;
    directions.col(j) << std::sin(static_cast<double>(j)), 0.1, 1;
    lengths(j) = 0.05 * static_cast<double>(j);
  }
  from(1, 17) = nan;
  directions.col(18).setZero();
  lengths(19) = nan;
  from.col(20) << 9, 9, 9;
  std::vector<std::vector<RayResult>> answers;
  for (const int threads : {1, 3}) {
    Context context;
    context.threads = threads;
    RaySolver solver(test::ellipsoid(1, 1, 0.5), {.conjugate = false, .points = false}, context);
    answers.push_back(solver.solve_many(from, directions, lengths));
    ASSERT_EQ(answers.back().size(), static_cast<std::size_t>(kRays));
  }
  RaySolver alone(test::ellipsoid(1, 1, 0.5), {.conjugate = false, .points = false});
  for (Index j = 0; j < kRays; ++j) {
    SCOPED_TRACE("ray " + std::to_string(j));
    const RayResult& one = answers[0][static_cast<std::size_t>(j)];
    const RayResult& three = answers[1][static_cast<std::size_t>(j)];
    const bool bad = j >= 17 && j <= 20;
    EXPECT_EQ(one.status, bad ? Status::not_converged : Status::ok);
    EXPECT_EQ(one.message.empty(), !bad);
    EXPECT_EQ(one.point, three.point);
    EXPECT_EQ(one.error, three.error);
    if (!bad) {
      EXPECT_EQ(one.point, alone.solve(from.col(j), directions.col(j), lengths(j)).point);
    }
  }
}

TEST(Ray, OfManySaysWhichStartIsSingular) {
  Points from(3, 2);
  from << 0, 1, 0, 0, 0, 1;
  const Points directions = Vector(Eigen::Vector3d(1, 0, 1)).replicate(1, 2);
  RaySolver solver(parse_surface("x^2+y^2=z^2"));
  const std::vector<RayResult> rays = solver.solve_many(from, directions, Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(rays[0].status, Status::rank_deficient);
  EXPECT_EQ(rays[1].status, Status::ok);
}

}  // namespace
}  // namespace taut
