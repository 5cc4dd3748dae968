#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/geodesic_start.hpp"
#include "support/surfaces.hpp"
#include "taut/curve/newton.hpp"

namespace taut {
namespace {

struct Reference {
  std::string surface;
  std::string kind;
  double length;
  Vector p, q, v;
};

const std::map<std::string, Surface>& surfaces() {
  static const std::map<std::string, Surface> all{
      {"oblate_c0.5", test::ellipsoid(1, 1, 0.5)},
      {"oblate_c0.1", test::ellipsoid(1, 1, 0.1)},
      {"prolate_c2", test::ellipsoid(1, 1, 2)},
      {"triaxial_3_2_1", test::ellipsoid(3, 2, 1)},
      {"torus_1_0.4", test::torus(1, 0.4)},
      {"torus_1_0.8", test::torus(1, 0.8)},
      {"tanglecube", test::tangle_cube()},
      {"hyperellipsoid_R5",
       test::make_surface(test::EllipsoidFunction{(Vector(5) << 1.5, 1.2, 1, 0.9, 0.8).finished()})}};
  return all;
}

std::vector<Reference> references(const std::string& kind) {
  std::ifstream file(TAUT_TEST_DATA "/reference_geodesics.txt");
  std::vector<Reference> result;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    Reference row;
    words >> row.surface >> row.kind >> row.length;
    for (Vector* vector : {&row.p, &row.q, &row.v}) {
      vector->resize(surfaces().at(row.surface).dim());
      for (double& entry : *vector) words >> entry;
    }
    EXPECT_TRUE(words) << line;
    if (row.kind == kind) result.push_back(row);
  }
  return result;
}

Points start_of(const Reference& row, double noise, unsigned seed) {
  Points path = test::integrate_geodesic(surfaces().at(row.surface), row.p, row.v, row.length, 30);
  path.col(30) = row.q;
  return test::with_noise(path, noise * row.length, seed);
}

TEST(NewtonReferences, MeetEveryToleranceWithAnHonestEstimate) {
  const auto rows = references("distance");
  ASSERT_GE(rows.size(), 50U);
  for (const double tolerance : {1e-3, 1e-6, 1e-9, 1e-12, 1e-13}) {
    std::vector<double> ratio;
    unsigned seed = 0;
    for (const Reference& row : rows) {
      SCOPED_TRACE(row.surface + " length " + std::to_string(row.length) + " tolerance " + std::to_string(tolerance));
      const NewtonResult path =
          correct_newton(surfaces().at(row.surface), start_of(row, 0.003, ++seed), {.tolerance = tolerance});
      ASSERT_EQ(path.status, Status::ok) << path.reason;
      const double error = std::abs(path.length - row.length);
      EXPECT_LE(error, tolerance * row.length + 2e-15);
      EXPECT_LE(error, path.length_error + 5e-16);
      EXPECT_TRUE(path.locally_shortest);
      if (error > 1e-13 * row.length) ratio.push_back(path.length_error / error);
    }
    if (!ratio.empty()) {
      std::nth_element(ratio.begin(), ratio.begin() + static_cast<std::ptrdiff_t>(ratio.size() / 2), ratio.end());
      EXPECT_LT(ratio[ratio.size() / 2], 1000) << "tolerance " << tolerance;
    }
  }
}

TEST(NewtonReferences, ARoughGeodesicIsRefined) {
  const auto rows = references("distance");
  unsigned seed = 0;
  Index from_start = 0;
  Index from_rough = 0;
  for (const Reference& row : rows) {
    SCOPED_TRACE(row.surface + " length " + std::to_string(row.length));
    const Surface& surface = surfaces().at(row.surface);
    const Points start = start_of(row, 0.003, ++seed);
    const NewtonResult rough = correct_newton(surface, start, {.tolerance = 1e-3});
    NewtonSolver solver(surface, {.tolerance = 1e-12});
    const NewtonResult path = solver.refine(rough.curve);
    ASSERT_EQ(path.status, Status::ok) << path.reason;
    EXPECT_LE(std::abs(path.length - row.length), 1e-12 * row.length + 2e-15);
    EXPECT_LE(std::abs(path.length - row.length), path.length_error + 5e-16);
    EXPECT_TRUE(path.locally_shortest);
    EXPECT_EQ(path.points.col(0), start.col(0));
    EXPECT_EQ(path.points.rightCols<1>(), start.rightCols<1>());
    from_rough += path.num_evaluated;
    from_start += solver.solve(start).num_evaluated;
  }
  EXPECT_LT(from_rough, from_start);
}

TEST(NewtonReferences, TheCertificateTurnsAtTheConjugatePoint) {
  for (const Reference& row : references("conjugate")) {
    SCOPED_TRACE(row.surface + " conjugate at " + std::to_string(row.length));
    const Surface& surface = surfaces().at(row.surface);
    for (const double share : {0.98, 1.02}) {
      const Points start = test::integrate_geodesic(surface, row.p, row.v, share * row.length, 80);
      const NewtonResult path = correct_newton(surface, start, {.leave_saddles = false});
      ASSERT_EQ(path.status, Status::ok) << path.reason;
      ASSERT_NEAR(path.length, share * row.length, 1e-5 * row.length);
      EXPECT_EQ(path.locally_shortest, share < 1);
      EXPECT_EQ(path.index, share < 1 ? 0 : 1);
      if (share > 1) {
        ASSERT_TRUE(path.conjugate_at.has_value());
        EXPECT_NEAR(*path.conjugate_at, row.length, 1e-4 * row.length);
      } else {
        EXPECT_FALSE(path.conjugate_at.has_value());
      }
    }
  }
}

}  // namespace
}  // namespace taut
