// Figure 4: the gap in one grid cell that equation (5) closes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap_filling.hpp"
#include "parts.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

// A slot in the plane z = 0, along y: two walls kWidth apart and a round bottom kDepth below.
constexpr double kWidth = 0.5;
constexpr double kDepth = 2;
constexpr double kCell = 0.8;
constexpr double kCellTop = 0.15;
constexpr Index kNodes = 40;

Surface slot() {
  return parse_surface(fmt::format("max(z,{}-sqrt(x^2+(z-min(max(z,{}),0))^2))", kWidth / 2, -kDepth),
                       {.dim = 3, .box = Box{Eigen::Vector3d(-2, -1, -3), Eigen::Vector3d(2, 1, 1)}});
}

// One on each wall, not far below the rim.
const Eigen::Vector3d kLeft(-kWidth / 2, 0, -0.25);
const Eigen::Vector3d kRight(kWidth / 2, 0, -0.27);

/// Down one wall, round the bottom, up the other.
double true_length() { return (kLeft.z() + kDepth) + (kRight.z() + kDepth) + std::numbers::pi * kWidth / 2; }

/// The slot cut across, and what was put in between A and B.
void draw_panel(Drawing& drawing, double left, const GapFilling& filling, const Colour& colour,
                const std::string& title) {
  const auto see = [left](double x, double z) { return Eigen::Vector2d(left + 150 * x, 120 - 150 * z); };
  constexpr double kCellBottom = kCellTop - kCell;
  Points cell(2, 4);
  cell << see(-kCell / 2, kCellTop), see(kCell / 2, kCellTop), see(kCell / 2, kCellBottom),
      see(-kCell / 2, kCellBottom);
  drawing.add(Stroke{.points = cell, .colour = kGreen, .width = 1.6, .closed = true, .fill = Colour::hex(0xe4f3e7)});
  constexpr Index kArc = 40;  // points of the round bottom
  Points outline(2, kArc + 4);
  outline.col(0) = see(-1.1, 0);
  outline.col(1) = see(-kWidth / 2, 0);
  for (Index i = 0; i < kArc; ++i) {
    const double turn = std::numbers::pi * static_cast<double>(i) / (kArc - 1);
    outline.col(2 + i) = see(-kWidth / 2 * std::cos(turn), -kDepth - kWidth / 2 * std::sin(turn));
  }
  outline.col(kArc + 2) = see(kWidth / 2, 0);
  outline.col(kArc + 3) = see(1.1, 0);
  drawing.add(Stroke{.points = outline, .colour = kGrey, .width = 2.4});
  drawing.line(see(0, 0.3), see(0, -kDepth - 0.45), kAmber, 1.8, 3);
  drawing.add(TextLine{
      .at = see(0, 0.36), .text = "π", .size = 19, .anchor = TextAnchor::middle, .colour = kAmber, .italic = true});
  Points nodes(2, filling.nodes.cols());
  for (Index i = 0; i < nodes.cols(); ++i) nodes.col(i) = see(filling.nodes(0, i), filling.nodes(2, i));
  drawing.add(Stroke{.points = nodes, .colour = colour, .width = 1.6});
  for (Index i = 1; i + 1 < nodes.cols(); ++i) {
    drawing.add(Disc{.centre = nodes.col(i), .radius = 3.8, .colour = colour});
  }
  for (const auto& [p, name, aside] : {std::tuple{kLeft, "A", 10.0}, {kRight, "B", -23.0}}) {
    const Eigen::Vector2d at = see(p.x(), p.z());
    drawing.add(Disc{.centre = at, .radius = 6});
    drawing.add(TextLine{.at = at + Eigen::Vector2d(aside, -8), .text = name, .size = 17, .bold = true});
  }
  drawing.add(TextLine{.at = {left, 32}, .text = title, .size = 16, .anchor = TextAnchor::middle, .bold = true});
}

double length_of(const Points& nodes) {
  return (nodes.rightCols(nodes.cols() - 1) - nodes.leftCols(nodes.cols() - 1)).colwise().norm().sum();
}

}  // namespace

void write_figure4(Study& /*study*/, Report& report) {
  Section& section = report.section("Figure 4");
  section.paper(
      "A plane π through the middle of AB and across it closes the gap: the new node is sought in that plane, as the "
      "point where F is least (equation (5)). That is needed only where a gap lies within one grid cell.");
  const Surface surface = slot();
  const GapFilling ordinary = fill_gap(surface, kLeft, kRight, kNodes, NodeProjection::ordinary);
  const GapFilling in_plane = fill_gap(surface, kLeft, kRight, kNodes, NodeProjection::in_plane);
  Drawing drawing{.width = 760, .height = 520, .title = "The gap between A and B in one grid cell"};
  draw_panel(drawing, 200, ordinary, kRed, "Ordinary projection");
  draw_panel(drawing, 560, in_plane, kBlue, "Equation (5)");
  section.add(
      figure_of("figure4_gap",
                fmt::format("A slot, cut across; the gap between A and B lies in one cell (green). {} nodes were "
                            "put in, each into the interval that was longest by then.",
                            kNodes),
                drawing));

  constexpr double kBeside = 0.15;  // of the gap
  const double gap = (kRight - kLeft).norm();
  Index at_ends = 0;
  for (Index i = 1; i <= kNodes; ++i) {
    const Eigen::Vector3d p = ordinary.nodes.col(i);
    at_ends += std::min((p - kLeft).norm(), (p - kRight).norm()) < kBeside * gap ? 1 : 0;
  }
  Table table{.name = "figure4_gap",
              .title = fmt::format("The gap between A and B, {:.3f} wide; the way round the slot is {:.6f} long", gap,
                                   true_length()),
              .columns = {{"nodes put in by"}, {"nodes"}, {"longest interval left", "{:.4f}"}, {"length", "{:.6f}"}}};
  table.add({std::string("ordinary projection"), kNodes, ordinary.longest.back(), length_of(ordinary.nodes)});
  table.add({std::string("equation (5)"), kNodes, in_plane.longest.back(), length_of(in_plane.nodes)});
  section.measured(fmt::format(
      "Of {} nodes put in by ordinary projection {} gather at A or B, and an interval of {:.3f} stays of the {:.3f} "
      "there were. By equation (5) the longest interval falls to {:.3f}.",
      kNodes, at_ends, ordinary.longest.back(), ordinary.longest.front(), in_plane.longest.back()));
  section.add(std::move(table));

  std::vector<double> count;
  for (Index i = 0; i <= kNodes; ++i) count.push_back(static_cast<double>(i));
  section.add(
      figure_of("figure4_longest_interval", "The longest interval that is left, against the number of nodes put in.",
                Chart{.title = "Closing the gap between A and B",
                      .x = {"nodes put in"},
                      .y = {"longest interval left", true},
                      .series = {{.name = "ordinary projection", .x = count, .y = ordinary.longest, .colour = kRed},
                                 {.name = "equation (5)", .x = count, .y = in_plane.longest, .colour = kBlue}}}));
}

}  // namespace taut::paper
