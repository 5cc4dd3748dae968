// The snippets that the pages of docs/ show, each as a function of what the page leaves out. A test compares the pages
// with this file (tests/cli/test_snippets.cpp), so what they show compiles; running it shows that it works. Run where
// examples/data is.

#include <taut/cells/find_cells.hpp>
#include <taut/cells/mesh_surface.hpp>
#include <taut/cells/surface_cells.hpp>
#include <taut/core/error.hpp>
#include <taut/curve/exponential_map.hpp>
#include <taut/curve/flow.hpp>
#include <taut/curve/newton.hpp>
#include <taut/io/read_point_cloud.hpp>
#include <taut/io/read_surface.hpp>
#include <taut/io/write_geometry.hpp>
#include <taut/march/march.hpp>
#include <taut/query/bezier.hpp>
#include <taut/query/closed_geodesic.hpp>
#include <taut/query/distance.hpp>
#include <taut/query/distance_matrix.hpp>
#include <taut/query/path.hpp>
#include <taut/query/point_sets.hpp>
#include <taut/query/surface_mesh.hpp>
#include <taut/query/surface_summary.hpp>
#include <taut/query/tangent_maps.hpp>
#include <taut/surface/conformance.hpp>
#include <taut/surface/fit.hpp>
#include <taut/surface/formula.hpp>
#include <taut/surface/height_field.hpp>
#include <taut/surface/neural_network.hpp>
#include <taut/surface/volume.hpp>
#include <taut/view/scene.hpp>
#include <taut/view/write_scene.hpp>

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

namespace {

using taut::Points;
using taut::Surface;
using taut::Vector;

bool fine(const taut::PathResult& path) { return path.status == taut::Status::ok && path.length > 0; }

// What you ask

bool accuracy(const Surface& surface, const Vector& p, const Vector& q) {
  taut::PathSolver solver(surface, {.tolerance = 1e-12});  // prepares once
  const taut::PathResult path = solver.solve(p, q);        // path.length, path.length_error, path.seconds
  return fine(path);
}

bool command_line(const Vector& p, const Vector& q) {
  const taut::Surface surface = taut::parse_surface("x^2+y^2+4z^2=1");
  const taut::PathResult path = taut::shortest_path(surface, p, q, {.tolerance = 1e-12});
  return fine(path);
}

bool json(const Surface& surface, const Vector& p, const Vector& q) {
  const taut::PathResult path = taut::shortest_path(surface, p, q);
  if (path.status != taut::Status::ok) std::cout << path.message << "\n";
  return fine(path);
}

bool troubleshooting(const Surface& surface, const Vector& p, const Vector& q) {
  try {
    const taut::PathResult path = taut::shortest_path(surface, p, q);
    if (path.status != taut::Status::ok) std::cerr << taut::to_string(path.status) << ": " << path.message << "\n";
  } catch (const taut::Error& error) {
    std::cerr << error.what() << "\n";
  }
  return true;
}

bool shortest(const Surface& surface, const Vector& p, const Vector& q) {
  const taut::PathResult path = taut::shortest_path(surface, p, q, {.all = true});
  if (path.unique) std::cout << "the shortest: " << path.length << ", of " << path.candidates.size() << " ways\n";
  path.doubts.for_each([](taut::Doubt doubt) { std::cout << "in doubt: " << to_string(doubt) << "\n"; });
  return fine(path);
}

bool many_dimensions(const Surface& surface, const Vector& p, const Vector& q) {
  const taut::PathResult path = taut::shortest_path(surface, p, q, {.all = true});
  const auto fault = taut::diagnose_rank(surface.function(), p);  // nothing: all is well
  if (fault) std::cout << fault->text() << "\n";
  return fine(path) && !fault;
}

bool edges(const Vector& p, const Vector& q) {
  const taut::Surface can = taut::parse_surface("max(x^2+y^2-4, abs(z)-1)");
  const taut::PathResult path = taut::shortest_path(can, p, q);
  for (const taut::PathPiece& piece : path.pieces) std::cout << piece.length << "\n";
  const taut::SurfaceEdges edges = taut::surface_edges(can);
  return fine(path) && edges.edges.size() == 2;
}

bool loops(const Surface& surface, const Points& polyline, const Points& loop) {
  const taut::PathResult twice = taut::path_in_class(surface, polyline);    // polyline: d x m
  const taut::ClosedGeodesic waist = taut::closed_geodesic(surface, loop);  // joined from the last point to the first
  if (waist.is_point) std::cout << "shrinks to a point\n";                  // status ok, length 0
  return fine(twice);
}

bool field(const Surface& surface, const Points& sources, const Points& targets) {
  taut::DistanceSolver solver(surface, sources);  // d x m
  const taut::Distances u = solver.at(targets);   // u.distance, u.error, u.status, u.source, u.departure
  return u.distance.allFinite();
}

bool matrix(const Surface& surface, const Points& points) {
  taut::DistanceMatrix matrix(surface, points);  // d x n
  for (const taut::MatrixRow& row : matrix.rows(0, matrix.num_rows())) {
    std::cout << row.row << ": " << row.distance.size() << " distances\n";
  }
  return true;
}

bool sample(const Surface& surface, const Vector& p, const Points& points) {
  const taut::FarthestPoints spread = taut::farthest_points(surface, p, 24);
  const taut::VoronoiResult parts = taut::geodesic_voronoi(surface, spread.points);
  const taut::KarcherMean mean = taut::karcher_mean(surface, points);  // d x n
  return parts.mesh.vertices.cols() > 0 && mean.point.allFinite();
}

bool log(const Surface& surface, const Vector& p, const Vector& q, const Points& stations, const Points& vectors) {
  taut::PathSolver solver(surface);
  const taut::LogMapResult log = taut::log_map(solver, p, q);  // log.velocity(), log.arrival, log.scales
  const taut::TransportResult carried = taut::transport_along(solver, stations, vectors);  // d x n, d x m
  return log.velocity().allFinite() && carried.length > 0;
}

bool curve(const Surface& surface, const Points& controls) {
  taut::PathSolver solver(surface);
  const taut::BezierCurve curve = taut::bezier_curve(solver, controls, 65);  // d x 4, points
  return curve.points.cols() == 65;
}

bool view(const Surface& surface, const taut::PathResult& path) {
  taut::Scene scene;
  scene.title = "Tangle cube";
  scene.meshes.push_back({.mesh = taut::display_mesh(surface)});
  scene.paths.push_back({.points = path.points, .label = "geodesic", .length = path.length});
  scene.points.push_back({.position = path.from, .label = "from"});
  scene.towards_viewer = taut::view_direction(-60, 24);  // azimuth and elevation, degrees
  taut::write_html("page.html", scene);
  taut::write_svg("picture.svg", scene);
  taut::write_png("picture.png", scene, {.width = 1600, .height = 1000});
  return true;
}

// What you have

bool formula() {
  const taut::Surface torus = taut::parse_surface("(x^2+y^2+z^2+R^2-r^2)^2 = 4R^2*(x^2+y^2)",
                                                  {.parameters = {{"R", 1}, {"r", 0.4}}, .domain = {"z >= 0"}});
  return torus.dim() == 3;
}

bool files(const taut::PathResult& path) {
  const taut::PointCloud cloud = taut::read_point_cloud("examples/data/ring.xyz");
  taut::write_polylines("path.vtp", {.lines = {path.points}, .scalars = {}});
  return cloud.size() == 800;
}

bool fitting() {
  const taut::PointCloud cloud = taut::read_point_cloud("examples/data/ring.xyz");
  const taut::Surface surface = taut::make_surface(taut::fit_surface(cloud));
  const std::optional<double> off = taut::fit_residual(surface);
  return off && *off < 1e-9;
}

bool rbf() {
  const taut::PointCloud cloud = taut::read_point_cloud("examples/data/ring.xyz");
  const auto model = std::make_shared<const taut::RbfModel>(taut::fit_rbf(cloud));
  const taut::Surface surface = taut::make_surface(model);
  taut::write_model("ring.taut", *model);  // model->report: residual, what was left out
  return surface.samples() != nullptr;
}

bool volumes(const Vector& p, const Vector& q) {
  const taut::Surface skin = taut::volume_surface(taut::read_volume("examples/data/two_balls.nrrd"), {.iso = 500});
  const taut::PathResult path = taut::shortest_path(skin, p, q);
  return fine(path);
}

bool heights() {
  const taut::Surface land = taut::height_surface(taut::read_height_field("examples/data/hills.pgm"));
  const std::optional<double> z = taut::height_at(land, 12, 8);  // nothing outside of the grid
  return z.has_value();
}

bool networks() {
  const taut::Surface learned = taut::network_surface(taut::read_neural_network("examples/data/peanut.npz"));
  return learned.dim() == 3;
}

// How it works

bool cells(const Surface& surface, const Points& seeds) {
  const taut::CellGrid all = taut::subdivide(surface, {.size = 0.05});       // Algorithm I
  const taut::CellGrid one = taut::grow(surface, seeds, {.size = 0.05});     // Algorithm II, seeds: d x n
  const taut::SurfaceCells cells(surface, all);                              // a surface point and normals for each
  taut::SurfaceCells lazy = taut::SurfaceCells::lazy(surface, seeds, 0.05);  // grows where expand(i) asks
  return cells.num_cells() == all.num_cells() && one.num_cells() == all.num_cells() && lazy.num_cells() > 0;
}

bool mesh(const Surface& surface) {
  const taut::CellGrid cells = taut::subdivide(surface, {.size = 0.05});
  const taut::SurfaceMesh mesh = taut::mesh_surface(surface, cells);  // d = 3, k = 1
  return mesh.faces.cols() > 0;
}

bool march(const Surface& surface, const Vector& p, const Vector& q, double h, const Points& points) {
  taut::SurfaceCells cells = taut::SurfaceCells::lazy(surface, p, h);         // nothing but the cells at p yet
  taut::DistanceField field = taut::march(surface, cells, p, {.target = q});  // grows them up to q and stops
  const double distance = field.target_distance;                              // infinity: not reached
  const taut::Points line = taut::descend(surface, cells, field, q);          // d x m, from p to q
  const taut::Vector more = taut::distance_at(surface, cells, field, points);
  return std::isfinite(distance) && line.cols() > 1 && more.size() == points.cols();
}

bool newton(const Surface& surface, const Points& start) {
  taut::NewtonSolver solver(surface, {.tolerance = 1e-12});  // keeps evaluator and workspace
  const taut::NewtonResult path = solver.solve(start);       // start: d x m, ends on the surface
  if (path.status == taut::Status::ok) std::cout << path.length << " +- " << path.length_error << "\n";
  return path.status == taut::Status::ok;
}

bool flow(const Surface& surface, const Points& start) {
  taut::FlowOptions options;
  options.spacing = 0.01;                                                     // eps_E
  const taut::FlowResult path = taut::correct_flow(surface, start, options);  // start: d x m, near the surface
  return path.status == taut::Status::ok;
}

bool exp(const Surface& surface, const Vector& p, const Vector& v) {
  taut::ExponentialMap map(surface);                       // keeps evaluators and workspace
  const taut::ExponentialResult ray = map.trace(p, v, 3);  // ray.point, .direction, .error, .conjugate_at, .points
  return ray.point.allFinite();
}

int failures = 0;

void check(const std::string& page, bool works) {
  if (works) return;
  std::cerr << page << ": the snippet does not do what the page says\n";
  ++failures;
}

}  // namespace

int main() {
  const Surface ellipsoid = taut::parse_surface("x^2+y^2+4z^2=1");
  const Vector p = Eigen::Vector3d(1, 0, 0);
  const Vector q = Eigen::Vector3d(0, 0.6, 0.4);
  Points points(3, 3);
  points << 1, 0, 0, 0, 1, 0, 0, 0, 0.5;
  const Points loop = (Points(3, 4) << 1, 0, -1, 0, 0, 1, 0, -1, 0, 0, 0, 0).finished();
  const Points controls = (Points(3, 4) << 1, 0.8, 0.6, 0, 0, 0.6, 0.8, 1, 0, 0, 0, 0).finished();
  const taut::PathResult path = taut::shortest_path(ellipsoid, p, q);

  check("accuracy", accuracy(ellipsoid, p, q));
  check("command_line", command_line(p, q));
  check("json", json(ellipsoid, p, q));
  check("troubleshooting", troubleshooting(ellipsoid, p, q));
  check("shortest", shortest(ellipsoid, p, q));
  check("many_dimensions", many_dimensions(ellipsoid, p, q));
  check("edges", edges(Eigen::Vector3d(0.5, 0, 1), Eigen::Vector3d(2, 0, 0)));
  check("loops", loops(ellipsoid, path.points, loop));
  check("field", field(ellipsoid, p, points));
  check("matrix", matrix(ellipsoid, points));
  check("sample", sample(ellipsoid, p, points));
  check("log", log(ellipsoid, p, q, points, Eigen::Vector3d(0, 0, 1)));
  check("curve", curve(ellipsoid, controls));
  check("view", view(ellipsoid, path));
  check("formula", formula());
  check("files", files(path));
  check("fitting", fitting());
  check("rbf", rbf());
  check("volumes", volumes(Eigen::Vector3d(-0.9947, 0, 0.8434), Eigen::Vector3d(0.9947, 0.8434, 0)));
  check("heights", heights());
  check("networks", networks());
  check("cells", cells(ellipsoid, p));
  check("mesh", mesh(ellipsoid));
  check("march", march(ellipsoid, p, q, 0.05, points));
  check("newton", newton(ellipsoid, path.points));
  check("flow", flow(ellipsoid, path.points));
  check("exp", exp(ellipsoid, p, Eigen::Vector3d(0, 1, 1)));
  return failures;
}
