#include "taut/surface/volume.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "support/volumes.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using ::testing::HasSubstr;

/// The world box around the voxels from `first` to `last` (fractions of the volume along each axis).
Box part_of(const VoxelVolume& volume, double first, double last) {
  Box box{Vector::Constant(3, std::numeric_limits<double>::infinity()),
          Vector::Constant(3, -std::numeric_limits<double>::infinity())};
  for (int corner = 0; corner < 8; ++corner) {
    Eigen::Vector3d voxel;
    for (int a = 0; a < 3; ++a) {
      voxel(a) =
          ((corner >> a & 1) != 0 ? last : first) * static_cast<double>(volume.size[static_cast<std::size_t>(a)] - 1);
    }
    const Vector x = volume.origin + volume.axes * voxel;
    box = {box.lower.cwiseMin(x), box.upper.cwiseMax(x)};
  }
  return box;
}

Eigen::Vector3d voxel_centre(const VoxelVolume& volume, Index i, Index j, Index k) {
  return volume.origin +
         volume.axes * Eigen::Vector3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
}

template <class Build>
std::string error_of(const Build& build) {
  try {
    static_cast<void>(build());
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

double distance_from_sphere(const Eigen::Vector3d& x) { return x.norm() - 1; }

TEST(Volume, KeepsWhatEvaluatorsPromise) {
  const VoxelVolume volume = test::noise_volume(13, 10, 15);
  const Surface surface = volume_surface(volume, {.iso = 0.1});
  // Differences across the middle third; what lies outside the volume is for the test of bounds.
  const ConformanceReport report = check_conformance(surface.function(), part_of(volume, 0.4, 0.6));
  EXPECT_TRUE(report.ok()) << report.text();
  EXPECT_GT(report.num_checks, 300);
}

TEST(Volume, DerivativesAreThoseOfTheValue) {
  // A smooth volume, so that differences settle wherever they are taken.
  const VoxelVolume volume =
      test::sampled_volume(24, 1, [](const Eigen::Vector3d& x) { return std::sin(2 * x(0)) + x(1) * std::cos(x(2)); });
  const Surface surface = volume_surface(volume, {.iso = 0});
  // The second derivatives have kinks between voxels, which differences smear out by about the third ones' jumps.
  const ConformanceReport report =
      check_conformance(surface.function(), part_of(volume, 0.1, 0.9), {.derivative_tolerance = 1e-3});
  EXPECT_TRUE(report.ok()) << report.text();
  EXPECT_LT(report.num_skipped, report.num_checks / 4);
}

TEST(Volume, PassesThroughTheVoxels) {
  const VoxelVolume volume = test::noise_volume(6, 4, 9);
  const Surface surface = volume_surface(volume, {.iso = 0.1});
  double side = 0;
  std::size_t v = 0;
  for (Index k = 0; k < 9; ++k) {
    for (Index j = 0; j < 4; ++j) {
      for (Index i = 0; i < 6; ++i, ++v) {
        const double value = surface.value(voxel_centre(volume, i, j, k))(0);
        const double expected = static_cast<double>(volume.values[v]) - 0.1;
        if (side == 0) side = std::copysign(1.0, value * expected);
        EXPECT_NEAR(value, side * expected, 1e-5);  // 32-bit coefficients, tens large at the ends
      }
    }
  }
}

TEST(Volume, ReproducesCubicsUpToTheBorder) {
  const auto cubic = [](const Eigen::Vector3d& x) {
    return (1 + x(0) - 2 * std::pow(x(0), 3)) * (2 - std::pow(x(1), 2) + std::pow(x(1), 3)) + std::pow(x(2), 3) - x(2);
  };
  const VoxelVolume volume = test::sampled_volume(6, 1, cubic);
  const Surface surface = volume_surface(volume, {.iso = 1});
  const double side = surface.value(Eigen::Vector3d(0, 0, 0))(0) > 0 ? 1 : -1;
  std::mt19937 random(3);
  for (int n = 0; n < 100; ++n) {
    Eigen::Vector3d x;
    for (double& entry : x) entry = static_cast<double>(random()) * 0x1p-31 - 1;
    EXPECT_NEAR(surface.value(x)(0), side * (cubic(x) - 1), 2e-5);
  }
}

TEST(Volume, ValuesConvergeWithFourthOrder) {
  const auto f = [](const Eigen::Vector3d& x) { return std::exp(x(0)) * std::sin(2 * x(1)) + std::cos(2 * x(2)); };
  const auto error = [&](Index n) {
    const Surface surface = volume_surface(test::sampled_volume(n, 1, f), {.iso = 1});
    const double side = surface.value(Eigen::Vector3d(0, 0, 0.5))(0) > 0 ? -1 : 1;  // f < 1 there
    double largest = 0;
    std::mt19937 random(5);
    for (int p = 0; p < 400; ++p) {
      Eigen::Vector3d x;
      for (double& entry : x) entry = static_cast<double>(random()) * 0x1p-31 - 1;
      largest = std::max(largest, std::abs(surface.value(x)(0) - side * (f(x) - 1)));
    }
    return largest;
  };
  const double order = std::log2(error(11) / error(21));
  EXPECT_GT(order, 3.6);
  EXPECT_LT(order, 4.6);
}

TEST(Volume, BoundsHoldSamplesInBoxesOfEverySize) {
  const VoxelVolume volume = test::noise_volume(30, 24, 40);
  const Surface surface = volume_surface(volume, {.iso = 0});
  const auto evaluator = surface.make_evaluator();
  std::mt19937 random(11);
  const auto uniform = [&] { return static_cast<double>(random()) * 0x1p-32; };
  const Box whole = part_of(volume, -0.2, 1.2);
  for (int n = 0; n < 300; ++n) {
    const double size = std::exp2(-8 * uniform());
    Eigen::Vector3d lower;
    Eigen::Vector3d upper;
    for (Index a = 0; a < 3; ++a) {
      const double edge = size * (0.2 + uniform()) * whole.extent()(a);
      lower(a) = whole.lower(a) + uniform() * whole.extent()(a);
      upper(a) = lower(a) + edge;
    }
    double least = 0;
    double largest = 0;
    ASSERT_TRUE(evaluator->bounds(
        {.n = 1, .lower = lower.data(), .upper = upper.data(), .value_lower = &least, .value_upper = &largest}));
    for (int p = 0; p < 60; ++p) {
      Eigen::Vector3d x;
      for (Index a = 0; a < 3; ++a) x(a) = lower(a) + uniform() * (upper(a) - lower(a));
      if (p < 8)
        x = Eigen::Vector3d((p & 1) != 0 ? upper(0) : lower(0), (p & 2) != 0 ? upper(1) : lower(1),
                            (p & 4) != 0 ? upper(2) : lower(2));
      const double value = surface.value(x)(0);
      EXPECT_LE(least, value) << "size " << size;
      EXPECT_GE(largest, value) << "size " << size;
    }
  }
}

TEST(Volume, BoundsOfSmallBoxesAreTight) {
  const VoxelVolume volume = test::sampled_volume(20, 2, distance_from_sphere);
  const Surface surface = volume_surface(volume, {.iso = 0});
  const auto evaluator = surface.make_evaluator();
  for (const double half : {0.04, 0.02, 0.002}) {
    const Eigen::Vector3d centre(0.31, 0.52, 0.83);
    const Eigen::Vector3d lower = centre.array() - half;
    const Eigen::Vector3d upper = centre.array() + half;
    double least = 0;
    double largest = 0;
    evaluator->bounds(
        {.n = 1, .lower = lower.data(), .upper = upper.data(), .value_lower = &least, .value_upper = &largest});
    // The distance grows along every axis there: its range is that between two corners.
    const double range = surface.value(upper)(0) - surface.value(lower)(0);
    EXPECT_LT(largest - least, (1 + half) * range);
  }
}

TEST(Volume, InsideIsWhatTheFacesAreNot) {
  // A ball of high values, and a ball of low ones.
  for (const double sign : {1.0, -1.0}) {
    const auto f = [&](const Eigen::Vector3d& x) { return sign * (2 - x.norm()); };
    const Surface surface = volume_surface(test::sampled_volume(12, 2, f), {.iso = sign});
    EXPECT_LT(surface.value(Eigen::Vector3d(0.5, 0, 0))(0), 0);
    EXPECT_GT(surface.value(Eigen::Vector3d(1.5, 0, 0))(0), 0);
    EXPECT_EQ(surface.domain(), nullptr);
    EXPECT_EQ(surface.kind(), "volume");
  }
}

TEST(Volume, EndsWhereTheVolumeDoes) {
  std::string note;
  Context context;
  context.note = [&](std::string_view text) { note = text; };
  // A sphere that pokes out through the face x = -1.
  const auto f = [](const Eigen::Vector3d& x) { return (x - Eigen::Vector3d(-0.9, 0, 0)).norm(); };
  const Surface surface = volume_surface(test::sampled_volume(16, 1, f), {.iso = 0.5}, context);
  ASSERT_NE(surface.domain(), nullptr);
  EXPECT_EQ(surface.domain()->codim(), 1);
  EXPECT_THAT(note, HasSubstr("reaches 1 of the volume's 6 faces"));
  EXPECT_TRUE(surface.inside_domain(Eigen::Vector3d(-0.99, 0.5, 0))(0));
  EXPECT_FALSE(surface.inside_domain(Eigen::Vector3d(-1.01, 0.5, 0))(0));
  EXPECT_TRUE(surface.inside_domain(Eigen::Vector3d(1.01, 0.5, 0))(0));  // the surface does not get there
}

TEST(Volume, DomainKeepsWhatEvaluatorsPromise) {
  const VoxelVolume volume = test::noise_volume(6, 7, 8);
  const Surface surface = volume_surface(volume, {.iso = 0});
  ASSERT_NE(surface.domain(), nullptr);
  const ConformanceReport report = check_conformance(*surface.domain(), part_of(volume, -0.2, 1.2));
  EXPECT_TRUE(report.ok()) << report.text();
  EXPECT_EQ(surface.domain()->codim(), 6);
}

TEST(Volume, WorldCoordinatesAreThoseOfTheLattice) {
  // The same ball on a straight lattice and on an oblique one.
  VoxelVolume volume;
  volume.size = {30, 26, 22};
  volume.axes << 0.2, 0.05, 0, -0.04, 0.22, 0.06, 0.03, 0, 0.26;
  volume.origin << -3.5, -3, -3;
  const Eigen::Vector3d centre = volume.origin + volume.axes * Eigen::Vector3d(14, 13, 11);
  for (Index k = 0; k < 22; ++k) {
    for (Index j = 0; j < 26; ++j) {
      for (Index i = 0; i < 30; ++i) {
        volume.values.push_back(static_cast<float>((voxel_centre(volume, i, j, k) - centre).norm()));
      }
    }
  }
  const Surface surface = volume_surface(volume, {.iso = 1.5});
  for (const Eigen::Vector3d& direction :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0.6, 0, 0.8)}) {
    const auto found = project_to_surface(surface, centre + 1.6 * direction);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR((found.point - centre).norm(), 1.5, 2e-4);
  }
}

TEST(Volume, ThreadsChangeNothing) {
  const VoxelVolume volume = test::noise_volume(20, 33, 18);
  Points reference;
  for (const int threads : {1, 2, 5}) {
    Context context;
    context.threads = threads;
    const Surface surface = volume_surface(volume, {.iso = 0, .smooth = 0.7}, context);
    Points x(3, 200);
    std::mt19937 random(2);
    const Box box = part_of(volume, 0, 1);
    for (Index j = 0; j < x.cols(); ++j) {
      for (Index a = 0; a < 3; ++a) {
        x(a, j) = box.lower(a) + static_cast<double>(random()) * 0x1p-32 * box.extent()(a);
      }
    }
    const Points value = surface.value(x);
    if (reference.size() == 0) reference = value;
    EXPECT_EQ(value, reference);
  }
}

TEST(Volume, LabelsBecomeSmoothSurfaces) {
  const auto label = [](const Eigen::Vector3d& x) { return x.norm() < 1 ? 7 : x.norm() < 1.3 ? 3 : 0; };
  const VoxelVolume volume = test::sampled_volume(40, 2, label);  // voxels of 0.1
  const Surface surface = volume_surface(volume, {.label = 7});
  EXPECT_LT(surface.value(Eigen::Vector3d(0, 0, 0))(0), 0);
  double worst_radius = 0;
  double worst_turn = 0;
  std::mt19937 random(4);
  for (int n = 0; n < 200; ++n) {
    Eigen::Vector3d x;
    for (double& entry : x) entry = static_cast<double>(random()) * 0x1p-31 - 1;
    x.normalize();
    const auto found = project_to_surface(surface, x);
    ASSERT_TRUE(found.converged);
    worst_radius = std::max(worst_radius, std::abs(found.point.norm() - 1));
    const Eigen::Vector3d normal = surface.jacobian(found.point).col(0).normalized();
    worst_turn = std::max(worst_turn, std::acos(std::min(1.0, normal.dot(found.point) / found.point.norm())));
  }
  EXPECT_LT(worst_radius, 0.05);  // half a voxel
  EXPECT_LT(worst_turn, 0.3);     // a staircase turns by up to 0.95
}

TEST(Volume, SmoothingKeepsPlanesAndFlattensNoise) {
  VoxelVolume volume = test::sampled_volume(24, 1, [](const Eigen::Vector3d& x) { return x(0) + 0.5 * x(1); });
  const Surface plane = volume_surface(volume, {.iso = 0, .smooth = 1});
  const double side = plane.value(Eigen::Vector3d(0.3, 0.1, 0))(0) > 0 ? 1 : -1;
  EXPECT_NEAR(plane.value(Eigen::Vector3d(0.3, 0.1, 0.2))(0), side * 0.35, 1e-5);
  std::mt19937 random(9);
  for (float& value : volume.values) value = static_cast<float>(random()) * 0x1p-31F - 1;
  const auto spread = [&](double smooth) {
    const Surface surface = volume_surface(volume, {.iso = 0, .smooth = smooth});
    double sum = 0;
    for (int n = 0; n < 500; ++n) {
      Eigen::Vector3d x;
      for (double& entry : x) entry = 1.6 * static_cast<double>(random()) * 0x1p-32 - 0.8;
      sum += std::pow(surface.value(x)(0), 2);
    }
    return std::sqrt(sum / 500);
  };
  // White noise smoothed by a Gaussian of s voxels keeps (2 sqrt(pi) s)^-3/2 of its spread.
  EXPECT_NEAR(spread(2) / spread(1), std::pow(2, -1.5), 0.1);
}

TEST(Volume, RefusesWhatIsNoVolume) {
  const auto plane = [](const Eigen::Vector3d& x) { return x(0); };
  VoxelVolume flat = test::sampled_volume(5, 1, plane);
  flat.size = {25, 5, 1};
  EXPECT_THAT(error_of([&] { return volume_surface(flat, {.iso = 0}); }), HasSubstr("25 x 5 x 1 voxels"));
  VoxelVolume short_of_values = test::sampled_volume(5, 1, plane);
  short_of_values.values.pop_back();
  EXPECT_THAT(error_of([&] { return volume_surface(short_of_values, {.iso = 0}); }), HasSubstr("124 values"));
  VoxelVolume no_spacing = test::sampled_volume(5, 1, plane);
  no_spacing.axes.col(1).setZero();
  EXPECT_THAT(error_of([&] { return volume_surface(no_spacing, {.iso = 0}); }), HasSubstr("longer than zero"));
  VoxelVolume in_a_plane = test::sampled_volume(5, 1, plane);
  in_a_plane.axes.col(1) = in_a_plane.axes.col(0);
  EXPECT_THAT(error_of([&] { return volume_surface(in_a_plane, {.iso = 0}); }), HasSubstr("not in one plane"));
  VoxelVolume with_nan = test::sampled_volume(5, 1, plane);
  with_nan.values[5 * 5 * 2 + 5 * 3 + 4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(error_of([&] { return volume_surface(with_nan, {.iso = 0}); }),
              HasSubstr("1 of 125 voxels are NaN or infinite, the first at (4, 3, 2)"));
}

TEST(Volume, SaysWhichLevelsThereAre) {
  const VoxelVolume volume = test::sampled_volume(20, 1, [](const Eigen::Vector3d& x) { return 3 + x(0); });
  const std::string missing = error_of([&] { return volume_surface(volume, {}); });
  EXPECT_THAT(missing, HasSubstr("values run from 2 to 4, half of them within 2.42 and 3.47"));
  EXPECT_THAT(missing, HasSubstr("(option iso)"));
  EXPECT_THROW((void)volume_surface(volume, {.iso = 4.5}), EmptySurface);
  EXPECT_THAT(error_of([&] { return volume_surface(volume, {.iso = 4.5}); }),
              HasSubstr("no surface at iso 4.5: values run from 2 to 4"));
  const VoxelVolume labels = test::sampled_volume(8, 1, [](const Eigen::Vector3d& x) { return x(0) > 0 ? 5 : 2; });
  EXPECT_THAT(error_of([&] { return volume_surface(labels, {.label = 3}); }), HasSubstr("there are 2, 5"));
  EXPECT_THAT(error_of([&] { return volume_surface(labels, {.label = 5, .smooth = 0.1}); }), HasSubstr("staircase"));
  EXPECT_THAT(error_of([&] { return volume_surface(labels, {.iso = 3, .label = 5}); }), HasSubstr("not both"));
  VoxelVolume speck = test::sampled_volume(8, 1, [](const Eigen::Vector3d&) { return 0; });
  speck.values[100] = 1;
  EXPECT_THAT(error_of([&] { return volume_surface(speck, {.label = 1}); }), HasSubstr("nothing is left of label 1"));
}

}  // namespace
}  // namespace taut
