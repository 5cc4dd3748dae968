// Inertia matrix from geodesics (Kim and Luo): moments of geodesic distances, which bending does not change.

#include "inertia.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "applications.hpp"
#include "models.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/query/point_sets.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {

GeodesicInertia geodesic_inertia(const std::vector<PathResult>& paths) {
  GeodesicInertia inertia;
  Index count = 0;
  for (const PathResult& path : paths) {
    if (path.status != Status::ok || path.start_direction.size() == 0) continue;
    const Vector u = path.length * path.start_direction;
    if (count == 0) inertia.matrix = Eigen::MatrixXd::Zero(u.size(), u.size());
    inertia.matrix += u * u.transpose();
    ++count;
  }
  if (count == 0) throw InvalidArgument("geodesic_inertia: no path has a start direction");
  inertia.matrix /= static_cast<double>(count);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inertia.matrix);
  inertia.eigenvalues = solver.eigenvalues().reverse();
  inertia.directions = solver.eigenvectors().rowwise().reverse();
  inertia.mean_square = inertia.matrix.trace();
  return inertia;
}

namespace {

/// Of the axes' rays: to rounding they cannot be followed on a fit, which is noisy at 1e-10 of its size.
constexpr double kRayTolerance = 1e-6;

}  // namespace

void write_inertia(Study& study, Section& section) {
  section.text(
      "The paper names inertia matrices constructed by geodesics without saying more. Here each destination counts as "
      "the "
      "tangent vector of its geodesic, direction times length; the matrix is the mean of u uᵀ over all destinations. "
      "Its "
      "eigenvectors are the principal axes of the body as seen by someone who walks on it.");
  Table table{.name = "inertia",
              .title = "Moments of geodesic distances",
              .columns = {{"surface"},
                          {"destinations"},
                          {"largest moment", "{:.6g}"},
                          {"second", "{:.6g}"},
                          {"third (normal)", "{:.1e}"},
                          {"mean squared distance", "{:.6g}"},
                          {"truth", "{:.6g}"},
                          {"seconds", "{:.2f}"}}};
  {
    // On the whole unit sphere the mean squared distance is (pi^2 - 4) / 2, shared by both directions.
    const Surface sphere = parse_surface("x^2+y^2+z^2=1");
    constexpr Index kCount = 1000;
    Points destinations(3, kCount);
    for (Index i = 0; i < kCount; ++i) {
      // A spiral from pole to pole, a golden angle a step: as even as points on a sphere come.
      const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / kCount;
      const double turn = 2 * std::numbers::pi * std::numbers::phi * static_cast<double>(i);
      destinations.col(i) << std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z;
    }
    const ProcessorClock clock;
    PathSolver solver(sphere, {.tolerance = 1e-6}, study.context);
    const GeodesicInertia inertia = geodesic_inertia(solver.solve_from(Eigen::Vector3d(0, 0, 1), destinations));
    table.add({std::string("sphere, even points"), kCount, inertia.eigenvalues(0), inertia.eigenvalues(1),
               inertia.eigenvalues(2), inertia.mean_square, 0.5 * (std::numbers::pi * std::numbers::pi - 4),
               clock.seconds()});
  }
  const Model& hand = model(study, ModelKind::hand);
  const ProcessorClock clock;
  const Vector extent = hand.cloud.points.rowwise().maxCoeff() - hand.cloud.points.rowwise().minCoeff();
  SurfaceCells cells(hand.surface, grow(hand.surface, hand.cloud.points, extent.norm() / 60, study.context),
                     study.context);
  constexpr Index kCount = 60;
  // From the sample nearest to the middle of the body: on the back of the hand.
  const Vector middle = hand.cloud.points.rowwise().mean();
  Index start = 0;
  (hand.cloud.points.colwise() - middle).colwise().squaredNorm().minCoeff(&start);
  const Points spread = farthest_points(hand.surface, cells, cells.point(0), kCount, study.context).points;
  PathSolver solver(hand.surface, {.tolerance = 1e-6}, study.context);
  const std::vector<PathResult> paths = solver.solve_from(hand.cloud.points.col(start), spread);
  const GeodesicInertia inertia = geodesic_inertia(paths);
  table.add({hand.name + ", farthest points", kCount, inertia.eigenvalues(0), inertia.eigenvalues(1),
             inertia.eigenvalues(2), inertia.mean_square, Value(), clock.seconds()});

  Scene scene;
  scene.title = "Principal axes along geodesics";
  scene.up = hand.up;
  scene.meshes.push_back({.mesh = display_mesh(hand.surface, {}, study.context), .colour = Colour::hex(0xdfe4e9)});
  for (const PathResult& path : paths) {
    if (path.points.cols() > 1)
      scene.paths.push_back({.points = path.points,
                             .label = "geodesics",
                             .colour = Colour::hex(0xb9c3cd),
                             .length = path.length,
                             .width = 0.5});
  }
  for (Index axis = 0; axis < 2; ++axis) {
    const double reach = std::sqrt(inertia.eigenvalues(axis));
    for (const double side : {-1.0, 1.0}) {
      const ExponentialResult ray =
          exponential_map(hand.surface, paths.front().from, side * inertia.directions.col(axis), reach,
                          {.tolerance = kRayTolerance, .conjugate = false}, study.context);
      if (ray.points.cols() > 1)
        scene.paths.push_back({.points = ray.points,
                               .label = axis == 0 ? "first axis" : "second axis",
                               .colour = axis == 0 ? kRed : kBlue,
                               .length = ray.length});
    }
  }
  scene.points.push_back({.position = paths.front().from, .colour = kInk});
  section.add(figure_of("inertia_hand",
                        "Geodesics from the middle of the hand to 60 farthest points, and the principal axes of their "
                        "moments, drawn along "
                        "geodesics as long as the square roots of the moments.",
                        scene, {.width = 640, .height = 640, .towards_viewer = hand.towards_viewer}));
  section.add(std::move(table));
}

}  // namespace taut::paper
