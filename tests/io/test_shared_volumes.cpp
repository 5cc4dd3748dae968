// Real volumes, with the sizes that their makers name. Their folder is named by the environment variable
// TAUT_SHARED_DATA; without it these tests are skipped, as those of scans are (test_shared_data.cpp).

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "taut/core/error.hpp"
#include "taut/io/read_surface.hpp"

namespace taut {
namespace {

struct ExpectedVolume {
  std::string file;
  std::array<Index, 3> size;
  Eigen::Vector3d spacing;
  double least = 0;
  double largest = 0;
};

void PrintTo(const ExpectedVolume& expected, std::ostream* out) { *out << expected.file; }

class SharedVolumes : public testing::TestWithParam<ExpectedVolume> {};

TEST_P(SharedVolumes, SizeSpacingAndRangeAreTheKnownOnes) {
  const char* folder = std::getenv("TAUT_SHARED_DATA");
  if (folder == nullptr) GTEST_SKIP() << "TAUT_SHARED_DATA is not set";
  const ExpectedVolume& expected = GetParam();
  VoxelVolume volume;
  try {
    volume = read_volume(std::filesystem::path(folder) / "volumes" / expected.file);
  } catch (const IoError& error) {
    if (std::string(error.what()).find("built without OpenVDB") != std::string::npos) GTEST_SKIP() << error.what();
    throw;
  }
  EXPECT_EQ(volume.size, expected.size);
  EXPECT_TRUE(volume.axes.colwise().norm().transpose().isApprox(expected.spacing, 1e-4));
  const auto [least, largest] = std::ranges::minmax(volume.values);
  EXPECT_NEAR(least, expected.least, 1e-6);
  EXPECT_NEAR(largest, expected.largest, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Volumes, SharedVolumes,
    testing::Values(ExpectedVolume{"FLAIR.nrrd", {124, 160, 140}, {1, 1, 1}, 0, 255},
                    ExpectedVolume{"HeadMRVolume.mhd", {48, 62, 42}, {4, 4, 4}, 0, 255},
                    ExpectedVolume{"avg152T1.nii.gz", {91, 109, 91}, {2, 2, 2}, 0, 255},
                    ExpectedVolume{"frogtissue.mhd", {500, 470, 136}, {1, 1, 1.5}, 0, 29},
                    ExpectedVolume{"headsq_ct.mhd", {64, 64, 93}, {3.2, 3.2, 1.5}, 0, 3926},
                    ExpectedVolume{"lung_ct_small.mha", {57, 78, 64}, {2.732, 2.732, 5}, -1130, 1379},
                    ExpectedVolume{"lung_mask.mha", {115, 157, 129}, {1.366, 1.366, 2.5}, 0, 1},
                    ExpectedVolume{"ironProt.vtk", {68, 68, 68}, {1, 1, 1}, 0, 255},
                    ExpectedVolume{"sphere_fog.vdb", {31, 31, 31}, {0.1, 0.1, 0.1}, 0, 1},
                    ExpectedVolume{"pynrrd/BallBinary30x30x30.nhdr", {30, 30, 30}, {1, 1, 1}, 0, 257},
                    ExpectedVolume{"pynrrd/BallBinary30x30x30_gz.nrrd", {30, 30, 30}, {1, 1, 1}, 0, 257},
                    ExpectedVolume{"pynrrd/BallBinary30x30x30.nii.gz", {30, 30, 30}, {1, 1, 1}, 0, 257}),
    [](const testing::TestParamInfo<ExpectedVolume>& volume) {
      std::string name;
      for (const char c : volume.param.file) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
      return name;
    });

}  // namespace
}  // namespace taut
