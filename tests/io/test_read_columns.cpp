#include <gtest/gtest.h>

#include <clocale>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::read_as;

void expect_two(const PointCloud& cloud) {
  ASSERT_EQ(cloud.dim(), 3);
  ASSERT_EQ(cloud.size(), 2);
  EXPECT_EQ(cloud.points.col(0), Eigen::Vector3d(1, -2, 0.5));
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(4e2, 5, 6));
}

TEST(ReadColumns, SeparatorsCommentsAndLineEnds) {
  for (const char* text : {"1 -2 .5\n4e2 5 6\n", "1\t-2\t0.5\t\n4E+2\t5\t6", "1,-2,.5\r\n4e2, 5 ,6\r\n",
                           "1;-2;0.5\n4e2;5;6\n", "# header\n\n  +1 -2 0.5 # first\n\n400 5 6\n\n",
                           "\xEF\xBB\xBF"
                           "1 -2 0.5\n4e2 5 6\n",
                           "1 -2 0.5\r4e2 5 6\r", "2\n1 -2 0.5\n4e2 5 6\n"}) {
    expect_two(read_as("a.xyz", text));
    expect_two(read_as("a.pts", text));
  }
}

TEST(ReadColumns, SixColumnsAreNormalsUnlessTheyAreColours) {
  EXPECT_EQ(read_as("a.xyz", "0 0 0 0 0 1\n1 0 0 0 1 0\n").normals.col(1), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(read_as("a.xyz", "0 0 0 0 0 2.5\n1 0 0 0 7 0\n").normals.col(0), Eigen::Vector3d(0, 0, 2.5));
  std::vector<std::string> notes;
  EXPECT_FALSE(read_as("a.xyz", "0 0 0 255 128 0\n1 0 0 17 0 1\n", &notes).has_normals());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("3 columns beside coordinates and normals not used"), std::string::npos);
}

TEST(ReadColumns, IntensityAndColoursOfScannersAreNotNormals) {
  EXPECT_FALSE(read_as("a.pts", "2\n0 0 0 -1200 10 20 30\n1 0 0 -900 11 21 31\n").has_normals());
  EXPECT_FALSE(read_as("a.pts", "0 0 0 0.7\n1 0 0 0.8\n").has_normals());
}

TEST(ReadColumns, NormalsAreFoundBehindColours) {
  const PointCloud cloud = read_as("a.xyz", "0 0 0 255 128 0 0 0 1\n1 0 0 17 0 1 0.6 0 0.8\n");
  ASSERT_TRUE(cloud.has_normals());
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d(0.6, 0, 0.8));
}

TEST(ReadColumns, PwnComesInTwoForms) {
  const PointCloud halves = read_as("a.pwn", "2\n0 0 0\n1 2 3\n0 0 1\n0 1 0\n");
  const PointCloud rows = read_as("a.pwn", "0 0 0 0 0 1\n1 2 3 0 1 0\n");
  const PointCloud counted = read_as("a.pwn", "2\n0 0 0 0 0 1\n1 2 3 0 1 0\n");
  for (const PointCloud* cloud : {&halves, &rows, &counted}) {
    ASSERT_EQ(cloud->size(), 2);
    EXPECT_EQ(cloud->points.col(1), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(cloud->normals.col(1), Eigen::Vector3d(0, 1, 0));
  }
}

TEST(ReadColumns, CsvWithoutHeaderHasACoordinateAColumn) {
  const PointCloud cloud = read_as("a.csv", "1,2,3,4,5,6,7\n1,2,3,4,5,6,8\n");
  EXPECT_EQ(cloud.dim(), 7);
  EXPECT_EQ(cloud.points(6, 1), 8);
  EXPECT_FALSE(cloud.has_normals());
  EXPECT_EQ(read_as("a.csv", "1,2\n3,4\n").dim(), 2);
}

TEST(ReadColumns, CsvHeaderNamesTheColumns) {
  std::vector<std::string> notes;
  const PointCloud cloud = read_as("a.csv", "label,Z,\"Y\",X,nx,ny,nz\n\"a, b\",3,2,1,0,0,1\nb,6,5,4,0,1,0\n", &notes);
  EXPECT_EQ(cloud.points.col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(cloud.normals.col(1), Eigen::Vector3d(0, 1, 0));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("column 'label' is not used"), std::string::npos);
}

TEST(ReadColumns, CsvHeaderMayNumberTheCoordinates) {
  const PointCloud cloud = read_as("a.csv", "x1,x2,x3,x4,x5,n1,n2,n3,n4,n5\n1,2,3,4,5,0,0,0,0,1\n");
  EXPECT_EQ(cloud.dim(), 5);
  EXPECT_EQ(cloud.normals(4, 0), 1);
  EXPECT_EQ(read_as("a.csv", "alpha,beta\n1,2\n").dim(), 2);  // other names: all of them
}

TEST(ReadColumns, HeaderOfAnXyzFileIsUnderstood) {
  EXPECT_EQ(read_as("a.xyz", "X Y Z Nx Ny Nz\n1 2 3 0 0 1\n").normals, Eigen::Vector3d(0, 0, 1));
}

TEST(ReadColumns, TinyNumbersBecomeZero) {
  EXPECT_EQ(read_as("a.xyz", "1e-400 -1e-5000 5e-324\n").points,
            Eigen::Vector3d(0, 0, std::numeric_limits<double>::denorm_min()));
}

TEST(ReadColumns, DecimalsAreReadTheSameInEveryLocale) {
  const char* before = std::setlocale(LC_NUMERIC, nullptr);
  const std::string old = before == nullptr ? "C" : before;
  for (const char* name : {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "C"}) {
    if (std::setlocale(LC_NUMERIC, name) == nullptr) continue;
    EXPECT_EQ(read_as("a.xyz", "0.5 1.25 -3.75\n").points, Eigen::Vector3d(0.5, 1.25, -3.75)) << name;
  }
  std::setlocale(LC_NUMERIC, old.c_str());
}

}  // namespace
}  // namespace taut
