#include "taut/surface/fit.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "support/clouds.hpp"
#include "surface/simd_dispatch.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

Surface surface_of(const PointCloud& cloud, const LocalFitOptions& options = {}) {
  return make_surface(std::make_shared<const LocalFitModel>(fit_local(cloud, options)));
}

/// How far the fit's surface stands off points of the true one, and its normals off the true ones (radians), both root
/// mean squares.
struct Miss {
  double distance = 0;
  double normal = 0;
};

Miss miss_at(const Surface& surface, const PointCloud& truth) {
  const Points value = surface.value(truth.points);
  const Points gradient = surface.jacobian(truth.points);
  Miss miss;
  for (Index i = 0; i < truth.size(); ++i) {
    const double slope = gradient.col(i).norm();
    miss.distance += std::pow(value(0, i) / slope, 2);
    miss.normal += (gradient.col(i) / slope - truth.normals.col(i)).squaredNorm();
  }
  const auto n = static_cast<double>(truth.size());
  return {std::sqrt(miss.distance / n), std::sqrt(miss.normal / n)};
}

PointCloud circle_cloud(Index n) {
  PointCloud cloud = test::empty_cloud(2, n);
  for (Index i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    cloud.normals.col(i) << std::cos(t), std::sin(t);
  }
  cloud.points = cloud.normals;
  return cloud;
}

PointCloud with_noise(PointCloud cloud, double sigma) {
  test::Uniform uniform(11);
  for (Index i = 0; i < cloud.size(); ++i) cloud.points.col(i) += sigma * uniform.normal() * cloud.normals.col(i);
  cloud.normals.resize(cloud.dim(), 0);
  return cloud;
}

/// z = height cos(2 pi x / wavelength) over a square of edge 2, on a lattice.
PointCloud ripple_cloud(Index per_side, double wavelength, double height) {
  PointCloud cloud = test::empty_cloud(3, per_side * per_side);
  const double k = 2 * std::numbers::pi / wavelength;
  for (Index i = 0; i < per_side; ++i) {
    for (Index j = 0; j < per_side; ++j) {
      const double x = -1 + 2 * static_cast<double>(i) / static_cast<double>(per_side - 1);
      const double y = -1 + 2 * static_cast<double>(j) / static_cast<double>(per_side - 1);
      cloud.points.col(i * per_side + j) << x, y, height * std::cos(k * x);
      cloud.normals.col(i * per_side + j) = Eigen::Vector3d(height * k * std::sin(k * x), 0, 1).normalized();
    }
  }
  return cloud;
}

TEST(LocalFit, ConvergesOnTheTorusWithOrderThreeAndItsNormalsWithTwo) {
  const PointCloud truth = test::torus_cloud(2000, 1, 0.4, 77);
  const Miss coarse = miss_at(surface_of(test::torus_cloud(1500)), truth);
  const Miss middle = miss_at(surface_of(test::torus_cloud(6000)), truth);
  const Miss fine = miss_at(surface_of(test::torus_cloud(24000)), truth);
  // Four times the samples halve the spacing. Random samples have holes, which vary.
  EXPECT_GT(std::log2(coarse.distance / fine.distance) / 2, 2.9);
  EXPECT_GT(std::log2(coarse.normal / fine.normal) / 2, 1.9);
  EXPECT_LT(middle.distance, coarse.distance / 6);
  EXPECT_LT(fine.distance, middle.distance / 6);
  EXPECT_LT(fine.distance, 1e-5);
}

TEST(LocalFit, ConvergesOnTheSphere) {
  const PointCloud truth = test::sphere_cloud(3, 1777);
  const Miss coarse = miss_at(surface_of(test::sphere_cloud(3, 1000)), truth);
  const Miss fine = miss_at(surface_of(test::sphere_cloud(3, 16000)), truth);
  EXPECT_GT(std::log2(coarse.distance / fine.distance) / 2, 2.9);
}

TEST(LocalFit, ConvergesOnTheCircle) {
  const PointCloud truth = circle_cloud(997);
  const Miss coarse = miss_at(surface_of(circle_cloud(100)), truth);
  const Miss fine = miss_at(surface_of(circle_cloud(400)), truth);
  EXPECT_LT(fine.distance, coarse.distance / 100);
  EXPECT_LT(fine.distance, 1e-6);
}

TEST(LocalFit, KeepsThePromisesOfAnEvaluator) {
  for (const PointCloud& cloud : {test::torus_cloud(2000), test::sphere_cloud(3, 700)}) {
    const Surface surface = surface_of(cloud);
    // Near the samples; farther out F jumps from one plane to the next.
    for (const Index at : {0, 100, 300}) {
      const Vector x = cloud.points.col(at);
      const Box box{x.array() - 0.02, x.array() + 0.02};
      const ConformanceReport report = check_conformance(surface.function(), box, {.derivative_tolerance = 1e-5});
      EXPECT_TRUE(report.ok()) << report.text();
      EXPECT_GT(report.num_checks, 1000);
    }
    // Bounds hold everywhere.
    const Box all{Vector::Constant(3, -1.6), Vector::Constant(3, 1.6)};
    for (const ConformanceViolation& found : check_conformance(surface.function(), all).violations) {
      EXPECT_NE(found.rule, "bounds") << found.detail;
      EXPECT_NE(found.rule, "batch") << found.detail;
      EXPECT_NE(found.rule, "nan") << found.detail;
    }
  }
}

TEST(LocalFit, IsTheSameOnAnyInstructionSet) {
  const auto best = detail::instruction_set();
  for (const PointCloud& cloud : {circle_cloud(60), test::sphere_cloud(3, 400)}) {
    const Surface surface = surface_of(cloud);
    const Index d = surface.dim();
    Points x(d, 200);
    test::Uniform uniform(5);
    for (double& c : x.reshaped()) c = 2.4 * uniform() - 1.2;
    x.leftCols(100).colwise().normalize();
    Points value;
    Points jacobian;
    Eigen::MatrixXd hessian;
    for (const auto set : {detail::InstructionSet::baseline, detail::InstructionSet::sse4, detail::InstructionSet::avx2,
                           detail::InstructionSet::avx512}) {
      if (!detail::has_instruction_set(set)) continue;
      detail::use_instruction_set(set);
      if (set == detail::InstructionSet::baseline) {
        value = surface.value(x);
        jacobian = surface.jacobian(x);
        hessian = surface.hessian(x.col(0), Vector::Ones(1));
      }
      EXPECT_EQ(surface.value(x), value);
      EXPECT_EQ(surface.jacobian(x), jacobian);
      EXPECT_EQ(surface.hessian(x.col(0), Vector::Ones(1)), hessian);
    }
    detail::use_instruction_set(best);
  }
}

// Most points are known to be inside by a sample that held another one.
TEST(LocalFit, TheSideOfItsBorderIsThatOfTheValue) {
  const PointCloud sphere = test::sphere_cloud(3, 2000);
  PointCloud half = test::empty_cloud(3, 1000);
  half.points = sphere.points.leftCols(1000);
  half.normals = sphere.normals.leftCols(1000);
  const Surface surface = surface_of(half);
  Points x(3, 3000);
  test::Uniform uniform(7);
  for (double& c : x.reshaped()) c = 2.4 * uniform() - 1.2;
  x.leftCols(2500).colwise().normalize();
  const std::unique_ptr<Evaluator> domain = surface.domain()->make_evaluator();
  Vector value(x.cols());
  domain->evaluate({.n = x.cols(), .x = x.data(), .value = value.data()});
  const auto inside = surface.inside_domain(x);
  EXPECT_GT(inside.count(), 500);
  EXPECT_GT(x.cols() - inside.count(), 500);
  for (Index j = 0; j < x.cols(); ++j) EXPECT_EQ(inside(j), value(j) >= 0) << x.col(j).transpose();
}

TEST(LocalFit, BoundsExcludeBoxesBesideTheSurface) {
  const Surface surface = surface_of(test::sphere_cloud(3, 4000));
  const auto evaluator = surface.make_evaluator();
  const double h = 0.05;
  Index excluded = 0;
  Index boxes = 0;
  for (double r = 0.85; r <= 1.15; r += 0.01) {
    for (double t = 0; t < 6; t += 0.1) {
      const Eigen::Vector3d centre(r * std::cos(t) * 0.8, r * std::sin(t) * 0.8, r * 0.6);
      const Eigen::Vector3d lower = centre.array() - h / 2;
      const Eigen::Vector3d upper = centre.array() + h / 2;
      double from = 0;
      double to = 0;
      ASSERT_TRUE(evaluator->bounds(
          {.n = 1, .lower = lower.data(), .upper = upper.data(), .value_lower = &from, .value_upper = &to}));
      const bool meets = std::abs(r - 1) <= h / 2;  // then the box certainly meets the sphere
      const bool away = std::abs(r - 1) > h;        // then it certainly does not, by a margin
      if (meets) {
        EXPECT_TRUE(from <= 0 && to >= 0) << r;
      }
      if (away) {
        ++boxes;
        if (from > 0 || to < 0) ++excluded;
      }
    }
  }
  EXPECT_GT(excluded, boxes * 9 / 10);
}

TEST(LocalFit, ThreadsDoNotChangeABit) {
  const PointCloud cloud = with_noise(test::torus_cloud(3000), 0.01);
  Context one;
  one.threads = 1;
  Context four;
  four.threads = 4;
  const LocalFitModel a = fit_local(cloud, {}, one);
  const LocalFitModel b = fit_local(cloud, {}, four);
  EXPECT_EQ(a.centres, b.centres);
  EXPECT_EQ(a.radii, b.radii);
  EXPECT_EQ(a.coefficients, b.coefficients);
  EXPECT_EQ(a.support, b.support);
  EXPECT_EQ(a.samples.normals, b.samples.normals);
  EXPECT_EQ(a.report.residual_rms, b.report.residual_rms);
}

TEST(LocalFit, ReportsHowFarItStandsOffItsSamples) {
  const PointCloud cloud = with_noise(test::torus_cloud(4000), 0.01);
  const auto model = std::make_shared<const LocalFitModel>(fit_local(cloud));
  const Surface surface = make_surface(model);
  const Points value = surface.value(cloud.points);
  const Points gradient = surface.jacobian(cloud.points);
  const Vector miss = value.transpose().array().abs() / gradient.colwise().norm().transpose().array();
  EXPECT_NEAR(model->report.residual_rms, miss.norm() / std::sqrt(static_cast<double>(miss.size())), 1e-12);
  EXPECT_NEAR(model->report.residual_max, miss.maxCoeff(), 1e-12);
  EXPECT_NEAR(miss(model->report.residual_at), miss.maxCoeff(), 1e-12);
  EXPECT_EQ(fit_residual(surface), model->report.residual_rms);
}

TEST(LocalFit, AveragesNoiseAway) {
  // Of tube radius 0.4, sampled 0.031 apart: noise of a third of a spacing.
  const double sigma = 0.01;
  const LocalFitModel model = fit_local(with_noise(test::torus_cloud(16000), sigma));
  const Miss miss = miss_at(make_surface(std::make_shared<LocalFitModel>(model)), test::torus_cloud(2000, 1, 0.4, 77));
  EXPECT_NEAR(model.report.residual_rms, sigma, 0.15 * sigma);
  EXPECT_NEAR(model.report.noise, sigma, 0.4 * sigma);
  EXPECT_LT(miss.distance, 0.3 * sigma);
  EXPECT_LT(miss.normal, 0.12);
}

TEST(LocalFit, SmoothingFlattensRipplesOfItsLength) {
  const double height = 0.004;
  for (const double wavelength : {0.2, 0.4}) {
    const PointCloud cloud = ripple_cloud(121, wavelength, height);
    const auto kept = [&](double smoothing) {
      const Surface surface = surface_of(cloud, {.smoothing = smoothing});
      // The crest in the middle, where the sheet's edges are far.
      return project_to_surface(surface, Eigen::Vector3d(0, 0.003, height)).point(2) / height;
    };
    EXPECT_GT(kept(0), 0.99);
    EXPECT_LT(kept(wavelength), 0.7);
    EXPECT_GT(kept(0.4 * wavelength), 0.9);
    EXPECT_LT(kept(2.5 * wavelength), 0.15);
  }
}

/// The surface's cells, grown from the samples, are one piece each a true piece, and lie within reach of the samples.
Index count_components(const Surface& surface, double h) {
  return components(grow(surface, surface.samples()->points, {.size = h, .origin = {}})).count;
}

TEST(LocalFit, HasNoSheetsBesideTheTrueOnes) {
  EXPECT_EQ(count_components(surface_of(test::torus_cloud(4000)), 0.08), 1);
  EXPECT_EQ(count_components(surface_of(test::knot_cloud(200, 20)), 0.15), 1);
  // Two spheres, 0.3 apart.

  PointCloud pair = test::empty_cloud(3, 6000);
  const PointCloud ball = test::sphere_cloud(3, 3000);
  pair.points << ball.points, ball.points.colwise() + Eigen::Vector3d(2.3, 0, 0);
  pair.normals << ball.normals, ball.normals;
  EXPECT_EQ(count_components(surface_of(pair), 0.08), 2);
}

TEST(LocalFit, EndsWhereItsSamplesEndAndHasNoHolesBetweenThem) {
  // A square of edge 2, its right half four times as dense.
  PointCloud cloud = test::empty_cloud(3, 5000);
  test::Uniform uniform(5);
  for (Index i = 0; i < cloud.size(); ++i) {
    const double x = i < 1000 ? -uniform() : uniform();
    cloud.points.col(i) << x, 2 * uniform() - 1, 0;
    cloud.normals.col(i) << 0, 0, 1;
  }
  const Surface surface = surface_of(cloud);
  ASSERT_NE(surface.domain(), nullptr);
  Index inside = 0;
  Index tried = 0;
  for (double x = -0.98; x < 1; x += 0.02) {
    for (double y = -0.98; y < 1; y += 0.02) {
      ++tried;
      if (surface.inside_domain(Eigen::Vector3d(x, y, 0))(0)) ++inside;
    }
  }
  EXPECT_GE(inside, tried - 5);  // samples at random have holes of any size
  // Spacings 0.045 and 0.022.
  EXPECT_FALSE(surface.inside_domain(Eigen::Vector3d(-1.2, 0, 0))(0));
  EXPECT_FALSE(surface.inside_domain(Eigen::Vector3d(1.1, 0, 0))(0));
}

TEST(LocalFit, TellsWhatIsWrongWithARequest) {
  EXPECT_THROW((void)fit_local(test::sphere_cloud(4, 100)), InvalidArgument);
  EXPECT_THROW((void)fit_local(test::sphere_cloud(3, 100), {.smoothing = -1.0}), InvalidArgument);
  EXPECT_THROW((void)fit_local(test::sphere_cloud(3, 100), {.support_radius = -1.0}), InvalidArgument);
  Context tight;
  tight.memory_limit = 10'000;
  EXPECT_THROW((void)fit_local(test::sphere_cloud(3, 100), {}, tight), OutOfMemory);
  const std::atomic<bool> cancel = true;
  Context cancelled;
  cancelled.cancel = &cancel;
  EXPECT_THROW((void)fit_local(test::sphere_cloud(3, 3000), {}, cancelled), Cancelled);
  LocalFitModel torn = fit_local(test::sphere_cloud(3, 100));
  torn.support.resize(3);
  EXPECT_THROW((void)make_surface(std::make_shared<const LocalFitModel>(torn)), InvalidArgument);
}

TEST(LocalFit, TakesFewAndRepeatedSamples) {
  PointCloud cloud = test::sphere_cloud(3, 12);
  EXPECT_GT(fit_local(cloud).radii.size(), 0);
  cloud.points.col(1) = cloud.points.col(0);
  cloud.normals.col(1) = cloud.normals.col(0);
  const LocalFitModel model = fit_local(cloud);
  EXPECT_EQ(model.report.num_samples, 11);
  EXPECT_EQ(model.support.size(), 12);
}

TEST(FitSurface, IsLocalForManySamplesUnlessAskedOtherwise) {
  const auto is_local = [](const FitModel& model) { return std::holds_alternative<LocalFitModel>(model); };
  EXPECT_FALSE(is_local(fit_surface(test::sphere_cloud(3, 200))));
  EXPECT_TRUE(is_local(fit_surface(test::sphere_cloud(3, kDefaultMaxSamples + 1))));
  EXPECT_TRUE(is_local(fit_surface(test::sphere_cloud(3, 200), {.method = FitMethod::local})));
  EXPECT_FALSE(is_local(fit_surface(test::sphere_cloud(3, 3000), {.max_samples = 100})));
  EXPECT_THROW((void)fit_surface(test::sphere_cloud(4, 100), {.method = FitMethod::local}), InvalidArgument);
}

TEST(FitSurface, NamesAPointFarFromAllOthers) {
  PointCloud cloud = test::sphere_cloud(3, 300);
  cloud.points.array() += 5000;
  cloud.points.col(123).setZero();
  try {
    (void)fit_surface(cloud);
    ADD_FAILURE() << "accepted";
  } catch (const InvalidArgument& error) {
    EXPECT_NE(std::string(error.what()).find("point 123 at (0, 0, 0)"), std::string::npos) << error.what();
  }
}

/// Across the sheet the surface ends at half of what it reaches along it: what F does farther off is of no concern.
TEST(LocalFit, TheDomainIsFlat) {
  const LocalFitModel model = fit_local(test::sphere_cloud(3, 2000));
  const Surface surface = make_surface(std::make_shared<const LocalFitModel>(model));
  const auto evaluator = surface.domain()->make_evaluator();
  const auto inside = [&](const Vector& x) {
    double value = 0;
    evaluator->evaluate({.n = 1, .x = x.data(), .value = &value});
    return value;
  };
  for (const Index i : {3, 700, 1999}) {
    const Vector at = model.samples.points.col(i);
    const Vector normal = model.samples.normals.col(i);
    const double reach = model.support(i);
    EXPECT_GT(inside(at), 0);
    EXPECT_LT(inside(at + 0.7 * reach * normal), 0);
    EXPECT_LT(inside(at - 0.7 * reach * normal), 0);
    EXPECT_GT(inside(at + 0.3 * reach * normal), 0);
  }
}

/// A torus (1, 0.3) of `around` x `across` vertices, two triangles for each.
PointCloud torus_mesh(int around, int across) {
  PointCloud cloud = test::empty_cloud(3, around * across);
  cloud.normals.resize(3, 0);
  cloud.faces.resize(3, 2 * around * across);
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double a = 2 * std::numbers::pi * i / around;
      const double b = 2 * std::numbers::pi * j / across;
      const double r = 1 + 0.3 * std::cos(b);
      const int at = i * across + j;
      cloud.points.col(at) << r * std::cos(a), r * std::sin(a), 0.3 * std::sin(b);
      const int next = (i + 1) % around * across + j;
      const int up = i * across + (j + 1) % across;
      const int beyond = (i + 1) % around * across + (j + 1) % across;
      cloud.faces.col(2 * at) << at, next, up;
      cloud.faces.col(2 * at + 1) << next, beyond, up;
    }
  }
  return cloud;
}

/// Eight vertices round a tube leave faces that turn by 45 degrees: between them the surface has places of its own.
TEST(LocalFit, OfAMeshReachesOverItsFacesAndNoFarther) {
  for (const int across : {8, 24}) {
    const PointCloud mesh = torus_mesh(80, across);
    const LocalFitModel model = fit_local(mesh);
    EXPECT_EQ(model.between.radius.size() > 0, across == 8);
    Context serial;
    serial.threads = 1;
    const LocalFitModel again = fit_local(mesh, {}, serial);
    EXPECT_EQ(again.between.points, model.between.points);
    EXPECT_EQ(again.between.radius, model.between.radius);
    const Surface surface = make_surface(std::make_shared<const LocalFitModel>(model));
    Points middles(3, 4 * mesh.faces.cols());
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
      const Eigen::Matrix3d corners = mesh.points(Eigen::all, mesh.faces.col(f));
      middles.col(4 * f) = corners.rowwise().mean();
      for (int i = 0; i < 3; ++i) middles.col(4 * f + 1 + i) = (corners.col(i) + corners.col((i + 1) % 3)) / 2;
    }
    const auto evaluator = surface.make_evaluator();
    ASSERT_TRUE(project_to_surface(*evaluator, 3, 1, middles).all());
    EXPECT_TRUE(surface.inside_domain(middles).all());
    for (Index i = 0; i < mesh.size(); i += 7) {
      // 0.08 off a tube of 0.3: within a third of what the vertices' balls are along the sheet.
      const Vector off = mesh.points.col(i) + 0.08 * model.samples.normals.col(i);
      EXPECT_FALSE(surface.inside_domain(off)(0));
    }
  }
}

/// Of a cloud the ends are as ever.
TEST(LocalFit, OfACloudHasNoPlacesBetween) {
  const LocalFitModel model = fit_local(test::torus_cloud(3000));
  EXPECT_EQ(model.between.radius.size(), 0);
  EXPECT_EQ(model.flatness, 2);
}

}  // namespace
}  // namespace taut
