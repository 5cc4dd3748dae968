// What goes in besides numbers on the command line, and what comes out besides one length.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::lines_of;
using test::run_taut;
using test::TempFolder;

const std::string kSphere = "x^2+y^2+z^2=1";

TEST(InputsAndOutputs, AFormulaMayStandInAFile) {
  const TempFolder folder;
  const auto file = folder.write("ball.txt", "# a ball\n(x^2 + y^2 // and z\n  + z\u00B2) / R^2\n = 1\n");
  const test::ProgramResult result =
      run_taut({"path", "@" + file.string(), "--set", "R=2", "--from", "2,0,0", "--to", "0,2,0", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(nlohmann::json::parse(result.out)["length"].get<double>(), std::numbers::pi, 1e-9);
  EXPECT_NE(run_taut({"info", file.string()}).err.find("write @"), std::string::npos);
  const auto bad = folder.write("bad.txt", "x^2 +\n y^^2 = 1\n");
  const test::ProgramResult refused = run_taut({"info", "@" + bad.string()});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("bad.txt: line 2: "), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("\n   y^^2 = 1\n     ^\n"), std::string::npos) << refused.err;
}

TEST(InputsAndOutputs, VariablesOfTheUsersOwn) {
  const test::ProgramResult result = run_taut({"path", "a^2+b^2+c^2=1", "--vars", "a,b,c", "--domain", "c >= -0.5",
                                               "--from", "1,0,0", "--to", "0,1,0", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(nlohmann::json::parse(result.out)["length"].get<double>(), std::numbers::pi / 2, 1e-9);
}

// Where F is linear in its last variable that need not be given: a saddle z = x y holds straight lines.
TEST(InputsAndOutputs, PointsOfAGraphByTwoCoordinates) {
  const test::ProgramResult result =
      run_taut({"path", "z = c x y + h", "--set", "c=2,h=-1", "--from", "3,1", "--to", "3,-1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto path = nlohmann::json::parse(result.out);
  EXPECT_EQ(path["from"].get<std::vector<double>>(), (std::vector<double>{3, 1, 5}));
  EXPECT_NEAR(path["length"].get<double>(), std::hypot(2, 12), 1e-9);
  EXPECT_EQ(run_taut({"path", "z^2 = x + y", "--from", "1,0", "--to", "0,1"}).exit_code, 3);
  const test::ProgramResult decimal_comma =
      run_taut({"path", "z = c x y", "--set", "c=1,5", "--from", "1,0", "--to", "0,1"});
  EXPECT_EQ(decimal_comma.exit_code, 2);
  EXPECT_NE(decimal_comma.err.find("'5' has no name"), std::string::npos) << decimal_comma.err;
}

TEST(InputsAndOutputs, StandardInputIsReadEverywhere) {
  const TempFolder folder;
  const auto points = folder.write("points.csv", "0,1,0\n0,0,1\n");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"path", kSphere, "--from", "1,0,0", "--to-file", "-"},
        {"field", kSphere, "--from", "1,0,0", "--at", "-"}}) {
    const test::ProgramResult result = run_taut(arguments, "", points.string());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    ASSERT_EQ(lines_of(result.out).size(), 2U) << result.out;
    for (const std::string& line : lines_of(result.out)) EXPECT_NEAR(std::stod(line), std::numbers::pi / 2, 1e-9);
  }
  const auto rays = folder.write("rays.csv", "1,0,0,0,1,0,1\n");
  const test::ProgramResult traced = run_taut({"exp", kSphere, "--rays", "-", "--header"}, "", rays.string());
  EXPECT_EQ(traced.exit_code, 0) << traced.err;
  ASSERT_EQ(lines_of(traced.out).size(), 2U) << traced.out;
  EXPECT_EQ(lines_of(traced.out)[0], "q1,q2,q3,w1,w2,w3,error,status");
  EXPECT_NEAR(std::stod(lines_of(traced.out)[1]), std::cos(1), 1e-12);
  const auto line = folder.write("line.csv", "1,0,0\n0.7,0.7,0\n0,1,0\n");
  const test::ProgramResult taut_line = run_taut({"path", kSphere, "--start", "-"}, "", line.string());
  EXPECT_EQ(taut_line.exit_code, 0) << taut_line.err;
}

TEST(InputsAndOutputs, ABatchMayHaveAHeaderAndSayWhatIsUnique) {
  const TempFolder folder;
  const auto pairs = folder.write("pairs.csv", "1,0,0,0,1,0\n1,0,0,-1,0,0\n1,0\n");
  const auto out = folder.path() / "lengths.csv";
  const test::ProgramResult result =
      run_taut({"path", kSphere, "--pairs", pairs.string(), "--header", "--unique", "-o", out.string()});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const std::vector<std::string> lines = lines_of(test::file_bytes(out));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "length,error,converged,locally_shortest,status,unique");
  EXPECT_TRUE(lines[1].ends_with(",ok,1")) << lines[1];
  EXPECT_TRUE(lines[2].ends_with(",ok,0")) << lines[2];  // antipodes
  EXPECT_EQ(lines[3], "nan,inf,0,0,bad_input,");
}

TEST(InputsAndOutputs, OfManyBadLinesFiveAreToldAndTheRestCounted) {
  const TempFolder folder;
  std::string text = "1,0,0,0,1,0\n";
  for (int i = 0; i < 40; ++i) text += "1,2,3\n";
  const auto pairs = folder.write("pairs.csv", text);
  const test::ProgramResult result = run_taut({"path", kSphere, "--pairs", pairs.string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(lines_of(result.out).size(), 41U);
  const std::vector<std::string> told = lines_of(result.err);
  ASSERT_EQ(told.size(), 6U) << result.err;
  EXPECT_NE(told[5].find("and 35 more"), std::string::npos) << told[5];
}

TEST(InputsAndOutputs, PointsAreSpacedEvenlyOnDemand) {
  const TempFolder folder;
  const auto csv = folder.path() / "path.csv";
  const test::ProgramResult result = run_taut(
      {"path", kSphere, "--from", "1,0,0", "--to", "0,1,0", "--samples-along", "7", "--json", "-o", csv.string()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto points = nlohmann::json::parse(result.out)["points"];
  ASSERT_EQ(points.size(), 7U);
  const std::vector<std::string> lines = lines_of(test::file_bytes(csv));
  ASSERT_EQ(lines.size(), 8U);
  EXPECT_EQ(lines[0], "x,y,z,nx,ny,nz,arc_length");
  for (std::size_t i = 0; i < 7; ++i) {
    const double angle = std::numbers::pi / 2 * static_cast<double>(i) / 6;
    EXPECT_NEAR(points[i][0].get<double>(), std::cos(angle), 1e-7);
    EXPECT_NEAR(points[i][1].get<double>(), std::sin(angle), 1e-7);
    std::istringstream row(lines[i + 1]);
    std::vector<double> numbers;
    for (std::string field; std::getline(row, field, ',');) numbers.push_back(std::stod(field));
    ASSERT_EQ(numbers.size(), 7U);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(numbers[k], numbers[k + 3], 1e-12);  // a unit sphere's normals
    EXPECT_NEAR(numbers[6], angle, 1e-9);
  }
}

TEST(InputsAndOutputs, FilesOfPointsMayNameSamples) {
  const TempFolder folder;
  std::string cloud = "x,y,z\n1,0,0\n0,1,0\n0,0,1\n-1,0,0\n0,-1,0\n0,0,-1\n";
  for (const double x : {-1, 1}) {
    for (const double y : {-1, 1}) {
      for (const double z : {-1, 1}) {
        const double r = std::sqrt(3);
        cloud += std::to_string(x / r) + "," + std::to_string(y / r) + "," + std::to_string(z / r) + "\n";
      }
    }
  }
  const std::string surface = folder.write("ball.csv", cloud).string();
  const auto length = [&](const std::string& from, const std::string& to) {
    return nlohmann::json::parse(run_taut({"path", surface, "--from", from, "--to", to, "--json"}).out)["length"]
        .get<double>();
  };
  const double first = length("@0", "@1");
  const double second = length("@0", "@2");
  const auto pairs = folder.write("pairs.csv", "@0,@1\n@0,0,0,1\n1,0,0,@1\n@0,@99\n");
  const test::ProgramResult batch = run_taut({"path", surface, "--pairs", pairs.string()});
  EXPECT_EQ(batch.exit_code, 1);
  const std::vector<std::string> lines = lines_of(batch.out);
  ASSERT_EQ(lines.size(), 4U) << batch.err;
  EXPECT_NEAR(std::stod(lines[0]), first, 1e-9);
  EXPECT_NEAR(std::stod(lines[1]), second, 1e-9);
  EXPECT_NEAR(std::stod(lines[2]), first, 1e-9);
  EXPECT_EQ(lines[3], "nan,inf,0,0,bad_input");
  EXPECT_NE(batch.err.find("line 4: '@99': samples go from @0 to @13"), std::string::npos) << batch.err;
  const auto ends = folder.write("ends.csv", "@1\n0,0,1\n");
  for (const std::vector<std::string>& question :
       {std::vector<std::string>{"field", surface, "--from", "@0", "--at", ends.string()},
        {"path", surface, "--from", "@0", "--to-file", ends.string()}}) {
    const test::ProgramResult result = run_taut(question);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    ASSERT_EQ(lines_of(result.out).size(), 2U) << result.out;
    EXPECT_NEAR(std::stod(lines_of(result.out)[0]), first, 1e-5);
    EXPECT_NEAR(std::stod(lines_of(result.out)[1]), second, 1e-5);
  }
  const test::ProgramResult none = run_taut({"field", kSphere, "--from", "1,0,0", "--at", ends.string()});
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_NE(none.err.find("'@1' names a sample, and here there are none; give coordinates"), std::string::npos);
}

TEST(InputsAndOutputs, HelpAndShortOptionsAreUnderstood) {
  EXPECT_EQ(run_taut({"-V"}).out, run_taut({"--version"}).out);
  EXPECT_EQ(run_taut({"help"}).out, run_taut({"--help"}).out);
  EXPECT_EQ(run_taut({"help", "path"}).out, run_taut({"path", "--help"}).out);
  EXPECT_NE(run_taut({"path", "--help"}).out.find("--from"), std::string::npos);
  const TempFolder folder;
  const auto points = folder.write("far.csv", "temp,x,y,z\n1,1,0,0\n2,0,1,0\n3,0,0,1\n4,-1,0,0\n5,0,-1,0\n6,0,0,-1\n");
  EXPECT_NE(run_taut({"info", points.string()}).err.find("note: "), std::string::npos);
  EXPECT_EQ(run_taut({"info", "-q", points.string()}).err.find("note: "), std::string::npos);
}

}  // namespace
}  // namespace taut
