#include <gtest/gtest.h>

#include <clocale>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::error_of;
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
  EXPECT_NE(notes[0].find("columns 1 to 3 are taken as coordinates; not used: columns 4 to 6"), std::string::npos);
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

TEST(ReadColumns, CsvWithoutHeaderOfMoreThanThreeColumnsNeedsTheDimension) {
  const std::string seven = "1,2,3,4,5,6,7\n1,2,3,4,5,6,8\n";
  EXPECT_NE(error_of("a.csv", seven).find("line 1: has 7 columns and no header"), std::string::npos);
  const PointCloud cloud = read_as("a.csv", seven, nullptr, 7);
  EXPECT_EQ(cloud.dim(), 7);
  EXPECT_EQ(cloud.points(6, 1), 8);
  EXPECT_FALSE(cloud.has_normals());
  std::vector<std::string> notes;
  EXPECT_EQ(read_as("a.csv", seven, &notes, 3).points.col(1), Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("not used: columns 4 to 7"), std::string::npos) << notes[0];
  EXPECT_EQ(read_as("a.csv", "1,2\n3,4\n").dim(), 2);
  EXPECT_EQ(read_as("a.csv", "0,0,1,0,0,1\n1,0,0,1,0,0\n", nullptr, 3).normals.col(1), Eigen::Vector3d(1, 0, 0));
}

TEST(ReadColumns, NamesOfViewersSolversAndSurveyorsAreKnown) {
  const Eigen::Vector3d p(1, 2, 3);
  for (const char* header :
       {"temp,Points_0,Points_1,Points_2", "temp,Points:0,Points:1,Points:2", "t,x0,x1,x2", "t,X [m],Y [m],Z [m]",
        "t,x[0],x[1],x[2]", "t,x_coord,y_coord,z_coord", "id,px,py,pz", "id,Easting,Northing,Elevation",
        "id,x,y,height", "\"\",\"x\",\"y\",\"z\"", "t,Position X,Position Y,Position Z", "t,x1,x2,x3", "lat,x,y,z"}) {
    std::vector<std::string> notes;
    const PointCloud cloud = read_as("a.csv", std::string(header) + "\n7,1,2,3\n", &notes);
    EXPECT_EQ(cloud.points, p) << header;
    ASSERT_EQ(notes.size(), 1U) << header;
    EXPECT_NE(notes[0].find("is not used"), std::string::npos) << notes[0];
  }
  for (const char* header : {"x,y,z,Normals_0,Normals_1,Normals_2", "x,y,z,Normals:0,Normals:1,Normals:2",
                             "x,y,z,NormalX,NormalY,NormalZ", "x,y,z,normal_x,normal_y,normal_z", "x y z nx ny nz"}) {
    EXPECT_EQ(read_as("a.txt", std::string(header) + "\n1 2 3 0 0 1\n").normals, Eigen::Vector3d(0, 0, 1)) << header;
  }
  // The plain case is no news.
  std::vector<std::string> notes;
  EXPECT_EQ(read_as("a.csv", "x,y,z\n1,2,3\n", &notes).points, p);
  EXPECT_EQ(read_as("a.csv", "1,2,3\n", &notes).points, p);
  EXPECT_EQ(read_as("a.tsv", "X\tY\tZ\n1\t2\t3\n", &notes).points, p);
  EXPECT_TRUE(notes.empty()) << notes[0];
}

TEST(ReadColumns, AHeaderMayBeAComment) {
  for (const char* text :
       {"//X Y Z R G B\n1 -2 0.5 12 200 30\n400 5 6 12 200 30\n",
        "//X;Y;Z;R;G;B\n2\n1;-2;0.5;12;200;30\n400;5;6;12;200;30\n",
        "# made by a program\n# x,y,z,a,b,c\n1 -2 0.5 12 200 30\n400 5 6 12 200 30\n",
        "2\n// x y z a b c\n1 -2 0.5 12 200 30\n400 5 6 12 200 30\n", "% exported\n1 -2 0.5\n400 5 6\n"}) {
    expect_two(read_as("a.asc", text));
    expect_two(read_as("a.txt", text));
  }
  const PointCloud cloud = read_as("a.csv", "#z,y,x\n0.5,-2,1\n6,5,400\n");
  expect_two(cloud);
}

TEST(ReadColumns, DecimalCommasAreReadWhereTheySeparateNothing) {
  for (const char* text : {"1,0;-2;0,5\n4,0e2;5;6,0\n", "1\t-2,0\t0,5\n400,0\t5\t6\n",
                           "\"1,0\",\"-2,0\",\"0,5\"\n\"400,0\",\"5\",\"6\"\n", "x;y;z\n1;-2;0,5\n400;5;6\n"}) {
    std::vector<std::string> notes;
    expect_two(read_as("a.csv", text, &notes));
    ASSERT_EQ(notes.size(), 1U) << text;
    EXPECT_NE(notes[0].find("decimal commas"), std::string::npos) << notes[0];
  }
  EXPECT_NE(error_of("a.csv", "1,234;5.5;6\n").find("decimal commas and decimal points are mixed"), std::string::npos);
  EXPECT_NE(error_of("a.csv", "1.234,5;5;6\n").find("not one number"), std::string::npos);
  // Between commas they cannot be told from separators.
  EXPECT_NE(error_of("a.csv", "115,123,180,001,46,210\n").find("semicolons between the columns"), std::string::npos);
  EXPECT_NE(error_of("a.xyz", "115,123,180,001,46,210\n").find("semicolons between the columns"), std::string::npos);
  EXPECT_NE(error_of("a.csv", "x,y,z\n1,5,2,5,3,5\n").find("semicolons between the columns"), std::string::npos);
}

TEST(ReadColumns, ACountMayHeadACsv) {
  expect_two(read_as("a.csv", "2\n1,-2,0.5\n400,5,6\n"));
  EXPECT_NE(error_of("a.csv", "3\n1,-2,0.5\n400,5,6\n").find("announces 3 points"), std::string::npos);
}

TEST(ReadColumns, QuotedValuesAreNumbers) {
  expect_two(read_as("a.csv", "\"x\",\"y\",\"z\"\n\"1\",\"-2\",\"0.5\"\n\" 400 \",5,\"6\"\n"));
  expect_two(read_as("a.xyz", "\"1\" \"-2\" \"0.5\"\n400 5 6\n"));
}

TEST(ReadColumns, AnIndexIsNoCoordinate) {
  const std::string rows = "0 5 1 2\n1 6 2 3\n2 5 3 3\n3 7 1 2\n";
  EXPECT_NE(error_of("a.xyz", rows).find("column 1 counts the lines"), std::string::npos);
  EXPECT_EQ(read_as("a.xyz", "id x y z\n" + rows).points.col(3), Eigen::Vector3d(7, 1, 2));
}

TEST(ReadColumns, AnglesAreNoCoordinates) {
  EXPECT_NE(error_of("a.csv", "lat,lon,alt\n48.1,11.5,500\n").find("angles"), std::string::npos);
}

TEST(ReadColumns, PointsThatStandForMissingValuesAreLeftOutAndNamed) {
  std::string scan;
  for (int i = 0; i < 20; ++i) scan += std::to_string(317785 + i % 5) + " 5049158 " + std::to_string(65 + i / 5) + "\n";
  for (const char* stray : {"0 0 0", "-9999 -9999 -9999", "317786 5049158 -9999", "1e38 1e38 1e38"}) {
    std::vector<std::string> notes;
    const PointCloud cloud = read_as("a.xyz", std::string(stray) + "\n" + scan, &notes);
    EXPECT_EQ(cloud.size(), 20) << stray;
    EXPECT_EQ(cloud.points.col(0), Eigen::Vector3d(317785, 5049158, 65)) << stray;
    ASSERT_EQ(notes.size(), 1U) << stray;
    EXPECT_NE(notes[0].find("point 0 (from 0) is"), std::string::npos) << notes[0];
  }
  // Around the origin 0,0,0 is a point like others.
  std::vector<std::string> notes;
  EXPECT_EQ(read_as("a.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 9\n", &notes).size(), 4);
  EXPECT_TRUE(notes.empty());
}

TEST(ReadColumns, CompressedFilesAreUnpacked) {
  // printf '1 -2 0.5\n4e2 5 6\n' | gzip -n
  constexpr char kPacked[] =
      "\x1f\x8b\x08\x00\x00\x00\x00\x00\x02\xff\x33\x54\xd0\x35\x52\x30"
      "\xd0\x33\xe5\x32\x49\x35\x52\x30\x55\x30\xe3\x02\x00\x32\xbd\xb5"
      "\xf0\x11\x00\x00\x00";
  const std::string packed(kPacked, sizeof kPacked - 1);
  if (error_of("a.xyz.gz", packed).find("without zlib") != std::string::npos) GTEST_SKIP() << "no zlib";
  expect_two(read_as("a.xyz.gz", packed));
  expect_two(read_as("A.XYZ.GZ", packed));
  EXPECT_NE(error_of("a.xyz.gz", packed.substr(0, 20)).find("cut short"), std::string::npos);
  EXPECT_NE(error_of("a.xyz.gz", "1 2 3\n").find("damaged"), std::string::npos);
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
