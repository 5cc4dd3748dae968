// taut path --via: what it writes, and how it ends when a leg cannot be found.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::ProgramResult;
using test::run_taut;

const std::string kSphere = "x^2+y^2+z^2=1";

TEST(PathVia, WritesLegsInOrder) {
  const ProgramResult result =
      run_taut({"path", kSphere, "--from", "1,0,0", "--via", "0,1,0", "--via", "0,0,1", "--to", "-1,0,0", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const double quarter = std::acos(0.0);
  EXPECT_EQ(json["command"], "path");
  EXPECT_NEAR(json["length"].get<double>(), 3 * quarter, 1e-12);
  EXPECT_EQ(json["index"], 0);
  ASSERT_EQ(json["legs"].size(), 3U);
  ASSERT_EQ(json["via"].size(), 2U);
  EXPECT_EQ(json["via"][1], nlohmann::json({0.0, 0.0, 1.0}));
  for (const auto& leg : json["legs"]) {
    EXPECT_NEAR(leg["length"].get<double>(), quarter, 1e-12);
    EXPECT_TRUE(leg["unique"]);
    EXPECT_EQ(leg["status"], "ok");
  }
}

TEST(PathVia, EndsWithTheContractsCodes) {
  const std::string two = "(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0";
  const ProgramResult apart = run_taut({"path", two, "--from", "1,0,0", "--via", "5,0,0", "--to", "0,1,0", "--json"});
  EXPECT_EQ(apart.exit_code, 4);
  EXPECT_NE(apart.err.find("leg 1 of 2"), std::string::npos) << apart.err;
  EXPECT_TRUE(nlohmann::json::parse(apart.out)["length"].is_null());
  const std::vector<std::pair<int, std::vector<std::string>>> bad = {
      {2, {"--from", "1,0,0", "--via", "0,1,0"}},
      {2, {"--from", "1,0,0", "--to", "0,0,1", "--via", "0,one,0"}},
      {2, {"--from", "1,0,0", "--to", "0,0,1", "--via", "0,1,0", "--all"}},
      {2, {"--from", "1,0,0", "--to", "0,0,1", "--via", "0,1,0", "--verify"}},
      {3, {"--from", "1,0,0", "--to", "0,0,1", "--via", "0,1"}},
      {3, {"--from", "1,0,0", "--to", "0,0,1", "--via", "0,nan,1"}},
      {3, {"--from", "1,0,0", "--to", "0,0,1", "--via", "0,0,0"}},
      {3, {"--from", "1,0,0", "--to", "0,0,1", "--via", "50,0,0"}},
      {3, {"--from", "1,0,0", "--to", "0,0,1", "--via", "@3"}},
  };
  for (const auto& [code, options] : bad) {
    std::vector<std::string> arguments = {"path", kSphere};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(arguments);
    EXPECT_EQ(result.exit_code, code) << options.back() << ": " << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
}

}  // namespace
}  // namespace taut
