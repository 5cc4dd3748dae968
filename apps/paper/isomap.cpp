// Isomap (Tenenbaum et al.) and manifold interpolation, on the swiss roll, whose distances are known.

#include "isomap.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "applications.hpp"
#include "classical_mds.hpp"
#include "curves.hpp"
#include "distance_matrix.hpp"
#include "rolled_sheet.hpp"
#include "taut/surface/fit.hpp"

namespace taut::paper {
namespace {

constexpr Index kSamples = 1500;
constexpr Index kEmbedded = 36;
constexpr Index kNeighbours = 8;

struct Deviation {
  double mean = 0;  // of |found / truth - 1|
  double worst = 0;
};

Deviation deviation(const Eigen::MatrixXd& found, const Eigen::MatrixXd& truth) {
  Deviation deviation;
  Index count = 0;
  for (Index i = 0; i < truth.cols(); ++i) {
    for (Index j = 0; j < i; ++j, ++count) {
      const double relative = std::abs(found(i, j) / truth(i, j) - 1);
      deviation.mean += relative;
      deviation.worst = std::max(deviation.worst, relative);
    }
  }
  deviation.mean /= static_cast<double>(count);
  return deviation;
}

}  // namespace

void write_isomap(Study& study, Section& section) {
  const RolledSheet sheet{.height = 21};
  Points at;  // (t, y) of every sample
  const PointCloud cloud = sheet.cloud(kSamples, &at);
  // Samples inside the sheet, evenly over it.
  Eigen::VectorX<Index> chosen(kEmbedded);
  Index count = 0;
  constexpr Index kStride = 37;  // coprime to the golden ratio's convergents, so that heights vary, too
  for (Index i = kStride; count < kEmbedded && i < kSamples; i += kStride) {
    if (at(1, i) > 1 && at(1, i) < 20) chosen(count++) = i;
  }
  chosen.conservativeResize(count);
  Points flat(2, count);
  Points points(3, count);
  Eigen::MatrixXd truth(count, count);
  for (Index i = 0; i < count; ++i) {
    flat.col(i) << RolledSheet::arc_length(at(0, chosen(i))), at(1, chosen(i));
    points.col(i) = cloud.points.col(chosen(i));
    for (Index j = 0; j < count; ++j) truth(i, j) = RolledSheet::distance(at.col(chosen(i)), at.col(chosen(j)));
  }

  const ProcessorClock graph_clock;
  const Eigen::MatrixXd to_all = isomap_distances(cloud.points, kNeighbours, chosen);
  Eigen::MatrixXd graph(count, count);
  for (Index i = 0; i < count; ++i) graph.row(i) = to_all.row(chosen(i));
  const double graph_seconds = graph_clock.seconds();
  const ProcessorClock clock;
  const Surface surface = make_surface(std::make_shared<const RbfModel>(fit_rbf(cloud, {}, study.context)));
  PathSolver solver(surface, {.tolerance = 1e-6}, study.context);
  const Eigen::MatrixXd geodesic = distance_matrix(solver, points);
  const double seconds = clock.seconds();

  Table table{
      .name = "isomap",
      .title = fmt::format("Distances between {} of {} samples of the swiss roll, and what scaling makes of them",
                           count, kSamples),
      .columns = {{"distances"},
                  {"mean relative error", "{:.1e}"},
                  {"largest", "{:.1e}"},
                  {"embedding against the unrolled sheet, rms", "{:.4f}"},
                  {"seconds", "{:.2f}"}}};
  Chart chart{.title = "The swiss roll unrolled",
              .x = {"along the sheet"},
              .y = {"height"},
              .series = {{.name = "truth", .colour = kGrey, .line = false, .radius = 7, .hollow = true}},
              .width = 760,
              .height = 330,
              .legend_above = true,
              .equal_scales = true};
  for (const auto& x : flat.colwise()) {
    chart.series[0].x.push_back(x(0));
    chart.series[0].y.push_back(x(1));
  }
  for (const auto& [name, distances, colour, time] : {std::tuple<std::string, const Eigen::MatrixXd*, Colour, double>{
                                                          "Isomap’s graph", &graph, kAmber, graph_seconds},
                                                      {"geodesics", &geodesic, kBlue, seconds}}) {
    const Deviation off = deviation(*distances, truth);
    const Alignment laid = align(classical_mds(*distances, 2).points, flat);
    table.add({name, off.mean, off.worst, laid.rms, time});
    Series series{.name = name, .colour = colour, .line = false, .radius = 3.2};
    for (const auto& x : laid.points.colwise()) {
      series.x.push_back(x(0));
      series.y.push_back(x(1));
    }
    chart.series.push_back(std::move(series));
  }
  section.text(
      fmt::format("Isomap stands for geodesics by shortest walks over a graph of {} nearest neighbours. Here the same "
                  "samples are made into "
                  "a surface, and the geodesics on it take the graph’s place.",
                  kNeighbours));
  section.add(figure_of("isomap", "Both embeddings, laid over the truth.", chart));
  section.add(std::move(table));

  // Interpolation: half-way between two samples.
  Table between{
      .name = "manifold_interpolation",
      .title = "Half-way between two samples: along the straight line, and along the geodesic",
      .columns = {{"pair"}, {"straight: off the sheet", "{:.3f}"}, {"geodesic: off the true middle", "{:.1e}"}}};
  for (Index pair = 0; pair < 6; ++pair) {
    const Index i = pair;
    const Index j = count - 1 - 2 * pair;
    const PathResult path = solver.solve(points.col(i), points.col(j));
    const Eigen::Vector2d middle = 0.5 * (flat.col(i) + flat.col(j));
    const Eigen::Vector3d true_middle = RolledSheet::point(RolledSheet::angle_at(middle.x()), middle.y());
    const Eigen::Vector3d straight = 0.5 * (points.col(i) + points.col(j));
    double off = 1e300;
    constexpr int kProbes = 4000;  // of the spiral
    for (int k = 0; k <= kProbes; ++k) {
      const double t = RolledSheet::kInnerAngle + (RolledSheet::kOuterAngle - RolledSheet::kInnerAngle) * k / kProbes;
      off = std::min(off, (RolledSheet::point(t, straight.y()) - straight).norm());
    }
    if (path.points.cols() < 2) continue;
    const double miss = (point_along(path.points, 0.5 * polyline_length(path.points)) - true_middle).norm();
    between.add({pair + 1, off, miss});
  }
  section.add(std::move(between));
}

}  // namespace taut::paper
