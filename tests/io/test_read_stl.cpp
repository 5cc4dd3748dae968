#include <gtest/gtest.h>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::raw;
using test::read_as;

std::string facet(const std::string& a, const std::string& b, const std::string& c) {
  return "facet normal 0 0 1\n outer loop\n  vertex " + a + "\n  vertex " + b + "\n  vertex " + c +
         "\n endloop\nendfacet\n";
}

std::string binary(const std::vector<std::array<float, 9>>& triangles, std::string header) {
  header.resize(80, ' ');
  std::string bytes = header + raw(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    bytes += std::string(12, '\0');
    for (const float x : triangle) bytes += raw(x);
    bytes += std::string(2, '\0');
  }
  return bytes;
}

TEST(ReadStl, TextCornersAreWelded) {
  const PointCloud cloud = read_as("a.stl", "solid two words\n" + facet("0 0 0", "1 0 0", "1 1 0") +
                                                facet("-0.0 0 0", "1e0 1 0", "0 1 0") + "endsolid\n");
  EXPECT_EQ(cloud.size(), 4);
  ASSERT_EQ(cloud.faces.cols(), 2);
  EXPECT_EQ(cloud.faces.col(1), Eigen::Vector3i(0, 2, 3));
}

TEST(ReadStl, SeveralSolidsMakeOneCloud) {
  const std::string solid = "SOLID\n" + facet("0 0 0", "1 0 0", "1 1 0") + "ENDSOLID x\n";
  EXPECT_EQ(read_as("a.stl", solid + solid).faces.cols(), 2);
}

TEST(ReadStl, EndsMayBeWrittenInTwoWords) {
  const PointCloud cloud = read_as("a.stl",
                                   "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 "
                                   "0\nend loop\nend facet\nEnd Solid part\n");
  EXPECT_EQ(cloud.size(), 3);
  EXPECT_EQ(cloud.faces.cols(), 1);
}

TEST(ReadStl, BinaryMayBeginWithSolid) {
  const PointCloud cloud =
      read_as("a.stl", binary({{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 1, 1, 0, 0, 1, 0.1F}}, "solid cad"));
  EXPECT_EQ(cloud.size(), 4);
  EXPECT_EQ(cloud.faces.cols(), 2);
  EXPECT_EQ(cloud.points(2, 3), static_cast<double>(0.1F));
}

TEST(ReadStl, DegenerateTrianglesAreLeftOutWithANote) {
  std::vector<std::string> notes;
  const PointCloud cloud =
      read_as("a.stl", binary({{0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 0, 0, 0, 0, 0, 1, 0}}, ""), &notes);
  EXPECT_EQ(cloud.faces.cols(), 1);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("1 triangle with two equal corners left out"), std::string::npos);
}

}  // namespace
}  // namespace taut
