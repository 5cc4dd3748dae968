#include <gtest/gtest.h>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::raw;
using test::read_as;

const std::string kSquare =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n";

void expect_square(const PointCloud& cloud) {
  ASSERT_EQ(cloud.size(), 4);
  EXPECT_EQ(cloud.points.col(3), Eigen::Vector3d(0, 1, 0.5));
  EXPECT_FALSE(cloud.has_normals());
  ASSERT_EQ(cloud.faces.cols(), 2);
  EXPECT_EQ(cloud.faces.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(cloud.faces.col(1), Eigen::Vector3i(0, 2, 3));
}

TEST(ReadPly, QuadBecomesTwoTriangles) { expect_square(read_as("a.ply", kSquare)); }

TEST(ReadPly, ExtensionMayBeUpperCase) { expect_square(read_as("A.PLY", kSquare)); }

TEST(ReadPly, CarriageReturnsAndMissingLastLineEndAreFine) {
  std::string text;
  for (const char c : kSquare) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_square(read_as("a.ply", text));
  expect_square(read_as("a.ply", kSquare.substr(0, kSquare.size() - 1)));
}

TEST(ReadPly, BlankLinesBetweenRowsAreFine) {
  std::string text = kSquare;
  text.insert(text.find("1 1 0\n"), "\n  \n");
  expect_square(read_as("a.ply", text));
}

TEST(ReadPly, PropertiesMayStandInAnyOrderAmongOthers) {
  const PointCloud cloud =
      read_as("a.ply",
              "ply\nformat ascii 1.0\ncomment made by hand\nobj_info anything\nelement vertex 1\n"
              "property uchar red\nproperty double nz\nproperty float64 y\nproperty list uchar float extra\n"
              "property double z\nproperty double nx\nproperty double x\nproperty double ny\n"
              "property float32 quality\nend_header\n"
              "255 6 2 3 0.1 0.2 0.3 3 4 1 5 0.5\n");
  EXPECT_EQ(cloud.points, Eigen::Vector3d(1, 2, 3));
  ASSERT_TRUE(cloud.has_normals());
  EXPECT_EQ(cloud.normals, Eigen::Vector3d(4, 5, 6));
}

TEST(ReadPly, VerticesNeedNotComeFirst) {
  const PointCloud cloud = read_as("a.ply",
                                   "ply\nformat ascii 1.0\nelement camera 2\nproperty float a\nelement face 1\n"
                                   "property list uchar int vertex_index\nproperty uchar flag\nelement vertex 3\n"
                                   "property int x\nproperty int y\nproperty int z\nend_header\n"
                                   "1\n2\n3 2 1 0 7\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(cloud.size(), 3);
  ASSERT_EQ(cloud.faces.cols(), 1);
  EXPECT_EQ(cloud.faces.col(0), Eigen::Vector3i(2, 1, 0));
}

TEST(ReadPly, StripsAlternateTheirDirection) {
  const PointCloud cloud = read_as("a.ply",
                                   "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                                   "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
                                   "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n8 0 1 2 3 -1 2 3 4\n");
  ASSERT_EQ(cloud.faces.cols(), 3);
  EXPECT_EQ(cloud.faces.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(cloud.faces.col(1), Eigen::Vector3i(1, 3, 2));
  EXPECT_EQ(cloud.faces.col(2), Eigen::Vector3i(2, 3, 4));
}

/// Every scalar type once, in both byte orders.
class BinaryPly : public testing::TestWithParam<bool> {};

TEST_P(BinaryPly, ReadsEveryTypeInBothByteOrders) {
  const bool big = GetParam();
  std::string bytes = std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\nelement junk 2\nproperty list ushort short values\nelement vertex 3\nproperty short x\n"
                      "property char skip\nproperty ushort y\nproperty uint u\nproperty double z\nproperty float nx\n"
                      "property int ny\nproperty uint8 nz\nelement face 2\nproperty list uint8 uint32 vertex_indices\n"
                      "end_header\n";
  bytes += raw<std::uint16_t>(0, big);
  bytes += raw<std::uint16_t>(2, big) + raw<std::int16_t>(-5, big) + raw<std::int16_t>(6, big);
  for (int i = 0; i < 3; ++i) {
    bytes += raw<std::int16_t>(static_cast<std::int16_t>(-300 - i), big) + raw<std::int8_t>(-1, big);
    bytes += raw<std::uint16_t>(40000, big) + raw<std::uint32_t>(4000000000U, big) + raw<double>(0.1 * i, big);
    bytes += raw<float>(0.5F, big) + raw<std::int32_t>(-70000, big) + raw<std::uint8_t>(200, big);
  }
  bytes += raw<std::uint8_t>(0, big);
  bytes += raw<std::uint8_t>(3, big);
  for (std::uint32_t i = 0; i < 3; ++i) bytes += raw<std::uint32_t>(i, big);

  const PointCloud cloud = read_as("a.ply", bytes);
  ASSERT_EQ(cloud.size(), 3);
  EXPECT_EQ(cloud.points.col(2), Eigen::Vector3d(-302, 40000, 0.2));
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d(0.5, -70000, 200));
  ASSERT_EQ(cloud.faces.cols(), 1);
  EXPECT_EQ(cloud.faces.col(0), Eigen::Vector3i(0, 1, 2));
}

INSTANTIATE_TEST_SUITE_P(Orders, BinaryPly, testing::Values(false, true));

TEST(ReadPly, NormalsThatAreNotFiniteBecomeUnknown) {
  std::vector<std::string> notes;
  const PointCloud cloud =
      read_as("a.ply",
              "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
              "property float z\nproperty float nx\nproperty float ny\nproperty float nz\nend_header\n"
              "0 0 0 0 0 1\n1 0 0 nan nan nan\n",
              &notes);
  EXPECT_EQ(cloud.normals.col(0), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d::Zero());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("1 normal not finite: taken as unknown"), std::string::npos);
}

}  // namespace
}  // namespace taut
