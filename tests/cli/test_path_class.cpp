// taut path --start and --closed: what they write, and how they end.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cli/run_program.hpp"
#include "support/loops.hpp"

namespace taut {
namespace {

using std::numbers::pi;
using test::ProgramResult;
using test::run_taut;
using test::TempFolder;

const std::string kCylinder = "x^2+y^2=1+0*z";
const std::string kSphere = "x^2+y^2+z^2=1";

std::string write(const TempFolder& folder, const std::string& name, const Points& points) {
  std::string file = (folder.path() / name).string();
  std::ofstream out(file);
  out.precision(17);
  for (Index j = 0; j < points.cols(); ++j) {
    for (Index i = 0; i < points.rows(); ++i) out << (i > 0 ? "," : "") << points(i, j);
    out << "\n";
  }
  return file;
}

Points turns(Index n, double angle) {
  return test::polyline(n, [=](double t) { return test::on_cylinder(angle * t, t); });
}

TEST(PathClass, StartKeepsTheClass) {
  const TempFolder folder;
  const std::string file = write(folder, "twice.csv", turns(30, 4 * pi));
  for (const std::string method : {"newton", "flow"}) {
    const ProgramResult result =
        run_taut({"path", kCylinder, "--start", file, "--from", "1,0,0", "--method", method, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_NEAR(json["length"].get<double>(), std::hypot(4 * pi, 1), method == "newton" ? 1e-10 : 5e-4);
    EXPECT_TRUE(json["unique"].is_null());
    EXPECT_EQ(json["status"], "ok");
  }
  const ProgramResult verified = run_taut({"path", kCylinder, "--start", file, "--verify", "--json"});
  EXPECT_LT(nlohmann::json::parse(verified.out)["verify"]["miss"].get<double>(), 1e-6);
}

TEST(PathClass, ClosedSaysWhatItIs) {
  const TempFolder folder;
  const std::string equator =
      write(folder, "inner.csv",
            test::polyline(30, [](double t) { return test::on_torus(2 * pi * t, pi + 0.5 * std::sin(2 * pi * t)); }));
  const ProgramResult result = run_taut({"path", "(sqrt(x^2+y^2)-1)^2+z^2=0.16", "--closed", equator, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NEAR(json["length"].get<double>(), 1.2 * pi, 1e-10);
  EXPECT_FALSE(json["closed"]["is_point"]);
  EXPECT_EQ(json["index"], 0);
  EXPECT_TRUE(json["locally_shortest"]);
  EXPECT_EQ(json["points"].front(), json["points"].back());

  const std::string small = write(folder, "small.csv", test::loop(20, [](double t) -> Vector {
                                    return Eigen::Vector3d(0.5 * std::cos(2 * pi * t), 0.5 * std::sin(2 * pi * t), 0.8);
                                  }));
  const ProgramResult point = run_taut({"path", kSphere, "--closed", small, "--json"});
  ASSERT_EQ(point.exit_code, 0) << point.err;
  const auto shrunk = nlohmann::json::parse(point.out);
  EXPECT_EQ(shrunk["status"], "ok");
  EXPECT_EQ(shrunk["length"], 0.0);
  EXPECT_TRUE(shrunk["closed"]["is_point"]);
  EXPECT_TRUE(shrunk["closed"]["kink"].is_null());
}

// The second variation round the waist of a spheroid of half height 1.2 is that of -u'' - K u with K = 1 / 1.44 on a
// circle of length 2 pi: its eigenvalues n^2 - K are negative for n = 0 alone.
TEST(PathClass, CountsTheWaysToShortenALoop) {
  const TempFolder folder;
  const std::string waist = write(folder, "waist.csv", test::loop(30, [](double t) -> Vector {
                                    return Eigen::Vector3d(std::cos(2 * pi * t), std::sin(2 * pi * t), 0);
                                  }));
  const ProgramResult result = run_taut({"path", "x^2+y^2+z^2/1.44=1", "--closed", waist, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NEAR(json["length"].get<double>(), 2 * pi, 1e-10);
  EXPECT_FALSE(json["locally_shortest"]);
  EXPECT_EQ(json["index"], 1);
}

TEST(PathClass, WritesFiles) {
  const TempFolder folder;
  const std::string file = write(folder, "ring.csv", turns(20, 2 * pi).leftCols(20));
  for (const std::string name : {"loop.csv", "loop.ply", "loop.html", "loop.svg", "loop.json"}) {
    const std::string out = (folder.path() / name).string();
    const ProgramResult result = run_taut({"path", kCylinder, "--start", file, "--out", out});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GT(std::filesystem::file_size(out), 100U) << name;
  }
}

TEST(PathClass, EndsWithTheContractsCodes) {
  const TempFolder folder;
  const std::string good = write(folder, "good.csv", turns(30, 4 * pi));
  const std::string coarse = write(folder, "coarse.csv", turns(5, 4 * pi));
  const std::string one = write(folder, "one.csv", turns(1, 1).leftCols(1));
  const std::string flat = write(folder, "flat.csv", Points::Ones(2, 4));
  const std::string missing = (folder.path() / "missing.csv").string();
  const std::vector<std::pair<int, std::vector<std::string>>> bad = {
      {3, {"--start", coarse}},
      {3, {"--start", one}},
      {3, {"--start", flat}},
      {3, {"--start", missing}},
      {3, {"--closed", coarse}},
      {3, {"--closed", one}},
      {3, {"--closed", missing}},
      {3, {"--start", good, "--from", "0,1,0"}},
      {3, {"--start", good, "--to", "1,0,0.5"}},
      {2, {"--start", good, "--closed", good}},
      {2, {"--start", good, "--via", "1,0,0"}},
      {2, {"--start", good, "--to-file", good}},
      {2, {"--start", good, "--pairs", good}},
      {2, {"--start", good, "--all"}},
      {2, {"--start", good, "--method", "grid"}},
      {2, {"--closed", good, "--method", "flow"}},
      {2, {"--closed", good, "--from", "1,0,0"}},
      {2, {"--start", good, "--method", "flow", "--verify"}},
  };
  for (const auto& [code, options] : bad) {
    std::vector<std::string> arguments = {"path", kCylinder};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(arguments);
    EXPECT_EQ(result.exit_code, code) << options[0] << " " << options.back() << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    if (options.back() == coarse) {
      EXPECT_NE(result.err.find("points 1 and 2"), std::string::npos) << result.err;
      EXPECT_NE(result.err.find("coarse.csv"), std::string::npos) << result.err;
    }
  }
}

}  // namespace
}  // namespace taut
