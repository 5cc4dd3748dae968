#include "taut/surface/point_cloud.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "support/clouds.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

/// Share of the columns whose angle to the truth is below `degrees`, side included.
double share_within(const Points& normals, const Points& truth, double degrees) {
  const double least = std::cos(degrees * std::numbers::pi / 180);
  return static_cast<double>((normals.cwiseProduct(truth).colwise().sum().array() >= least).count()) /
         static_cast<double>(truth.cols());
}

PointCloud without_normals(PointCloud cloud) {
  cloud.normals.resize(cloud.dim(), 0);
  return cloud;
}

TEST(Normals, EstimatedOutwardOnSpheresOfEveryDimension) {
  for (Index d = 2; d <= 6; ++d) {
    const PointCloud sphere = test::sphere_cloud(d, d < 5 ? 600 : 3000);
    // Where the samples stand far apart the direction is rough, but the side is not in doubt.
    EXPECT_GE(share_within(estimate_normals(without_normals(sphere)), sphere.normals, 45), d < 5 ? 1.0 : 0.99)
        << "d = " << d;
  }
}

TEST(Normals, EstimatedOutwardOnTorusAndKnot) {
  const PointCloud torus = test::torus_cloud(2000);
  EXPECT_EQ(share_within(estimate_normals(without_normals(torus)), torus.normals, 15), 1.0);
  const PointCloud knot = test::knot_cloud(240, 16);
  EXPECT_EQ(share_within(estimate_normals(without_normals(knot)), knot.normals, 25), 1.0);
}

TEST(Normals, EachPieceIsTurnedOutwards) {
  PointCloud pair = test::sphere_cloud(3, 500);
  Points two(3, 1000);
  two << pair.points, 0.5 * pair.points;
  two.rightCols(500).row(0).array() += 3;
  Points truth(3, 1000);
  truth << pair.normals, pair.normals;
  EXPECT_EQ(share_within(estimate_normals({two, Points(3, 0), Eigen::Matrix3Xi(3, 0)}), truth, 20), 1.0);
}

TEST(Normals, ThinShapeKeepsItsTwoSidesApart) {
  // A lens with samples 0.06 apart, bent at its rim to a radius of 0.04: there the other side is near.
  const PointCloud lens = test::ellipsoid_cloud(Eigen::Vector3d(1, 1, 0.2), 2000);
  EXPECT_GT(share_within(estimate_normals(without_normals(lens)), lens.normals, 90), 0.99);
}

TEST(Normals, GivenOnesAreNormalisedAndRepaired) {
  PointCloud sphere = test::sphere_cloud(3, 400);
  const Points truth = sphere.normals;
  sphere.normals *= 7;
  sphere.normals.col(3).setZero();
  sphere.normals.col(4).setConstant(std::numeric_limits<double>::quiet_NaN());
  sphere.normals.col(5) *= 1e300;
  std::string note;
  Context context;
  context.note = [&](std::string_view message) { note += message; };
  const Points normals = estimate_normals(sphere, 10, context);
  EXPECT_LT((normals.colwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
  EXPECT_EQ(share_within(normals, truth, 10), 1.0);
  EXPECT_NE(note.find("2 points without a usable normal"), std::string::npos) << note;
}

TEST(Normals, GivenSideIsTrusted) {
  PointCloud sphere = test::sphere_cloud(3, 100);
  sphere.normals *= -1;
  EXPECT_LT((estimate_normals(sphere) - sphere.normals).norm(), 1e-13);
}

/// The torus with the normals `flips(i)` turned to the wrong side.
template <class Flips>
Points repaired(Flips flips, std::string& note) {
  PointCloud torus = test::torus_cloud(2000);
  for (Index i = 0; i < torus.size(); ++i) {
    if (flips(i, torus.points.col(i))) torus.normals.col(i) *= -1;
  }
  Context context;
  context.note = [&](std::string_view message) { note += message; };
  return estimate_normals(torus, 10, context);
}

TEST(Normals, GivenOnesThatPointToTheWrongSideAreTurned) {
  const Points truth = test::torus_cloud(2000).normals;
  std::string few;
  EXPECT_EQ(share_within(repaired([](Index i, const Vector&) { return i % 50 == 7; }, few), truth, 1), 1.0);
  EXPECT_NE(few.find("40 normals point to the other side"), std::string::npos) << few;
  std::string patch;
  EXPECT_EQ(share_within(repaired([](Index, const Vector& x) { return x(0) > 1; }, patch), truth, 1), 1.0);
  EXPECT_NE(patch.find("to the other side"), std::string::npos) << patch;
  std::string random;
  test::Uniform uniform(4);
  EXPECT_EQ(share_within(repaired([&](Index, const Vector&) { return uniform() < 0.5; }, random), truth, 1), 1.0);
  EXPECT_NE(random.find("at random"), std::string::npos) << random;
  std::string none;
  (void)repaired([](Index, const Vector&) { return false; }, none);
  EXPECT_EQ(none, "");
}

TEST(Normals, GivenOnesThatDoNotStandOnTheSheetAreEstimated) {
  PointCloud sphere = test::sphere_cloud(3, 600);
  const Points truth = sphere.normals;
  sphere.normals.colwise() = Eigen::Vector3d(0, 0, 1);
  std::string note;
  Context context;
  context.note = [&](std::string_view message) { note += message; };
  EXPECT_EQ(share_within(estimate_normals(sphere, 10, context), truth, 20), 1.0);
  EXPECT_NE(note.find("estimated instead"), std::string::npos) << note;
}

TEST(Normals, NoisySheetsTakeMoreNeighbours) {
  PointCloud torus = test::torus_cloud(8000);
  const Points truth = torus.normals;
  test::Uniform uniform(6);
  // Spacing 0.044: ten neighbours lie within 0.08, and spread by 0.02 across.
  for (Index i = 0; i < torus.size(); ++i) torus.points.col(i) += 0.02 * uniform.normal() * truth.col(i);
  torus.normals.resize(3, 0);
  EXPECT_GT(share_within(estimate_normals(torus), truth, 30), 0.99);
}

TEST(Normals, FromFacesWhicheverWayTheMeshIsWound) {
  // An octahedron: by symmetry the vertex normals are the axes.
  PointCloud octahedron{Points(3, 6), Points(3, 0), Eigen::Matrix3Xi(3, 8)};
  octahedron.points << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1;
  octahedron.faces << 0, 2, 1, 3, 2, 1, 3, 0, 2, 1, 3, 0, 0, 2, 1, 3, 4, 4, 4, 4, 5, 5, 5, 5;
  EXPECT_LT((estimate_normals(octahedron) - octahedron.points).norm(), 1e-14);
  octahedron.faces.row(0).swap(octahedron.faces.row(1));
  EXPECT_LT((estimate_normals(octahedron) - octahedron.points).norm(), 1e-14);
}

TEST(Normals, AnglesNotTrianglesWeighTheFaces) {
  // A cube's corner: three right angles, one of them cut into two triangles.
  PointCloud corner{Points(3, 5), Points(3, 0), Eigen::Matrix3Xi(3, 4)};
  corner.points << 0, 1, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0;
  corner.faces << 0, 0, 0, 0, 1, 4, 2, 3, 4, 2, 3, 1;
  const Vector normal = estimate_normals(corner).col(0);
  EXPECT_LT((normal - Vector::Constant(3, 1 / std::sqrt(3.0))).norm(), 1e-14) << normal.transpose();
}

TEST(Normals, DegenerateCloudsAreRefusedWithTheReason) {
  const auto message = [](const PointCloud& cloud) -> std::string {
    try {
      (void)estimate_normals(cloud);
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "accepted";
  };
  PointCloud cloud = without_normals(test::sphere_cloud(3, 50));
  cloud.points(1, 17) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message(cloud).find("point 17"), std::string::npos) << message(cloud);
  cloud.points = Vector::LinSpaced(10, 0, 1).transpose().replicate(3, 1);
  EXPECT_NE(message(cloud).find("on a line"), std::string::npos) << message(cloud);
  cloud.points = Points::Ones(3, 10);
  EXPECT_NE(message(cloud).find("span only 0"), std::string::npos) << message(cloud);
  cloud.points.resize(3, 0);
  EXPECT_NE(message(cloud).find("0 different points"), std::string::npos) << message(cloud);
  cloud = without_normals(test::sphere_cloud(3, 50));
  cloud.faces.resize(3, 1);
  cloud.faces << 0, 1, 50;
  EXPECT_NE(message(cloud).find("names point 50"), std::string::npos) << message(cloud);
  cloud.normals = cloud.points;  // given normals need no faces, but others do
  EXPECT_NE(message(cloud).find("names point 50"), std::string::npos) << message(cloud);
  cloud.faces.resize(3, 0);
  cloud.normals = Points::Ones(2, 50);
  EXPECT_NE(message(cloud).find("2 x 50"), std::string::npos) << message(cloud);
}

TEST(Normals, CoplanarPointsAreAFlatSheet) {
  Points flat = Points::Random(3, 60);
  flat.row(2).setConstant(0.25);
  const Points normals = estimate_normals({flat, Points(3, 0), Eigen::Matrix3Xi(3, 0)});
  EXPECT_LT((normals.row(2).array().abs() - 1).abs().maxCoeff(), 1e-12);
  EXPECT_NEAR(normals.row(2).minCoeff(), normals.row(2).maxCoeff(), 1e-12);  // one side
}

}  // namespace
}  // namespace taut
