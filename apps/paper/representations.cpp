// The paper's last claim: other representations than implicit ones.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "parts.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

/// A torus with radii 1 and 0.4 by its parameters, u round the axis and v round the tube.
Eigen::Vector3d torus_point(double u, double v) {
  const double r = 1 + 0.4 * std::cos(v);
  return {r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)};
}
Eigen::Vector3d torus_normal(double u, double v) {
  return {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)};
}

/// n samples, about evenly spread: as many round the tube as its length asks for.
PointCloud sample_torus(Index n) {
  const double step = std::sqrt(4 * std::numbers::pi * std::numbers::pi * 0.4 / static_cast<double>(n));
  const auto rings = static_cast<Index>(std::lround(2 * std::numbers::pi * 0.4 / step));
  std::vector<Eigen::Vector2d> places;
  for (Index j = 0; j < rings; ++j) {
    const double v = 2 * std::numbers::pi * static_cast<double>(j) / static_cast<double>(rings);
    const auto count = static_cast<Index>(std::lround(2 * std::numbers::pi * (1 + 0.4 * std::cos(v)) / step));
    for (Index i = 0; i < count; ++i) {
      places.emplace_back(2 * std::numbers::pi * (static_cast<double>(i) + 0.5 * static_cast<double>(j % 2)) /
                              static_cast<double>(count),
                          v);
    }
  }
  PointCloud cloud{
      .points = Points(3, static_cast<Index>(places.size())), .normals = {}, .faces = Eigen::Matrix3Xi(3, 0)};
  cloud.normals = cloud.points;
  for (std::size_t i = 0; i < places.size(); ++i) {
    cloud.points.col(static_cast<Index>(i)) = torus_point(places[i].x(), places[i].y());
    cloud.normals.col(static_cast<Index>(i)) = torus_normal(places[i].x(), places[i].y());
  }
  return cloud;
}

/// The cube [-1, 1]^3 by its eight corners and twelve triangles.
PointCloud cube() {
  PointCloud cloud{.points = Points(3, 8), .normals = Points(3, 0), .faces = Eigen::Matrix3Xi(3, 12)};
  for (int i = 0; i < 8; ++i)
    cloud.points.col(i) << ((i & 1) != 0 ? 1 : -1), ((i & 2) != 0 ? 1 : -1), ((i & 4) != 0 ? 1 : -1);
  cloud.faces << 0, 0, 4, 4, 0, 0, 2, 2, 0, 0, 1, 1,  //
      3, 2, 5, 7, 1, 5, 6, 7, 4, 6, 3, 7,             //
      1, 3, 7, 6, 5, 4, 7, 3, 6, 2, 7, 5;
  return cloud;
}

}  // namespace

void write_representations(Study& study, Report& report) {
  Section& section = report.section("Other representations");
  section.paper(
      "The conclusions say that the algorithms can be applied to other, non-implicit representations of surfaces, "
      "too.");

  section.subheading("Parametric surfaces");
  section.text(
      "A parametric surface is either made implicit, where its equation is known, or sampled and fitted. Both are done "
      "here for a "
      "torus given by two angles; <code>examples/parametric_surface.cpp</code> is the same as a program.");
  const Surface implicit = parse_surface("(sqrt(x^2+y^2)-1)^2+z^2=0.16");
  const Vector from = torus_point(0.2, 0.5);
  const Vector to = torus_point(2.4, 2.3);
  const PathResult exact = shortest_path(implicit, from, to, {.tolerance = 1e-12}, study.context);
  Table table{.name = "representations_parametric",
              .title = "A path on a torus known by its parameters",
              .columns = {{"made implicit by"},
                          {"samples"},
                          {"length", "{:.9f}"},
                          {"relative difference", "{:.1e}"},
                          {"seconds", "{:.2f}"}}};
  table.add({std::string("its equation"), Value(), exact.length, Value(), Value()});
  std::vector<double> spacing, error;
  PathResult shown;
  for (const Index n : {250, 500, 1000, 2000}) {
    const ProcessorClock clock;
    const PointCloud cloud = sample_torus(n);
    const Surface fitted = make_surface(
        std::make_shared<const RbfModel>(fit_rbf(cloud, {.smoothing = 0, .support_radius = -1}, study.context)));
    shown = shortest_path(fitted, from, to, {}, study.context);
    table.add(
        {std::string("samples, fitted"), cloud.size(), shown.length, shown.length / exact.length - 1, clock.seconds()});
    spacing.push_back(1 / std::sqrt(static_cast<double>(cloud.size())));
    error.push_back(std::abs(shown.length / exact.length - 1));
  }
  section.measured(
      fmt::format("The fitted surface’s geodesic goes to the true one with order {:.1f} in the spacing of the samples.",
                  fit_power_law(spacing, error).exponent));
  section.add(table);

  section.subheading("Meshes");
  const PointCloud corners = cube();
  const Surface fitted = make_surface(std::make_shared<const RbfModel>(fit_rbf(corners, {}, study.context)));
  const PathResult over = shortest_path(fitted, corners.points.col(0), corners.points.col(7), {}, study.context);
  Table mesh{.name = "representations_mesh",
             .title = "From corner to opposite corner of a cube given as a mesh of eight vertices",
             .columns = {{"surface"}, {"length", "{:.6f}"}}};
  const double on_faces = 2 * std::sqrt(5.0);
  mesh.add({std::string("the cube’s faces"), on_faces});
  mesh.add({std::string("the smooth fit through its vertices"), over.length});
  section.measured(
      fmt::format("Taut fits a smooth surface through a mesh’s vertices and lets its faces tell inside from outside "
                  "only. Through the eight corners of a cube "
                  "that is a ball: the path is {:.3f} long where it is {:.3f} on the faces. The program says so "
                  "whenever the fit stands off the "
                  "faces by more than a hundredth of the path.",
                  over.length, on_faces));
  section.add(mesh);
  Scene scene;
  scene.title = "What is fitted through a cube's corners";
  scene.meshes.push_back(
      {.mesh = display_mesh(fitted, {.cell = 0.12}, study.context), .colour = Colour::hex(0xd3dde6)});
  if (over.points.cols() > 1)
    scene.paths.push_back({.points = over.points, .label = "path on the fit", .colour = kRed, .length = over.length});
  // Edges as paths: those are seen through the ball.
  for (int i = 0; i < 8; ++i) {
    for (const int bit : {1, 2, 4}) {
      if ((i & bit) != 0) continue;
      Points edge(3, 2);
      edge << corners.points.col(i), corners.points.col(i | bit);
      scene.paths.push_back({.points = edge, .label = "the cube's edges", .colour = kInk, .width = 0.5});
    }
  }
  section.add(figure_of("representations_cube", "The cube (edges) and the surface that is fitted through its corners.",
                        scene, {.width = 640, .height = 480}));
  section.remark(
      "For a mesh with flat faces and sharp edges an exact polyhedral method is the right tool; the paper does not "
      "discuss edges.");
}

}  // namespace taut::paper
