// Length measurement: a tape over a face.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "applications.hpp"
#include "models.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_mesh.hpp"

namespace taut::paper {
namespace {

/// The sample farthest in a direction, of those within a part of the extent from the middle in another.
Vector extreme_sample(const Points& points, const Eigen::Vector3d& direction, const Eigen::Vector3d& across,
                      double part) {
  const Vector along = points.transpose() * direction;
  const Vector aside = points.transpose() * across;
  const double middle = 0.5 * (aside.minCoeff() + aside.maxCoeff());
  const double reach = 0.5 * part * (aside.maxCoeff() - aside.minCoeff());
  Index best = -1;
  for (Index i = 0; i < points.cols(); ++i) {
    if (std::abs(aside(i) - middle) > reach) continue;
    if (best < 0 || along(i) > along(best)) best = i;
  }
  return points.col(best);
}

}  // namespace

void write_length_measurement(Study& study, Section& section) {
  const Model& face = model(study, ModelKind::face);
  const Eigen::Vector3d up = face.up;
  const Eigen::Vector3d front = face.is_real ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d(-Eigen::Vector3d::UnitY());
  const Eigen::Vector3d right = up.cross(front);
  // A scan's rim is rough: ends are taken a little inside.
  const Points& all = face.cloud.points;
  const Vector height = all.transpose() * up;
  const Vector side = all.transpose() * right;
  constexpr double kInside = 0.86;
  std::vector<Index> inner;
  for (Index i = 0; i < all.cols(); ++i) {
    const double h =
        (height(i) - 0.5 * (height.minCoeff() + height.maxCoeff())) / (0.5 * (height.maxCoeff() - height.minCoeff()));
    const double s =
        (side(i) - 0.5 * (side.minCoeff() + side.maxCoeff())) / (0.5 * (side.maxCoeff() - side.minCoeff()));
    if (std::hypot(h, s) < kInside) inner.push_back(i);
  }
  const Points points = all(Eigen::all, inner);
  const Vector nose = extreme_sample(points, front, right, 0.3);
  const Vector chin = extreme_sample(points, -up, right, 0.1);
  const Vector brow = extreme_sample(points, up, right, 0.1);
  const Vector left = extreme_sample(points, -right, up, 0.15);
  const Vector other = extreme_sample(points, right, up, 0.15);

  PathSolver solver(face.surface, {}, study.context);
  Table table{.name = "length_measurement",
              .title = "Lengths over the face, in the model’s units",
              .columns = {{"measure"},
                          {"straight", "{:.4f}"},
                          {"over the surface", "{:.9f}"},
                          {"error estimate", "{:.1e}"},
                          {"status"},
                          {"seconds", "{:.2f}"}}};
  Scene scene;
  scene.title = "A tape over the face";
  scene.up = face.up;
  scene.meshes.push_back({.mesh = display_mesh(face.surface, {}, study.context), .colour = Colour::hex(0xe3d6cb)});
  struct Measure {
    std::string name;
    std::vector<Vector> through;
    Colour colour;
  };
  for (const Measure& measure :
       {Measure{"cheek to cheek over the nose", {left, nose, other}, kRed},
        Measure{"cheek to cheek, shortest", {left, other}, kBlue}, Measure{"forehead to chin", {brow, chin}, kGreen}}) {
    Points way(3, static_cast<Index>(measure.through.size()));
    for (std::size_t i = 0; i < measure.through.size(); ++i) way.col(static_cast<Index>(i)) = measure.through[i];
    const ProcessorClock clock;
    const ViaResult path = path_through(solver, way);
    table.add({measure.name, (way.rightCols(1) - way.col(0)).norm(), path.length, path.length_error,
               std::string(to_string(path.status)), clock.seconds()});
    if (path.points.cols() > 1)
      scene.paths.push_back(
          {.points = path.points, .label = measure.name, .colour = measure.colour, .length = path.length});
  }
  section.add(figure_of("length_measurement", fmt::format("{} ({}).", face.name, escape_markup(face.origin)), scene,
                        {.width = 640, .height = 680, .towards_viewer = face.towards_viewer}));
  section.add(std::move(table));
}

}  // namespace taut::paper
