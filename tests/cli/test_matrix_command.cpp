// taut matrix, sample, voronoi and mean: what they write, and how they end.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using std::numbers::pi;
using test::ProgramResult;
using test::run_taut;
using test::RunningProgram;
using test::TempFolder;

const std::string kSphere = "x^2+y^2+z^2=1";
const std::string kSix = "1,0,0\n-1,0,0\n0,1,0\n0,-1,0\n0,0,1\n0,0,-1\n";

std::vector<double> npy_numbers(const std::filesystem::path& file, std::string& header) {
  const std::string bytes = test::file_bytes(file);
  const std::size_t begin = bytes.find('\n') + 1;
  header = bytes.substr(0, begin);
  std::vector<double> numbers((bytes.size() - begin) / sizeof(double));
  std::memcpy(numbers.data(), bytes.data() + begin, numbers.size() * sizeof(double));
  return numbers;
}

TEST(MatrixCommand, WritesEachLayout) {
  const TempFolder folder;
  const std::string points = folder.write("six.csv", kSix).string();
  const auto make = [&](const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> command = {"matrix", kSphere, "--points", points, "--out", (folder.path() / out).string()};
    command.insert(command.end(), more.begin(), more.end());
    const ProgramResult result = run_taut(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / (out + ".partial")));
    return folder.path() / out;
  };
  std::string header;
  const std::vector<double> square = npy_numbers(make("square.npy", {}), header);
  EXPECT_NE(header.find("(6, 6)"), std::string::npos) << header;
  ASSERT_EQ(square.size(), 36U);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      EXPECT_EQ(square[6 * i + j], square[6 * j + i]);
      EXPECT_NEAR(square[6 * i + j], i == j ? 0 : i / 2 == j / 2 ? pi : pi / 2, 1e-9);
    }
  }
  const std::vector<double> condensed = npy_numbers(make("condensed.npy", {"--condensed"}), header);
  EXPECT_NE(header.find("(15,)"), std::string::npos) << header;
  std::vector<double> upper;
  for (std::size_t i = 0; i < 6; ++i)
    upper.insert(upper.end(), square.begin() + static_cast<std::ptrdiff_t>(7 * i) + 1,
                 square.begin() + static_cast<std::ptrdiff_t>(6 * i) + 6);
  EXPECT_EQ(condensed, upper);
  const std::string targets = folder.write("targets.csv", "1,0,0\n0.6,0.8,0\n").string();
  const std::vector<double> full = npy_numbers(make("full.npy", {"--targets", targets}), header);
  EXPECT_NE(header.find("(6, 2)"), std::string::npos) << header;
  EXPECT_NEAR(full[1], std::atan2(0.8, 0.6), 1e-10);
  const std::vector<double> near = npy_numbers(make("near.npy", {"--max-distance", "2"}), header);
  EXPECT_NE(header.find("(12, 3)"), std::string::npos) << header;
  const std::string nearest = test::file_bytes(make("nearest.csv", {"--k-nearest", "2"}));
  EXPECT_TRUE(nearest.starts_with("row,column,distance\n0,")) << nearest;
  EXPECT_NE(nearest.find(",1.57079632"), std::string::npos) << nearest;
  EXPECT_EQ(std::count(nearest.begin(), nearest.end(), '\n'), 13);
  const std::string table = test::file_bytes(make("square.csv", {}));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
}

TEST(MatrixCommand, AKilledOneGoesOnWhereItWas) {
  const TempFolder folder;
  std::string text;
  for (int i = 0; i < 400; ++i) {
    const double z = 0.99 - 1.98 * i / 399;
    text += std::to_string(std::cos(2.4 * i) * std::sqrt(1 - z * z)) + "," +
            std::to_string(std::sin(2.4 * i) * std::sqrt(1 - z * z)) + "," + std::to_string(z) + "\n";
  }
  const std::string points = folder.write("points.csv", text).string();
  const auto out = folder.path() / "matrix.npy";
  const auto partial = folder.path() / "matrix.npy.partial";
  const std::vector<std::string> command = {"matrix", kSphere, "--points", points, "--out", out.string()};
  {
    RunningProgram program(command);
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(50);
    while (test::file_bytes(partial).size() < 200000 && !program.ended() &&
           std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    program.send(SIGKILL);
    program.wait(std::chrono::seconds(10));
  }
  ASSERT_FALSE(std::filesystem::exists(out));
  std::ofstream(partial, std::ios::app | std::ios::binary) << "half a row";
  const ProgramResult rest = run_taut(command);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NE(rest.err.find("going on after"), std::string::npos) << rest.err;
  EXPECT_NE(rest.out.find("of the rows of this run"), std::string::npos) << rest.out;
  const auto whole = folder.path() / "whole.npy";
  const ProgramResult once =
      run_taut({"matrix", kSphere, "--points", points, "--out", whole.string(), "--threads", "1"});
  EXPECT_EQ(once.exit_code, 0) << once.err;
  EXPECT_TRUE(test::file_bytes(out) == test::file_bytes(whole)) << "the same bytes as in one go";
}

TEST(MatrixCommand, EndsWithTheContractsCodes) {
  const TempFolder folder;
  const std::string points = folder.write("six.csv", kSix).string();
  const std::string out = (folder.path() / "m.npy").string();
  EXPECT_EQ(run_taut({"matrix", kSphere, "--points", points}).exit_code, 2);
  EXPECT_EQ(run_taut({"matrix", kSphere, "--points", points, "--out", "m.xyz"}).exit_code, 2);
  EXPECT_EQ(
      run_taut({"matrix", kSphere, "--points", points, "--out", out, "--condensed", "--k-nearest", "2"}).exit_code, 2);
  EXPECT_EQ(run_taut({"matrix", kSphere, "--points", "missing.csv", "--out", out}).exit_code, 3);
  const std::string off = folder.write("off.csv", "1,0,0\n9,9,9\n").string();
  const ProgramResult bad = run_taut({"matrix", kSphere, "--points", off, "--out", out});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.err.find("point 1"), std::string::npos) << bad.err;
  const std::string both = folder.write("both.csv", "3,0,0\n-3,0,0\n").string();
  const ProgramResult apart = run_taut({"matrix", "((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)", "--points", both, "--out",
                                        (folder.path() / "a.csv").string()});
  EXPECT_EQ(apart.exit_code, 0) << apart.err;
  EXPECT_EQ(test::file_bytes(folder.path() / "a.csv"), "0,inf\ninf,0\n");
}

TEST(SampleCommand, WritesPoints) {
  const ProgramResult result = run_taut({"sample", kSphere, "-n", "5", "--from", "0,0,1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 5);
  EXPECT_TRUE(result.out.starts_with("0,0,1\n")) << result.out;
  const TempFolder folder;
  const auto out = folder.path() / "points.ply";
  EXPECT_EQ(run_taut({"sample", kSphere, "-n", "20", "--out", out.string()}).exit_code, 0);
  EXPECT_GT(std::filesystem::file_size(out), 400U);
  EXPECT_EQ(run_taut({"sample", kSphere}).exit_code, 2);
  EXPECT_EQ(run_taut({"sample", kSphere, "-n", "0"}).exit_code, 2);
}

TEST(VoronoiCommand, WritesPartsAndTheirBorders) {
  const TempFolder folder;
  const std::string six = folder.write("six.csv", kSix).string();
  const ProgramResult labels = run_taut({"voronoi", kSphere, "--sources", six, "--at", six});
  ASSERT_EQ(labels.exit_code, 0) << labels.err;
  EXPECT_TRUE(labels.out.starts_with("0,0,")) << labels.out;
  EXPECT_NE(labels.out.find("\n5,0,"), std::string::npos) << labels.out;
  const auto mesh = folder.path() / "parts.vtp";
  const auto lines = folder.path() / "borders.csv";
  const auto picture = folder.path() / "parts.svg";
  const ProgramResult drawn = run_taut({"voronoi", kSphere, "--sources", six, "--out", mesh.string(), "--out",
                                        picture.string(), "--boundaries", lines.string()});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(drawn.out.find("lines"), std::string::npos);
  for (const auto& file : {mesh, lines, picture}) EXPECT_GT(std::filesystem::file_size(file), 1000U) << file;
  EXPECT_EQ(run_taut({"voronoi", kSphere, "--sources", six}).exit_code, 2);
}

TEST(MeanCommand, TellsTheMean) {
  const TempFolder folder;
  const std::string points = folder.write("two.csv", "1,0,0\n0,1,0\n").string();
  const ProgramResult result = run_taut({"mean", kSphere, "--points", points, "--weights", "2,1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NEAR(json["point"][0].get<double>(), std::cos(pi / 6), 1e-9);
  EXPECT_TRUE(json["unique"].get<bool>());
  const std::string opposite = folder.write("opposite.csv", "1,0,0\n-1,0,0\n").string();
  const ProgramResult any = run_taut({"mean", kSphere, "--points", opposite});
  EXPECT_EQ(any.exit_code, 0) << any.err;
  EXPECT_NE(any.out.find("another"), std::string::npos) << any.out;
  EXPECT_EQ(run_taut({"mean", kSphere, "--points", points, "--weights", "1"}).exit_code, 3);
}

}  // namespace
}  // namespace taut
