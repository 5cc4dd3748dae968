// What the report is made of, against closed forms: bodies, farthest points, scaling, windings, moments.

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "bent_sheet.hpp"
#include "chart.hpp"
#include "classical_mds.hpp"
#include "drawing.hpp"
#include "geodesic_delaunay.hpp"
#include "inertia.hpp"
#include "isomap.hpp"
#include "models.hpp"
#include "random_points.hpp"
#include "rolled_sheet.hpp"
#include "table.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/query/point_sets.hpp"
#include "taut/surface/formula.hpp"
#include "winding_pattern.hpp"

namespace taut::paper {
namespace {

const Surface& unit_sphere() {
  static const Surface sphere = parse_surface("x^2+y^2+z^2=1");
  return sphere;
}

struct Genus {
  ModelKind kind;
  Index euler_number;  // 2 - 2 genus, or 1 for a disc
};

class OwnModel : public testing::TestWithParam<Genus> {};

TEST_P(OwnModel, HasTheTopologyOfThePapersBody) {
  const PointCloud cloud = sample_own_model(GetParam().kind);
  TriangleMesh mesh;
  mesh.vertices = cloud.points;
  mesh.faces = cloud.faces;
  EXPECT_EQ(euler_number(mesh), GetParam().euler_number);
  EXPECT_GT(cloud.size(), 1500) << "a few thousand samples, as a scan has";
  EXPECT_NEAR(cloud.normals.colwise().norm().minCoeff(), 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, OwnModel,
                         testing::Values(Genus{ModelKind::hand, 2}, Genus{ModelKind::pot, -2},
                                         Genus{ModelKind::sculpture, -2}, Genus{ModelKind::face, 1}));

TEST(ClassicalMds, FindsPointsAgainFromTheirDistances) {
  RandomNumbers random(3);
  Points points(3, 20);
  for (double& x : points.reshaped()) x = random.normal();
  Eigen::MatrixXd distances(20, 20);
  for (Index i = 0; i < 20; ++i) distances.col(i) = (points.colwise() - points.col(i)).colwise().norm();
  const Embedding embedding = classical_mds(distances, 3);
  EXPECT_LT(embedding.stress, 1e-12);
  EXPECT_LT(align(embedding.points, points).rms, 1e-12);
  EXPECT_NEAR(embedding.eigenvalues(3), 0, 1e-10) << "no fourth direction";
  // In a plane something is lost.
  EXPECT_GT(classical_mds(distances, 2).stress, 0.01);
}

TEST(FarthestPoints, OfASphereStartWithTheAntipode) {
  SurfaceCells cells(unit_sphere(), subdivide(unit_sphere(), {.size = 0.05}));
  const FarthestPoints chosen = farthest_points(unit_sphere(), cells, Eigen::Vector3d(0, 0, 1), 5);
  // The antipode, then anywhere on the equator, then two more there: wherever they are, a quarter turn from all others
  // at least, to a cell. (A sixth need not find so much room.)
  EXPECT_NEAR(chosen.points(2, 1), -1, 0.02);
  EXPECT_NEAR(chosen.cover[0], std::numbers::pi, 0.06);
  EXPECT_NEAR(chosen.cover[1], std::numbers::pi / 2, 0.06);
  for (Index i = 0; i < 5; ++i) {
    for (Index j = 0; j < i; ++j) {
      EXPECT_GT(std::acos(chosen.points.col(i).dot(chosen.points.col(j))), std::numbers::pi / 2 - 0.15)
          << i << " " << j;
    }
  }
}

TEST(GeodesicDelaunay, OfManyPointsIsTheSphereAgain) {
  SurfaceCells cells(unit_sphere(), subdivide(unit_sphere(), {.size = 0.04}));
  const SurfaceMesh fine = mesh_surface(unit_sphere(), cells.grid());
  const FarthestPoints chosen = farthest_points(unit_sphere(), cells, Eigen::Vector3d(0, 0, 1), 100);
  const TriangleMesh mesh = geodesic_delaunay(chosen, fine);
  EXPECT_EQ(euler_number(mesh), 2);
  EXPECT_EQ(mesh.faces.cols(), 2 * 100 - 4) << "a closed triangulation of genus 0";
  Index outwards = 0;
  for (const auto& face : mesh.faces.colwise()) {
    const Eigen::Vector3d a = mesh.vertices.col(face(0));
    const Eigen::Vector3d b = mesh.vertices.col(face(1));
    const Eigen::Vector3d c = mesh.vertices.col(face(2));
    outwards += (b - a).cross(c - a).dot(a + b + c) > 0 ? 1 : 0;
  }
  // Where four samples lie on a circle, either diagonal will do, and one triangle may fold over.
  EXPECT_GE(outwards, mesh.faces.cols() - 2);
  EXPECT_GT(smallest_angles(mesh).mean(), 40) << "farthest points make well-shaped triangles";
}

TEST(WindingPattern, ClosesAndKeepsClairautsConstant) {
  const Surface vessel = parse_surface("x^2+y^2+(z/1.5)^2=1");
  const WindingPattern pattern = close_winding(vessel, 1, 0.5, 9, {});
  EXPECT_LT(pattern.closing_miss, 1e-9);
  EXPECT_LT(pattern.closing_turn, 1e-9);
  EXPECT_LT(pattern.clairaut_spread, 1e-10);
  // r never falls below Clairaut's constant, which is the sine of the winding angle, and comes down to it.
  const double least = pattern.fibre.topRows(2).colwise().norm().minCoeff();
  EXPECT_GT(least, std::sin(pattern.angle) - 1e-9);
  EXPECT_LT(least, std::sin(pattern.angle) + 0.05);
}

TEST(GeodesicInertia, OfTheSphereIsThatOfTheSquaredDistance) {
  RandomNumbers random(1);
  constexpr Index kCount = 400;
  Points to(3, 2 * kCount);  // in antipodal-free pairs mirrored through the axis, so that the mean is steadier
  for (Index i = 0; i < kCount; ++i) {
    const double z = -1 + 2 * (static_cast<double>(i) + 0.5) / kCount;
    const double a = 2 * std::numbers::pi * random.uniform();
    const double r = std::sqrt(1 - z * z);
    to.col(2 * i) << r * std::cos(a), r * std::sin(a), z;
    to.col(2 * i + 1) << -r * std::sin(a), r * std::cos(a), z;
  }
  PathSolver solver(unit_sphere(), {.tolerance = 1e-6});
  const GeodesicInertia inertia = geodesic_inertia(solver.solve_from(Eigen::Vector3d(0, 0, 1), to));
  // Mean of theta^2 over the sphere: (pi^2 - 4) / 2, by the midpoint rule in z; equal in both directions.
  EXPECT_NEAR(inertia.mean_square, (std::numbers::pi * std::numbers::pi - 4) / 2, 2e-3);
  EXPECT_NEAR(inertia.eigenvalues(0), inertia.eigenvalues(1), 1e-3);
  EXPECT_NEAR(inertia.eigenvalues(2), 0, 1e-12) << "nothing along the normal";
}

TEST(BentSheet, KeepsLengths) {
  const BentSheet sheet{.wave = 1, .roll = 2};
  double length = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    length += (sheet.point(sheet.length * (i + 1) / kSteps, 1) - sheet.point(sheet.length * i / kSteps, 1)).norm();
  }
  EXPECT_NEAR(length, sheet.length, 5e-6);  // chords of 2,000 steps
}

TEST(IsomapDistances, AreNeverShorterThanTheChord) {
  const RolledSheet sheet{.height = 21};
  const PointCloud cloud = sheet.cloud(600);
  Eigen::VectorX<Index> sources(1);
  sources << 0;
  const Eigen::MatrixXd distance = isomap_distances(cloud.points, 8, sources);
  for (Index i = 0; i < cloud.size(); ++i) {
    EXPECT_GE(distance(i, 0), (cloud.points.col(i) - cloud.points.col(0)).norm() - 1e-12);
    EXPECT_TRUE(std::isfinite(distance(i, 0)));
  }
  EXPECT_EQ(distance(0, 0), 0);
}

TEST(PowerLaw, IsFoundAgain) {
  const PowerLaw law = fit_power_law({1, 2, 4, 10}, {3, 3 * std::pow(2, 1.5), 3 * 8, 3 * std::pow(10, 1.5)});
  EXPECT_NEAR(law.exponent, 1.5, 1e-12);
  EXPECT_NEAR(law.factor, 3, 1e-12);
}

TEST(PaperTable, QuotesWhatCsvMustQuote) {
  Table table{.name = "t", .title = "", .columns = {{"a, b"}, {"c"}}};
  table.add({std::string("say \"x\", y"), Value()});
  table.add({1.5, Index(3)});
  EXPECT_EQ(to_csv(table), "\"a, b\",c\n\"say \"\"x\"\", y\",\n1.5,3\n");
  EXPECT_TRUE(to_json(table)["rows"][0]["c"].is_null());
}

TEST(PaperTable, WritesPowersOfTenAsPeopleDo) {
  EXPECT_EQ(readable_number(1.2e-5, "{:.1e}"), "1.2 · 10<sup>−5</sup>");
  EXPECT_EQ(readable_number(-0.5, "{:.2f}"), "−0.50");
  EXPECT_EQ(readable_number(std::nan(""), "{:.2f}"), "–");
}

TEST(TextRuns, TellRaisedFromLowered) {
  const std::vector<TextRun> runs = text_runs("p^{i-1} k_{g}N");
  ASSERT_EQ(runs.size(), 5U);
  EXPECT_EQ(runs[1].text, "i-1");
  EXPECT_EQ(runs[1].shift, 1);
  EXPECT_EQ(runs[3].shift, -1);
  EXPECT_EQ(runs[4].text, "N");
}

}  // namespace
}  // namespace taut::paper
