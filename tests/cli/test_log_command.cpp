// taut log and taut transport: what they write, and how they end.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::lines_of;
using test::ProgramResult;
using test::run_taut;
using test::TempFolder;

const std::string kSphere = "x^2+y^2+z^2=1";

TEST(LogCommand, WritesTheContractsJson) {
  const ProgramResult result = run_taut({"log", kSphere, "--from", "1,0,0", "--to", "0,1,0", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["command"], "log");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_NEAR(json["length"].get<double>(), std::numbers::pi / 2, 1e-13);
  EXPECT_NEAR(json["direction"][1].get<double>(), 1, 1e-12);
  EXPECT_NEAR(json["velocity"][1].get<double>(), std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(json["arrival"][0].get<double>(), -1, 1e-12);
  EXPECT_NEAR(json["m12"].get<double>(), 1, 1e-12);  // sin(pi / 2)
  EXPECT_NEAR(json["M12"].get<double>(), 0, 1e-12);
  EXPECT_LT(json["miss"].get<double>(), 1e-11);
  EXPECT_TRUE(json["unique"].get<bool>());
}

/// Behind the start a line of --to-file is what `taut exp --rays` takes.
TEST(LogCommand, AnswersManyPointsLineByLine) {
  const TempFolder folder;
  const auto targets = folder.write("targets.csv", "0,1,0\n0.6,0,0.8\n1,0\n9,9,9\n1,0,0\n");
  const ProgramResult result = run_taut({"log", kSphere, "--from", "1,0,0", "--to-file", targets.string(), "--header"});
  EXPECT_EQ(result.exit_code, 1);
  const auto lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 6U) << result.out;
  EXPECT_EQ(lines[0], "v1,v2,v3,length,error,status");
  EXPECT_TRUE(lines[1].ends_with(",ok"));
  EXPECT_TRUE(lines[3].ends_with(",nan,inf,bad_input")) << lines[3];
  EXPECT_TRUE(lines[4].ends_with(",nan,inf,not_converged")) << lines[4];
  EXPECT_NE(lines[5].find(",0,"), std::string::npos) << lines[5];
  std::string rays;
  for (const std::size_t i : {1U, 2U}) {
    const std::string ray = lines[i].substr(0, lines[i].rfind(',', lines[i].rfind(',') - 1));
    rays += "1,0,0," + ray + "\n";
  }
  const ProgramResult back = run_taut({"exp", kSphere, "--rays", folder.write("rays.csv", rays).string()});
  ASSERT_EQ(back.exit_code, 0) << back.err;
  const auto ends = lines_of(back.out);
  EXPECT_NEAR(std::stod(ends[0].substr(ends[0].find(',') + 1)), 1, 1e-9);
  EXPECT_NEAR(std::stod(ends[1]), 0.6, 1e-9);
}

TEST(LogCommand, EndsWithTheContractsCodes) {
  EXPECT_EQ(run_taut({"log", kSphere, "--from", "1,0,0"}).exit_code, 2);
  EXPECT_EQ(run_taut({"log", kSphere, "--from", "1,0,0", "--to", "0,1,0", "--to-file", "x"}).exit_code, 2);
  EXPECT_EQ(run_taut({"log", kSphere, "--from", "1,0", "--to", "0,1,0"}).exit_code, 3);
  EXPECT_EQ(run_taut({"log", kSphere, "--from", "1,0,0", "--to-file", "missing.csv"}).exit_code, 3);
  const ProgramResult apart =
      run_taut({"log", "((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)", "--from", "3,0,0", "--to", "-3,0,0", "--json"});
  EXPECT_EQ(apart.exit_code, 4);
  EXPECT_TRUE(nlohmann::json::parse(apart.out)["direction"].is_null());
}

TEST(TransportCommand, CarriesVectors) {
  const ProgramResult result = run_taut(
      {"transport", kSphere, "--from", "1,0,0", "--to", "0,1,0", "--vector", "0,1,0", "--vector", "5,0,2", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NEAR(json["vectors"][0][0].get<double>(), -1, 1e-12);
  EXPECT_NEAR(json["vectors"][1][2].get<double>(), 2, 1e-12);
  EXPECT_NEAR(json["vectors_from"][1][0].get<double>(), 0, 1e-15);
  EXPECT_LT(json["error"].get<double>(), 1e-12);
}

TEST(TransportCommand, GoesAlongACurveAndToManyPoints) {
  const TempFolder folder;
  const auto curve = folder.write("octant.csv", "1,0,0\n0,1,0\n0,0,1\n1,0,0\n");
  const ProgramResult round =
      run_taut({"transport", kSphere, "--along", curve.string(), "--vector", "0,1,0", "--json"});
  ASSERT_EQ(round.exit_code, 0) << round.err;
  EXPECT_NEAR(nlohmann::json::parse(round.out)["vectors"][0][2].get<double>(), 1, 1e-12);
  const auto targets = folder.write("targets.csv", "0,1,0\n0,0,1\n2,2\n");
  for (const std::string& surface : {kSphere, std::string("x1^2+x2^2+x3^2+x4^2=1")}) {
    const bool space = surface == kSphere;
    const ProgramResult many =
        run_taut({"transport", surface, "--from", space ? "1,0,0" : "1,0,0,0", "--to-file",
                  space ? targets.string() : folder.write("four.csv", "0,1,0,0\n0,0,1,0\n2,2\n").string(), "--vector",
                  space ? "0,1,0" : "0,1,0,0"});
    EXPECT_EQ(many.exit_code, 1) << many.err;
    const auto lines = lines_of(many.out);
    ASSERT_EQ(lines.size(), 3U) << many.out;
    EXPECT_NEAR(std::stod(lines[0]), -1, 1e-9);
    EXPECT_NEAR(std::stod(lines[1].substr(lines[1].find(',') + 1)), 1, 1e-9);
    EXPECT_TRUE(lines[2].ends_with("nan,bad_input"));
  }
}

TEST(TransportCommand, EndsWithTheContractsCodes) {
  EXPECT_EQ(run_taut({"transport", kSphere, "--from", "1,0,0", "--to", "0,1,0"}).exit_code, 2);
  EXPECT_EQ(run_taut({"transport", kSphere, "--from", "1,0,0", "--vector", "0,1,0"}).exit_code, 2);
  EXPECT_EQ(run_taut({"transport", kSphere, "--from", "1,0,0", "--to", "0,1,0", "--vector", "0,1"}).exit_code, 3);
}

}  // namespace
}  // namespace taut
