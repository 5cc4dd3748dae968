#include "taut/io/write_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "io/read_text.hpp"
#include "taut/io/read_points.hpp"

namespace taut {
namespace {

using test::TempFolder;

constexpr unsigned kSeed = 20240611;

/// Numbers of every size, so that a digit lost anywhere shows.
Points random_points(Index dim, Index n) {
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-300, 300);
  Points points(dim, n);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = std::ldexp(mantissa(random), exponent(random));
  return points;
}

TriangleMesh octahedron() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << 0.1, -1.0 / 3, 0, 0, 0, 0,  //
      0, 0, M_PI, -1e-17, 0, 0,                //
      0, 0, 0, 0, 1e22, -0.7;
  mesh.faces.resize(3, 8);
  mesh.faces << 0, 2, 1, 3, 2, 1, 3, 0,  //
      2, 1, 3, 0, 0, 2, 1, 3,            //
      4, 4, 4, 4, 5, 5, 5, 5;
  mesh.normals = mesh.vertices.colwise().normalized();
  mesh.scalars = {{"distance", Vector::LinSpaced(6, 0, 1.0 / 7)}, {"two words", Vector::Constant(6, -1e-300)}};
  return mesh;
}

class MeshRoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(MeshRoundTrip, KeepsEveryBit) {
  const TriangleMesh mesh = octahedron();
  const TempFolder folder;
  const auto path = folder.path() / (std::string("mesh") + GetParam());
  write_mesh(path, mesh);
  EXPECT_EQ(folder.num_entries(), 1U);
  const PointCloud cloud = read_point_cloud(path);
  EXPECT_EQ(cloud.faces, mesh.faces);
  ASSERT_TRUE(cloud.has_normals());
  if (std::string(GetParam()) == ".ply") {  // 32 bits, for other programs
    EXPECT_EQ(cloud.points.cast<float>(), mesh.vertices.cast<float>());
    EXPECT_EQ(cloud.normals.cast<float>(), mesh.normals.cast<float>());
    return;
  }
  EXPECT_EQ(cloud.points, mesh.vertices);
  // OBJ's corners name their normals, which the reader makes unit vectors once more.
  EXPECT_LT((cloud.normals - mesh.normals).cwiseAbs().maxCoeff(), std::string(GetParam()) == ".obj" ? 1e-15 : 1e-300);
}

INSTANTIATE_TEST_SUITE_P(Formats, MeshRoundTrip, testing::Values(".ply", ".obj", ".off"));

TEST(WriteMesh, PlyNamesTheScalarThatViewersColourBy) {
  const TempFolder folder;
  write_mesh(folder.path() / "mesh.ply", octahedron());
  const std::string bytes = test::file_bytes(folder.path() / "mesh.ply");
  EXPECT_NE(bytes.find("property float z\nproperty float nx"), std::string::npos);
  EXPECT_NE(bytes.find("property float distance\nproperty float two_words\nproperty float quality\n"),
            std::string::npos);
}

TEST(WriteMesh, PlyKeepsDoublesWhereFloatsAreCoarse) {
  TriangleMesh mesh = octahedron();
  mesh.vertices = mesh.vertices.cwiseMin(1.0).cwiseMax(-1.0).array() + 5e6;  // a building in metres from far away
  const TempFolder folder;
  write_mesh(folder.path() / "mesh.ply", mesh);
  EXPECT_EQ(read_point_cloud(folder.path() / "mesh.ply").points, mesh.vertices);
}

TEST(WriteMesh, StlKeepsFloatsAndTopology) {
  TriangleMesh mesh = octahedron();
  const TempFolder folder;
  write_mesh(folder.path() / "mesh.stl", mesh);
  const PointCloud cloud = read_point_cloud(folder.path() / "mesh.stl");
  ASSERT_EQ(cloud.size(), 6);
  ASSERT_EQ(cloud.faces.cols(), 8);
  for (Index f = 0; f < 8; ++f) {
    for (Index i = 0; i < 3; ++i) {
      const Eigen::Vector3f expected = mesh.vertices.col(mesh.faces(i, f)).cast<float>();
      const Eigen::Vector3f read = cloud.points.col(cloud.faces(i, f)).cast<float>();
      EXPECT_EQ(read, expected);
    }
  }
}

class CloudRoundTrip : public testing::TestWithParam<const char*> {};

TEST_P(CloudRoundTrip, KeepsEveryBit) {
  PointCloud cloud;
  cloud.points = random_points(3, 500);
  cloud.normals = random_points(3, 1000).rightCols(500);
  const TempFolder folder;
  const auto path = folder.path() / (std::string("cloud") + GetParam());
  write_point_cloud(path, cloud);
  const PointCloud read = read_point_cloud(path);
  EXPECT_EQ(read.points, cloud.points) << "seed " << kSeed;
  const bool keeps_normals = std::string(GetParam()) != ".npy";
  EXPECT_EQ(read.normals, keeps_normals ? cloud.normals : Points(3, 0)) << "seed " << kSeed;
  EXPECT_EQ(read.faces.cols(), 0);
}

INSTANTIATE_TEST_SUITE_P(Formats, CloudRoundTrip, testing::Values(".ply", ".obj", ".off", ".xyz", ".csv", ".npy"));

TEST(WritePointCloud, OtherDimensionsGoToTables) {
  const TempFolder folder;
  for (const Index dim : {2, 4, 17}) {
    const PointCloud cloud{.points = random_points(dim, 20), .normals = random_points(dim, 20), .faces = {}};
    for (const char* name : {"a.csv", "a.npy"}) {
      write_point_cloud(folder.path() / name, cloud);
      EXPECT_EQ(read_points(folder.path() / name, dim), cloud.points) << name << ", seed " << kSeed;
    }
    write_point_cloud(folder.path() / "a.csv", cloud);
    EXPECT_EQ(read_point_cloud(folder.path() / "a.csv").normals, cloud.normals) << "seed " << kSeed;
  }
  const PointCloud cloud{.points = random_points(4, 20), .normals = {}, .faces = {}};
  EXPECT_THROW(write_point_cloud(folder.path() / "a.ply", cloud), IoError);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "a.ply"));
}

Polylines two_lines() {
  return {.lines = {random_points(3, 4), 2 * random_points(3, 3)}, .scalars = {{"s", Vector::LinSpaced(7, 0, 1)}}};
}

TEST(WritePolylines, PlyHasEdges) {
  const TempFolder folder;
  const Polylines lines = two_lines();
  write_polylines(folder.path() / "a.ply", lines);
  const std::string bytes = test::file_bytes(folder.path() / "a.ply");
  EXPECT_NE(bytes.find("element vertex 7\n"), std::string::npos);
  EXPECT_NE(bytes.find("property double s\nelement edge 5\n"), std::string::npos);
  EXPECT_TRUE(bytes.ends_with(test::raw<std::int32_t>(5) + test::raw<std::int32_t>(6)));
  EXPECT_EQ(read_point_cloud(folder.path() / "a.ply").points.rightCols(3).cast<float>(), lines.lines[1].cast<float>());
}

TEST(WritePolylines, ObjHasLines) {
  const TempFolder folder;
  Polylines lines = two_lines();
  lines.lines.push_back(Points::Zero(3, 1));
  lines.scalars.clear();
  write_polylines(folder.path() / "a.obj", lines);
  EXPECT_TRUE(test::file_bytes(folder.path() / "a.obj").ends_with("l 1 2 3 4\nl 5 6 7\np 8\n"));
  EXPECT_EQ(read_point_cloud(folder.path() / "a.obj").points.leftCols(4), lines.lines[0]);
}

TEST(WritePolylines, CsvNumbersTheLines) {
  const TempFolder folder;
  Polylines lines{.lines = {Points::Constant(2, 2, 0.1), Points::Constant(2, 1, 1e-9)}, .scalars = {}};
  write_polylines(folder.path() / "a.csv", lines);
  EXPECT_EQ(test::file_bytes(folder.path() / "a.csv"), "line,x,y\n0,0.1,0.1\n0,0.1,0.1\n1,1e-09,1e-09\n");
  lines.lines.pop_back();
  write_polylines(folder.path() / "a.csv", lines);
  EXPECT_EQ(test::file_bytes(folder.path() / "a.csv"), "x,y\n0.1,0.1\n0.1,0.1\n");
}

TEST(WriteJson, IsReadByAnotherParser) {
  const TempFolder folder;
  TriangleMesh mesh = octahedron();
  mesh.scalars[0].name = "a \"quoted\\\" name\n";
  mesh.scalars[0].values(2) = std::numeric_limits<double>::quiet_NaN();
  write_mesh(folder.path() / "a.json", mesh);
  const auto json = nlohmann::json::parse(test::file_bytes(folder.path() / "a.json"));
  EXPECT_EQ(json["points"].size(), 6U);
  EXPECT_EQ(json["points"][1][0].get<double>(), -1.0 / 3);
  EXPECT_EQ(json["points"][4][2].get<double>(), 1e22);
  EXPECT_EQ(json["faces"][7], (std::vector<int>{0, 3, 5}));
  EXPECT_EQ(json["normals"].size(), 6U);
  EXPECT_TRUE(json["scalars"][mesh.scalars[0].name][2].is_null());
  EXPECT_EQ(json["scalars"]["two words"][5].get<double>(), -1e-300);

  write_polylines(folder.path() / "b.json", two_lines());
  const auto lines = nlohmann::json::parse(test::file_bytes(folder.path() / "b.json"));
  EXPECT_EQ(lines["lines"], (std::vector<std::vector<int>>{{0, 1, 2, 3}, {4, 5, 6}}));
}

// --- .vtp, unpacked by hand ------------------------------------------------------------------------------------------

std::string from_base64(std::string_view text) {
  const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0;
  int bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    group = group << 6 | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 255);
  }
  return bytes;
}

template <class T>
std::vector<T> vtp_array(const std::string& file, const std::string& name) {
  const auto at = file.find("Name=\"" + name + "\"");
  if (at == std::string::npos) return {};
  const auto begin = file.find('\n', at) + 1;
  const std::string bytes = from_base64(std::string_view(file).substr(begin, file.find('\n', begin) - begin));
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(size, bytes.size() - 8);
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), bytes.data() + 8, size);
  return values;
}

TEST(WriteVtp, ArraysHoldTheMesh) {
  const TempFolder folder;
  TriangleMesh mesh = octahedron();
  mesh.scalars[0].values(0) = std::numeric_limits<double>::quiet_NaN();
  write_mesh(folder.path() / "a.vtp", mesh);
  const std::string file = test::file_bytes(folder.path() / "a.vtp");
  EXPECT_NE(
      file.find(
          "NumberOfPoints=\"6\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"8\""),
      std::string::npos);
  const std::vector<double> points = vtp_array<double>(file, "Points");
  EXPECT_EQ(points, std::vector<double>(mesh.vertices.data(), mesh.vertices.data() + 18));
  EXPECT_EQ(vtp_array<double>(file, "Normals").size(), 18U);
  const std::vector<double> distance = vtp_array<double>(file, "distance");
  ASSERT_EQ(distance.size(), 6U);
  EXPECT_TRUE(std::isnan(distance[0]));
  EXPECT_EQ(distance[5], 1.0 / 7);
  const auto connectivity = vtp_array<std::int64_t>(file, "connectivity");
  EXPECT_EQ(connectivity, std::vector<std::int64_t>(mesh.faces.data(), mesh.faces.data() + 24));
  EXPECT_EQ(vtp_array<std::int64_t>(file, "offsets").back(), 24);
}

TEST(WriteVtp, LinesAndClouds) {
  const TempFolder folder;
  write_polylines(folder.path() / "a.vtp", two_lines());
  const std::string lines = test::file_bytes(folder.path() / "a.vtp");
  EXPECT_EQ(vtp_array<std::int64_t>(lines, "offsets"), (std::vector<std::int64_t>{4, 7}));
  EXPECT_EQ(vtp_array<std::int64_t>(lines, "connectivity").size(), 7U);
  write_point_cloud(folder.path() / "b.vtp", {.points = random_points(2, 5), .normals = {}, .faces = {}});
  const std::string cloud = test::file_bytes(folder.path() / "b.vtp");
  EXPECT_NE(cloud.find("NumberOfVerts=\"5\""), std::string::npos);
  EXPECT_EQ(vtp_array<double>(cloud, "Points").size(), 15U);  // planar points are given z = 0
}

// --- .glb and .dxf ---------------------------------------------------------------------------------------------------

/// As `two_lines`, within what 32-bit floats hold.
Polylines finite_lines() {
  Points first(3, 4);
  first << 0, 1, 2, 3, 0.5, -1.25, 7, 1.0 / 3, 1e-9, 4, -6, 2;
  return {.lines = {first, first.leftCols(3).array() + 0.7}, .scalars = {}};
}

TEST(WriteGlb, CurvesAreLineStripsAboutTheMiddleOfTheirBox) {
  const TempFolder folder;
  Polylines lines = finite_lines();
  for (Points& line : lines.lines) line.row(0).array() += 5e6;  // more than 32-bit floats hold
  write_polylines(folder.path() / "a.glb", lines);
  const std::string file = test::file_bytes(folder.path() / "a.glb");
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, file.data() + at, 4);
    return value;
  };
  ASSERT_EQ(file.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2U);
  EXPECT_EQ(word(8), file.size());
  const std::uint32_t json_size = word(12);
  EXPECT_EQ(json_size % 4, 0U);
  const auto json = nlohmann::json::parse(file.substr(20, json_size));
  const auto& primitives = json["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2U);
  EXPECT_EQ(primitives[0]["mode"], 3);
  const auto& accessor = json["accessors"][primitives[1]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(accessor["count"], 3);
  EXPECT_EQ(json["buffers"][0]["byteLength"], word(20 + json_size));
  const std::size_t first = 28 + json_size + accessor["byteOffset"].get<std::size_t>();
  for (std::size_t i = 0; i < 3; ++i) {
    float x = 0;
    std::memcpy(&x, file.data() + first + 4 * i, 4);
    const double middle = json["nodes"][0]["translation"][i];
    EXPECT_NEAR(static_cast<double>(x) + middle, lines.lines[1](static_cast<Index>(i), 0), 1e-6);
    EXPECT_GE(x, accessor["min"][i].get<float>());
    EXPECT_LE(x, accessor["max"][i].get<float>());
  }
}

TEST(WriteGlb, MeshesHaveIndices) {
  const TempFolder folder;
  write_mesh(folder.path() / "a.glb", octahedron());
  const std::string file = test::file_bytes(folder.path() / "a.glb");
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, file.data() + 12, 4);
  const auto json = nlohmann::json::parse(file.substr(20, json_size));
  const auto& primitive = json["meshes"][0]["primitives"][0];
  EXPECT_EQ(primitive["mode"], 4);
  EXPECT_EQ(json["accessors"][primitive["indices"].get<std::size_t>()]["count"], 24);
  EXPECT_EQ(file.size(), 28 + json_size + 2 * 6 * 12 + 8 * 12);
}

TEST(WriteDxf, CurvesArePolylinesInSpace) {
  const TempFolder folder;
  const Polylines lines = finite_lines();
  write_polylines(folder.path() / "a.dxf", lines);
  std::istringstream in(test::file_bytes(folder.path() / "a.dxf"));
  int polylines = 0;
  int vertices = 0;
  std::vector<double> x;
  std::string entity;
  for (std::string code, value; std::getline(in, code) && std::getline(in, value);) {
    if (code == "0") entity = value;
    polylines += code == "0" && value == "POLYLINE" ? 1 : 0;
    vertices += code == "0" && value == "VERTEX" ? 1 : 0;
    if (code == "10" && entity == "VERTEX") x.push_back(std::stod(value));
  }
  EXPECT_EQ(entity, "EOF");
  EXPECT_EQ(polylines, 2);
  EXPECT_EQ(vertices, 7);
  ASSERT_EQ(x.size(), 7U);
  EXPECT_EQ(x[4], lines.lines[1](0, 0));
}

TEST(WriteGeometry, InfinitePointsAreRefusedWhereTheFormatHasNone) {
  const TempFolder folder;
  Polylines lines = finite_lines();
  lines.lines[1](2, 2) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_polylines(folder.path() / "a.glb", lines), InvalidArgument);
  EXPECT_THROW(write_polylines(folder.path() / "a.dxf", lines), InvalidArgument);
}

// --- Tables ----------------------------------------------------------------------------------------------------------

TEST(WriteTable, CsvHasAHeaderOfTheNames) {
  const TempFolder folder;
  write_table(folder.path() / "a.csv",
              {{"length", Eigen::Vector2d(0.1, std::nan(""))}, {"a, \"b\"", Eigen::Vector2d(1, 2)}});
  EXPECT_EQ(test::file_bytes(folder.path() / "a.csv"), "length,\"a, \"\"b\"\"\"\n0.1,1\nnan,2\n");
}

TEST(WriteMatrix, RoundTripsThroughNpyAndCsv) {
  const TempFolder folder;
  const Points matrix = random_points(5, 9);
  for (const char* name : {"a.npy", "a.csv"}) {
    write_matrix(folder.path() / name, matrix);
    EXPECT_EQ(read_points(folder.path() / name, 5), matrix) << name << ", seed " << kSeed;
  }
  EXPECT_EQ(test::file_bytes(folder.path() / "a.npy").size() % 64, 5 * 9 * 8 % 64U);  // the header is padded
}

// --- What is refused -------------------------------------------------------------------------------------------------

TEST(WriteGeometry, WrongShapesAndExtensionsAreRefusedBeforeAnythingIsWritten) {
  const TempFolder folder;
  TriangleMesh mesh = octahedron();
  mesh.scalars[0].values.resize(5);
  EXPECT_THROW(write_mesh(folder.path() / "a.ply", mesh), InvalidArgument);
  mesh = octahedron();
  mesh.faces(0, 0) = 6;
  EXPECT_THROW(write_mesh(folder.path() / "a.ply", mesh), InvalidArgument);
  mesh = octahedron();
  mesh.normals.conservativeResize(3, 5);
  EXPECT_THROW(write_mesh(folder.path() / "a.ply", mesh), InvalidArgument);
  EXPECT_THROW(write_mesh(folder.path() / "a.xyz", octahedron()), IoError);
  EXPECT_THROW(write_mesh(folder.path() / "a", octahedron()), IoError);
  EXPECT_THROW(write_polylines(folder.path() / "a.stl", two_lines()), IoError);
  EXPECT_THROW(write_polylines(folder.path() / "a.npy", two_lines()), IoError);
  EXPECT_EQ(folder.num_entries(), 0U);
}

}  // namespace
}  // namespace taut
