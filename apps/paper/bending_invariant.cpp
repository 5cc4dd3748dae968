// Bending invariant (Elad and Kimmel): geodesic distances do not change when a surface is bent, so multidimensional
// scaling of their matrix gives the same form for every pose.

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "applications.hpp"
#include "bent_sheet.hpp"
#include "classical_mds.hpp"
#include "distance_matrix.hpp"
#include "inertia.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/fit.hpp"

namespace taut::paper {
namespace {

constexpr Index kSamples = 700;
constexpr Index kColumns = 7;  // of the points that are compared
constexpr Index kRows = 4;

/// The places that are compared, (s, y), well inside the strip.
Points places(const BentSheet& sheet) {
  Points places(2, kColumns * kRows);
  for (Index i = 0; i < kColumns; ++i) {
    for (Index j = 0; j < kRows; ++j) {
      places.col(i * kRows + j) << sheet.length * (0.07 + 0.86 * static_cast<double>(i) / (kColumns - 1)),
          sheet.width * (0.1 + 0.8 * static_cast<double>(j) / (kRows - 1));
    }
  }
  return places;
}

struct Pose {
  std::string name;
  BentSheet sheet;
  Surface surface;
  Points points;             // 3 x n
  Eigen::MatrixXd geodesic;  // n x n
};

Pose make_pose(const std::string& name, const BentSheet& sheet, const Context& context) {
  Surface surface = make_surface(std::make_shared<const RbfModel>(fit_rbf(sheet.cloud(kSamples), {}, context)));
  const Points at = places(sheet);
  Points points(3, at.cols());
  for (Index i = 0; i < at.cols(); ++i) points.col(i) = sheet.point(at(0, i), at(1, i));
  PathSolver solver(surface, {.tolerance = 1e-7}, context);
  Eigen::MatrixXd geodesic = distance_matrix(solver, points);
  return {name, sheet, std::move(surface), std::move(points), std::move(geodesic)};
}

Eigen::MatrixXd chords(const Points& points) {
  Eigen::MatrixXd distances(points.cols(), points.cols());
  for (Index i = 0; i < points.cols(); ++i) distances.col(i) = (points.colwise() - points.col(i)).colwise().norm();
  return distances;
}

/// Largest |a - b| / b off the diagonal.
double largest_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double largest = 0;
  for (Index i = 0; i < a.cols(); ++i) {
    for (Index j = 0; j < i; ++j) largest = std::max(largest, std::abs(a(i, j) / b(i, j) - 1));
  }
  return largest;
}

Figure pose_picture(const Pose& pose, const std::string& file, const Context& context) {
  Scene scene;
  scene.title = pose.name;
  scene.meshes.push_back({.mesh = display_mesh(pose.surface, {}, context), .colour = Colour::hex(0xcdd8e4)});
  for (const auto& x : pose.points.colwise()) scene.points.push_back({.position = x, .colour = kRed});
  return figure_of(file, "A flat strip, bent: the points that are compared.", scene,
                   {.width = 560, .height = 460, .towards_viewer = {0.35, -1, 0.75}});
}

}  // namespace

void write_bending_invariant(Study& study, Section& section) {
  const BentSheet wave{.wave = 1.25};
  const BentSheet roll{.roll = 5.0};
  const ProcessorClock clock;
  const Pose first = make_pose("Bent into a wave", wave, study.context);
  const Pose second = make_pose("Bent into a roll", roll, study.context);
  const double seconds = clock.seconds();
  const Points flat = places(wave);
  const Eigen::MatrixXd truth = chords(flat);
  const Embedding first_form = classical_mds(first.geodesic, 3);
  const Embedding second_form = classical_mds(second.geodesic, 3);
  Points flat_in_space = Points::Zero(3, flat.cols());
  flat_in_space.topRows(2) = flat;

  std::vector<Figure> pictures;
  pictures.push_back(pose_picture(first, "bending_wave", study.context));
  pictures.push_back(pose_picture(second, "bending_roll", study.context));
  section.add_row(std::move(pictures));
  Table table{.name = "bending_invariant",
              .title = fmt::format("Two poses of one strip, {} points, {} pairs", flat.cols(),
                                   flat.cols() * (flat.cols() - 1) / 2),
              .columns = {{"pose"},
                          {"geodesic distances against the flat strip, largest difference", "{:.1e}"},
                          {"straight distances against the flat strip", "{:.2f}"},
                          {"eigenvalue 1", "{:.4f}"},
                          {"2", "{:.4f}"},
                          {"3", "{:.1e}"},
                          {"form against the flat strip, rms", "{:.1e}"}}};
  Chart chart{.title = "The form of either pose, laid over the flat strip",
              .x = {"along the strip"},
              .y = {"across"},
              .series = {{.name = "flat strip", .colour = kGrey, .line = false, .radius = 9, .hollow = true}},
              .height = 400,
              .legend_above = true,
              .equal_scales = true};
  const auto series_of = [](const Points& points) {
    std::pair<std::vector<double>, std::vector<double>> xy;
    for (const auto& x : points.colwise()) {
      xy.first.push_back(x(0));
      xy.second.push_back(x(1));
    }
    return xy;
  };
  std::tie(chart.series[0].x, chart.series[0].y) = series_of(flat);
  for (const auto& [pose, form, colour] : {std::tuple{&first, &first_form, kBlue}, {&second, &second_form, kRed}}) {
    const Alignment laid = align(form->points, flat_in_space);
    table.add({pose->name, largest_difference(pose->geodesic, truth), largest_difference(chords(pose->points), truth),
               form->eigenvalues(0), form->eigenvalues(1), form->eigenvalues(2), laid.rms});
    auto [x, y] = series_of(laid.points);
    chart.series.push_back({.name = pose->name,
                            .x = std::move(x),
                            .y = std::move(y),
                            .colour = colour,
                            .line = false,
                            .radius = colour.red > colour.blue ? 3.0 : 6.0});
  }
  section.add(std::move(table));
  section.add(figure_of("bending_forms",
                        "Multidimensional scaling of the matrix of geodesic distances, turned onto the flat strip: the "
                        "poses cannot be told apart.",
                        chart));
  section.text(
      fmt::format("The matrices of the two poses differ by at most {}; fits, cells and all paths took {:.1f} s.",
                  readable_number(largest_difference(first.geodesic, second.geodesic), "{:.1e}"), seconds));
}

}  // namespace taut::paper
