#include "taut/io/read_points.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::TempFolder;

std::vector<CsvRow> rows_of(const std::string& text) {
  std::istringstream in(text);
  CsvRows rows(in, "stdin");
  std::vector<CsvRow> all;
  for (CsvRow row; rows.next(row);) all.push_back(row);
  return all;
}

TEST(CsvRows, LinesKeepTheirNumbers) {
  const auto rows = rows_of("# pairs\n1,2,3\n\n4,5,6 # the second\r\n7,8,9");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].line, 2U);
  EXPECT_EQ(rows[1].line, 4U);
  EXPECT_EQ(rows[1].values, (std::vector<double>{4, 5, 6}));
  EXPECT_EQ(rows[2].line, 5U);
  EXPECT_EQ(rows[2].values, (std::vector<double>{7, 8, 9}));
}

TEST(CsvRows, HeaderAndByteOrderMarkAreSkipped) {
  EXPECT_EQ(rows_of("\xEF\xBB\xBFpx,py\n1,2\n").size(), 1U);
  EXPECT_EQ(rows_of("1 2\n").size(), 1U);
  EXPECT_EQ(rows_of("pairs\n1,2\n").front().values, (std::vector<double>{1, 2}));
  EXPECT_NE(rows_of("pairs\nmore\n1,2\n").front().problem, "");  // one line of names, not two
  EXPECT_EQ(rows_of("").size(), 0U);
}

TEST(CsvRows, FieldsMayNameSamples) {
  Points samples(2, 3);
  samples << 1, 2, 3, 10, 20, 30;
  std::istringstream in("@0\n@2,@1\n5,6,@1\n@3\n@1x\n");
  CsvRows rows(in, "stdin");
  rows.set_samples(samples);
  std::vector<CsvRow> all;
  for (CsvRow row; rows.next(row);) all.push_back(row);
  ASSERT_EQ(all.size(), 5U);  // a first line of samples is no header
  EXPECT_EQ(all[0].values, (std::vector<double>{1, 10}));
  EXPECT_EQ(all[1].values, (std::vector<double>{3, 30, 2, 20}));
  EXPECT_EQ(all[2].values, (std::vector<double>{5, 6, 2, 20}));
  EXPECT_NE(all[3].problem.find("samples go from @0 to @2"), std::string::npos) << all[3].problem;
  EXPECT_NE(all[4].problem, "");
  EXPECT_NE(rows_of("@1\n").front().problem.find("here there are none"), std::string::npos);
}

TEST(CsvRows, ABadLineDoesNotEndTheWalk) {
  const auto rows = rows_of("1,2\nabc,2\n3,nan\n1e999,0\n,1\n5,6\n");
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0].problem, "");
  EXPECT_EQ(rows[1].problem, "column 1: 'abc' is not a number; correct the line");
  EXPECT_EQ(rows[2].problem, "column 2 is nan; give a finite value");
  EXPECT_NE(rows[3].problem.find("too large"), std::string::npos);
  EXPECT_NE(rows[4].problem.find("column 1 is empty"), std::string::npos);
  EXPECT_EQ(rows[5].values, (std::vector<double>{5, 6}));
}

TEST(CsvRows, LongFilesPassThroughASmallBuffer) {
  std::string text;
  for (int i = 0; i < 50000; ++i) text += std::to_string(i) + "," + std::to_string(0.5 * i) + "\n";
  const TempFolder folder;
  CsvRows rows(folder.write("a.csv", text));
  CsvRow row;
  int n = 0;
  for (; rows.next(row); ++n) {
    ASSERT_EQ(row.values, (std::vector<double>{1.0 * n, 0.5 * n}));
    ASSERT_EQ(row.line, static_cast<std::size_t>(n + 1));
  }
  EXPECT_EQ(n, 50000);
}

TEST(CsvRows, EndlessLineIsRefused) { EXPECT_THROW(rows_of(std::string(20 << 20, '1')), IoError); }

TEST(CsvRows, FilesThatAreNoTables) {
  const TempFolder folder;
  EXPECT_THROW(CsvRows(folder.path() / "missing.csv"), IoError);
  EXPECT_THROW(CsvRows{folder.path()}, IoError);
  EXPECT_THROW(CsvRows(folder.write("a.csv", "")), IoError);
  EXPECT_THROW(CsvRows(folder.write("b.csv", "\x89PNG\r\n")), IoError);
  EXPECT_THROW(CsvRows(folder.write("c.csv", std::string("1,2\n\0", 5))), IoError);
}

TEST(ReadPoints, AnyExtensionAndDimension) {
  const TempFolder folder;
  const Points plane = read_points(folder.write("a.txt", "1 2\n3 4\n"), 2);
  EXPECT_EQ(plane.col(1), Eigen::Vector2d(3, 4));
  EXPECT_EQ(read_points(folder.write("points", "1,2,3,4\n"), 4).cols(), 1);
  EXPECT_EQ(read_points(folder.write("a.xyz", "1 2 3 4\n"), 4).rows(), 4);
  EXPECT_EQ(read_points(folder.write("b.xyz", "1 2 3 0 0 1\n"), 3).col(0), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(read_points(folder.write("a.csv", "id,x,y,z\n7,1,2,3\n"), 3).col(0), Eigen::Vector3d(1, 2, 3));
}

TEST(ReadPoints, WrongDimensionIsSaid) {
  const TempFolder folder;
  try {
    static_cast<void>(read_points(folder.write("a.csv", "1,2,3,4\n"), 3));
    FAIL() << "accepted";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("has 4 columns where 3 coordinates are needed"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(static_cast<void>(read_points(folder.write("b.txt", "\x89PNG\r\n"), 3)), IoError);
}

}  // namespace
}  // namespace taut
