// Two sheets side by side, nearer to each other than the samples on them: faces of plates, without normals.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/clouds.hpp"
#include "surface/normals/sheet_split.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut {
namespace {

struct Plate {
  double gap = 0.5;  // between the faces; samples on each stand 1 apart
  double noise = 0;  // standard deviation, in gaps
  double bend = 0;   // 1 / radius
  bool random = false;
  bool one_face = false;
};

/// Samples of a plate's faces, 21 x 21 each, with the true outward normals.
PointCloud plate_cloud(const Plate& plate, std::uint64_t seed = 1) {
  constexpr Index kSide = 21;
  const Index faces = plate.one_face ? 1 : 2;
  PointCloud cloud = test::empty_cloud(3, faces * kSide * kSide);
  test::Uniform uniform(seed);
  Index at = 0;
  for (Index face = 0; face < faces; ++face) {
    const double side = face == 0 ? 1 : -1;
    for (Index i = 0; i < kSide * kSide; ++i, ++at) {
      const double x = plate.random ? 20 * uniform() - 10 : static_cast<double>(i % kSide) - 10;
      const double y = plate.random ? 20 * uniform() - 10 : static_cast<double>(i / kSide) - 10;
      const double z = plate.gap * ((plate.one_face ? 0 : 0.5 * side) + plate.noise * uniform.normal());
      if (plate.bend == 0) {
        cloud.points.col(at) << x, y, z;
        cloud.normals.col(at) << 0, 0, side;
      } else {
        const double angle = x * plate.bend;
        const double radius = 1 / plate.bend + z;
        cloud.points.col(at) << radius * std::sin(angle), y, radius * std::cos(angle);
        cloud.normals.col(at) << side * std::sin(angle), 0, side * std::cos(angle);
      }
    }
  }
  return cloud;
}

double share_outward(const Plate& plate) {
  PointCloud cloud = plate_cloud(plate);
  const Points truth = cloud.normals;
  cloud.normals.resize(3, 0);
  const Points normals = estimate_normals(cloud);
  return static_cast<double>((normals.cwiseProduct(truth).colwise().sum().array() > 0).count()) /
         static_cast<double>(truth.cols());
}

TEST(Sheets, FacesOfAPlateFaceAwayFromEachOther) {
  for (const bool random : {false, true}) {
    for (const double gap : {0.1, 0.3, 0.6, 1.0}) {
      const double bend = gap < 0.5 ? 0.1 : 0.15;
      for (const Plate& plate : {Plate{.gap = gap, .noise = 0.05, .random = random},
                                 Plate{.gap = gap, .noise = 0.05, .bend = bend, .random = random}}) {
        EXPECT_GT(share_outward(plate), 0.97) << "gap " << gap << " bend " << plate.bend << " random " << random;
      }
    }
  }
}

TEST(Sheets, OneSheetIsNotParted) {
  const auto parted = [](const Plate& plate) {
    const PointCloud cloud = plate_cloud(plate);
    const detail::KdTree tree(cloud.points);
    return detail::SheetSplit(cloud.points, tree, {}).any();
  };
  for (const bool random : {false, true}) {
    for (const double bend : {0.0, 0.1, 0.2}) {
      for (const double noise : {0.0, 0.1}) {
        EXPECT_FALSE(parted({.gap = 1, .noise = noise, .bend = bend, .random = random, .one_face = true}))
            << "noise " << noise << " bend " << bend << " random " << random;
      }
    }
  }
  EXPECT_TRUE(parted({.gap = 0.5}));
}

/// Both kinds of fit keep the faces of a plate apart: F is negative in the middle, positive outside.
TEST(Sheets, FitsKeepFacesApart) {
  constexpr double kGap = 0.4;
  for (const FitMethod method : {FitMethod::dense, FitMethod::local}) {
    PointCloud cloud = plate_cloud({.gap = kGap, .random = true});
    cloud.normals.resize(3, 0);
    const Surface surface = make_surface(fit_surface(cloud, {.method = method}));
    EXPECT_EQ(fit_doubt(surface), "");
    Points probes(3, 3);
    probes << 0.3, 0.3, 0.3, 0.2, 0.2, 0.2, 0, kGap, -kGap;
    const Points value = surface.value(probes);
    EXPECT_LT(value(0), 0);
    EXPECT_GT(value(1), 0);
    EXPECT_GT(value(2), 0);
  }
}

/// Normals that point to one side on both faces make two sheets of one: that is told.
TEST(Sheets, FacesThatBecomeOneSheetAreTold) {
  PointCloud cloud = plate_cloud({.gap = 0.3, .random = true});
  for (Index i = 0; i < cloud.size(); ++i) cloud.normals.col(i) = Eigen::Vector3d(0, 0, 1);
  std::string notes;
  Context context;
  context.note = [&](std::string_view note) { notes += note; };
  const LocalFitModel model = fit_local(cloud, {}, context);
  if (model.report.merged_sheets.count == 0) {  // the normals were turned
    EXPECT_NE(notes.find("normals"), std::string::npos) << notes;
    return;
  }
  EXPECT_GT(model.report.merged_sheets.count, cloud.size() / 2);
  EXPECT_NE(notes.find("two sheets"), std::string::npos) << notes;
  EXPECT_NE(fit_doubt(make_surface(FitModel(model))), "");
}

/// Noise of 0.15 to 0.3 gaps: whatever becomes of the faces, a fit that does not keep them apart says so.
TEST(Sheets, NoiseThatBlursTheFacesIsTold) {
  for (const bool random : {false, true}) {
    for (const Plate& plate : {Plate{.gap = 0.3, .noise = 0.15, .random = random},
                               Plate{.gap = 0.6, .noise = 0.2, .bend = 0.1, .random = random},
                               Plate{.gap = 0.6, .noise = 0.3, .random = random},
                               Plate{.gap = 1, .noise = 0.3, .bend = 0.05, .random = random}}) {
      PointCloud cloud = plate_cloud(plate);
      cloud.normals.resize(3, 0);
      EXPECT_NE(fit_doubt(make_surface(fit_surface(cloud, {.method = FitMethod::local}))), "")
          << "gap " << plate.gap << " noise " << plate.noise << " random " << random;
    }
  }
}

/// One sheet, however noisy, raises no doubt.
TEST(Sheets, NoiseOfOneSheetIsNotTakenForTwo) {
  for (const bool random : {false, true}) {
    for (const double noise : {0.1, 0.3}) {
      PointCloud cloud = plate_cloud({.gap = 1, .noise = noise, .bend = 0.1, .random = random, .one_face = true});
      cloud.normals.resize(3, 0);
      EXPECT_EQ(fit_doubt(make_surface(fit_surface(cloud, {.method = FitMethod::local}))), "")
          << "noise " << noise << " random " << random;
    }
  }
}

}  // namespace
}  // namespace taut
