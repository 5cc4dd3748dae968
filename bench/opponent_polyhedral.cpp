// The opponent on meshes: exact polyhedral geodesics by CGAL's Surface_mesh_shortest_path (continuous Dijkstra, Xin and
// Wang). CGAL's package is GPL: this program stands alone, is built only with TAUT_BUILD_BENCH, and shares no code with
// Taut.
//
//   opponent_polyhedral MESH PAIRS.csv
//   opponent_polyhedral MESH --distances POINTS.csv
//   opponent_polyhedral MESH --count
//
// MESH: .obj .off .ply .stl, triangles or polygons. PAIRS.csv: a line a pair, p1,p2,p3,q1,q2,q3 or @i,@j (points of the
// file, from 0); each point is moved to the nearest point of the mesh. Prints a CSV line a pair:
// length,offset_from,offset_to,seconds (model units; the offsets are how far the points were moved; seconds = building
// the sequence tree for the source plus the query). A pair in different components gives inf. The second form prints
// the largest and the mean distance of the points (x,y,z a line) to the mesh, the third the number of points in the
// file. Exit code 3 when something cannot be read.

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

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
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

/// `points` receives the points of the file, in their order.
bool read_mesh(const std::string& path, Mesh& mesh, std::vector<Point>& points_of_file) {
  namespace PMP = CGAL::Polygon_mesh_processing;
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  if (!CGAL::IO::read_polygon_soup(path, points, polygons) || polygons.empty()) return false;
  points_of_file = points;
  PMP::repair_polygon_soup(points, polygons);
  PMP::orient_polygon_soup(points, polygons);
  PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  PMP::triangulate_faces(mesh);
  return true;
}

/// Lines of numbers, or of @i for the coordinates of a point of the file.
bool read_points(const std::string& path, const std::vector<Point>& points_of_file, std::size_t points_a_line,
                 std::vector<Point>& points) {
  std::ifstream file(path);
  if (!file) return false;
  std::string line;
  while (std::getline(file, line)) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream fields(line);
    std::vector<double> numbers;
    std::string word;
    while (fields >> word) {
      if (word[0] == '@') {
        const std::size_t index = std::stoul(word.substr(1));
        if (index >= points_of_file.size()) return false;
        for (int c = 0; c < 3; ++c) numbers.push_back(points_of_file[index][c]);
      } else {
        numbers.push_back(std::stod(word));
      }
    }
    if (numbers.empty()) continue;
    if (numbers.size() < 3 * points_a_line) return false;
    for (std::size_t i = 0; i < points_a_line; ++i) {
      points.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
    }
  }
  return true;
}

int report_distances(const Tree& tree, const std::vector<Point>& points) {
  double largest = 0;
  double sum = 0;
  for (const Point& p : points) {
    const double distance = std::sqrt(tree.squared_distance(p));
    largest = std::max(largest, distance);
    sum += distance;
  }
  std::printf("%.3g,%.3g\n", largest, points.empty() ? 0 : sum / static_cast<double>(points.size()));
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  const bool count = argc == 3 && std::string(argv[2]) == "--count";
  const bool distances = argc == 4 && std::string(argv[2]) == "--distances";
  if (argc != 3 && !distances) {
    std::fprintf(stderr, "usage: opponent_polyhedral MESH PAIRS.csv | --distances POINTS.csv | --count\n");
    return 2;
  }
  Mesh mesh;
  std::vector<Point> points_of_file;
  if (!read_mesh(argv[1], mesh, points_of_file)) {
    std::fprintf(stderr, "opponent_polyhedral: %s: no triangles could be read\n", argv[1]);
    return 3;
  }
  if (count) {
    std::printf("%zu\n", points_of_file.size());
    return 0;
  }
  std::vector<Point> points;
  if (!read_points(argv[argc - 1], points_of_file, distances ? 1 : 2, points)) {
    std::fprintf(stderr, "opponent_polyhedral: %s: cannot be read\n", argv[argc - 1]);
    return 3;
  }
  Tree tree;
  ShortestPath shortest_path(mesh);
  shortest_path.build_aabb_tree(tree);
  if (distances) return report_distances(tree, points);

  std::fprintf(stderr, "opponent_polyhedral: %zu vertices, %zu triangles\n",
               static_cast<std::size_t>(num_vertices(mesh)), static_cast<std::size_t>(num_faces(mesh)));
  std::printf("length,offset_from,offset_to,seconds\n");
  for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
    const auto begin = std::chrono::steady_clock::now();
    const auto source = shortest_path.locate(points[i], tree);
    const auto target = shortest_path.locate(points[i + 1], tree);
    shortest_path.remove_all_source_points();
    shortest_path.add_source_point(source);
    const double length = shortest_path.shortest_distance_to_source_points(target.first, target.second).first;
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    const auto offset = [&](const Point& p, const auto& location) {
      return std::sqrt(CGAL::squared_distance(p, shortest_path.point(location.first, location.second)));
    };
    std::printf("%.17g,%.3g,%.3g,%.3g\n", length < 0 ? std::numeric_limits<double>::infinity() : length,
                offset(points[i], source), offset(points[i + 1], target), time.count());
    std::fflush(stdout);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "opponent_polyhedral: %s\n", error.what());
  return 3;
}
