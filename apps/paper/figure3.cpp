// Figures 3 and 4: a geodesic on a rolled sheet, and the gap in one grid cell that equation (5) closes.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>

#include "gap_filling.hpp"
#include "paper_chain.hpp"
#include "parts.hpp"
#include "rolled_sheet.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/rbf.hpp"

namespace taut::paper {
namespace {

constexpr Index kSamples = 700;
constexpr double kCell = 0.8;

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

Eigen::Vector3d place(const Eigen::Vector2d& at) { return RolledSheet::point(at.x(), at.y()); }

struct RollPaths {
  Table table;
  std::vector<Chain> chains;
};

RollPaths find_paths(const Surface& roll, const Context& context) {
  RollPaths paths{.table = {.name = "figure3_roll",
                            .title = "Paths on the roll: the paper's chain (Algorithm II, fast marching, projection, "
                                     "flow), and Newton's method",
                            .columns = {{"pair"},
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
  PathSolver newton(roll, {.cell = kCell}, context);
  for (const RollPair& pair : pairs()) {
    const double truth = RolledSheet::distance(pair.from, pair.to);
    const ProcessorClock chain_clock;
    Chain chain = run_chain(roll, place(pair.from), place(pair.to), {.cell = kCell}, context);
    const double chain_seconds = chain_clock.seconds();
    const ProcessorClock newton_clock;
    const PathResult by_newton = newton.solve(place(pair.from), place(pair.to));
    const FlowSummary& summary = chain.flow.summary;
    paths.table.add({pair.name, (place(pair.to) - place(pair.from)).norm(), truth, chain.flow.length,
                     chain.flow.length / truth - 1, std::string(to_string(chain.flow.status)), summary.num_intervals,
                     summary.num_inserted, summary.num_plane_inserted, by_newton.length, by_newton.length / truth - 1,
                     chain_seconds, newton_clock.seconds()});
    paths.chains.push_back(std::move(chain));
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
  scene.points.push_back({.position = place(all[0].from), .label = "A", .colour = kRed});
  scene.points.push_back({.position = place(all[0].to), .label = "B", .colour = kRed});
  return scene;
}

/// The roll cut across its axis, with what was put into the gap between A and B.
Drawing gap_drawing(const GapFilling& ordinary, const GapFilling& in_plane, double cell,
                    const Eigen::Vector2d& corner) {
  Drawing drawing{.width = 860, .height = 560, .title = "The gap between A and B in one grid cell"};
  const double scale = 17.5;
  const auto panel = [&](const GapFilling& filling, double left, const Colour& colour, const std::string& title) {
    const auto see = [&](double x, double z) { return Eigen::Vector2d(left + scale * x, 300 - scale * z); };
    Points square(2, 4);
    square << see(corner.x(), corner.y()), see(corner.x() + cell, corner.y()),
        see(corner.x() + cell, corner.y() + cell), see(corner.x(), corner.y() + cell);
    drawing.add(Stroke{.points = square,
                       .colour = kGreen,
                       .width = 1.6,
                       .closed = true,
                       .fill = Colour::hex(0xe4f3e7),
                       .fill_opacity = 0.8});
    Points spiral(2, 240);
    for (Index i = 0; i < spiral.cols(); ++i) {
      const double t = RolledSheet::kInnerAngle +
                       (RolledSheet::kOuterAngle - RolledSheet::kInnerAngle) * static_cast<double>(i) / 239;
      spiral.col(i) = see(t * std::cos(t), t * std::sin(t));
    }
    drawing.add(Stroke{.points = spiral, .colour = Colour::hex(0x8593a0), .width = 2.2});
    const Eigen::Vector3d a = filling.nodes.col(0), b = filling.nodes.rightCols(1);
    const Eigen::Vector3d middle = 0.5 * (a + b);
    drawing.line(see(middle.x(), corner.y() - 0.9), see(middle.x(), corner.y() + cell + 0.9), kAmber, 1.8, 2.5);
    drawing.add(TextLine{.at = see(middle.x(), corner.y() + cell + 1.2),
                         .text = "π",
                         .size = 19,
                         .anchor = TextAnchor::middle,
                         .colour = kAmber,
                         .italic = true});
    drawing.line(see(a.x(), a.z()), see(b.x(), b.z()), kInk, 1.2, 5);
    Points nodes(2, filling.nodes.cols());
    for (Index i = 0; i < nodes.cols(); ++i) nodes.col(i) = see(filling.nodes(0, i), filling.nodes(2, i));
    drawing.add(Stroke{.points = nodes, .colour = colour, .width = 1.4});
    for (Index i = 1; i + 1 < nodes.cols(); ++i)
      drawing.add(Disc{.centre = nodes.col(i), .radius = 3.6, .colour = colour});
    for (const auto& [p, name] : {std::pair{a, "A"}, {b, "B"}}) {
      drawing.add(Disc{.centre = see(p.x(), p.z()), .radius = 6, .colour = kInk});
      drawing.add(TextLine{.at = see(p.x(), p.z()) + Eigen::Vector2d(name[0] == 'A' ? -16 : 10, -10),
                           .text = name,
                           .size = 17,
                           .bold = true});
    }
    drawing.add(TextLine{.at = {left, 34}, .text = title, .size = 15, .anchor = TextAnchor::middle, .bold = true});
  };
  panel(ordinary, 215, kRed, "Ordinary projection");
  panel(in_plane, 640, kBlue, "Equation (5)");
  return drawing;
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
  Index found = 0;
  double worst = 0;
  for (const auto& row : paths.table.rows) {
    const double error = std::abs(std::get<double>(row[4]));
    if (std::get<std::string>(row[5]) != to_string(Status::ok)) continue;
    ++found;
    worst = std::max(worst, error);
  }
  section.measured(fmt::format(
      "Unrolled, the sheet is a flat strip, so the true lengths are known. From cells of {}, where neighbouring "
      "turns are 6.3 apart, the paper's chain comes to rest for {} of {} pairs, at most {} off the truth.",
      kCell, found, paths.table.rows.size(), readable_number(worst, "{:.1e}")));
  section.add(paths.table);

  Section& gap = report.section("Figure 4");
  gap.paper(
      "A plane π through the middle of AB and across it closes the gap: the new node is sought in that plane, as the "
      "point "
      "where F is least (equation (5)). That is needed only where a gap lies within one grid cell.");
  const RollPair pair = pairs().front();
  const Vector a = place(pair.from);
  const Vector b = place(pair.to);
  constexpr Index kNodes = 40;
  const GapFilling ordinary = fill_gap(roll, a, b, kNodes, NodeProjection::ordinary);
  const GapFilling in_plane = fill_gap(roll, a, b, kNodes, NodeProjection::in_plane);
  // A cell as coarse as to hold A and B both.
  constexpr double kCoarse = 8;
  const Eigen::Vector2d corner(0.5 * (a.x() + b.x()) - 0.5 * kCoarse, -0.5 * kCoarse);
  gap.add(
      figure_of("figure4_gap",
                fmt::format("The roll cut across its axis, in one coarse cell (green). {} nodes were put in, each into "
                            "the longest interval by then. Left: projected by Newton-Raphson. Right: by equation (5), "
                            "in the plane π across each gap.",
                            kNodes),
                gap_drawing(ordinary, in_plane, kCoarse, corner)));
  std::vector<double> count;
  for (Index i = 0; i <= kNodes; ++i) count.push_back(static_cast<double>(i));
  gap.add(figure_of("figure4_longest_interval",
                    "The longest interval that is left, against the number of nodes put in.",
                    Chart{.title = "Closing the gap between A and B",
                          .x = {"nodes put in"},
                          .y = {"longest interval left", true},
                          .series = {{.name = "ordinary projection", .x = count, .y = ordinary.longest, .colour = kRed},
                                     {.name = "equation (5)", .x = count, .y = in_plane.longest, .colour = kBlue}}}));
  Index at_ends = 0;
  for (Index i = 1; i <= kNodes; ++i) {
    const Eigen::Vector3d p = ordinary.nodes.col(i);
    at_ends += std::min((p - a).norm(), (p - b).norm()) < 0.05 * (b - a).norm() ? 1 : 0;
  }
  Table table{.name = "figure4_gap",
              .title = fmt::format("After {} nodes in the gap between A and B", kNodes),
              .columns = {{"projection"}, {"gap before", "{:.4f}"}, {"longest interval after", "{:.4f}"}}};
  table.add({std::string("ordinary"), ordinary.longest.front(), ordinary.longest.back()});
  table.add({std::string("equation (5)"), in_plane.longest.front(), in_plane.longest.back()});
  gap.measured(fmt::format(
      "Of {} nodes put in by ordinary projection {} end within a twentieth of the gap from A or B, "
      "and "
      "an interval of {:.3f} stays of the {:.3f} there were. By equation (5) the longest interval falls to {:.3f}.",
      kNodes, at_ends, ordinary.longest.back(), ordinary.longest.front(), in_plane.longest.back()));
  gap.add(table);
}

}  // namespace taut::paper
