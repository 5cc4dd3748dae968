// Points from VTK's files: legacy and XML.

#include <gtest/gtest.h>
#include <zlib.h>

#include "io/read_text.hpp"
#include "taut/io/write_geometry.hpp"

namespace taut {
namespace {

using test::error_of;
using test::raw;
using test::read_as;

const std::string kLegacy = "# vtk DataFile Version 3.0\ntitle\n";

TEST(ReadVtk, LegacyTextWithPolygonsAndNormals) {
  const PointCloud cloud = read_as(
      "a.vtk", kLegacy +
                   "ASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0.5\n\nPOLYGONS 1 5\n4 0 1 2 "
                   "3\nCELL_DATA 1\nSCALARS s int 1\nLOOKUP_TABLE default\n7\nPOINT_DATA 4\nNORMALS n float\n"
                   "0 0 1 0 0 1 0 0 1\n0 0 1\n");
  ASSERT_EQ(cloud.size(), 4);
  EXPECT_EQ(cloud.points.col(3), Eigen::Vector3d(0, 1, 0.5));
  ASSERT_EQ(cloud.faces.cols(), 2);
  EXPECT_EQ(cloud.faces.col(1), Eigen::Vector3i(0, 2, 3));
  EXPECT_EQ(cloud.normals.col(2), Eigen::Vector3d(0, 0, 1));
}

TEST(ReadVtk, LegacyBinaryIsBigEndian) {
  std::string bytes = kLegacy + "BINARY\nDATASET POLYDATA\nPOINTS 3 double\n";
  for (const double x : {0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5, 0.0}) bytes += raw(x, true);
  bytes += "\nPOLYGONS 1 4\n" + raw(3, true) + raw(0, true) + raw(1, true) + raw(2, true) + "\n";
  const PointCloud cloud = read_as("a.vtk", bytes);
  ASSERT_EQ(cloud.size(), 3);
  EXPECT_EQ(cloud.points(1, 2), 1.5);
  EXPECT_EQ(cloud.faces.col(0), Eigen::Vector3i(0, 1, 2));
  // Version 5: offsets and corners apart.
  std::string five = kLegacy + "BINARY\nDATASET POLYDATA\nPOINTS 3 float\n";
  for (const float x : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.5F, 0.0F}) five += raw(x, true);
  five += "\nPOLYGONS 2 3\nOFFSETS vtktypeint64\n" + raw<std::int64_t>(0, true) + raw<std::int64_t>(3, true) +
          "\nCONNECTIVITY vtktypeint64\n";
  for (const std::int64_t corner : {0, 1, 2}) five += raw(corner, true);
  EXPECT_EQ(read_as("a.vtk", five + "\n").faces.col(0), Eigen::Vector3i(0, 1, 2));
}

/// What Taut writes comes back to the last bit.
TEST(ReadVtk, WhatIsWrittenToVtpIsReadAgain) {
  const test::TempFolder folder;
  PointCloud cloud;
  cloud.points.resize(3, 4);
  cloud.points << 0.1, 1, 0, 1.0 / 3, 0, 1e-300, 2, 3, 5e6, 1, 2, 3;
  cloud.normals = cloud.points.colwise().normalized();
  cloud.faces.resize(3, 2);
  cloud.faces << 0, 1, 1, 2, 2, 3;
  write_point_cloud(folder.path() / "a.vtp", cloud);
  const PointCloud again = read_point_cloud(folder.path() / "a.vtp");
  EXPECT_EQ(again.points, cloud.points);
  EXPECT_EQ(again.normals, cloud.normals);
  EXPECT_EQ(again.faces, cloud.faces);
}

std::string grid(const std::string& root, const std::string& array, const std::string& rest = {}) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" " + root +
         "><UnstructuredGrid><Piece NumberOfPoints=\"2\" NumberOfCells=\"0\"><Points>\n" + array +
         "\n</Points></Piece></UnstructuredGrid>" + rest + "</VTKFile>\n";
}

TEST(ReadVtk, XmlArraysAsTextAppendedAndPacked) {
  const Eigen::Vector3d last(4, 5, 6.5);
  const PointCloud text =
      read_as("a.vtu", grid("byte_order='LittleEndian'",
                            "<DataArray type=\"Float32\" NumberOfComponents=\"3\">1 2 3\n4 5 6.5</DataArray>"));
  ASSERT_EQ(text.size(), 2);
  EXPECT_EQ(text.points.col(1), last);
  std::string numbers;
  for (const float x : {1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.5F}) numbers += raw(x, true);
  const std::string array = "<DataArray type=\"Float32\" format=\"appended\" offset=\"3\"/>";
  const PointCloud appended = read_as("a.vtu", grid("byte_order=\"BigEndian\" header_type=\"UInt64\"", array,
                                                    "<AppendedData encoding=\"raw\">\n_abc" +
                                                        raw<std::uint64_t>(24, true) + numbers + "</AppendedData>"));
  EXPECT_EQ(appended.points.col(1), last);
  std::string packed(100, '\0');
  uLongf size = packed.size();
  ASSERT_EQ(
      compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(numbers.data()), 24),
      Z_OK);
  packed.resize(size);
  const auto word = [](std::uint32_t x) { return raw(x, true); };
  const std::string blocks = word(1) + word(32768) + word(24) + word(static_cast<std::uint32_t>(size)) + packed;
  const std::string root = "byte_order=\"BigEndian\" compressor=\"vtkZLibDataCompressor\"";
  const auto file = [&](const std::string& data) {
    return grid(root, array, "<AppendedData encoding=\"raw\">_abc" + data + "</AppendedData>");
  };
  EXPECT_EQ(read_as("a.vtu", file(blocks)).points.col(1), last);
  EXPECT_NE(
      error_of("a.vtu", file(word(1) + word(4000000000U) + word(0) + word(static_cast<std::uint32_t>(size)) + packed))
          .find("damaged"),
      std::string::npos);
  EXPECT_NE(error_of("a.vtu", file(word(4000000000U))).find("cut short"), std::string::npos);
}

TEST(ReadVtk, BadFilesAreNamed) {
  const auto legacy = [](const std::string& rest) { return error_of("a.vtk", kLegacy + rest); };
  EXPECT_NE(legacy("ASCII\nDATASET POLYDATA\nPOINTS 4000000 float\n0 0 0\n").find("POINTS says 12000000"),
            std::string::npos);
  EXPECT_NE(legacy("ASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 nan 0\n").find("coordinate y is nan"),
            std::string::npos);
  EXPECT_NE(legacy("BINARY\nDATASET POLYDATA\nPOINTS 2 float\n0000").find("cut short"), std::string::npos);
  EXPECT_NE(legacy("ASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n3 0 1 2\n").find("out of range"),
            std::string::npos);
  EXPECT_NE(legacy("ASCII\nDATASET POLYDATA\n").find("has no POINTS"), std::string::npos);
  EXPECT_NE(legacy("MIXED\n").find("neither ASCII nor BINARY"), std::string::npos);
  EXPECT_NE(error_of("a.vtp", "<?xml version=\"1.0\"?><html/>").find("no VTKFile"), std::string::npos);
  EXPECT_NE(error_of("a.vtp", grid("", "<DataArray type=\"Float32\">1 2 3</DataArray>")).find("3 numbers where 6"),
            std::string::npos);
  EXPECT_NE(error_of("a.vtp", grid("", "<DataArray type=\"Float32\" format=\"appended\" offset=\"9\"/>"))
                .find("not where the file says"),
            std::string::npos);
  EXPECT_NE(error_of("a.vtp", grid("", "<DataArray type=\"Float32\" format=\"binary\">AAAA/w==</DataArray>"))
                .find("cut short"),
            std::string::npos);
}

}  // namespace
}  // namespace taut
