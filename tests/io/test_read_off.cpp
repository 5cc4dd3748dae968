#include <gtest/gtest.h>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::read_as;

TEST(ReadOff, CountsMayStandBesideTheKeyword) {
  const PointCloud cloud =
      read_as("a.off", "OFF 4 1 0 # counts\n0 0 0\n1 0 0\n1 1 0 # corner\n\n0 1 0\n4 0 1 2 3 255 0 0\n");
  EXPECT_EQ(cloud.size(), 4);
  EXPECT_EQ(cloud.faces.cols(), 2);
}

TEST(ReadOff, EdgeCountMayBeMissingAndFacesToo) {
  const PointCloud cloud = read_as("a.off", "# cloud\nOFF\n2 0\n0 0 0\n1 2 3");
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.faces.cols(), 0);
}

TEST(ReadOff, ColoursAndTextureAreSkipped) {
  EXPECT_EQ(read_as("a.off", "COFF\n1 0 0\n1 2 3 255 0 0 255\n").points, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read_as("a.off", "STCOFF\n1 0 0\n1 2 3 1 0 0 1 0.5 0.5\n").points, Eigen::Vector3d(1, 2, 3));
}

TEST(ReadOff, NormalsFollowTheCoordinates) {
  for (const std::string keyword : {"NOFF", "CNOFF", "STNOFF", "STCNOFF"}) {
    const PointCloud cloud = read_as("a.off", keyword + "\n1 0 0\n1 2 3 0 0 1 9 9 9 9\n");
    EXPECT_EQ(cloud.normals, Eigen::Vector3d(0, 0, 1)) << keyword;
  }
}

}  // namespace
}  // namespace taut
