// Appendix I: how many cells Algorithms I and II test, and how long that takes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "chart.hpp"
#include "parts.hpp"
#include "random_points.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

constexpr Index kSeeds = 500;
constexpr std::array kColours = {kRed, kAmber, kGreen, kBlue, kViolet};

Surface unit_hypersphere(Index dim) {
  std::string formula;
  for (Index i = 1; i <= dim; ++i) formula += fmt::format("{}x{}^2", i == 1 ? "" : "+", i);
  return parse_surface(formula + "=1", {.dim = dim});
}

/// Cell sizes, a dozen to a hundred thousand cells.
std::vector<double> sizes_for(Index dim) {
  switch (dim) {
    case 2: return {0.05, 0.0125, 0.003125, 0.00078125};
    case 3: return {0.2, 0.1, 0.05, 0.025};
    case 4: return {0.4, 0.25, 0.16, 0.1};
    case 5: return {0.6, 0.45, 0.33, 0.25};
    default: return {0.8, 0.65, 0.52, 0.42};
  }
}

struct Counted {
  Index num_cells = 0;
  Index num_tests = 0;
  double seconds = 0;
};

/// What the paper counts for one seed in its extreme case, if the patch's neighbours are tested anew at every step.
double paper_worst_case(Index num_cells, Index dim) {
  const auto n = static_cast<double>(num_cells);
  const auto d = static_cast<double>(dim);
  return n * n * (d - 1) + n * (d + 1);
}

template <class Make>
Counted count(const Make& make) {
  CellCounts counts;
  const ProcessorClock clock;
  const CellGrid grid = make(&counts);
  return {grid.num_cells(), counts.num_tests, clock.seconds()};
}

/// Time of one source to all cells, by each march.
Table march_times(const Context& context) {
  Table table{
      .name = "appendix1_march",
      .title = "One source to all N cells of the unit sphere",
      .columns = {{"cells N"}, {"fast marching, s", "{:.2e}"}, {"Dijkstra, s", "{:.2e}"}, {"convergent, s", "{:.2e}"}}};
  const Surface sphere = unit_hypersphere(3);
  std::vector<double> sizes;
  std::array<std::vector<double>, 3> seconds;
  for (const double cell : {0.1, 0.05, 0.025, 0.0125}) {
    SurfaceCells cells(sphere, subdivide(sphere, {.size = cell}, context), context);
    sizes.push_back(static_cast<double>(cells.num_cells()));
    std::vector<Value> row = {cells.num_cells()};
    std::size_t column = 0;
    for (const MarchMethod method : {MarchMethod::axis, MarchMethod::dijkstra, MarchMethod::convergent}) {
      const ProcessorClock clock;
      static_cast<void>(march(sphere, cells, Eigen::Vector3d(0, 0, 1), {.method = method}, context));
      seconds[column].push_back(clock.seconds());
      row.emplace_back(seconds[column++].back());
    }
    table.add(std::move(row));
  }
  std::vector<Value> exponents = {std::string("fitted exponent of N")};
  for (const std::vector<double>& column : seconds) {
    exponents.emplace_back(fmt::format("{:.2f}", fit_power_law(sizes, column).exponent));
  }
  table.add(std::move(exponents));
  return table;
}

struct Measured {
  Index dim;
  std::vector<double> cells, tests1, tests2, seconds1, seconds2;
};

}  // namespace

void write_appendix1(Study& study, Report& report) {
  Section& section = report.section("Appendix I");
  section.paper(
      "Algorithm I tests O(2<sup>d</sup>N) cells to find N of them, since every cell that is kept is cut into "
      "2<sup>d</sup>. "
      "Algorithm II tests the 2d neighbours of every cell; grown from a single seed, with the patch’s whole rim tested "
      "at "
      "each step, that is n²(d − 1) + n(d + 1) tests in the extreme case, so O(dN²).");
  Table table{.name = "appendix1_counts",
              .title = "Cell tests and time on the unit hypersphere",
              .columns = {{"d"},
                          {"σ", "{:.3g}"},
                          {"cells N"},
                          {"I: tests"},
                          {"I: tests / N", "{:.2f}"},
                          {"I: µs / N", "{:.2f}"},
                          {"II, one seed: tests"},
                          {"II: tests / N", "{:.2f}"},
                          {"II: µs / N", "{:.2f}"},
                          {"II, 500 seeds: tests"},
                          {"paper’s worst case for II", "{:.2e}"}}};
  std::vector<Measured> all;
  for (Index dim = 2; dim <= 6; ++dim) {
    const Surface sphere = unit_hypersphere(dim);
    RandomNumbers random(7);
    Points seeds(dim, kSeeds);
    for (Index i = 0; i < kSeeds; ++i) seeds.col(i) = random.direction(dim);
    Measured measured{.dim = dim, .cells = {}, .tests1 = {}, .tests2 = {}, .seconds1 = {}, .seconds2 = {}};
    const Vector origin = Vector::Constant(dim, -1.61803);                     // no round faces on round numbers
    const Box box{Vector::Constant(dim, -1.05), Vector::Constant(dim, 1.05)};  // the search for it is not Algorithm I
    for (const double size : sizes_for(dim)) {
      study.context.check_cancelled();
      const Counted one = count([&](CellCounts* counts) {
        return subdivide(sphere, {.size = size, .box = box, .origin = origin, .counts = counts}, study.context);
      });
      const Counted two = count([&](CellCounts* counts) {
        return grow(sphere, seeds.col(0), {.size = size, .origin = origin, .counts = counts}, study.context);
      });
      const Counted seeded = count([&](CellCounts* counts) {
        return grow(sphere, seeds, {.size = size, .origin = origin, .counts = counts}, study.context);
      });
      const auto n = static_cast<double>(one.num_cells);
      table.add({dim, size, one.num_cells, one.num_tests, static_cast<double>(one.num_tests) / n, 1e6 * one.seconds / n,
                 two.num_tests, static_cast<double>(two.num_tests) / n, 1e6 * two.seconds / n, seeded.num_tests,
                 paper_worst_case(one.num_cells, dim)});
      measured.cells.push_back(n);
      measured.tests1.push_back(static_cast<double>(one.num_tests));
      measured.tests2.push_back(static_cast<double>(two.num_tests));
      measured.seconds1.push_back(one.seconds);
      measured.seconds2.push_back(two.seconds);
    }
    all.push_back(std::move(measured));
  }

  Table exponents{.name = "appendix1_exponents",
                  .title = "Fitted exponents: tests ~ N^p in every dimension",
                  .columns = {{"d"},
                              {"I: p", "{:.3f}"},
                              {"paper: p"},
                              {"II from one seed: p", "{:.3f}"},
                              {"paper: p "},
                              {"I: tests / N, finest", "{:.2f}"},
                              {"2ᵈ"},
                              {"II: tests / N, finest", "{:.2f}"},
                              {"2d"}}};
  Chart tests{.title = "Cell tests against cells", .x = {"cells N", true}, .y = {"tests", true}, .series = {}};
  Chart growth{.title = "Tests a cell, against the dimension",
               .x = {"dimension d"},
               .y = {"tests / N", true},
               .series = {{.name = "Algorithm I", .colour = kRed},
                          {.name = "2^{d}", .colour = kRed, .marks = false, .dash = 5},
                          {.name = "Algorithm II", .colour = kBlue},
                          {.name = "2d", .colour = kBlue, .marks = false, .dash = 5}}};
  double least = 10, most = 0;
  std::vector<std::string> rates1, rates2, predicted;
  for (const Measured& measured : all) {
    const double p1 = fit_power_law(measured.cells, measured.tests1).exponent;
    const double p2 = fit_power_law(measured.cells, measured.tests2).exponent;
    least = std::min({least, p1, p2});
    most = std::max({most, p1, p2});
    const double rate1 = measured.tests1.back() / measured.cells.back();
    const double rate2 = measured.tests2.back() / measured.cells.back();
    const Index corners = Index(1) << measured.dim;
    rates1.push_back(fmt::format("{:.1f}", rate1));
    rates2.push_back(fmt::format("{:.1f}", rate2));
    predicted.push_back(fmt::format("{:.1f}", static_cast<double>(corners) / static_cast<double>(corners / 2 - 1)));
    exponents.add({measured.dim, p1, Index(1), p2, Index(2), rate1, corners, rate2, 2 * measured.dim});
    const Colour colour = kColours[static_cast<std::size_t>(measured.dim - 2)];
    tests.series.push_back(
        {.name = fmt::format("I, d = {}", measured.dim), .x = measured.cells, .y = measured.tests1, .colour = colour});
    tests.series.push_back({.name = fmt::format("II, d = {}", measured.dim),
                            .x = measured.cells,
                            .y = measured.tests2,
                            .colour = colour,
                            .dash = 5});
    for (const auto& [series, value] : {std::pair<std::size_t, double>{0, rate1},
                                        {1, static_cast<double>(corners)},
                                        {2, rate2},
                                        {3, 2.0 * static_cast<double>(measured.dim)}}) {
      growth.series[series].x.push_back(static_cast<double>(measured.dim));
      growth.series[series].y.push_back(value);
    }
  }
  section.measured(fmt::format(
      "Both algorithms are linear in N: the fitted exponents lie between {:.2f} and {:.2f}, also for "
      "Algorithm II from a single "
      "seed. For each cell that is kept Algorithm I tests {} cells in {} to {} dimensions, which is less than "
      "2<sup>d</sup> from three on; Algorithm II tests {}, fewer than 2d, since neighbours share theirs.",
      least, most, fmt::join(rates1, ", "), all.front().dim, all.back().dim, fmt::join(rates2, ", ")));
  std::vector<Figure> charts;
  charts.push_back(figure_of("appendix1_tests", "Algorithm I (whole lines) and II from one seed (dashed).", tests));
  charts.push_back(figure_of("appendix1_growth",
                             "How the work for one cell grows with the dimension, at the finest cells.", growth));
  section.add_row(std::move(charts));
  section.add(exponents);
  section.add(table);
  section.paper(
      "Section 3.2 gives O(N² log N) for fast marching between all pairs, and so about O(N²(d + log N)) with Algorithm "
      "II.");
  section.add(march_times(study.context));
  section.text(
      "One source costs about N log N, so N sources cost N² log N, as stated. With O(dN) for the cells the whole is "
      "O(N² log N + dN).");
  section.remark(
      "O(dN²) is what it costs to test the rim of the whole patch again in every round. A hash of the cells that were "
      "seen makes "
      "every test happen once: O(dN), whatever the number of seeds. The many samples of a cloud then save no tests, "
      "only rounds. "
      "The paper’s estimate is an upper bound, so nothing contradicts it.");
  section.remark(fmt::format(
      "The paper’s sum for Algorithm I goes one level too far: it tests the 2<sup>d</sup> parts of the N cells of "
      "the last size, too, which need not be cut. Without them its own assumption, that half of the parts "
      "survive, gives 2<sup>d</sup>/(2<sup>d−1</sup> − 1) tests a cell: {} for d = {} to {}. That is what is "
      "measured where cells are small against the body; in the higher dimensions they are not yet. So the work is "
      "O(N), and what grows with d exponentially is N itself.",
      fmt::join(predicted, ", "), all.front().dim, all.back().dim));
}

}  // namespace taut::paper
