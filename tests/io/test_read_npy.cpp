#include <gtest/gtest.h>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::raw;
using test::read_as;

std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  bytes += version == 1 ? raw(static_cast<std::uint16_t>(dictionary.size()))
                        : raw(static_cast<std::uint32_t>(dictionary.size()));
  return bytes + dictionary + data;
}

template <class T>
std::string numbers(std::initializer_list<double> values, bool big = false) {
  std::string bytes;
  for (const double v : values) bytes += raw(static_cast<T>(v), big);
  return bytes;
}

void expect_rows(const PointCloud& cloud) {
  ASSERT_EQ(cloud.dim(), 2);
  ASSERT_EQ(cloud.size(), 3);
  EXPECT_EQ(cloud.points.col(0), Eigen::Vector2d(1, -2));
  EXPECT_EQ(cloud.points.col(1), Eigen::Vector2d(3, 40));
  EXPECT_EQ(cloud.points.col(2), Eigen::Vector2d(5, 60));
}

std::string dictionary(const std::string& type, bool fortran = false) {
  return "{'descr': '" + type + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': (3, 2), }\n";
}

TEST(ReadNpy, EveryNumberTypeAndByteOrder) {
  const std::initializer_list<double> rows = {1, -2, 3, 40, 5, 60};
  expect_rows(read_as("a.npy", npy(dictionary("<f8"), numbers<double>(rows))));
  expect_rows(read_as("a.npy", npy(dictionary(">f8"), numbers<double>(rows, true))));
  expect_rows(read_as("a.npy", npy(dictionary("<f4"), numbers<float>(rows))));
  expect_rows(read_as("a.npy", npy(dictionary(">f4"), numbers<float>(rows, true))));
  expect_rows(read_as("a.npy", npy(dictionary("|i1"), numbers<std::int8_t>(rows))));
  expect_rows(read_as("a.npy", npy(dictionary("<i2"), numbers<std::int16_t>(rows))));
  expect_rows(read_as("a.npy", npy(dictionary(">i4"), numbers<std::int32_t>(rows, true))));
  expect_rows(read_as("a.npy", npy(dictionary("<i8"), numbers<std::int64_t>(rows))));
}

TEST(ReadNpy, FortranOrderStandsColumnByColumn) {
  expect_rows(read_as("a.npy", npy(dictionary("<f8", true), numbers<double>({1, 3, 5, -2, 40, 60}))));
}

TEST(ReadNpy, LaterVersionsHaveALongerHeader) {
  expect_rows(read_as("a.npy", npy(dictionary("<f8"), numbers<double>({1, -2, 3, 40, 5, 60}), 2)));
}

TEST(ReadNpy, HeaderIsPaddedAsNumpyPadsIt) {
  std::string header = dictionary("<f8");
  header.insert(header.size() - 1, 118 - header.size(), ' ');  // 10 + 118: data begin at a multiple of 64
  expect_rows(read_as("a.npy", npy(header, numbers<double>({1, -2, 3, 40, 5, 60}))));
}

}  // namespace
}  // namespace taut
