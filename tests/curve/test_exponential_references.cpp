// The exponential map against rays and conjugate points computed by others.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "taut/curve/exponential_map.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

struct ReferenceRay {
  Surface surface;
  std::string name;
  bool conjugate;
  double length;         // of the ray, or to the conjugate point (0: none)
  double amplification;  // or the length searched
  Vector p, v, q, w;
};

std::vector<ReferenceRay> references(bool conjugate) {
  std::ifstream file(TAUT_TEST_DATA "/reference_rays.txt");
  std::vector<ReferenceRay> result;
  std::optional<Surface> surface;
  std::string name;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "surface") {
      Index d = 0;
      std::string equations;
      words >> name >> d >> equations;
      surface = parse_surface(equations, {.dim = d});
      continue;
    }
    ReferenceRay row{*surface, name, kind == "conjugate", 0, 0, {}, {}, {}, {}};
    words >> row.length >> row.amplification;
    for (Vector* vector : {&row.p, &row.v, &row.q, &row.w}) {
      if (row.conjugate && vector == &row.q) break;
      vector->resize(surface->dim());
      for (double& entry : *vector) words >> entry;
    }
    EXPECT_TRUE(words) << line;
    if (row.conjugate == conjugate) result.push_back(std::move(row));
  }
  return result;
}

double miss(const ExponentialResult& ray, const ReferenceRay& row) {
  return std::max((ray.point - row.q).norm(), (ray.direction - row.w).norm() * std::min(1.0, row.length));
}

TEST(ExponentialReferences, EndPointsAgreeToRounding) {
  const auto rows = references(false);
  ASSERT_GE(rows.size(), 100U);
  for (const ReferenceRay& row : rows) {
    SCOPED_TRACE(row.name + " length " + std::to_string(row.length));
    const ExponentialResult ray = exponential_map(row.surface, row.p, row.v, row.length);
    ASSERT_EQ(ray.status, Status::ok) << ray.reason;
    EXPECT_LT(miss(ray, row), 1e-14 * std::max(1.0, row.length) * row.amplification);
    EXPECT_LT(miss(ray, row), std::max(ray.error, ray.direction_error));
    EXPECT_LT(ray.error, 1e-11 * row.amplification);
  }
}

TEST(ExponentialReferences, TheErrorEstimateIsHonestAtEveryTolerance) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    std::vector<double> over;
    for (const ReferenceRay& row : references(false)) {
      SCOPED_TRACE(row.name + " length " + std::to_string(row.length) + " tolerance " + std::to_string(tolerance));
      const ExponentialResult ray =
          exponential_map(row.surface, row.p, row.v, row.length, {.tolerance = tolerance, .points = false});
      ASSERT_EQ(ray.status, Status::ok) << ray.reason;
      const double error = miss(ray, row);
      EXPECT_LT(error, std::max(ray.error, ray.direction_error));
      if (error > 1e-13) over.push_back(std::max(ray.error, ray.direction_error) / error);
    }
    std::sort(over.begin(), over.end());
    if (!over.empty()) {
      EXPECT_LT(over[over.size() / 2], 1000) << tolerance;
    }
  }
}

TEST(ExponentialReferences, NeighboursTellTheErrorWhereJacobiFieldsWouldBeTooMany) {
  for (const ReferenceRay& row : references(false)) {
    SCOPED_TRACE(row.name + " length " + std::to_string(row.length));
    const ExponentialResult ray = exponential_map(row.surface, row.p, row.v, row.length, {.max_fields = 0});
    EXPECT_LT(miss(ray, row), std::max(ray.error, ray.direction_error));
    EXPECT_EQ(ray.conjugate_searched, 0);
  }
}

TEST(ExponentialReferences, ConjugatePointsAgreeToRounding) {
  const auto rows = references(true);
  ASSERT_GE(rows.size(), 40U);
  for (const ReferenceRay& row : rows) {
    SCOPED_TRACE(row.name + " conjugate at " + std::to_string(row.length));
    const double reach = row.length > 0 ? 1.1 * row.length : row.amplification;
    const ExponentialResult ray = exponential_map(row.surface, row.p, row.v, reach, {.points = false});
    EXPECT_EQ(ray.conjugate_searched, reach);
    ASSERT_EQ(ray.conjugate_at.has_value(), row.length > 0);
    if (row.length > 0) {
      EXPECT_NEAR(*ray.conjugate_at, row.length, 1e-14 * row.length * ray.amplification);
      EXPECT_FALSE(exponential_map(row.surface, row.p, row.v, 0.999 * row.length).conjugate_at.has_value());
    }
  }
}

}  // namespace
}  // namespace taut
