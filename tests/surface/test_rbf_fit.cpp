// How well a fit meets the surface its samples come from, what it refuses, and what it tells.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "support/clouds.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

struct Misfit {
  double distance = 0;  ///< largest |F| / |grad F| at true points
  double normal = 0;    ///< largest |grad F / |grad F| - n| there
  double slope_low = 0;
  double slope_high = 0;
};

Misfit misfit(const Surface& surface, const PointCloud& truth) {
  const Points value = surface.value(truth.points);
  const Points gradient = surface.jacobian(truth.points);
  const Eigen::ArrayXd slope = gradient.colwise().norm();
  return {(value.row(0).transpose().array().abs() / slope).maxCoeff(),
          (gradient.colwise().normalized() - truth.normals).colwise().norm().maxCoeff(), slope.minCoeff(),
          slope.maxCoeff()};
}

Misfit fit_and_measure(const PointCloud& cloud, const PointCloud& truth, const RbfOptions& options = {}) {
  return misfit(make_surface(std::make_shared<RbfModel>(fit_rbf(cloud, options))), truth);
}

TEST(RbfFit, MeetsAnEllipsoid) {
  const Eigen::Vector3d axes(1, 0.8, 0.5);
  const Misfit found = fit_and_measure(test::ellipsoid_cloud(axes, 500), test::ellipsoid_cloud(axes, 3001));
  EXPECT_LT(found.distance, 6e-5);
  EXPECT_LT(found.normal, 1.5e-3);
  EXPECT_GT(found.slope_low, 0.9);
  EXPECT_LT(found.slope_high, 1.05);
}

TEST(RbfFit, MeetsATorusSampledAtRandom) {
  const Misfit found = fit_and_measure(test::torus_cloud(1000), test::torus_cloud(3000, 1, 0.4, 55));
  EXPECT_LT(found.distance, 2e-3);
  EXPECT_LT(found.normal, 5e-2);
}

TEST(RbfFit, ErrorFallsWithTheFourthPowerOfTheSpacing) {
  // Four times the samples halve the spacing.
  const Eigen::Vector3d axes(1, 0.9, 0.7);
  const PointCloud truth = test::ellipsoid_cloud(axes, 2003);
  const double coarse = fit_and_measure(test::ellipsoid_cloud(axes, 250), truth).distance;
  const double fine = fit_and_measure(test::ellipsoid_cloud(axes, 1000), truth).distance;
  EXPECT_GT(std::log2(coarse / fine), 3.3);
}

TEST(RbfFit, AFlatSheetIsReproducedExactly) {
  const Vector normal = Eigen::Vector3d(1, 2, -2) / 3;
  test::Uniform uniform(4);
  PointCloud sheet = test::empty_cloud(3, 120);
  for (Index i = 0; i < sheet.size(); ++i) {
    const Eigen::Vector3d x(4 * uniform(), 4 * uniform(), 4 * uniform());
    sheet.points.col(i) = x - (normal.dot(x) - 0.7) * normal;
    sheet.normals.col(i) = normal;
  }
  for (const RbfKernel kernel : {RbfKernel::cubic, RbfKernel::quintic}) {
    const Surface surface = make_surface(std::make_shared<RbfModel>(fit_rbf(sheet, {.kernel = kernel})));
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector3d x(8 * uniform() - 2, 8 * uniform() - 2, 8 * uniform() - 2);
      EXPECT_NEAR(surface.value(x)(0), normal.dot(x) - 0.7, 1e-9);
      EXPECT_LT((surface.jacobian(x) - normal).norm(), 1e-9);
      EXPECT_LT(surface.hessian(x, Vector::Ones(1)).norm(), 1e-8);
    }
  }
}

TEST(RbfFit, WorksInTwoToTenDimensions) {
  for (const RbfKernel kernel : {RbfKernel::cubic, RbfKernel::quintic}) {
    for (const Index d : {2, 3, 4, 6, 8, 10}) {
      const PointCloud sphere = test::sphere_cloud(d, 60 * d);
      const Misfit found = fit_and_measure(sphere, test::sphere_cloud(d, 500, 31), {.kernel = kernel});
      // Samples at random thin out quickly: in R^10 a thousand of them stand 0.6 apart.
      EXPECT_LT(found.distance, d <= 3 ? 0.01 : 0.1) << "d = " << d;
      EXPECT_GT(found.slope_low, 0.3) << "d = " << d;
      EXPECT_LT(found.slope_high, 3) << "d = " << d;
    }
  }
}

TEST(RbfFit, OutsideIsPositiveWithEstimatedNormalsToo) {
  PointCloud torus = test::torus_cloud(800);
  torus.normals.resize(3, 0);
  const Surface surface = make_surface(std::make_shared<RbfModel>(fit_rbf(torus)));
  EXPECT_LT(surface.value(Eigen::Vector3d(1, 0, 0))(0), 0);
  EXPECT_GT(surface.value(Eigen::Vector3d(0, 0, 0))(0), 0);
  EXPECT_GT(surface.value(Eigen::Vector3d(1.6, 0, 0))(0), 0);
}

TEST(RbfFit, QuinticIsMoreAccurateOnASmoothShape) {
  const PointCloud cloud = test::sphere_cloud(3, 300);
  const PointCloud truth = test::sphere_cloud(3, 1001);
  const double cubic = fit_and_measure(cloud, truth).distance;
  const double quintic = fit_and_measure(cloud, truth, {.kernel = RbfKernel::quintic}).distance;
  EXPECT_LT(quintic, 0.4 * cubic);
}

TEST(RbfFit, BothSidesKeepTheSlopeNearerToOne) {
  const PointCloud cloud = test::sphere_cloud(3, 300);
  const Misfit one = fit_and_measure(cloud, test::sphere_cloud(3, 1001));
  const Misfit both = fit_and_measure(cloud, test::sphere_cloud(3, 1001), {.both_sides = true});
  EXPECT_LT(both.slope_high - both.slope_low, one.slope_high - one.slope_low + 1e-3);
  EXPECT_LT(std::abs(both.slope_low - 1), std::abs(one.slope_low - 1));
}

TEST(RbfFit, ALargeCloudIsThinnedAndTheUserTold) {
  const PointCloud cloud = test::ellipsoid_cloud(Eigen::Vector3d(1, 0.8, 0.6), 5000);
  std::string notes;
  Context context;
  context.note = [&](std::string_view note) { notes += note; };
  const RbfModel model = fit_rbf(cloud, {.max_samples = 500}, context);
  EXPECT_LE(model.report.num_fitted, 500);
  EXPECT_GE(model.report.num_fitted, 450);
  EXPECT_NE(notes.find("5000 points: a well-spread subset of " + std::to_string(model.report.num_fitted)),
            std::string::npos)
      << notes;
  EXPECT_EQ(model.samples.size(), 5000);
  EXPECT_GT(model.report.left_out_max, model.report.left_out_rms);
  EXPECT_LT(model.report.left_out_max, 2e-4);
}

TEST(RbfFit, SmoothingLengthIsTheWavelengthThatIsHalved) {
  // A flat sheet with a ripple of wavelength 1 and small amplitude: the fit's amplitude at the middle of the sheet.
  constexpr double kAmplitude = 1e-3;
  const Index side = 31;
  PointCloud ripple = test::empty_cloud(3, side * side);
  for (Index k = 0; k < side * side; ++k) {
    const double x = 0.2 * static_cast<double>(k % side - side / 2);
    const double y = 0.2 * static_cast<double>(k / side - side / 2);
    ripple.points.col(k) << x, y, kAmplitude * std::cos(2 * std::numbers::pi * x);
    ripple.normals.col(k) =
        Eigen::Vector3d(kAmplitude * 2 * std::numbers::pi * std::sin(2 * std::numbers::pi * x), 0, 1).normalized();
  }
  const auto kept = [&](double length) {
    const Surface surface = make_surface(std::make_shared<RbfModel>(fit_rbf(ripple, {.smoothing = length})));
    const auto height = [&](double x) { return -surface.value(Eigen::Vector3d(x, 0, 0))(0); };
    return (height(0) - 0.5 * (height(0.5) + height(-0.5))) / (2 * kAmplitude);
  };
  EXPECT_NEAR(kept(0), 1, 0.01);
  EXPECT_NEAR(kept(0.5), 32.0 / 33, 0.05);  // 1 / (1 + (length / wavelength)^5)
  EXPECT_NEAR(kept(1), 0.5, 0.1);
  EXPECT_NEAR(kept(2), 1.0 / 33, 0.05);
}

TEST(RbfFit, NoisySamplesAreSmoothedByDefaultAndCleanOnesNot) {
  const PointCloud clean = test::ellipsoid_cloud(Eigen::Vector3d(1, 0.9, 0.8), 800);
  PointCloud noisy = clean;
  test::Uniform uniform(12);
  const double noise = 0.1 * std::sqrt(10.2 / 800);  // a tenth of the spacing
  for (Index i = 0; i < noisy.size(); ++i) noisy.points.col(i) += noise * uniform.normal() * clean.normals.col(i);
  const RbfModel clean_model = fit_rbf(clean);
  const RbfModel noisy_model = fit_rbf(noisy);
  EXPECT_EQ(clean_model.report.smoothing, 0);
  EXPECT_GT(noisy_model.report.smoothing, 3 * noisy_model.report.spacing);
  EXPECT_NEAR(noisy_model.report.noise, noise, 0.4 * noise);
  const PointCloud dense = test::ellipsoid_cloud(Eigen::Vector3d(1, 0.9, 0.8), 2001);
  const Misfit by_default = misfit(make_surface(std::make_shared<RbfModel>(noisy_model)), dense);
  const Misfit through = fit_and_measure(noisy, dense, {.smoothing = 0});
  EXPECT_LT(by_default.normal, 0.4 * through.normal);
  EXPECT_LT(by_default.distance, 0.6 * through.distance);
}

TEST(RbfFit, DuplicatesAreMergedAndKeepTheirPlaces) {
  PointCloud cloud = test::sphere_cloud(3, 200);
  cloud.points.col(11) = cloud.points.col(3);
  cloud.normals.col(11) = cloud.normals.col(3);
  std::string notes;
  Context context;
  context.note = [&](std::string_view note) { notes += note; };
  const RbfModel model = fit_rbf(cloud, {}, context);
  EXPECT_NE(notes.find("1 point coincides"), std::string::npos) << notes;
  EXPECT_EQ(model.report.num_samples, 199);
  EXPECT_EQ(model.samples.points, cloud.points);
}

TEST(RbfFit, AlmostCoincidentPointsDoNotSpoilIt) {
  PointCloud cloud = test::sphere_cloud(3, 200);
  for (Index i = 0; i < 20; ++i) {
    cloud.points.col(i) = cloud.points.col(i + 20) + 1e-9 * Vector::Unit(3, i % 3);
    cloud.normals.col(i) = cloud.normals.col(i + 20);
  }
  const Misfit found = fit_and_measure(cloud, test::sphere_cloud(3, 1001));
  EXPECT_LT(found.distance, 1e-2);
  EXPECT_GT(found.slope_low, 0.5);
}

template <class Exception>
std::string refusal(const PointCloud& cloud, const RbfOptions& options = {}, const Context& context = {}) {
  try {
    (void)fit_rbf(cloud, options, context);
  } catch (const Exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RbfFit, DegenerateCloudsAreRefusedWithTheReason) {
  PointCloud cloud = test::sphere_cloud(3, 50);
  cloud.points(2, 31) = std::numeric_limits<double>::infinity();
  EXPECT_NE(refusal<InvalidArgument>(cloud).find("point 31"), std::string::npos);
  for (const Index n : {0, 1, 2}) {
    const std::string why = refusal<InvalidArgument>(test::sphere_cloud(3, n));
    EXPECT_NE(why.find("span only"), std::string::npos) << why;
  }
  cloud = test::sphere_cloud(3, 50);
  cloud.points.bottomRows(2).setZero();
  EXPECT_NE(refusal<InvalidArgument>(cloud).find("on a line"), std::string::npos);
  EXPECT_NE(refusal<InvalidArgument>(test::empty_cloud(1, 5)).find("2 coordinates"), std::string::npos);
}

TEST(RbfFit, OptionsOutOfRangeAreRefused) {
  const PointCloud cloud = test::sphere_cloud(3, 50);
  EXPECT_NE(refusal<InvalidArgument>(cloud, {.smoothing = -1.0}), "accepted");
  EXPECT_NE(refusal<InvalidArgument>(cloud, {.offset = std::nan("")}), "accepted");
  EXPECT_NE(refusal<InvalidArgument>(cloud, {.max_samples = -5}), "accepted");
  EXPECT_NE(refusal<InvalidArgument>(cloud, {.normal_neighbours = 1}), "accepted");
}

TEST(RbfFit, StopsBeforeMemoryAndWhenCancelled) {
  Context small;
  small.memory_limit = 1 << 20;
  const std::string why = refusal<OutOfMemory>(test::sphere_cloud(3, 500), {}, small);
  EXPECT_NE(why.find("1000 constraints"), std::string::npos) << why;
  const std::atomic<bool> raised = true;
  Context cancelled;
  cancelled.cancel = &raised;
  EXPECT_EQ(refusal<Cancelled>(test::sphere_cloud(3, 500), {}, cancelled), "cancelled");
}

}  // namespace
}  // namespace taut
