#include "taut/cells/mesh_surface.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include "support/mesh_checks.hpp"
#include "support/surfaces.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using std::numbers::pi;
using test::MeshReport;

/// All cells of [lower, upper]^d: the mesh must find the crossed ones itself.
CellGrid full_grid(Index d, double lower, double upper, Index n, const Vector& shift) {
  CellGrid grid(Vector::Constant(d, lower) + shift, (upper - lower) / static_cast<double>(n));
  std::vector<std::int32_t> cell(static_cast<std::size_t>(d));
  const auto total = static_cast<Index>(std::pow(n, d) + 0.5);
  for (Index i = 0; i < total; ++i) {
    Index rest = i;
    for (std::int32_t& c : cell) {
      c = static_cast<std::int32_t>(rest % n);
      rest /= n;
    }
    grid.insert(cell);
  }
  return grid;
}
CellGrid full_grid(double lower, double upper, Index n) { return full_grid(3, lower, upper, n, Vector::Zero(3)); }

void expect_on_surface(const Surface& surface, const TriangleMesh& mesh, double tolerance) {
  const Points value = surface.value(mesh.vertices);
  const Points gradient = surface.jacobian(mesh.vertices);
  ASSERT_TRUE(mesh.has_normals());
  for (Index v = 0; v < mesh.vertices.cols(); ++v) {
    EXPECT_LE(std::abs(value(0, v)) / gradient.col(v).norm(), tolerance) << "vertex " << v;
    EXPECT_NEAR((mesh.normals.col(v) - gradient.col(v).normalized()).norm(), 0, 1e-12);
  }
}

TEST(MeshSurface, HasTheGenusOfTheSurface) {
  const auto euler = [](const Surface& surface, double reach, Index n) {
    const SurfaceMesh mesh = mesh_surface(surface, full_grid(-reach, reach, n));
    const MeshReport report = test::check_mesh(mesh);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.num_boundary_loops, 0);
    expect_on_surface(surface, mesh, 1e-12);
    return report.euler_characteristic;
  };
  EXPECT_EQ(euler(test::unit_sphere(), 1.3, 12), 2);
  EXPECT_EQ(euler(test::torus(), 1.6, 17), 0);
  EXPECT_EQ(euler(test::tangle_cube(), 3.0, 30), -8);  // genus 5
}

TEST(MeshSurface, AreaAndVolumeConvergeWithOrderTwo) {
  const double R = 1;
  const double r = 0.4;
  std::array<double, 3> area_error{};
  std::array<double, 3> volume_error{};
  for (std::size_t level = 0; level < 3; ++level) {
    const SurfaceMesh mesh = mesh_surface(test::torus(R, r), full_grid(-1.5, 1.5, Index{20} << level));
    area_error[level] = std::abs(test::area(mesh) - 4 * pi * pi * R * r);
    volume_error[level] = std::abs(test::volume(mesh) - 2 * pi * pi * R * r * r);
  }
  EXPECT_LT(area_error[2], 1e-3 * 4 * pi * pi * R * r);
  EXPECT_NEAR(std::log2(area_error[0] / area_error[2]) / 2, 2, 0.2);
  EXPECT_NEAR(std::log2(volume_error[0] / volume_error[2]) / 2, 2, 0.2);
}

TEST(MeshSurface, PointsOutwards) {
  EXPECT_GT(test::volume(mesh_surface(test::unit_sphere(), full_grid(-1.3, 1.3, 12))), 0);
}

TEST(MeshSurface, CornersOnTheSurfaceAreNoSpecialCase) {
  // h = 1/4 puts (1, 0, 0), (0.6, 0.8, 0)-like corners with F = 0 or F = rounding noise onto the sphere; h = 1/5 both.
  for (const double h : {0.25, 0.2, 0.5, 0.1}) {
    for (const double shift : {0.0, 0.5, 1.0 / 3, 0.1, 1e-17, -1e-16, 1e-13}) {
      const auto n = static_cast<Index>(std::ceil(1.6 / h)) * 2;
      const double reach = h * static_cast<double>(n) / 2;
      const SurfaceMesh mesh =
          mesh_surface(test::unit_sphere(), full_grid(3, -reach, reach, n, Vector::Constant(3, shift * h)));
      const MeshReport report = test::check_mesh(mesh);
      EXPECT_TRUE(report.manifold) << h << " " << shift;
      EXPECT_EQ(report.num_boundary_loops, 0) << h << " " << shift;
      EXPECT_EQ(report.euler_characteristic, 2) << h << " " << shift;
      EXPECT_EQ(report.num_components, 1) << h << " " << shift;
      expect_on_surface(test::unit_sphere(), mesh, 1e-12);
    }
  }
}

TEST(MeshSurface, PlaneThroughGridCornersStaysFlat) {
  struct Plane {
    Vector n;
    [[nodiscard]] Index dim() const { return 3; }
    [[nodiscard]] double value(const Vector& x) const { return n.dot(x); }
    [[nodiscard]] Vector gradient(const Vector&) const { return n; }
    [[nodiscard]] Eigen::MatrixXd hessian(const Vector&) const { return Eigen::MatrixXd::Zero(3, 3); }
  };
  for (const Eigen::Vector3d& n :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0.1, 0.2, 0.3)}) {
    const SurfaceMesh mesh = mesh_surface(test::make_surface(Plane{n}), full_grid(-0.7, 0.7, 14));
    const MeshReport report = test::check_mesh(mesh);
    EXPECT_TRUE(report.manifold);
    EXPECT_EQ(report.euler_characteristic, 1);
    EXPECT_EQ(report.num_boundary_loops, 1);
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
      EXPECT_GT(test::face_normal(mesh, f).dot(n), 0) << "a triangle is turned over";
    }
  }
}

/// Waves far too short for the grid: every sign mask and every ambiguous pair of cells occurs.
struct Waves {
  Eigen::MatrixXd k;
  Vector phase;
  explicit Waves(unsigned seed) : k(3, 24), phase(24) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> wave(-40, 40);
    for (double& x : k.reshaped()) x = wave(random);
    for (double& x : phase) x = wave(random);
  }
  [[nodiscard]] Index dim() const { return 3; }
  [[nodiscard]] double value(const Vector& x) const { return (k.transpose() * x + phase).array().sin().sum(); }
  [[nodiscard]] Vector gradient(const Vector& x) const {
    return k * (k.transpose() * x + phase).array().cos().matrix();
  }
  [[nodiscard]] Eigen::MatrixXd hessian(const Vector& x) const {
    return -k * (k.transpose() * x + phase).array().sin().matrix().asDiagonal() * k.transpose();
  }
};

TEST(MeshSurface, IsManifoldOnNoise) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Surface surface = test::make_surface(Waves(seed));
    const CellGrid grid = full_grid(-1, 1, 24);
    const SurfaceMesh mesh = mesh_surface(surface, grid);
    EXPECT_TRUE(test::check_mesh(mesh).manifold) << "seed " << seed;
    EXPECT_GT(mesh.faces.cols(), 10000);
    for (Index v = 0; v < mesh.vertices.cols(); ++v) {
      const auto cell = grid.cell(mesh.cell[static_cast<std::size_t>(v)]);
      for (Index a = 0; a < 3; ++a) {
        const double t = (mesh.vertices(a, v) - grid.origin()(a)) / grid.size() - cell[static_cast<std::size_t>(a)];
        EXPECT_GE(t, -0.25 - 1e-12);
        EXPECT_LE(t, 1.25 + 1e-12);
      }
    }
  }
}

TEST(MeshSurface, IsManifoldWithCellsMissing) {
  std::mt19937 random(7);
  CellGrid sparse(Vector::Constant(3, -1), 2.0 / 24);
  std::array<std::int32_t, 3> cell{};
  for (cell[0] = 0; cell[0] < 24; ++cell[0]) {
    for (cell[1] = 0; cell[1] < 24; ++cell[1]) {
      for (cell[2] = 0; cell[2] < 24; ++cell[2]) {
        if (random() % 8 != 0) sparse.insert(cell);
      }
    }
  }
  EXPECT_TRUE(test::check_mesh(mesh_surface(test::make_surface(Waves(3)), sparse)).manifold);
}

TEST(MeshSurface, ThinFeaturesAboveACellAreKept) {
  // A flat ellipsoid, 2.4 cells thick, and a tube 1.6 cells wide.
  const SurfaceMesh disc = mesh_surface(test::ellipsoid(1, 1, 0.06), full_grid(-1.2, 1.2, 48));
  EXPECT_TRUE(test::check_mesh(disc).manifold);
  EXPECT_EQ(test::check_mesh(disc).euler_characteristic, 2);
  EXPECT_NEAR(test::volume(disc), 4 * pi / 3 * 0.06, 0.05 * 4 * pi / 3 * 0.06);
  const SurfaceMesh ring = mesh_surface(test::torus(1, 0.04), full_grid(-1.2, 1.2, 48));
  EXPECT_TRUE(test::check_mesh(ring).manifold);
  EXPECT_EQ(test::check_mesh(ring).euler_characteristic, 0);
  EXPECT_EQ(test::check_mesh(ring).num_components, 1);
}

TEST(MeshSurface, DomainCutsAHemisphereAlongItsEquator) {
  struct UpperHalf {
    [[nodiscard]] Index dim() const { return 3; }
    [[nodiscard]] double value(const Vector& x) const { return x(2); }
    [[nodiscard]] Vector gradient(const Vector&) const { return Vector::Unit(3, 2); }
    [[nodiscard]] Eigen::MatrixXd hessian(const Vector&) const { return Eigen::MatrixXd::Zero(3, 3); }
  };
  SurfaceExtras extras;
  extras.domain = std::make_shared<test::ScalarFunction<UpperHalf>>(UpperHalf{});
  const Surface hemisphere = test::make_surface(test::EllipsoidFunction{Vector::Ones(3)}, extras);
  for (const double shift : {0.0, 0.03, 0.05}) {
    // The whole sphere's cells, and only those that reach into the domain, as Algorithm I leaves them.
    const CellGrid all = full_grid(3, -1.4, 1.4, 28, Vector::Constant(3, shift));
    CellGrid kept(all.origin(), all.size());
    for (Index c = 0; c < all.num_cells(); ++c) {
      if (all.origin()(2) + all.size() * (all.cell(c)[2] + 1) > 0) kept.insert(all.cell(c));
    }
    for (const CellGrid& grid : {all, kept}) {
      const SurfaceMesh mesh = mesh_surface(hemisphere, grid);
      const MeshReport report = test::check_mesh(mesh);
      EXPECT_TRUE(report.manifold);
      EXPECT_EQ(report.euler_characteristic, 1);
      EXPECT_EQ(report.num_boundary_loops, 1);
      EXPECT_NEAR(test::area(mesh), 2 * pi, 0.02 * 2 * pi);
      EXPECT_NEAR(report.boundary_length, 2 * pi, 0.01 * 2 * pi);
      EXPECT_GE(mesh.vertices.row(2).minCoeff(), -1e-12);
      for (const Index c : mesh.cell) EXPECT_LT(c, grid.num_cells());
      expect_on_surface(hemisphere, mesh, 1e-12);
    }
  }
}

TEST(MeshSurface, LeavesOutPolesAndUndefinedCells) {
  struct Pole {
    [[nodiscard]] Index dim() const { return 3; }
    [[nodiscard]] double value(const Vector& x) const { return 1 / (x(0) - 0.013) + 0 * std::sqrt(x(1) + 0.5); }
    [[nodiscard]] Vector gradient(const Vector& x) const { return -Vector::Unit(3, 0) / std::pow(x(0) - 0.013, 2); }
    [[nodiscard]] Eigen::MatrixXd hessian(const Vector&) const { return Eigen::MatrixXd::Zero(3, 3); }
  };
  EXPECT_EQ(mesh_surface(test::make_surface(Pole{}), full_grid(-1, 1, 10)).faces.cols(), 0);
}

TEST(MeshSurface, ThreadsChangeNothing) {
  const CellGrid grid = full_grid(-3, 3, 40);
  const SurfaceMesh one = mesh_surface(test::tangle_cube(), grid, {}, {.threads = 1});
  const SurfaceMesh many = mesh_surface(test::tangle_cube(), grid, {}, {.threads = 2});
  EXPECT_EQ(one.vertices, many.vertices);
  EXPECT_EQ(one.faces, many.faces);
}

TEST(MeshSurface, RefusesOtherDimensions) {
  EXPECT_THROW((void)mesh_surface(test::unit_sphere(4), CellGrid(Vector::Zero(4), 0.1)), InvalidArgument);
  EXPECT_THROW((void)mesh_surface(test::unit_sphere(2), CellGrid(Vector::Zero(2), 0.1)), InvalidArgument);
  EXPECT_THROW((void)mesh_surface(test::unit_sphere(3), CellGrid(Vector::Zero(2), 0.1)), InvalidArgument);
  EXPECT_THROW((void)mesh_curve(test::unit_sphere(3), CellGrid(Vector::Zero(3), 0.1)), InvalidArgument);
  EXPECT_EQ(mesh_surface(test::unit_sphere(3), CellGrid(Vector::Zero(3), 0.1)).faces.cols(), 0);
}

TEST(MeshCurve, CircleIsOneClosedPolygonTurningLeft) {
  for (const double shift : {0.0, 0.5, 0.3}) {
    const CellGrid grid = full_grid(2, -1.5, 1.5, 30, Vector::Constant(2, 0.1 * shift));
    const CurveMesh mesh = mesh_curve(test::unit_sphere(2), grid);
    ASSERT_EQ(mesh.segments.cols(), mesh.vertices.cols());
    ASSERT_EQ(mesh.cell.size(), static_cast<std::size_t>(mesh.vertices.cols()));
    std::vector<int> next(static_cast<std::size_t>(mesh.vertices.cols()), -1);
    for (Index s = 0; s < mesh.segments.cols(); ++s)
      next[static_cast<std::size_t>(mesh.segments(0, s))] = mesh.segments(1, s);
    Index steps = 0;
    double length = 0;
    double area = 0;
    int v = 0;
    do {
      const int w = next[static_cast<std::size_t>(v)];
      ASSERT_GE(w, 0);
      length += (mesh.vertices.col(w) - mesh.vertices.col(v)).norm();
      area += 0.5 * (mesh.vertices(0, v) * mesh.vertices(1, w) - mesh.vertices(1, v) * mesh.vertices(0, w));
      v = w;
      ++steps;
    } while (v != 0 && steps <= mesh.vertices.cols());
    EXPECT_EQ(steps, mesh.vertices.cols());
    EXPECT_NEAR(length, 2 * pi, 0.005);
    EXPECT_NEAR(area, pi, 0.01);
    EXPECT_LE((mesh.vertices.colwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
    EXPECT_LE((mesh.normals - mesh.vertices).cwiseAbs().maxCoeff(), 1e-14);
  }
}

}  // namespace
}  // namespace taut
