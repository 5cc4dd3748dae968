// The opponent on meshes: exact polyhedral geodesics by CGAL's Surface_mesh_shortest_path (continuous Dijkstra, Xin and
// Wang). CGAL's package is GPL: this program stands alone, is built only with TAUT_BUILD_BENCH, and shares no code with
// Taut.
//
//   opponent_polyhedral MESH PAIRS.csv
//
// MESH: .obj .off .ply .stl, triangles or polygons. PAIRS.csv: a line p1,p2,p3,q1,q2,q3 a pair; each point is moved to
// the nearest point of the mesh. Prints a CSV line a pair: length,offset_from,offset_to,seconds (model units; the
// offsets are how far the points were moved; seconds = building the sequence tree for the source plus the query). A
// pair in different components gives inf. Exit code 3 when the mesh or the pairs cannot be read.

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/triangulate_faces.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Traits = CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>;
using ShortestPath = CGAL::Surface_mesh_shortest_path<Traits>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

bool read_mesh(const std::string& path, Mesh& mesh) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_polygon_soup(path, points, polygons) || polygons.empty()) return false;
  PMP::repair_polygon_soup(points, polygons);
  PMP::orient_polygon_soup(points, polygons);
  PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  PMP::triangulate_faces(mesh);
  return true;
}

bool read_pairs(const std::string& path, std::vector<std::pair<Point, Point>>& pairs) {
  std::ifstream file(path);
  if (!file) return false;
  std::string line;
  while (std::getline(file, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream fields(line);
    double v[6];
    int count = 0;
    while (count < 6 && fields >> v[count]) ++count;
    if (count == 0) continue;
    if (count < 6) return false;
    pairs.emplace_back(Point(v[0], v[1], v[2]), Point(v[3], v[4], v[5]));
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: opponent_polyhedral MESH PAIRS.csv\n");
    return 2;
  }
  Mesh mesh;
  std::vector<std::pair<Point, Point>> pairs;
  if (!read_mesh(argv[1], mesh)) {
    std::fprintf(stderr, "opponent_polyhedral: %s: no triangles could be read\n", argv[1]);
    return 3;
  }
  if (!read_pairs(argv[2], pairs)) {
    std::fprintf(stderr, "opponent_polyhedral: %s: needs six numbers a line\n", argv[2]);
    return 3;
  }
  std::fprintf(stderr, "opponent_polyhedral: %zu vertices, %zu triangles\n",
               static_cast<std::size_t>(num_vertices(mesh)), static_cast<std::size_t>(num_faces(mesh)));

  Tree tree;
  ShortestPath shortest_path(mesh);
  shortest_path.build_aabb_tree(tree);
  std::printf("length,offset_from,offset_to,seconds\n");
  for (const auto& [from, to] : pairs) {
    const auto begin = std::chrono::steady_clock::now();
    const auto source = shortest_path.locate(from, tree);
    const auto target = shortest_path.locate(to, tree);
    const Point at_source = shortest_path.point(source.first, source.second);
    const Point at_target = shortest_path.point(target.first, target.second);
    shortest_path.remove_all_source_points();
    shortest_path.add_source_point(source);
    const double length = shortest_path.shortest_distance_to_source_points(target.first, target.second).first;
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    std::printf("%.17g,%.3g,%.3g,%.3g\n", length < 0 ? std::numeric_limits<double>::infinity() : length,
                std::sqrt(CGAL::squared_distance(from, at_source)), std::sqrt(CGAL::squared_distance(to, at_target)),
                time.count());
    std::fflush(stdout);
  }
  return 0;
}
