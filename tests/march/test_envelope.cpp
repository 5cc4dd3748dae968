// The paper's error bound (sec. 3.2): distances in the envelope are off by at most lambda sqrt(h).
#include "taut/cells/find_cells.hpp"

#include <algorithm>
#include <functional>
#include <numbers>

#include "march/support.hpp"
#include "support/interval_surfaces.hpp"

namespace taut {
namespace {

using Distance = std::function<double(const Vector&, const Vector&)>;

/// Largest |error| of the paper's march over all points of crossed cells.
double worst_error(const Surface& surface, const SurfaceCells& bare, Index layers, const Vector& source,
                   const Distance& truth) {
  SurfaceCells cells = bare.thickened(layers);
  const DistanceField field = march(surface, cells, source, {.method = MarchMethod::axis});
  Points x(3, bare.num_valid());
  Index n = 0;
  for (Index i = 0; i < bare.num_cells(); ++i) {
    if (bare.valid(i)) x.col(n++) = bare.point(i);
  }
  const Vector found = distance_at(surface, cells, field, x);
  double worst = 0;
  for (Index j = 0; j < n; ++j) worst = std::max(worst, std::abs(found(j) - truth(source, x.col(j))));
  return worst;
}

double cylinder_distance(const Vector& p, const Vector& q) {
  const double turn = std::atan2(p(1), p(0)) - std::atan2(q(1), q(0));
  return std::hypot(std::remainder(turn, 2 * std::numbers::pi), p(2) - q(2));
}

void expect_bound(const Surface& surface, const Vector& source, const Distance& truth) {
  double first_bare = 0;
  double last_bare = 0;
  double before = 0.8;  // lambda; measured 0.74, 0.70, 0.49, 0.47 on the sphere, 0.56, 0.65, 0.49, 0.40 on the cylinder
  for (const double h : {0.2, 0.1, 0.05, 0.025}) {
    const SurfaceCells bare(surface, subdivide(surface, {.size = h}));
    const double by_law = worst_error(surface, bare, envelope_layers(bare.grid()), source, truth) / std::sqrt(h);
    EXPECT_LT(by_law, before) << "h " << h;
    last_bare = worst_error(surface, bare, 0, source, truth) / std::sqrt(h);
    if (first_bare == 0) first_bare = last_bare;
  }
  EXPECT_GT(last_bare, 1.8 * first_bare);  // the crossed cells alone: it grows like 1 / sqrt(h)
}

TEST(Envelope, OnTheSphereErrorsStayBelowLambdaSqrtH) {
  expect_bound(test::unit_sphere().with_box({Vector::Constant(3, -1.1), Vector::Constant(3, 1.1)}),
               Eigen::Vector3d(0.36, -0.48, 0.8), test::sphere_distance);
}

TEST(Envelope, OnTheCylinderErrorsStayBelowLambdaSqrtH) {
  const Surface cylinder =
      test::generic_surface(3, 1, [](const auto& x, auto& y) { y[0] = test::square(x[0]) + test::square(x[1]) - 1.0; });
  expect_bound(cylinder.with_box({Eigen::Vector3d(-1.1, -1.1, -1), Eigen::Vector3d(1.1, 1.1, 1)}),
               Eigen::Vector3d(0.6, -0.8, 0.1), cylinder_distance);
}

TEST(Envelope, BothAlgorithmsMakeTheSame) {
  const Surface sphere = test::unit_sphere();
  const CellGrid all = subdivide(sphere, {.size = 0.1});
  for (const Index layers : {1, 4}) {
    const CellGrid thick = thicken(all, layers);
    EXPECT_GT(thick.num_cells(), all.num_cells() * (1 + layers));
    // The cells given come first; every other one is `layers` steps across faces from one of them, at most.
    for (Index i = 0; i < all.num_cells(); ++i) EXPECT_EQ(thick.find(all.cell(i)), i);
    for (Index i = 0; i < thick.num_cells(); ++i) {
      const double off = std::abs(thick.centre(i).norm() - 1) / thick.size();
      EXPECT_LE(off, static_cast<double>(layers) + std::sqrt(3.0));
    }
    // A centre that near the surface is a cell of it.
    Index missing = 0;
    std::mt19937 random(5);
    for (int k = 0; k < 2000; ++k) {
      const double off = static_cast<double>(layers) / std::sqrt(3.0) * thick.size();
      for (const double side : {1 - off, 1 + off}) {
        missing += thick.find_point(side * test::random_unit(3, random)) == CellGrid::kNone ? 1 : 0;
      }
    }
    EXPECT_EQ(missing, 0);
  }
  EXPECT_THROW((void)thicken(all, -1), InvalidArgument);
}

}  // namespace
}  // namespace taut
