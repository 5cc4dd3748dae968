// taut curve: what it writes, and how it ends.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::file_bytes;
using test::lines_of;
using test::ProgramResult;
using test::run_taut;
using test::TempFolder;

const std::string kSphere = "x^2+y^2+z^2=1";

/// A curve of two control points is the geodesic between them: a quarter circle at equal steps.
TEST(CurveCommand, WritesPoints) {
  const TempFolder folder;
  const auto controls = folder.write("two.csv", "1,0,0\n0,1,0\n");
  const ProgramResult result = run_taut({"curve", kSphere, "--bezier", controls.string(), "-n", "5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_EQ(lines.front(), "1,0,0");
  EXPECT_NEAR(std::stod(lines[2]), std::sqrt(0.5), 1e-12);
}

/// Pieces end to end: the joint once, control points 0, 2 and 4 on the curve.
TEST(CurveCommand, JoinsPiecesOfADegree) {
  const TempFolder folder;
  const auto controls = folder.write("five.csv", "1,0,0\n0.8,0.6,0\n0,1,0\n-0.6,0.8,0\n-0.6,0,0.8\n");
  const auto out = folder.path() / "curve.csv";
  const ProgramResult result = run_taut(
      {"curve", kSphere, "--bezier", controls.string(), "--degree", "2", "-n", "9", "--json", "--out", out.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["command"], "curve");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["pieces"], 2);
  ASSERT_EQ(json["points"].size(), 17U);
  EXPECT_NEAR(json["points"][8][1].get<double>(), 1, 1e-15);
  EXPECT_NEAR(json["points"][16][2].get<double>(), 0.8, 1e-15);
  EXPECT_EQ(lines_of(file_bytes(out)).size(), 18U);  // with a header
}

TEST(CurveCommand, RefusesWhatMakesNoCurve) {
  const TempFolder folder;
  const auto one = folder.write("one.csv", "1,0,0\n");
  const auto four = folder.write("four.csv", "1,0,0\n0,1,0\n-1,0,0\n0,-1,0\n");
  EXPECT_EQ(run_taut({"curve", kSphere, "--bezier", one.string()}).exit_code, 3);
  const ProgramResult odd = run_taut({"curve", kSphere, "--bezier", four.string(), "--degree", "2"});
  EXPECT_EQ(odd.exit_code, 3);
  EXPECT_NE(odd.err.find("give 3 or 5"), std::string::npos) << odd.err;
  EXPECT_EQ(run_taut({"curve", "x^2+y^2+z^2+w^2=1", "--bezier", four.string(), "--out", "a.png"}).exit_code, 2);
}

}  // namespace
}  // namespace taut
