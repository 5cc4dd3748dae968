// The opponent on meshes for all distances at once: CGAL's heat method. CGAL's package is GPL: this program stands
// alone, is built only with TAUT_BUILD_BENCH, and shares no code with Taut.
//
//   opponent_heat MESH PAIRS.csv COUNT
//
// MESH: triangles. PAIRS.csv: p1,p2,p3,q1,q2,q3 a line. For each of the first COUNT pairs one field from the vertex
// nearest to p, read at the vertex nearest to q. Prints the seconds to prepare, then a line a pair: both vertices, the
// distance, seconds.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Heat = CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh, CGAL::Heat_method_3::Intrinsic_Delaunay>;
using Clock = std::chrono::steady_clock;

Mesh::Vertex_index nearest(const Mesh& mesh, const Point& x) {
  Mesh::Vertex_index best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto v : mesh.vertices()) {
    const double distance = CGAL::squared_distance(mesh.point(v), x);
    if (distance < least) {
      least = distance;
      best = v;
    }
  }
  return best;
}

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

}  // namespace

int main(int argc, char** argv) {
  Mesh mesh;
  if (argc != 4 || !CGAL::IO::read_polygon_mesh(argv[1], mesh)) {
    std::fprintf(stderr, "usage: opponent_heat MESH PAIRS.csv COUNT\n");
    return 3;
  }
  auto distance = mesh.add_property_map<Mesh::Vertex_index, double>("v:distance", 0).first;
  const auto start = Clock::now();
  Heat heat(mesh);
  // The factorizations are made for the first source.
  heat.add_source(*mesh.vertices().begin());
  heat.estimate_geodesic_distances(distance);
  heat.clear_sources();
  std::printf("%.6g\n", seconds_since(start));
  std::ifstream file(argv[2]);
  int count = std::stoi(argv[3]);
  for (std::string line; count-- > 0 && std::getline(file, line);) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream numbers(line);
    double x[6];
    for (double& value : x) numbers >> value;
    const Point p(x[0], x[1], x[2]);
    const Point q(x[3], x[4], x[5]);
    const auto from = nearest(mesh, p);
    const auto to = nearest(mesh, q);
    const auto begin = Clock::now();
    heat.add_source(from);
    heat.estimate_geodesic_distances(distance);
    heat.remove_source(from);
    const double seconds = seconds_since(begin);
    for (const Point& x : {mesh.point(from), mesh.point(to)}) std::printf("%.17g,%.17g,%.17g,", x.x(), x.y(), x.z());
    std::printf("%.17g,%.6g\n", get(distance, to), seconds);
  }
  return 0;
}
