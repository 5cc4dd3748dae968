#include <gtest/gtest.h>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::read_as;

const std::string kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(ReadObj, CornersMayCarryTextureAndNormals) {
  const PointCloud cloud =
      read_as("a.obj", "# a comment\nmtllib a.mtl\no thing\n" + kTetrahedron +
                           "vt 0 0\nvn 0 0 2\nvn 3 0 0\ng side\nusemtl red\ns off\n"
                           "f 1/1/1 2/1/1 3/1/1\nf 1//2 3//2 4//2\nf 1/1 2/1 4/1\nf 2 3 4 # end\n");
  EXPECT_EQ(cloud.size(), 4);
  EXPECT_EQ(cloud.faces.cols(), 4);
  ASSERT_TRUE(cloud.has_normals());
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d(0, 0, 1));  // one normal named: that one, as a unit vector
  EXPECT_LT((cloud.normals.col(0) - Eigen::Vector3d(1, 0, 1).normalized()).norm(), 1e-15);  // two: their mean direction
}

TEST(ReadObj, NegativeIndicesCountBack) {
  const PointCloud cloud = read_as("a.obj", kTetrahedron + "f -4 -3 -2\nv 5 5 5\nf -1 -2 1\n");
  EXPECT_EQ(cloud.faces.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(cloud.faces.col(1), Eigen::Vector3i(4, 3, 0));
}

TEST(ReadObj, VerticesMayComeAfterTheirFace) {
  EXPECT_EQ(read_as("a.obj", "f 1 2 3\n" + kTetrahedron).faces.col(0), Eigen::Vector3i(0, 1, 2));
}

TEST(ReadObj, PolygonsBecomeFans) {
  const PointCloud cloud = read_as("a.obj", kTetrahedron + "v 1 1 1\nf 1 2 3 4 5\n");
  ASSERT_EQ(cloud.faces.cols(), 3);
  EXPECT_EQ(cloud.faces.col(2), Eigen::Vector3i(0, 3, 4));
}

TEST(ReadObj, LinesMayContinue) {
  EXPECT_EQ(read_as("a.obj", kTetrahedron + "f 1 2 \\\n3 4\nl 1 \\\n2\n").faces.cols(), 2);
}

TEST(ReadObj, VerticesMayCarryWeightOrColour) {
  const PointCloud cloud = read_as("a.obj", "v 1 2 3 1.0\nv 4 5 6 0.1 0.2 0.3\nv 7 8 9 1 0.1 0.2 0.3\n");
  ASSERT_EQ(cloud.size(), 3);
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(4, 5, 6));
}

TEST(ReadObj, CloudsMayHaveOneNormalAVertex) {
  const PointCloud cloud = read_as("a.obj", "v 1 0 0\nvn 1 0 0\nv 0 1 0\nvn 0 1 0\n");
  ASSERT_TRUE(cloud.has_normals());
  EXPECT_EQ(cloud.normals, cloud.points);
}

TEST(ReadObj, NormalsNobodyNamesAreLeftOutWithANote) {
  std::vector<std::string> notes;
  const PointCloud cloud = read_as("a.obj", "v 1 0 0\nvn 1 0 0\nv 0 1 0\n", &notes);
  EXPECT_FALSE(cloud.has_normals());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("1 normal for 2 vertices"), std::string::npos);
}

TEST(ReadObj, KeywordsOfOtherProgramsAreSkippedWithANote) {
  std::vector<std::string> notes;
  EXPECT_EQ(read_as("a.obj", kTetrahedron + "my_extension 1 2\n", &notes).size(), 4);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("1 line with unknown keywords skipped"), std::string::npos);
}

}  // namespace
}  // namespace taut
