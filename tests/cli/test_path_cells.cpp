// taut path, field, info and mesh: what is chosen by --grid, --march, --envelope, --method grid and the flow's options
// is what is used, and options without effect are refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/run_program.hpp"
#include "support/temp_folder.hpp"

namespace taut {
namespace {

using Json = nlohmann::json;
using test::ProgramResult;
using test::run_taut;

// Figure 5 of the paper: a hemisphere.
const double kTruth = std::acos(-0.8 * 0.6 + 0.6 * 0.64);

Json hemisphere(const std::vector<std::string>& options) {
  std::vector<std::string> words = {"path",      "x^2+y^2+z^2=1",       "--domain", "z>=0",   "--from",
                                    "0.8,0,0.6", "--to=-0.6,0.48,0.64", "--json",   "--quiet"};
  words.insert(words.end(), options.begin(), options.end());
  const ProgramResult result = run_taut(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.exit_code == 0 ? Json::parse(result.out) : Json();
}

double longest_interval(const Json& points) {
  double longest = 0;
  for (std::size_t j = 1; j < points.size(); ++j) {
    double squares = 0;
    for (std::size_t a = 0; a < points[j].size(); ++a) {
      squares += std::pow(points[j][a].get<double>() - points[j - 1][a].get<double>(), 2);
    }
    longest = std::max(longest, std::sqrt(squares));
  }
  return longest;
}

TEST(PathCells, TheGridsPathIsToldAsItIs) {
  for (const char* march : {"convergent", "axis", "dijkstra"}) {
    const Json path = hemisphere({"--method", "grid", "--march", march, "--cell", "0.2"});
    EXPECT_EQ(path["march"], march);
    EXPECT_TRUE(path["converged"].is_null());
    EXPECT_TRUE(path["locally_shortest"].is_null());
    EXPECT_TRUE(path["unique"].is_null());
    EXPECT_TRUE(path["candidates"].empty());
    EXPECT_GT(path["length"].get<double>(), 0.95 * kTruth) << march;  // corners are cut
    EXPECT_LT(path["length"].get<double>(), 1.3 * kTruth) << march;
    // A chord of half a cell stands 0.1^2 / 8 off the unit sphere; steps between cells far more.
    EXPECT_GT(path["residual"]["surface"].get<double>(), 2e-4) << march;
    EXPECT_LT(path["residual"]["surface"].get<double>(), 0.35) << march;
    EXPECT_GT(path["residual"]["geodesic_curvature"].get<double>(), 1e-3) << march;
  }
}

TEST(PathCells, EachMarchMeasuresItsOwnWay) {
  // Bare cells leave the paper's march 15 to 30 % too long, Dijkstra's 0 to 8 %, the convergent one below 0.2 %.
  const auto marched = [](const char* march, const char* cell) {
    return hemisphere({"--march", march, "--cell", cell})["marched"].get<double>() / kTruth;
  };
  EXPECT_NEAR(marched("convergent", "0.1"), 1, 0.002);
  const double dijkstra = marched("dijkstra", "0.1");
  EXPECT_GT(dijkstra, 1.002);
  EXPECT_LT(dijkstra, 1.09);
  const double axis = marched("axis", "0.1");
  EXPECT_GT(axis, 1.09);
  EXPECT_LT(axis, 1.4);
}

TEST(PathCells, AnEnvelopeIsMarchedIn) {
  const Json bare = hemisphere({"--march", "axis", "--cell", "0.05"});
  const Json thick = hemisphere({"--march", "axis", "--cell", "0.05", "--envelope", "2"});
  const Json law = hemisphere({"--march", "axis", "--cell", "0.05", "--envelope", "auto"});
  EXPECT_EQ(bare["envelope"], 0);
  EXPECT_EQ(thick["envelope"], 2);
  EXPECT_EQ(law["envelope"], 2);  // 0.25 sqrt(2 / 0.05), rounded up
  EXPECT_GT(thick["cells"].get<int>(), 2 * bare["cells"].get<int>());
  EXPECT_LT(std::abs(thick["marched"].get<double>() - kTruth), 0.5 * std::abs(bare["marched"].get<double>() - kTruth));
  for (const Json& path : {bare, thick, law}) EXPECT_NEAR(path["length"].get<double>(), kTruth, 1e-9);
}

TEST(PathCells, AlgorithmTwoGrowsFromTheEndsAndFromSamples) {
  const std::string spheres = "(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0";
  const auto cells = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"path", spheres, "--from", "1,0,0", "--to", "0,1,0", "--cell", "0.2", "--json"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Json path = Json::parse(result.out);
    EXPECT_NEAR(path["length"].get<double>(), std::acos(0.0), 1e-9);
    EXPECT_EQ(path["grid"], options.empty() ? "subdivide" : "grow");
    return path["cells"].get<double>();
  };
  const test::TempFolder folder;
  const std::string file = (folder.path() / "samples.csv").string();
  std::ofstream(file) << "5,0,0\n3,0,0\n";
  const double all = cells({});
  const double one = cells({"--grid", "grow"});
  EXPECT_NEAR(one, all / 2, 0.2 * all);  // the other sphere is not connected to the ends
  EXPECT_NEAR(cells({"--grid", "grow", "--samples", file}), all, 0.1 * all);
  // The other commands.
  const ProgramResult info =
      run_taut({"info", spheres, "--grid", "grow", "--samples", file, "--cell", "0.2", "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(Json::parse(info.out)["components"].size(), 1U);
  EXPECT_EQ(Json::parse(info.out)["grid"], "grow");
  EXPECT_GT(Json::parse(info.out)["crossing_tests"], Json::parse(info.out)["cells"]);
  const std::string mesh = (folder.path() / "one.ply").string();
  EXPECT_EQ(run_taut({"mesh", spheres, "--grid", "grow", "--samples", file, "--out", mesh}).exit_code, 0);
  const std::string field = (folder.path() / "field.ply").string();
  EXPECT_EQ(run_taut({"field", spheres, "--from", "1,0,0", "--grid", "grow", "--march", "axis", "--envelope", "auto",
                      "--out", field})
                .exit_code,
            0);
}

TEST(PathCells, AboveSixDimensionsCellsGrowWhereTheMarchGoes) {
  const ProgramResult result =
      run_taut({"path", "x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1", "--from", "1,0,0,0,0,0,0", "--to", "0.6,0.8,0,0,0,0,0",
                "--grid", "grow", "--march", "axis", "--cell", "0.5", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json path = Json::parse(result.out);
  EXPECT_EQ(path["march"], "axis");
  EXPECT_EQ(path["grid"], "grow");
  EXPECT_GT(path["cells"].get<int>(), 10);
  EXPECT_NEAR(path["length"].get<double>(), std::acos(0.6), 1e-8);
}

/// What a command that prints "name  value" says under this name.
std::string fact(const std::string& out, const std::string& name) {
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(name + " ")) return line.substr(line.find_first_not_of(' ', name.size()));
  }
  return "";
}

/// The number before the first blank, without the commas that group it.
double leading_number(std::string text) {
  std::erase(text, ',');
  return text.empty() ? 0 : std::stod(text);
}

// The farthest point of the unit sphere is its source's antipode, pi away.
TEST(MarchedField, IsMarchedAsAsked) {
  const test::TempFolder folder;
  const std::string file = (folder.path() / "field.ply").string();
  const auto field = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"field", "x^2+y^2+z^2=1", "--from", "1,0,0", "--cell",
                                      "0.1",   "--quiet",       "--out",  file};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  };
  const auto farthest = [&](const std::vector<std::string>& options) {
    return leading_number(fact(field(options), "farthest"));
  };
  const double pi = std::acos(-1.0);
  const double convergent = farthest({"--march", "convergent"});
  EXPECT_NEAR(convergent, pi, 0.05) << "a vertex within half a cell of it";
  const double axis = farthest({"--march", "axis"});
  EXPECT_GT(axis, 1.1 * pi) << "15 to 30 % too long on bare cells";
  EXPECT_LT(axis, 1.4 * pi);
  const double dijkstra = farthest({"--march", "dijkstra"});
  EXPECT_NEAR(dijkstra, pi, 0.09 * pi);
  EXPECT_GT(std::abs(dijkstra - convergent), 1e-4);
  EXPECT_LT(std::abs(farthest({"--march", "axis", "--envelope", "auto"}) - pi), 0.5 * (axis - pi));
  const std::string thick = fact(field({"--march", "axis", "--envelope", "3"}), "cells");
  EXPECT_NE(thick.find("3 layers"), std::string::npos) << thick;
  EXPECT_GT(leading_number(thick), 3 * leading_number(fact(field({"--march", "axis"}), "cells")));
}

TEST(MarchedField, GrowsFromItsSources) {
  const std::string spheres = "(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0";
  const test::TempFolder folder;
  const std::string file = (folder.path() / "field.ply").string();
  const auto cells = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"field", spheres,   "--from", "1,0,0", "--cell",
                                      "0.2",   "--march", "axis",   "--out", file};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return leading_number(fact(result.out, "cells"));
  };
  const double all = cells({"--grid", "subdivide"});
  EXPECT_NEAR(cells({"--grid", "grow"}), all / 2, 0.2 * all);
}

TEST(SurfaceCommands, GrowFromTheSamplesGiven) {
  const std::string spheres = "(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0";
  const test::TempFolder folder;
  const std::string samples = folder.write("samples.csv", "5,0,0\n3,0,0\n").string();
  const std::string file = (folder.path() / "one.ply").string();
  const auto triangles = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"mesh", spheres, "--cell", "0.2", "--out", file};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return leading_number(fact(result.out, "triangles"));
  };
  const double all = triangles({});
  EXPECT_NEAR(triangles({"--grid", "grow", "--samples", samples}), all / 2, 0.05 * all);
  const ProgramResult info = run_taut({"info", "x^2+y^2+z^2=1", "--cell", "0.1", "--envelope", "2", "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  const Json json = Json::parse(info.out);
  EXPECT_EQ(json["envelope"]["layers"], 2);
  EXPECT_GT(json["envelope"]["cells"].get<int>(), 3 * json["cells"].get<int>());
}

TEST(SurfaceCommands, InfoGrowsPatchesInSevenDimensions) {
  const std::string sphere = "x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1";
  const test::TempFolder folder;
  const std::string samples = folder.write("samples.csv", "1,0,0,0,0,0,0\n").string();
  const ProgramResult grown =
      run_taut({"info", sphere, "--grid", "grow", "--samples", samples, "--cell", "0.9", "--json"});
  ASSERT_EQ(grown.exit_code, 0) << grown.err;
  const Json json = Json::parse(grown.out);
  EXPECT_EQ(json["grid"], "grow");
  EXPECT_EQ(json["cells_complete"], true);
  EXPECT_EQ(json["components"], Json({json["cells"]}));
  EXPECT_GT(json["crossing_tests"], json["cells"]);
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--grid", "grow"}, {"--cell", "0.9"}, {"--envelope", "1"}}) {
    std::vector<std::string> words = {"info", sphere};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult refused = run_taut(words);
    EXPECT_EQ(refused.exit_code, 3) << options.front();
    EXPECT_FALSE(refused.err.empty());
  }
}

// At rest m chords of equal length span the arc of the great circle.
TEST(PathCells, FlowStepsAsAsked) {
  const auto flow = [](const std::vector<std::string>& options) {
    std::vector<std::string> words = {"--method", "flow", "--spacing", "0.1", "--cell", "0.2"};
    words.insert(words.end(), options.begin(), options.end());
    return hemisphere(words);
  };
  const Json implicit = flow({"--step", "implicit"});
  const Json exact = flow({"--step", "explicit"});
  EXPECT_EQ(flow({})["iterations"], implicit["iterations"]) << "implicit is the default";
  EXPECT_GT(exact["iterations"].get<double>(), 10 * implicit["iterations"].get<double>());
  for (const Json& path : {implicit, exact}) {
    const double m = path["flow"]["m"];
    EXPECT_NEAR(path["length"].get<double>(), 2 * m * std::sin(kTruth / (2 * m)), 1e-7);
  }
  // A step takes a node beta / 4 of its way to the surface.
  const Json slow = flow({"--step", "explicit", "--beta", "0.001"});
  EXPECT_NE(slow["iterations"], exact["iterations"]);
  EXPECT_NEAR(slow["length"].get<double>(), exact["length"].get<double>(), 1e-6);
}

// A quarter of an ellipse with semi-axes 3 and 1, a geodesic by symmetry: radii of curvature from 9 to 1/3.
TEST(PathCells, FlowSpreadsNodesAsAsked) {
  const auto variation = [](const char* nodes) {
    const ProgramResult result = run_taut({"path", "x^2/9+y^2/100+z^2=1", "--from", "0,0,1", "--to", "3,0,0",
                                           "--method", "flow", "--spacing", "0.1", "--nodes", nodes, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Json points = Json::parse(result.out)["points"];
    double least = 1e300;
    double most = 0;
    for (std::size_t j = 1; j < points.size(); ++j) {
      const auto middle = [&](int a) { return (points[j][a].get<double>() + points[j - 1][a].get<double>()) / 2; };
      const auto step = [&](int a) { return points[j][a].get<double>() - points[j - 1][a].get<double>(); };
      const double radius = std::pow(9 * middle(2) * middle(2) + middle(0) * middle(0) / 9, 1.5) / 3;
      const double ratio = std::hypot(step(0), step(1), step(2)) / radius;  // eps_i / r_i
      least = std::min(least, ratio);
      most = std::max(most, ratio);
    }
    return most / least;
  };
  EXPECT_GT(variation("even"), 15);
  EXPECT_LT(variation("curvature"), 1.6);
}

TEST(PathCells, FlowKeepsTheSpacingAskedFor) {
  for (const double spacing : {0.2, 0.05}) {
    const Json path = hemisphere({"--method", "flow", "--spacing", std::to_string(spacing)});
    EXPECT_LE(longest_interval(path["points"]), spacing * (1 + 1e-9));
    EXPECT_GT(longest_interval(path["points"]), spacing / 4);
  }
}

TEST(PathCells, OptionsWithoutEffectAreRefused) {
  const auto refused = [](const std::vector<std::string>& options, const std::string& what) {
    std::vector<std::string> words = {"path", "x^2+y^2+z^2=1", "--from", "1,0,0", "--to", "0,1,0"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(words);
    EXPECT_EQ(result.exit_code, 2) << what;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
  };
  refused({"--envelope", "2"}, "--march axis or dijkstra");
  refused({"--spacing", "0.1"}, "--spacing is for --method flow");
  refused({"--beta", "2"}, "--beta is for --method flow");
  refused({"--method", "grid", "--tol", "1e-6"}, "--tol has no effect");
  refused({"--method", "grid", "--all"}, "--all has no effect");
  refused({"--samples", "nowhere.csv"}, "--grid grow");
  // A polyline is shortened without a march.
  const test::TempFolder folder;
  const std::string line = folder.write("line.csv", "1,0,0\n0.7,0.7,0\n0,1,0\n").string();
  const ProgramResult shown = run_taut(
      {"path", "x^2+y^2+z^2=1", "--start", line, "--show", "cells", "--out", (folder.path() / "a.svg").string()});
  EXPECT_EQ(shown.exit_code, 2);
  EXPECT_NE(shown.err.find("--show has no effect"), std::string::npos) << shown.err;
  // In many dimensions.
  const ProgramResult seven =
      run_taut({"path", "x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1", "--from", "1,0,0,0,0,0,0", "--to", "0,1,0,0,0,0,0",
                "--grid", "grow", "--march", "dijkstra", "--cell", "0.3"});
  EXPECT_EQ(seven.exit_code, 3);
  EXPECT_NE(seven.err.find("(--grid grow)"), std::string::npos) << seven.err;
}

}  // namespace
}  // namespace taut
