// Figure 2: the vector triangle that stands for the second derivative of a curve, and its tangential part.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "parts.hpp"
#include "space_view.hpp"

namespace taut::paper {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Eigen::Vector3d on_sphere(double latitude, double longitude) {
  return {std::cos(latitude * kDegree) * std::cos(longitude * kDegree),
          std::cos(latitude * kDegree) * std::sin(longitude * kDegree), std::sin(latitude * kDegree)};
}

/// A line of the globe between two corners, with the latitude or the longitude held.
Points globe_line(double latitude0, double longitude0, double latitude1, double longitude1) {
  constexpr Index kPoints = 48;
  Points line(3, kPoints);
  for (Index i = 0; i < kPoints; ++i) {
    const double part = static_cast<double>(i) / (kPoints - 1);
    line.col(i) = on_sphere(latitude0 + part * (latitude1 - latitude0), longitude0 + part * (longitude1 - longitude0));
  }
  return line;
}

Drawing vector_triangle() {
  Drawing drawing{.width = 800, .height = 540, .title = "The vector triangle at a node and its tangential part"};
  const SpaceView view(-12, 30, 430, {400, 425});
  const double south = 22, north = 74, west = -62, east = 62;
  // The patch of surface.
  Points outline(3, 0);
  for (const Points& side : {globe_line(south, west, south, east), globe_line(south, east, north, east),
                             globe_line(north, east, north, west), globe_line(north, west, south, west)}) {
    outline.conservativeResize(3, outline.cols() + side.cols());
    outline.rightCols(side.cols()) = side;
  }
  drawing.add(Stroke{.points = view.see_all(outline),
                     .colour = Colour::hex(0x9fb0bf),
                     .width = 1.2,
                     .closed = true,
                     .fill = Colour::hex(0xe3ebf3)});
  for (double latitude = south + 13; latitude < north; latitude += 13) {
    drawing.add(Stroke{.points = view.see_all(globe_line(latitude, west, latitude, east)),
                       .colour = Colour::hex(0xc3d0dc),
                       .width = 0.9});
  }
  for (double longitude = west + 15.5; longitude < east; longitude += 15.5) {
    drawing.add(Stroke{.points = view.see_all(globe_line(south, longitude, north, longitude)),
                       .colour = Colour::hex(0xc3d0dc),
                       .width = 0.9});
  }
  drawing.add(TextLine{.at = view.see(on_sphere(27, -52)), .text = "S", .size = 20, .italic = true});

  const double latitude = 48, apart = 31;
  const Eigen::Vector3d before = on_sphere(latitude, -apart);
  const Eigen::Vector3d here = on_sphere(latitude, 0);
  const Eigen::Vector3d after = on_sphere(latitude, apart);
  const Eigen::Vector3d n = here;

  // The tangent plane at p^i.
  const Eigen::Vector3d eastwards = Eigen::Vector3d::UnitZ().cross(n).normalized();
  const Eigen::Vector3d northwards = n.cross(eastwards);
  Points plane(3, 4);
  plane << here - 0.3 * eastwards - 0.24 * northwards, here + 0.3 * eastwards - 0.24 * northwards,
      here + 0.3 * eastwards + 0.42 * northwards, here - 0.3 * eastwards + 0.42 * northwards;
  drawing.add(Stroke{.points = view.see_all(plane),
                     .colour = kAmber,
                     .width = 1.2,
                     .closed = true,
                     .fill = Colour::hex(0xf6dfae),
                     .fill_opacity = 0.55});
  drawing.add(TextLine{.at = view.see(plane.col(2)) + Eigen::Vector2d(6, -4),
                       .text = "tangent plane",
                       .size = 14,
                       .colour = Colour::hex(0x8a6210)});

  // The curve, its nodes and edges.
  drawing.add(Stroke{.points = view.see_all(globe_line(latitude, west + 6, latitude, east - 6)),
                     .colour = kGrey,
                     .width = 1.6,
                     .dash = 5});
  const Eigen::Vector2d p0 = view.see(before), p1 = view.see(here), p2 = view.see(after);
  drawing.arrow(p0, p1, kInk, 2.2);
  drawing.arrow(p1, p2, kInk, 2.2);

  // The triangle: the two edges from one point, and what closes them.
  const Eigen::Vector3d second = (after - here) - (here - before);
  const Eigen::Vector3d tip = here + second;
  drawing.line(view.see(here + (here - before)), p1, kGrey, 1.4, 6);
  drawing.line(view.see(here + (here - before)), p2, kGrey, 1.4, 6);
  drawing.arrow(p1, view.see(tip), kBlue, 3);
  const Eigen::Vector3d tangential = second - second.dot(n) * n;
  drawing.line(view.see(tip), view.see(here + tangential), kGrey, 1.4, 4);
  drawing.arrow(p1, view.see(here + tangential), kRed, 3);
  drawing.arrow(p1, view.see(here + 0.42 * n), kGreen, 2.6);

  for (const Eigen::Vector2d& p : {p0, p1, p2}) drawing.add(Disc{.centre = p, .radius = 5.5, .colour = kInk});
  drawing.add(TextLine{
      .at = p0 + Eigen::Vector2d(-14, 24), .text = "p^{i−1}", .size = 18, .anchor = TextAnchor::end, .italic = true});
  drawing.add(TextLine{
      .at = p1 + Eigen::Vector2d(-12, 26), .text = "p^{i}", .size = 18, .anchor = TextAnchor::end, .italic = true});
  drawing.add(TextLine{.at = p2 + Eigen::Vector2d(14, 22), .text = "p^{i+1}", .size = 18, .italic = true});
  drawing.add(TextLine{.at = view.see(tip) + Eigen::Vector2d(-12, 18),
                       .text = "C_{ss} Δh^{2}",
                       .size = 18,
                       .anchor = TextAnchor::end,
                       .colour = kBlue,
                       .italic = true});
  drawing.add(TextLine{.at = view.see(here + tangential) + Eigen::Vector2d(-10, -8),
                       .text = "k_{g}N Δh^{2}",
                       .size = 18,
                       .anchor = TextAnchor::end,
                       .colour = kRed,
                       .italic = true});
  drawing.add(TextLine{.at = view.see(here + 0.42 * n) + Eigen::Vector2d(10, 4),
                       .text = "n",
                       .size = 20,
                       .colour = kGreen,
                       .bold = true});
  return drawing;
}

/// The parabola z = a s^2 / 2 rolled up on the unit cylinder, s being arc length round it: unrolling keeps geodesic
/// curvature, which is that of the plane parabola, a at s = 0.
Eigen::Vector3d on_cylinder(double a, double s) { return {std::cos(s), std::sin(s), 0.5 * a * s * s}; }

Table convergence() {
  Table table{.name = "figure2_second_difference",
              .title = "k_g at the vertex of a parabola on the unit cylinder, by the vector triangle",
              .columns = {{"Δh", "{:.4f}"},
                          {"divided by Δh once", "{:.6f}"},
                          {"divided by Δh²", "{:.8f}"},
                          {"truth", "{:.2f}"},
                          {"error of Δh²", "{:.2e}"},
                          {"order", "{:.2f}"}}};
  const double truth = 1.2;
  double last = 0;
  for (const double apart : {0.4, 0.2, 0.1, 0.05, 0.025}) {
    const Eigen::Vector3d here = on_cylinder(truth, 0);
    const Eigen::Vector3d next = on_cylinder(truth, apart) - here;
    const Eigen::Vector3d previous = here - on_cylinder(truth, -apart);
    const double dh = 0.5 * (next.norm() + previous.norm());
    const Eigen::Vector3d triangle = next - previous;
    const Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
    const double tangential = (triangle - triangle.dot(normal) * normal).norm();
    const double error = std::abs(tangential / (dh * dh) - truth);
    table.add({dh, tangential / dh, tangential / (dh * dh), truth, error,
               last > 0 ? Value(std::log2(last / error)) : Value()});
    last = error;
  }
  return table;
}

}  // namespace

void write_figure2(Study& /*study*/, Report& report) {
  Section& section = report.section("Figure 2");
  section.paper(
      "A curve without parametrisation gets its second derivative from a vector triangle: the difference of two "
      "successive edges, divided by Δh, their mean length. Its part in the tangent plane at p<sup>i</sup> is the "
      "geodesic "
      "curvature vector of equation (3); where it vanishes at all nodes, the flow (2) rests and the curve is a "
      "geodesic.");
  section.add(
      figure_of("figure2_vector_triangle",
                "The vector triangle at p<sup>i</sup>: the edge to p<sup>i+1</sup> less the edge from "
                "p<sup>i−1</sup> (blue). What is left of it after the part along the normal <b>n</b> is taken away "
                "is the geodesic curvature vector (red), which lies in the tangent plane.",
                vector_triangle()));
  const Table table = convergence();
  section.measured(fmt::format(
      "Divided by Δh², the triangle's tangential part goes to the geodesic curvature with order {:.2f} in Δh: the "
      "error is "
      "{} at Δh = {:.4f}.",
      std::get<double>(table.rows.back()[5]), readable_number(std::get<double>(table.rows.back()[4]), "{:.1e}"),
      std::get<double>(table.rows.back()[0])));
  section.add(table);
  section.remark(
      "The paper divides by Δh once. The edges carry their lengths, so a second derivative needs Δh twice; divided "
      "once it "
      "goes to zero with Δh, as the second column shows. Where the flow comes to rest is the same: only the scale of "
      "time "
      "differs. Taut divides twice.");
}

}  // namespace taut::paper
