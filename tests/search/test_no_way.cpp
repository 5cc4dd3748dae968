// Why no way was found: a singular point, or parts of the surface that come near each other.
#include "search/no_way.hpp"

#include <gtest/gtest.h>

#include <string>

#include "taut/surface/formula.hpp"

namespace taut {
namespace {

PathResult explained(const std::string& formula, const Vector& from, const Vector& to, const Vector& barrier) {
  PathResult result;
  result.from = from;
  result.to = to;
  result.cell = 0.01;
  detail::NoWay no_way;
  no_way.barrier = Barrier{};
  no_way.barrier->point = barrier;
  detail::explain_no_way(result, parse_surface(formula), no_way);
  return result;
}

bool says(const PathResult& result, const std::string& what) { return result.message.find(what) != std::string::npos; }

TEST(NoWay, NamesTheSingularPoint) {
  const PathResult cone = explained("x^2+y^2=z^2", Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(1, 0, -1),
                                    Eigen::Vector3d(0.0085, 0.0026, 0.0089));
  EXPECT_EQ(cone.status, Status::not_converged);
  EXPECT_TRUE(says(cone, "singular between the two points: near (0, 0, 0)")) << cone.message;
  const PathResult touching = explained("(x^2+y^2+z^2-1)*((x-2)^2+y^2+z^2-1)", Eigen::Vector3d(-1, 0, 0),
                                        Eigen::Vector3d(3, 0, 0), Eigen::Vector3d(0.999, 0.04, 0.01));
  EXPECT_TRUE(says(touching, "near (1, ")) << touching.message;
}

TEST(NoWay, TellsNearlyTouchingSheetsFromASingularPoint) {
  const PathResult spheres = explained("(x^2+y^2+z^2-1)*((x-2.0001)^2+y^2+z^2-1)", Eigen::Vector3d(-1, 0, 0),
                                       Eigen::Vector3d(3.0001, 0, 0), Eigen::Vector3d(0.9934, 0.0797, 0.0827));
  EXPECT_EQ(spheres.status, Status::not_converged);
  EXPECT_TRUE(says(spheres, "come within 0.0001 of each other")) << spheres.message;
  EXPECT_FALSE(says(spheres, "singular")) << spheres.message;
  const PathResult neck = explained("x^2+y^2=z^2+1e-8", Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(1, 0, -1),
                                    Eigen::Vector3d(0.008, 0.002, 0.008));
  EXPECT_EQ(neck.status, Status::not_converged);  // a neck: not disconnected
  EXPECT_TRUE(says(neck, "come within 0.0002 of each other")) << neck.message;
}

}  // namespace
}  // namespace taut
