#include <gtest/gtest.h>

#include <array>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::error_of;
using test::raw;
using test::read_as;

struct Las {
  int minor = 2;
  int format = 0;
  std::uint64_t count = 2;
  double scale = 0.01;
  std::vector<std::array<int, 4>> points = {{100, 200, 300, 2}, {-100, 0, 50, 2}};  // x, y, z, class
};

/// A file of the published layout, with 13 bytes of records before the points.
std::string las(const Las& file) {
  const int header_size = file.minor >= 4 ? 375 : 227;
  const std::array<int, 11> sizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  const int record = sizes[static_cast<std::size_t>(file.format & 0x3F)];
  std::string bytes = "LASF";
  bytes += std::string(20, '\0');
  bytes += raw<std::uint8_t>(1) + raw(static_cast<std::uint8_t>(file.minor));
  bytes += std::string(68, ' ');
  bytes += raw(static_cast<std::uint16_t>(header_size)) + raw(static_cast<std::uint32_t>(header_size + 13)) +
           raw<std::uint32_t>(0);
  bytes += raw(static_cast<std::uint8_t>(file.format)) + raw(static_cast<std::uint16_t>(record));
  bytes += raw(static_cast<std::uint32_t>(file.minor >= 4 ? 0 : file.count)) + std::string(20, '\0');
  for (int i = 0; i < 3; ++i) bytes += raw(file.scale);
  bytes += raw(500000.0) + raw(5400000.0) + raw(0.0);
  bytes += std::string(48, '\0');
  if (file.minor >= 4) bytes += std::string(20, '\0') + raw(file.count) + std::string(120, '\0');
  EXPECT_EQ(bytes.size(), static_cast<std::size_t>(header_size));
  bytes += std::string(13, '\0');
  for (const auto& [x, y, z, kind] : file.points) {
    std::string row = raw(x) + raw(y) + raw(z);
    row.resize(static_cast<std::size_t>(record), '\0');
    row[file.format < 6 ? 15 : 16] = static_cast<char>(kind);
    bytes += row;
  }
  return bytes;
}

TEST(ReadLas, CoordinatesAreStepsOfTheScaleFromTheOffset) {
  for (const auto& [minor, format] :
       {std::pair(2, 0), std::pair(2, 3), std::pair(3, 4), std::pair(4, 6), std::pair(4, 10)}) {
    const PointCloud cloud = read_as("a.las", las({.minor = minor, .format = format}));
    ASSERT_EQ(cloud.size(), 2) << "1." << minor << " format " << format;
    EXPECT_EQ(cloud.points.col(0), Eigen::Vector3d(500001, 5400002, 3));
    EXPECT_EQ(cloud.points.col(1), Eigen::Vector3d(499999, 5400000, 0.5));
    EXPECT_FALSE(cloud.has_normals());
  }
}

TEST(ReadLas, WithheldPointsAndNoiseAreLeftOut) {
  std::vector<std::string> notes;
  Las file{.count = 3, .points = {{1, 2, 3, 7}, {4, 5, 6, 2}, {7, 8, 9, 0x80}}};
  EXPECT_EQ(read_as("a.las", las(file), &notes).size(), 1);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("2 points that the file marks as withheld or noise left out"), std::string::npos);
  file = {.minor = 4, .format = 7, .count = 2, .points = {{1, 2, 3, 18}, {4, 5, 6, 0x80}}};
  EXPECT_EQ(read_as("a.las", las(file)).size(), 1);
}

TEST(ReadLas, BadFilesAreNamed) {
  const std::string good = las({});
  EXPECT_NE(error_of("a.las", "").find("empty"), std::string::npos);
  EXPECT_NE(error_of("a.las", "LAS nonsense").find("does not start with 'LASF'"), std::string::npos);
  EXPECT_NE(error_of("a.las", good.substr(0, 150)).find("ends inside its header"), std::string::npos);
  EXPECT_NE(error_of("a.las", good.substr(0, good.size() - 5)).find("cut short"), std::string::npos);
  EXPECT_NE(error_of("a.las", las({.count = 4000000000U})).find("says 4000000000"), std::string::npos);
  EXPECT_NE(error_of("a.las", las({.minor = 4, .format = 6, .count = ~std::uint64_t{0}})).find("cut short"),
            std::string::npos);
  EXPECT_NE(error_of("a.las", las({.format = 0x80})).find("compressed (LAZ)"), std::string::npos);
  EXPECT_NE(error_of("a.las", las({.scale = 0})).find("scale or offset"), std::string::npos);
  EXPECT_NE(error_of("a.las", las({.minor = 7})).find("version 1.7"), std::string::npos);
  EXPECT_NE(error_of("a.laz", good).find("las2las"), std::string::npos);
  EXPECT_NE(error_of("a.e57", good).find("pdal translate"), std::string::npos);
}

}  // namespace
}  // namespace taut
