// Figure 3: geodesics on a rolled-up sheet.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "paper_chain.hpp"
#include "parts.hpp"
#include "rolled_sheet.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/projection.hpp"

namespace taut::paper {
namespace {

constexpr Index kSamples = 700;
/// From the first the march passes from turn to turn, from the second it goes round.
constexpr double kCells[] = {0.8, 0.5};

/// Two places by (angle, height).
struct RollPair {
  std::string name;
  Eigen::Vector2d from, to;
};

std::vector<RollPair> pairs() {
  return {{"face to face, from turn to turn", {2 * std::numbers::pi, 4}, {4 * std::numbers::pi, 4}},
          {"over all turns", {1.6 * std::numbers::pi, 1.6}, {4.3 * std::numbers::pi, 6.4}},
          {"on one turn", {3 * std::numbers::pi, 2.4}, {3.2 * std::numbers::pi, 4.8}}};
}

/// On the fitted surface: the ends of a flow stay where they are.
Vector place(const Surface& roll, const Eigen::Vector2d& at) {
  return project_to_surface(roll, RolledSheet::point(at.x(), at.y())).point;
}

struct RollPaths {
  Table table;
  std::vector<Chain> chains;  ///< from the finer cells
};

RollPaths find_paths(const Surface& roll, const Context& context) {
  RollPaths paths{.table = {.name = "figure3_roll",
                            .title = "Paths on the roll: the paper's chain (Algorithm II, fast marching, projection, "
                                     "flow), and Newton's method",
                            .columns = {{"pair"},
                                        {"cell", "{:.1f}"},
                                        {"through the air", "{:.3f}"},
                                        {"truth", "{:.5f}"},
                                        {"chain", "{:.5f}"},
                                        {"relative error", "{:.1e}"},
                                        {"status"},
                                        {"m"},
                                        {"inserted by ε_E"},
                                        {"inserted by (5)"},
                                        {"Newton", "{:.5f}"},
                                        {"relative error ", "{:.1e}"},
                                        {"chain, s", "{:.2f}"},
                                        {"Newton, s", "{:.2f}"}}},
                  .chains = {}};
  for (const double cell : kCells) {
    PathSolver newton(roll, {.cell = cell}, context);
    for (const RollPair& pair : pairs()) {
      const Vector from = place(roll, pair.from);
      const Vector to = place(roll, pair.to);
      const double truth = RolledSheet::distance(pair.from, pair.to);
      const ProcessorClock chain_clock;
      Chain chain = run_chain(roll, from, to, {.cell = cell}, context);
      const double chain_seconds = chain_clock.seconds();
      const ProcessorClock newton_clock;
      const PathResult by_newton = newton.solve(from, to);
      const FlowSummary& summary = chain.flow.summary;
      paths.table.add({pair.name, cell, (to - from).norm(), truth, chain.flow.length, chain.flow.length / truth - 1,
                       std::string(to_string(chain.flow.status)), summary.num_intervals, summary.num_inserted,
                       summary.num_plane_inserted, by_newton.length, by_newton.length / truth - 1, chain_seconds,
                       newton_clock.seconds()});
      if (cell == kCells[1]) paths.chains.push_back(std::move(chain));
    }
  }
  return paths;
}

Scene roll_scene(const Surface& roll, const std::vector<Chain>& chains, const Context& context) {
  Scene scene;
  scene.title = "The roll";
  scene.up = Eigen::Vector3d::UnitY();
  scene.meshes.push_back({.mesh = display_mesh(roll, {.cell = 0.45}, context), .colour = Colour::hex(0xc9d4de)});
  const std::vector<RollPair> all = pairs();
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const FlowResult& flow = chains[i].flow;
    if (flow.points.cols() < 2) continue;
    scene.paths.push_back({.points = flow.points,
                           .label = all[i].name,
                           .colour = i == 0   ? kBlue
                                     : i == 1 ? kTeal
                                              : kViolet,
                           .length = flow.length});
  }
  scene.points.push_back({.position = place(roll, all[0].from), .label = "A", .colour = kRed});
  scene.points.push_back({.position = place(roll, all[0].to), .label = "B", .colour = kRed});
  return scene;
}

}  // namespace

void write_figure3(Study& study, Report& report) {
  const RolledSheet sheet;
  const auto model = std::make_shared<const RbfModel>(fit_rbf(sheet.cloud(kSamples), {}, study.context));
  const Surface roll = make_surface(model);
  const RollPaths paths = find_paths(roll, study.context);

  Section& section = report.section("Figure 3");
  section.paper(
      "On a rolled-up sheet a node put between two neighbouring turns is always projected onto one of the two ends A "
      "and B, "
      "and the gap between them is never closed. The blue curve of Figure 3 is the geodesic that runs round the roll.");
  section.add(
      figure_of("figure3_roll",
                fmt::format("A sheet rolled up one and a half times, known by {} samples and made into a surface by "
                            "radial basis functions; the paths of the table below.",
                            kSamples),
                roll_scene(roll, paths.chains, study.context)));
  // Of the rows from cells of one size: how many came to rest, and how far off the worst of them is.
  const auto outcome = [&paths](double cell) {
    std::pair<Index, double> rest{0, 0};
    for (const auto& row : paths.table.rows) {
      if (std::get<double>(row[1]) != cell || std::get<std::string>(row[6]) != to_string(Status::ok)) continue;
      ++rest.first;
      rest.second = std::max(rest.second, std::abs(std::get<double>(row[5])));
    }
    return rest;
  };
  const auto [coarse, coarse_error] = outcome(kCells[0]);
  const auto [fine, fine_error] = outcome(kCells[1]);
  section.measured(
      fmt::format("Unrolled, the sheet is a flat strip, so the true lengths are known. The paper's chain comes to rest "
                  "for {} of {} pairs "
                  "from cells of {} (at most {} off the truth), and for {} from cells of {} (at most {} off).",
                  coarse, pairs().size(), kCells[0], readable_number(coarse_error, "{:.1e}"), fine, kCells[1],
                  readable_number(fine_error, "{:.1e}")));
  section.add(paths.table);
  section.remark(
      "Between two turns a function fitted to samples with normals changes sign once more. No surface is there, since "
      "no sample "
      "is near; but where cells are wide, those at the edge of the samples' reach touch both turns' own, and fast "
      "marching walks "
      "through them. No correction mends that. Neighbouring turns must be several cells apart.");
}

}  // namespace taut::paper
