#include <gtest/gtest.h>

#include <limits>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::raw;
using test::read_as;

std::string header(const std::string& points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS rgb x y z normal_x normal_y normal_z\n"
         "SIZE 4 4 4 8 4 4 4\nTYPE U F F F F F F\nCOUNT 2 1 1 1 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

TEST(ReadPcd, TextRowsWithoutFiniteCoordinatesAreLeftOut) {
  std::vector<std::string> notes;
  const PointCloud cloud = read_as(
      "a.pcd", header("3", "ascii") + "9 9 1 2 3 0 0 1\n9 9 nan nan nan nan nan nan\n9 9 4 5 6 0 nan 0\n", &notes);
  ASSERT_EQ(cloud.size(), 2);
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(cloud.normals.col(0), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d::Zero());
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_NE(notes[0].find("1 point without finite coordinates left out"), std::string::npos);
}

TEST(ReadPcd, BinaryRows) {
  std::string bytes = header("2", "binary");
  for (int i = 0; i < 2; ++i) {
    bytes += raw<std::uint32_t>(7) + raw<std::uint32_t>(8) + raw<float>(1.5F) + raw<float>(static_cast<float>(i));
    bytes += raw<double>(0.1) + raw<float>(0) + raw<float>(0) + raw<float>(1);
  }
  const PointCloud cloud = read_as("a.pcd", bytes);
  ASSERT_EQ(cloud.size(), 2);
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(1.5, 1, 0.1));
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d(0, 0, 1));
}

TEST(ReadPcd, CompressedColumns) {
  // Two points, x y z floats, field by field: x = 1, 1; y = 2, 2; z = 0, 0.
  const std::string one = raw(1.0F);
  const std::string two = raw(2.0F);
  std::string packed;
  packed += '\x03' + one;                                   // four bytes as they are
  packed += static_cast<char>(2 << 5) + std::string(1, 3);  // 4 = 2 + 2 bytes again, from 4 = 3 + 1 back
  packed += '\x07' + two + two;                             // eight bytes as they are
  packed += std::string(1, '\0') + std::string(1, '\0');    // one zero byte
  packed += '\xE0' + std::string(2, '\0');                  // 9 + 0 bytes again, from 1 back: more than is left
  const auto file = [&](const std::string& data) {
    return std::string("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA binary_compressed\n") +
           raw(static_cast<std::uint32_t>(data.size())) + raw<std::uint32_t>(24) + data;
  };
  EXPECT_NE(test::error_of("a.pcd", file(packed)).find("the compressed data are damaged"), std::string::npos);
  packed.resize(packed.size() - 3);
  packed += static_cast<char>(5 << 5) + std::string(1, '\0');  // 7 = 5 + 2 bytes again, from 1 back
  const PointCloud cloud = read_as("a.pcd", file(packed));
  ASSERT_EQ(cloud.size(), 2);
  EXPECT_EQ(cloud.points.col(0), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(1, 2, 0));
}

}  // namespace
}  // namespace taut
