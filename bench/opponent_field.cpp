// The opponents on meshes for all distances from one vertex: CGAL's heat method and its exact polyhedral distances.
// CGAL's packages are GPL: this program stands alone, is built only with TAUT_BUILD_BENCH, and shares no code with
// Taut.
//
//   opponent_field MESH.off VERTEX heat|polyhedral DISTANCES
//
// Prints the seconds to prepare (heat: factorization; polyhedral: the sequence tree) and the seconds to have the
// distances of all vertices; writes these as 64-bit floats, in the order of the file, to DISTANCES.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Heat_method_3/Surface_mesh_geodesic_distances_3.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_shortest_path.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cstdio>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Heat = CGAL::Heat_method_3::Surface_mesh_geodesic_distances_3<Mesh, CGAL::Heat_method_3::Intrinsic_Delaunay>;
using ShortestPath = CGAL::Surface_mesh_shortest_path<CGAL::Surface_mesh_shortest_path_traits<Kernel, Mesh>>;

/// Of the processor: other programs may run beside.
double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main(int argc, char** argv) {
  Mesh mesh;
  if (argc != 5 || !CGAL::IO::read_polygon_mesh(argv[1], mesh)) {
    std::fprintf(stderr, "usage: opponent_field MESH.off VERTEX heat|polyhedral DISTANCES\n");
    return 3;
  }
  const Mesh::Vertex_index source(static_cast<Mesh::size_type>(std::stoul(argv[2])));
  std::vector<double> distances;
  const double start = seconds();
  double prepared = 0;
  double solved = 0;
  if (std::string(argv[3]) == "heat") {
    auto distance = mesh.add_property_map<Mesh::Vertex_index, double>("v:distance", 0).first;
    Heat heat(mesh);
    heat.add_source(source);
    heat.estimate_geodesic_distances(distance);  // factorizes
    prepared = seconds() - start;
    heat.remove_source(source);
    heat.add_source(source);
    const double again = seconds();
    heat.estimate_geodesic_distances(distance);
    solved = seconds() - again;
    for (const auto v : mesh.vertices()) distances.push_back(get(distance, v));
  } else {
    ShortestPath paths(mesh);
    paths.add_source_point(source);
    paths.build_sequence_tree();
    prepared = seconds() - start;
    const double again = seconds();
    for (const auto v : mesh.vertices()) distances.push_back(paths.shortest_distance_to_source_points(v).first);
    solved = seconds() - again;
  }
  std::ofstream(argv[4], std::ios::binary)
      .write(reinterpret_cast<const char*>(distances.data()),
             static_cast<std::streamsize>(distances.size() * sizeof(double)));
  std::printf("%.6g %.6g\n", prepared, solved);
  return 0;
}
