// taut exp: what it writes, and how it ends when a ray cannot be followed.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
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

ProgramResult ray(const std::string& surface, const std::string& from, const std::string& direction,
                  const std::string& length, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"exp",     surface,    "--from", from,    "--dir",
                                        direction, "--length", length,   "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_taut(arguments);
}

TEST(ExpCommand, WritesTheContractsJson) {
  const ProgramResult result = ray(kSphere, "1,0,0", "0,2,0", "4");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["command"], "exp");
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["length"], 4.0);
  EXPECT_NEAR(json["point"][0].get<double>(), std::cos(4), 1e-14);
  EXPECT_NEAR(json["direction"][1].get<double>(), std::cos(4), 1e-14);
  EXPECT_NEAR(json["conjugate_at"].get<double>(), std::acos(-1), 1e-14);
  EXPECT_GT(json["error"].get<double>(), 0);
  EXPECT_GT(json["points"].size(), 20U);
  const auto back = nlohmann::json::parse(ray(kSphere, "1,0,0", "0,2,0", "-3").out);
  EXPECT_NEAR(back["point"][1].get<double>(), -std::sin(3), 1e-14);
  EXPECT_TRUE(back["conjugate_at"].is_null());
}

TEST(ExpCommand, WritesFiles) {
  const TempFolder folder;
  for (const std::string name : {"ray.csv", "ray.ply", "ray.html", "ray.svg", "ray.json"}) {
    const std::string file = (folder.path() / name).string();
    const ProgramResult result = ray(kSphere, "1,0,0", "0,1,1", "2", {"--out", file});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GT(std::filesystem::file_size(file), 100U) << name;
  }
}

TEST(ExpCommand, EndsWithTheContractsCodes) {
  EXPECT_EQ(ray("x^2+y^2=z^2", "1,0,1", "-1,0,-1", "3").exit_code, 5);
  const ProgramResult cut = ray(kSphere, "0,0,1", "0,1,0", "3", {"--domain", "z>=0"});
  EXPECT_EQ(cut.exit_code, 5);
  const auto json = nlohmann::json::parse(cut.out);
  EXPECT_EQ(json["status"], "left_domain");
  EXPECT_FALSE(json["converged"]);
  EXPECT_NEAR(json["length"].get<double>(), std::acos(0), 1e-14);
  for (const auto& [from, direction, code] :
       std::vector<std::tuple<std::string, std::string, int>>{{"0,0,0", "0,1,0", 3},
                                                              {"1,0,0", "0,0,0", 3},
                                                              {"1,0,0", "1,0,0", 3},
                                                              {"1,0,0", "0,1", 3},
                                                              {"1,0", "0,1,0", 3},
                                                              {"90,0,0", "0,1,0", 3},
                                                              {"1,0,0", "nan,1,0", 3},
                                                              {"1,0,0", "up", 2}}) {
    const ProgramResult bad = ray(kSphere, from, direction, "1", {"--quiet"});
    EXPECT_EQ(bad.exit_code, code) << from << " " << direction << "\n" << bad.err;
    EXPECT_TRUE(bad.out.empty());
    EXPECT_EQ(lines_of(bad.err).size(), 1U) << bad.err;
  }
  EXPECT_EQ(ray(kSphere, "1,0,0", "0,1,0", "far").exit_code, 2);
  EXPECT_EQ(run_taut({"exp", kSphere, "--from", "1,0,0", "--dir", "0,1,0"}).exit_code, 2);
  EXPECT_EQ(run_taut({"exp", kSphere, "--rays", "missing.csv"}).exit_code, 3);
  EXPECT_EQ(run_taut({"exp", kSphere, "--rays", "missing.csv", "--json"}).exit_code, 2);
}

TEST(ExpCommand, VerifiesPaths) {
  const std::vector<std::string> path = {"path", kSphere, "--from", "1,0,0", "--to", "0,1,0", "--verify", "--json"};
  const ProgramResult result = run_taut(path);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto verify = nlohmann::json::parse(result.out)["verify"];
  EXPECT_EQ(verify["status"], "ok");
  EXPECT_LT(verify["miss"].get<double>(), 1e-5);
  EXPECT_LT(std::abs(verify["miss_along"].get<double>()), 1e-9);
  std::vector<std::string> flow = path;
  flow.insert(flow.end(), {"--method", "flow"});
  EXPECT_EQ(run_taut(flow).exit_code, 2);
}

TEST(ExpCommand, AnswersRaysLineByLine) {
  const TempFolder folder;
  const auto rays =
      folder.write("rays.csv",
                   "# start, direction, length\n1,0,0,0,1,0,0\n1,0,0,0,0,0,1\n1,0,0,zero,1,0,1\n1,0,0,0,1,0\n"
                   "1,0,0,0,1,0,1\n");
  const ProgramResult result = run_taut({"exp", kSphere, "--rays", rays.string()});
  EXPECT_EQ(result.exit_code, 1);
  const auto answers = lines_of(result.out);
  ASSERT_EQ(answers.size(), 5U) << result.out;
  EXPECT_TRUE(answers[0].starts_with("1,0,0,0,1,0,")) << answers[0];
  for (const std::size_t good : {0U, 4U}) EXPECT_TRUE(answers[good].ends_with(",ok")) << answers[good];
  EXPECT_EQ(answers[1], "nan,nan,nan,nan,nan,nan,inf,not_converged");  // it can be read, but leads nowhere
  for (const std::size_t bad : {2U, 3U}) EXPECT_EQ(answers[bad], "nan,nan,nan,nan,nan,nan,inf,bad_input");
  EXPECT_NEAR(std::stod(answers[4]), std::cos(1), 1e-15);
  EXPECT_EQ(lines_of(result.err).size(), 3U) << result.err;
}

}  // namespace
}  // namespace taut
