// Figure 1: the neighbours of a cell that Algorithm II tests.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "parts.hpp"
#include "space_view.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

/// The three faces of a unit cube that the viewer sees, shaded by where they face.
void draw_cube(Drawing& drawing, const SpaceView& view, const Eigen::Vector3d& centre, double size, const Colour& fill,
               double opacity) {
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d out = Eigen::Vector3d::Unit(axis);
    if (view.nearness(out) < 0) out = -out;
    const Eigen::Vector3d u = 0.5 * size * Eigen::Vector3d::Unit((axis + 1) % 3);
    const Eigen::Vector3d v = 0.5 * size * Eigen::Vector3d::Unit((axis + 2) % 3);
    const Eigen::Vector3d middle = centre + 0.5 * size * out;
    Points corners(3, 4);
    corners << middle - u - v, middle + u - v, middle + u + v, middle - u + v;
    const float light = axis == 2 ? 1.0F : axis == 0 ? 0.86F : 0.74F;
    const Colour shaded{fill.red * light, fill.green * light, fill.blue * light};
    drawing.add(Stroke{.points = view.see_all(corners),
                       .colour = Colour::hex(0x5b6b7c),
                       .width = 1,
                       .closed = true,
                       .fill = shaded,
                       .fill_opacity = opacity});
  }
}

Drawing neighbourhood() {
  Drawing drawing{.width = 760, .height = 520, .title = "The six neighbours of cell (i, j, k) across its faces"};
  const SpaceView view(32, 22, 112, {380, 262});
  struct Place {
    Eigen::Vector3d cell;
    std::string label;
  };
  constexpr double kApart = 1.55;  // cells drawn apart, so that all seven are seen
  std::vector<Place> places = {{{0, 0, 0}, "(i, j, k)"},        {{-kApart, 0, 0}, "(i−1, j, k)"},
                               {{kApart, 0, 0}, "(i+1, j, k)"}, {{0, -kApart, 0}, "(i, j−1, k)"},
                               {{0, kApart, 0}, "(i, j+1, k)"}, {{0, 0, -kApart}, "(i, j, k−1)"},
                               {{0, 0, kApart}, "(i, j, k+1)"}};
  std::ranges::sort(places, {}, [&view](const Place& place) { return view.nearness(place.cell); });
  for (const Place& place : places) {
    const bool middle = place.cell.isZero();
    if (!middle) drawing.line(view.see(place.cell), view.see({0, 0, 0}), kGrey, 1.4, 5);
    draw_cube(drawing, view, place.cell, 0.8, middle ? Colour::hex(0x8fb5ea) : Colour::hex(0xa9d6ae), 0.96);
    drawing.add(Disc{.centre = view.see(place.cell + 0.4 * Eigen::Vector3d::UnitZ()),
                     .radius = 3.5,
                     .colour = middle ? kBlue : kGreen});
  }
  // Each beside its cell, where no other cell stands.
  for (const Place& place : places) {
    const bool right = place.cell.y() > 0 || place.cell.z() != 0 || place.cell.x() < 0;
    const bool middle = place.cell.isZero();
    Eigen::Vector2d at = view.see(place.cell) + Eigen::Vector2d(middle ? 17 : right ? 66 : -66, middle ? 14 : 6);
    if (place.cell.x() < 0) at += Eigen::Vector2d(0, -24);
    drawing.add(TextLine{.at = at,
                         .text = place.label,
                         .size = 16,
                         .anchor = middle  ? TextAnchor::middle
                                   : right ? TextAnchor::start
                                           : TextAnchor::end,
                         .bold = middle});
  }
  const Eigen::Vector2d corner(86, 470);
  for (const auto& [axis, name] : {std::pair{0, "i"}, {1, "j"}, {2, "k"}}) {
    const Eigen::Vector2d tip = corner + 0.48 * (view.see(Eigen::Vector3d::Unit(axis)) - view.see({0, 0, 0}));
    drawing.arrow(corner, tip, kGrey, 1.6);
    drawing.add(TextLine{.at = tip + Eigen::Vector2d(tip.x() < corner.x() ? -14 : 8, axis == 2 ? -6 : 10),
                         .text = name,
                         .size = 15,
                         .italic = true});
  }
  return drawing;
}

/// x_1^2 + ... + x_d^2 = 1
Surface unit_sphere(Index dim) {
  std::string formula;
  for (Index i = 1; i <= dim; ++i) formula += fmt::format("{}x{}^2", i == 1 ? "" : "+", i);
  return parse_surface(formula + "=1", {.dim = dim});
}

/// Algorithm II through 2 d faces, from one seed, against all cells there are: those of Algorithm I.
Table faces_suffice(const Context& context) {
  Table table{.name = "figure1_neighbours",
              .title = "Cells of the unit hypersphere from one seed through the 2d faces, against all cells",
              .columns = {{"d"},
                          {"faces 2d"},
                          {"all neighbours 3ᵈ − 1"},
                          {"cell size", "{:.3g}"},
                          {"Algorithm I, cells"},
                          {"Algorithm II, one seed, cells"}}};
  constexpr std::array kSizes = {0.02, 0.05, 0.15, 0.3, 0.5};  // d = 2 ... 6: some hundreds to ten thousands of cells
  for (Index dim = 2; dim <= 6; ++dim) {
    const Surface sphere = unit_sphere(dim);
    const double size = kSizes[static_cast<std::size_t>(dim - 2)];
    const CellGrid all = subdivide(sphere, {.size = size}, context);
    const CellGrid grown = grow(sphere, Vector(Vector::Unit(dim, 0)), {.size = size, .origin = all.origin()}, context);
    table.add({dim, 2 * dim, static_cast<Index>(std::pow(3, dim)) - 1, size, all.num_cells(), grown.num_cells()});
  }
  return table;
}

}  // namespace

void write_figure1(Study& study, Report& report) {
  Section& section = report.section("Figure 1");
  section.paper(
      "Algorithm II starts from the cells that hold samples and grows over the surface. Figure 1 shows which "
      "cells it tests next: the neighbours of point (i, j, k) on the Cartesian grid. Appendix I counts 2d of them.");
  section.add(figure_of("figure1_neighbourhood",
                        "The neighbourhood of cell (i, j, k): six cells share a face with it. In d dimensions "
                        "they are 2d, where all cells that touch it, corners included, are 3<sup>d</sup> − 1.",
                        neighbourhood()));
  const Table table = faces_suffice(study.context);
  Index worst = 0;
  for (const auto& row : table.rows)
    worst = std::max(worst, std::abs(std::get<Index>(row[4]) - std::get<Index>(row[5])));
  section.measured(
      fmt::format("Faces are enough: grown from a single seed through the 2d faces, Algorithm II finds {} that "
                  "Algorithm I finds, in "
                  "every dimension tried.",
                  worst == 0 ? "exactly the cells" : fmt::format("the cells, up to {},", worst)));
  section.add(table);
  section.remark(
      "The paper does not say why faces are enough. Where a connected surface passes from one cell to the next through "
      "an "
      "edge or a corner, all closed cells round it are crossed, and these hang together through faces.");
}

}  // namespace taut::paper
