// Appendix II: the error of the corrected curve against its nodes, and the time.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "chart.hpp"
#include "parts.hpp"
#include "taut/curve/flow.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

/// One flow from a rough start.
struct Run {
  FlowResult flow;
  double error = 0;  // true length - polyline
  double seconds = 0;
};

struct Setting {
  std::string name;
  Surface surface;
  Vector from, to;
  Points start;  // a rough polyline
  double truth = 0;
};

Setting make_setting(const std::string& name, const std::string& formula, const Vector& p, const Vector& q, double cell,
                     const Context& context) {
  Surface surface = parse_surface(formula);
  const PathResult exact = shortest_path(surface, p, q, {.tolerance = 1e-13}, context);
  const PathResult rough = shortest_path(
      surface, p, q, {.method = CorrectionMethod::grid, .march = MarchMethod::axis, .cell = cell}, context);
  return {name, std::move(surface), exact.from, exact.to, rough.points, exact.length};
}

Run run_flow(const Setting& setting, double spacing, FlowTimeStep step, NodeSpread nodes, const Context& context) {
  const ProcessorClock clock;
  Run run{.flow = correct_flow(setting.surface, setting.start, {.spacing = spacing, .nodes = nodes, .time_step = step},
                               context)};
  run.seconds = clock.seconds();
  run.error = setting.truth - run.flow.length;
  return run;
}

/// (A1) over L.
double relative_a1(double cst) { return std::acos(1 - 0.5 * cst * cst) / cst - 1; }

/// Figure A(1): an arc, its chord and the osculating circle.
Drawing osculating_circle() {
  Drawing drawing{.width = 560, .height = 380, .title = "Arc and chord on the osculating circle"};
  const Eigen::Vector2d centre(280, 330);
  const double radius = 250;
  const auto at = [&](double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return Eigen::Vector2d(centre.x() + radius * std::cos(a), centre.y() - radius * std::sin(a));
  };
  const auto arc = [&](double from, double to) {
    Points points(2, 60);
    for (Index i = 0; i < 60; ++i) points.col(i) = at(from + (to - from) * static_cast<double>(i) / 59);
    return points;
  };
  drawing.add(Stroke{.points = arc(12, 168), .colour = kGrey, .width = 1.4, .dash = 5});
  const Eigen::Vector2d a = at(122), b = at(58);
  drawing.line(centre, a, kGrey, 1.4);
  drawing.line(centre, b, kGrey, 1.4);
  drawing.line(a, b, kRed, 2.6);
  drawing.add(Stroke{.points = arc(58, 122), .colour = kBlue, .width = 3});
  for (const auto& [p, name, dx] : {std::tuple{a, "A", -22.0}, {b, "B", 10.0}}) {
    drawing.add(Disc{.centre = p, .radius = 5});
    drawing.add(TextLine{.at = p + Eigen::Vector2d(dx, -6), .text = name, .size = 18, .bold = true});
  }
  drawing.add(Disc{.centre = centre, .radius = 4, .colour = kGrey});
  drawing.add(TextLine{.at = {280, 66}, .text = "arc", .size = 15, .anchor = TextAnchor::middle, .colour = kBlue});
  drawing.add(TextLine{
      .at = {280, 140}, .text = "ε", .size = 19, .anchor = TextAnchor::middle, .colour = kRed, .italic = true});
  drawing.add(TextLine{.at = 0.5 * (centre + b) + Eigen::Vector2d(12, 4), .text = "r", .size = 19, .italic = true});
  return drawing;
}

}  // namespace

void write_appendix2(Study& study, Report& report) {
  Section& section = report.section("Appendix II");
  section.paper(
      "Between two nodes the curve is taken for an arc of its osculating circle of radius r, and the polyline for its "
      "chord ε: "
      "the error of a whole curve is the sum of r cos<sup>−1</sup>(1 − ε²/2r²) − ε. With ε/r the same everywhere, Cst, "
      "and "
      "Σε = L, that is (A1): err = L (cos<sup>−1</sup>(1 − Cst²/2)/Cst − 1).");
  section.add(figure_of("appendix2_circle", "The paper’s Figure A(1): the arc from A to B and its chord.",
                        osculating_circle()));

  const Setting sphere = make_setting("sphere", "x^2+y^2+z^2=1", Eigen::Vector3d(0.8, 0, 0.6),
                                      Eigen::Vector3d(-0.6, 0.48, 0.64), 0.2, study.context);
  const Setting ellipsoid = make_setting("ellipsoid 3 : 2 : 1", "(x/3)^2+(y/2)^2+z^2=1", Eigen::Vector3d(3, 0, 0),
                                         Eigen::Vector3d(-1.5, 1.2, 0.62), 0.4, study.context);
  Table table{.name = "appendix2_error",
              .title = "Error of the corrected polyline against ε_E (even nodes, implicit steps)",
              .columns = {{"surface"},
                          {"ε_E", "{:.4g}"},
                          {"m"},
                          {"mean ε", "{:.5f}"},
                          {"Cst", "{:.4f}"},
                          {"L", "{:.8f}"},
                          {"error measured", "{:.3e}"},
                          {"sum over circles", "{:.3e}"},
                          {"(A1)", "{:.3e}"},
                          {"(A1) / measured", "{:.4f}"}}};
  Chart against_m{.title = "Error against the number of nodes", .x = {"m", true}, .y = {"error", true}, .series = {}};
  Chart against_cst{
      .title = "Error / L against Cst", .x = {"Cst = ε / r", true}, .y = {"error / L", true}, .series = {}};
  std::vector<double> orders;
  double worst_ratio = 1;  // of (A1) to what was measured
  for (const auto& [setting, colour] : {std::pair{&sphere, kBlue}, {&ellipsoid, kRed}}) {
    Series measured{.name = setting->name + ", measured", .colour = colour, .line = false};
    Series model{.name = "(A1) with its Cst", .colour = colour, .marks = false};
    Series cst = measured;
    for (double spacing = 0.4; spacing > 0.005; spacing *= 0.5) {
      const Run run = run_flow(*setting, spacing, FlowTimeStep::linearly_implicit, NodeSpread::even, study.context);
      const FlowSummary& summary = run.flow.summary;
      table.add({setting->name, spacing, summary.num_intervals, summary.mean_interval, summary.cst, run.flow.length,
                 run.error, summary.error_sum, summary.error_a1, summary.error_a1 / run.error});
      worst_ratio = std::max(worst_ratio, std::max(summary.error_a1 / run.error, run.error / summary.error_a1));
      measured.x.push_back(static_cast<double>(summary.num_intervals));
      measured.y.push_back(run.error);
      model.x.push_back(static_cast<double>(summary.num_intervals));
      model.y.push_back(summary.error_a1);
      cst.x.push_back(summary.cst);
      cst.y.push_back(run.error / run.flow.length);
    }
    // The coarsest two are no more than a few nodes a bend.
    const std::vector<double> counts(measured.x.begin() + 2, measured.x.end());
    const std::vector<double> errors(measured.y.begin() + 2, measured.y.end());
    orders.push_back(-fit_power_law(counts, errors).exponent);
    if (setting == &sphere) {
      Series held{.name = "(A1), Cst held at its first value",
                  .x = {measured.x.front(), measured.x.back()},
                  .y = {model.y.front(), model.y.front()},
                  .colour = kGrey,
                  .marks = false,
                  .dash = 5};
      against_m.series.push_back(std::move(held));
    }
    against_m.series.push_back(std::move(measured));
    against_m.series.push_back(std::move(model));
    against_cst.series.push_back(std::move(cst));
  }
  Series theory{.name = "(A1)", .colour = kInk, .marks = false};
  for (double cst = 0.002; cst < 0.6; cst *= 1.2) {
    theory.x.push_back(cst);
    theory.y.push_back(relative_a1(cst));
  }
  against_cst.series.push_back(std::move(theory));
  std::vector<Figure> charts;
  charts.push_back(
      figure_of("appendix2_a2",
                "In place of Figure A(2): the error by (A1) depends on L only as a factor, so one curve shows it all.",
                against_cst));
  charts.push_back(figure_of(
      "appendix2_a3",
      "In place of Figure A(3): the error against m. The grey line is (A1) with Cst held fixed, as the paper reads it.",
      against_m));
  section.add_row(std::move(charts));
  section.measured(fmt::format(
      "(A1) is within a factor of {:.2f} of the measured error on both surfaces, and the measured error falls as "
      "m<sup>−{:.2f}</sup> on the sphere and m<sup>−{:.2f}</sup> on the ellipsoid, from ε = 0.1 on.",
      worst_ratio, orders[0], orders[1]));
  section.add(table);
  section.remark(
      "The paper holds Cst fixed, lets m grow, and finds that the error does not go to zero with m alone. But Cst is "
      "ε/r, and ε is "
      "L/m: on a given curve nobody can raise m without lowering Cst in proportion. So the error does go to zero, with "
      "the second "
      "power of m, as the measured points show.");

  section.subheading("How the nodes are spread");
  Table spread{.name = "appendix2_spread",
               .title =
                   "Ellipsoid 3 : 2 : 1, the same ε_E, nodes spread evenly (section 4) or by the radius of curvature "
                   "(Appendix II)",
               .columns = {{"nodes"},
                           {"ε_E", "{:.3g}"},
                           {"m"},
                           {"mean ε", "{:.4f}"},
                           {"longest ε", "{:.4f}"},
                           {"Cst", "{:.4f}"},
                           {"error measured", "{:.3e}"},
                           {"(A1)", "{:.3e}"},
                           {"status"}}};
  for (const double spacing : {0.2, 0.1, 0.05}) {
    for (const auto& [name, nodes] : {std::pair{"even", NodeSpread::even}, {"by curvature", NodeSpread::curvature}}) {
      const Run run = run_flow(ellipsoid, spacing, FlowTimeStep::linearly_implicit, nodes, study.context);
      const FlowSummary& summary = run.flow.summary;
      spread.add({std::string(name), spacing, summary.num_intervals, summary.mean_interval, summary.longest_interval,
                  summary.cst, run.error, summary.error_a1, std::string(to_string(run.flow.status))});
    }
  }
  section.add(spread);
  section.remark(
      "Section 4 wants nodes to repel each other to an even spacing; Appendix II takes their spacing to be in "
      "proportion to the "
      "radius of curvature. Both cannot hold on one curve. Taut offers either (<code>--nodes even</code> or "
      "<code>curvature</code>).");

  section.subheading("Time");
  section.paper(
      "If moving one node to the geodesic takes a time K, a curve of m = L/ε̄ nodes takes (A2): Time = err · K / (ε̄ "
      "(cos<sup>−1</sup>(1 "
      "− Cst²/2)/Cst − 1)).");
  Table time{.name = "appendix2_time",
             .title = "Time of the correction, on the sphere",
             .columns = {{"steps"},
                         {"m"},
                         {"iterations"},
                         {"time, s", "{:.2e}"},
                         {"K = time / m, s", "{:.2e}"},
                         {"(A2), s", "{:.2e}"},
                         {"error", "{:.1e}"}}};
  Chart against_time{
      .title = "Time against the number of nodes", .x = {"m", true}, .y = {"seconds", true}, .series = {}};
  std::vector<double> exponents;
  for (const auto& [name, step, colour, finest] :
       {std::tuple{"explicit, the paper’s", FlowTimeStep::explicit_euler, kRed, 0.012},
        {"implicit", FlowTimeStep::linearly_implicit, kBlue, 0.0015}}) {
    Series series{.name = name, .colour = colour};
    for (double spacing = 0.2; spacing > finest; spacing *= 0.5) {
      const Run run = run_flow(sphere, spacing, step, NodeSpread::even, study.context);
      const FlowSummary& summary = run.flow.summary;
      const auto m = static_cast<double>(summary.num_intervals);
      const double k = run.seconds / m;
      time.add({std::string(name), summary.num_intervals, static_cast<Index>(summary.num_iterations), run.seconds, k,
                run.error * k / (summary.mean_interval * relative_a1(summary.cst)), run.error});
      series.x.push_back(m);
      series.y.push_back(run.seconds);
    }
    exponents.push_back(fit_power_law(series.x, series.y).exponent);
    against_time.series.push_back(std::move(series));
  }
  section.add(figure_of("appendix2_a4", "In place of Figure A(4): measured time.", against_time));
  section.measured(
      fmt::format("Explicit steps, as the paper has them, take a time that grows as m<sup>{:.1f}</sup>; implicit ones "
                  "as m<sup>{:.1f}</sup>.",
                  exponents[0], exponents[1]));
  section.add(time);
  section.remark(
      "By (A1) the factor err / (…) in (A2) is L, so (A2) says Time = K L / ε̄ = K m. That is right once K is measured, "
      "but K is no "
      "constant: explicit steps must be shorter than ε²/2 to be stable, so the number of steps, and with it K, grows "
      "as m².");
}

}  // namespace taut::paper
