// Real scans and meshes, with the counts that other software found in them. Their folder is named by the environment
// variable TAUT_SHARED_DATA; without it these tests are skipped, since the files are too large and too mixed in their
// licences to be part of the project.

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "taut/io/read_point_cloud.hpp"

namespace taut {
namespace {

struct Expected {
  std::string file;
  Index points;
  Index faces;
  bool normals;
  Eigen::Vector3d extent;
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.file; }

class SharedData : public testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("TAUT_SHARED_DATA");
    if (folder == nullptr) GTEST_SKIP() << "TAUT_SHARED_DATA is not set";
    path_ = std::filesystem::path(folder) / GetParam().file;
  }
  std::filesystem::path path_;
};

/// V - E + F of a triangulation, over the vertices its faces use.
Index euler_characteristic(const PointCloud& mesh) {
  std::map<std::pair<int, int>, int> edges;
  std::map<int, int> used;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const int a = mesh.faces(i, f);
      const int b = mesh.faces((i + 1) % 3, f);
      ++edges[std::minmax(a, b)];
      ++used[a];
    }
  }
  return static_cast<Index>(used.size()) - static_cast<Index>(edges.size()) + mesh.faces.cols();
}

TEST_P(SharedData, CountsAndExtentAreTheKnownOnes) {
  const Expected& expected = GetParam();
  const PointCloud cloud = read_point_cloud(path_);
  EXPECT_EQ(cloud.dim(), 3);
  EXPECT_EQ(cloud.size(), expected.points);
  EXPECT_EQ(cloud.faces.cols(), expected.faces);
  EXPECT_EQ(cloud.has_normals(), expected.normals);
  const Eigen::Vector3d extent = cloud.points.rowwise().maxCoeff() - cloud.points.rowwise().minCoeff();
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(extent(i), expected.extent(i), 6e-4 * expected.extent(i));  // known to four digits
  }
  if (expected.normals) {
    const Vector lengths = cloud.normals.colwise().norm();
    EXPECT_GT(lengths.minCoeff(), 0.9);  // unit vectors in all of these files, give or take their decimals
    EXPECT_LT(lengths.maxCoeff(), 1.1);
  }
}

std::string test_name(const testing::TestParamInfo<Expected>& parameter) {
  std::string name = std::filesystem::path(parameter.param.file).filename().string();
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Files, SharedData,
    testing::Values(Expected{"scans/sven_fused.ply", 45428, 0, true, {0.2284, 0.3476, 0.4232}},
                    Expected{"scans/sven_frame000_points.ply", 34400, 0, false, {0.2538, 0.3713, 0.2701}},
                    Expected{"scans/bunny_bun000.ply", 40256, 0, false, {0.1557, 0.1522, 0.1174}},
                    Expected{"scans/hippo1.ply", 6104, 0, true, {0.9969, 0.5265, 0.3147}},
                    Expected{"scans/oni.pwn", 1435, 0, true, {0.5888, 1.0, 0.7537}},
                    Expected{"scans/kitten.xyz", 5210, 0, true, {0.651, 0.9986, 0.5906}},
                    Expected{"scans/chef.pcd", 5092, 0, true, {0.2732, 0.123, 0.1072}},
                    Expected{"scans/armadillo.pts", 6488, 0, false, {127.8, 152.2, 114.4}},
                    Expected{"meshes/face_libigl.ply", 25905, 51712, false, {24.25, 34.19, 26.35}},
                    Expected{"meshes/head_maxplanck_decimated.obj", 5272, 10540, false, {192.7, 340.1, 244.2}},
                    Expected{"meshes/hand_gel.obj", 10345, 20686, false, {175.9, 217.2, 87.48}},
                    Expected{"meshes/feline_genus2.obj", 20659, 41322, false, {136.1, 57.01, 131.9}},
                    Expected{"meshes/eight_genus2.off", 3498, 7000, false, {1.216, 0.5226, 2.541}},
                    Expected{"meshes/fertility_genus4.off", 4494, 9000, false, {199.2, 144.3, 73.27}},
                    Expected{"meshes/rocker-arm_genus1.obj", 10044, 20088, false, {0.3035, 0.5149, 1.0}},
                    Expected{"meshes/bunny_stanford.obj", 35947, 69451, false, {0.1557, 0.1543, 0.1207}},
                    Expected{"meshes/spot.obj", 2930, 5856, false, {0.9431, 1.69, 1.718}},
                    Expected{"meshes/elephant_genus3.off", 2775, 5558, false, {0.7204, 1.0, 0.603}},
                    Expected{"meshes/knot_genus1.off", 3200, 6400, false, {0.9602, 1.0, 0.4646}}),
    test_name);

TEST(ExampleData, BunnyIsAClosedMeshOfGenusZero) {
  const PointCloud mesh = read_point_cloud(TAUT_TEST_DATA "/../../examples/data/bunny.ply");
  EXPECT_EQ(mesh.size(), 1839);
  EXPECT_EQ(mesh.faces.cols(), 3674);
  EXPECT_EQ(euler_characteristic(mesh), 2);
}

TEST(SharedDataTopology, FertilityHasGenusFour) {
  const char* folder = std::getenv("TAUT_SHARED_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_SHARED_DATA is not set";
  const PointCloud mesh = read_point_cloud(std::filesystem::path(folder) / "meshes/fertility_genus4.off");
  EXPECT_EQ(euler_characteristic(mesh), 2 - 2 * 4);
}

TEST(SharedDataTopology, DepthFrameIsRefusedAsSuch) {
  const char* folder = std::getenv("TAUT_SHARED_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_SHARED_DATA is not set";
  try {
    static_cast<void>(read_point_cloud(std::filesystem::path(folder) / "scans/sven_frame000_depth.ply"));
    FAIL() << "accepted";
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("no element 'vertex' (its elements: metadata, color, depth)"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace taut
