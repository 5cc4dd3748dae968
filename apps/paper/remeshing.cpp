// Surface remeshing (Peyre and Cohen): points as far from each other as can be, joined where their regions meet.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "applications.hpp"
#include "geodesic_delaunay.hpp"
#include "models.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"

namespace taut::paper {
namespace {

constexpr Index kPoints = 500;

/// Flat triangles with dark rims, so that edges are seen where they are not hidden.
SceneMesh with_rims(const TriangleMesh& mesh) {
  constexpr double kRim = 0.13;  // of the way to the middle of a triangle
  constexpr Colour kFill = Colour::hex(0xe6ebf0);
  constexpr Colour kEdge = Colour::hex(0x3c5877);
  SceneMesh scene_mesh{.mesh = {.vertices = Points(3, 9 * mesh.faces.cols()),
                                .faces = Eigen::Matrix3Xi(3, 7 * mesh.faces.cols()),
                                .normals = Points(3, 9 * mesh.faces.cols()),
                                .scalars = {}},
                       .colours = Points(3, 9 * mesh.faces.cols())};
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    Eigen::Matrix3d corners;
    for (int i = 0; i < 3; ++i) corners.col(i) = mesh.vertices.col(mesh.faces(i, f));
    const Eigen::Vector3d middle = corners.rowwise().mean();
    const Eigen::Vector3d normal =
        (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).normalized();
    const auto first = static_cast<int>(9 * f);  // three corners, the inner triangle's, and those again for its colour
    for (int i = 0; i < 9; ++i) {
      const Eigen::Vector3d corner = corners.col(i % 3);
      scene_mesh.mesh.vertices.col(first + i) = i < 3 ? corner : Eigen::Vector3d(corner + kRim * (middle - corner));
      scene_mesh.mesh.normals.col(first + i) = normal;
      const Colour& colour = i < 6 ? kEdge : kFill;
      scene_mesh.colours.col(first + i) << static_cast<double>(colour.red), static_cast<double>(colour.green),
          static_cast<double>(colour.blue);
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      scene_mesh.mesh.faces.col(7 * f + 2 * i) << first + i, first + j, first + 3 + j;
      scene_mesh.mesh.faces.col(7 * f + 2 * i + 1) << first + i, first + 3 + j, first + 3 + i;
    }
    scene_mesh.mesh.faces.col(7 * f + 6) << first + 6, first + 7, first + 8;
  }
  return scene_mesh;
}

}  // namespace

void write_remeshing(Study& study, Section& section) {
  const Model& body = model(study, ModelKind::sculpture);
  const ProcessorClock clock;
  const Vector extent = body.cloud.points.rowwise().maxCoeff() - body.cloud.points.rowwise().minCoeff();
  SurfaceCells cells(body.surface, grow(body.surface, body.cloud.points, extent.norm() / 110, study.context),
                     study.context);
  const SurfaceMesh fine = mesh_surface(body.surface, cells.grid(), {}, study.context);
  const FarthestPoints chosen = farthest_points(body.surface, cells, cells.point(0), kPoints, study.context);
  const TriangleMesh mesh = geodesic_delaunay(chosen, fine);
  const double seconds = clock.seconds();

  Scene scene;
  scene.title = fmt::format("{} points", kPoints);
  scene.up = body.up;
  scene.meshes.push_back(with_rims(mesh));
  Scene before = scene;
  before.title = fmt::format("{} vertices on cells", fine.vertices.cols());
  before.meshes = {{.mesh = fine, .colour = Colour::hex(0xe2e7ec)}};
  std::vector<Figure> pictures;
  const PictureOptions portrait{.width = 560, .height = 640, .towards_viewer = body.towards_viewer};
  pictures.push_back(figure_of("remeshing_before", "The surface as it is displayed.", before, portrait));
  pictures.push_back(figure_of("remeshing_after",
                               "Remeshed: every vertex is a surface point, every triangle joins three "
                               "geodesic Voronoi regions.",
                               scene, portrait));
  section.add_row(std::move(pictures));

  Vector angles = smallest_angles(mesh);
  std::ranges::sort(angles);
  Table table{.name = "remeshing",
              .title = fmt::format("{}: {} farthest points, joined by the geodesic Delaunay rule", body.name, kPoints),
              .columns = {{"points"},
                          {"triangles"},
                          {"Euler number"},
                          {"of the surface"},
                          {"cover radius", "{:.4g}"},
                          {"median of smallest angles, °", "{:.1f}"},
                          {"1 % of triangles below, °", "{:.1f}"},
                          {"seconds", "{:.2f}"}}};
  table.add({kPoints, mesh.faces.cols(), euler_number(mesh), euler_number(fine), chosen.cover.back(),
             angles(angles.size() / 2), angles(angles.size() / 100), seconds});
  section.add(std::move(table));
}

}  // namespace taut::paper
