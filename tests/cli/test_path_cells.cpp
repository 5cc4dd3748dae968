// taut path, field, info and mesh: what is chosen by --grid, --march, --envelope, --method grid and --spacing is what
// is used, and options without effect are refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
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
  // In many dimensions.
  const ProgramResult seven =
      run_taut({"path", "x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1", "--from", "1,0,0,0,0,0,0", "--to", "0,1,0,0,0,0,0",
                "--grid", "grow", "--march", "dijkstra", "--cell", "0.3"});
  EXPECT_EQ(seven.exit_code, 3);
  EXPECT_NE(seven.err.find("--grid grow with --march axis"), std::string::npos) << seven.err;
}

}  // namespace
}  // namespace taut
