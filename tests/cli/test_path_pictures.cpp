// taut path: several sources, and what its pictures show.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut::test {
namespace {

using test::lines_of;

using nlohmann::json;
using testing::HasSubstr;

const std::string kSphere = "x^2+y^2+z^2=1";

int occurrences(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

/// As the legend of a picture counts them; 0 = it names none.
int cells_shown(const std::string& svg) {
  const std::string label = ">cells walked, ";
  const auto at = svg.find(label);
  if (at == std::string::npos) return 0;
  std::string number;
  for (const char c : svg.substr(at + label.size(), 12)) {
    if (c == '<' || c == ' ') break;
    if (c != ',') number += c;
  }
  return std::stoi(number);
}

/// The text of the picture that a path command writes with these options.
std::string picture_of(std::vector<std::string> arguments, const std::string& extension = ".svg") {
  const TempFolder folder;
  const std::string file = (folder.path() / ("picture" + extension)).string();
  arguments.insert(arguments.end(), {"--out", file});
  const ProgramResult result = run_taut(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return file_bytes(file);
}

class PathSources : public testing::Test {
 protected:
  TempFolder folder_;
  std::string ends_ = folder_.write("ends.csv", "0,1,0\n0,0,1\n0.6,0.8,0\n");
};

TEST_F(PathSources, AreAnsweredAsEachAloneInTheOrderGiven) {
  const std::vector<std::string> sources = {"1,0,0", "0,-0.6,0.8"};
  const ProgramResult both =
      run_taut({"path", kSphere, "--from", sources[0], "--from", sources[1], "--to-file", ends_});
  ASSERT_EQ(both.exit_code, 0) << both.err;
  std::string apart;
  for (const std::string& source : sources) {
    apart += run_taut({"path", kSphere, "--from", source, "--to-file", ends_}).out;
  }
  EXPECT_EQ(both.out, apart);
  EXPECT_EQ(lines_of(both.out).size(), 6U);
}

TEST_F(PathSources, GiveTheirOwnAnglesOnASphere) {
  const ProgramResult result =
      run_taut({"path", kSphere, "--from", "1,0,0", "--from", "0,0,1", "--to-file", ends_, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json paths = json::parse(result.out);
  ASSERT_EQ(paths.size(), 6U);
  const double right = std::numbers::pi / 2;
  const std::vector<double> angles = {right, right, std::acos(0.6), right, 0, right};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(paths[k]["length"], angles[k], 1e-9);
    EXPECT_EQ(paths[k]["from"], k < 3 ? json({1.0, 0.0, 0.0}) : json({0.0, 0.0, 1.0}));
    EXPECT_GT(paths[k]["seconds"]["total"], 0);
  }
  EXPECT_THAT(result.err, HasSubstr("6 paths from 2 sources in"));
}

TEST_F(PathSources, ShareAColourEachInOnePicture) {
  const std::string svg =
      picture_of({"path", kSphere, "--from", "1,0,0", "--from", "-0.6,0,0.8", "--to-file", ends_, "--view", "50,30"});
  // A swatch of the legend, and at least the seen part of each path.
  EXPECT_GE(occurrences(svg, "stroke=\"#e4482b\""), 1 + 3);
  EXPECT_GE(occurrences(svg, "stroke=\"#1f77c9\""), 1 + 3);
  EXPECT_EQ(occurrences(svg, "from 1,0,0, 3 paths, lengths"), 1);
  EXPECT_EQ(occurrences(svg, "from -0.6,0,0.8, 3 paths, lengths"), 1);
}

TEST_F(PathSources, AreDrawnOverTheirField) {
  const std::string svg =
      picture_of({"path", kSphere, "--from", "1,0,0", "--from", "0,0,1", "--to-file", ends_, "--field"});
  EXPECT_EQ(occurrences(svg, "<linearGradient"), 1);
  EXPECT_EQ(occurrences(svg, ">distance<"), 1);
  EXPECT_GE(occurrences(svg, "stroke=\"#1f77c9\""), 1);
}

TEST_F(PathSources, CountTheirPicturesInEveryObject) {
  const std::string file = (folder_.path() / "a.svg").string();
  const ProgramResult result =
      run_taut({"path", kSphere, "--from", "1,0,0", "--from", "0,0,1", "--to-file", ends_, "--json", "--out", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json paths = json::parse(result.out);
  ASSERT_EQ(paths.size(), 6U);
  for (const json& path : paths) {
    EXPECT_GT(path["seconds"]["pictures"], 0);
    EXPECT_GE(path["seconds"]["total"], path["seconds"]["pictures"]);
    EXPECT_EQ(path["seconds"]["pictures"], paths[0]["seconds"]["pictures"]);
  }
}

TEST_F(PathSources, ShowTheCellsOfTheirSharedMarch) {
  const std::string svg = picture_of({"path", kSphere, "--from", "1,0,0", "--to-file", ends_, "--cell", "0.2",
                                      "--method", "grid", "--march", "axis", "--show", "cells"});
  const ProgramResult info = run_taut({"info", kSphere, "--cell", "0.2", "--json"});
  EXPECT_EQ(cells_shown(svg), json::parse(info.out)["cells"].get<int>()) << "the whole sphere was marched over";
}

TEST_F(PathSources, NeedAFileOfEnds) {
  const ProgramResult result = run_taut({"path", kSphere, "--from", "1,0,0", "--from", "0,1,0", "--to", "0,0,1"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("several --from go with --to-file"));
}

TEST(PathJson, HasTheMarchedPathFromEndToEnd) {
  const ProgramResult result = run_taut({"path", kSphere, "--from", "1,0,0", "--to", "0,0.6,0.8", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json path = json::parse(result.out);
  ASSERT_GE(path["grid_path"].size(), 3U);
  EXPECT_EQ(path["grid_path"].front(), path["from"]);
  EXPECT_EQ(path["grid_path"].back(), path["to"]);
  EXPECT_FALSE(path["seconds"].contains("pictures"));
}

TEST(PathPictures, CountInTheSeconds) {
  const TempFolder folder;
  const std::string file = (folder.path() / "a.png").string();
  const ProgramResult result =
      run_taut({"path", kSphere, "--from", "1,0,0", "--to", "0,0.6,0.8", "--json", "--out", file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json seconds = json::parse(result.out)["seconds"];
  EXPECT_GT(seconds["pictures"], 0);
  EXPECT_GE(seconds["total"], seconds["pictures"]);
  // 1200 x 800 pixels, as the file's header says.
  const std::string png = file_bytes(file);
  ASSERT_GT(png.size(), 24U);
  EXPECT_EQ(png.substr(16, 8), std::string("\0\0\x04\xB0\0\0\x03\x20", 8));
}

TEST(PathPictures, ShowCellsMarchedAndCorrectedPathTogether) {
  const std::string svg = picture_of({"path", kSphere, "--domain", "z >= 0", "--from", "1,0,0", "--to", "-0.6,0,0.8",
                                      "--cell", "0.2", "--show", "cells,marched"});
  EXPECT_EQ(occurrences(svg, ">marched path, length"), 1);
  EXPECT_EQ(occurrences(svg, ">corrected path, length"), 1);
  EXPECT_EQ(occurrences(svg, ">cells walked, "), 1);
  EXPECT_GE(occurrences(svg, "stroke=\"#d7301f\""), 2);
  EXPECT_GE(occurrences(svg, "stroke=\"#1f5fbf\""), 2);
}

// Two spheres, of which the march sees one; and a march that stops at its goal has not been round it either.
TEST(PathPictures, TheCellsShownAreThoseThatWereWalked) {
  const std::string spheres = "(x^2+y^2+z^2-1)*((x-4)^2+y^2+z^2-1)=0";
  const TempFolder folder;
  const std::string file = (folder.path() / "cells.svg").string();
  const auto count = [&](const std::string& to, const std::vector<std::string>& options) {
    std::vector<std::string> words = {"path",   spheres, "--from", "1,0,0", "--to", to,        "--cell", "0.2",
                                      "--show", "cells", "--json", "--out", file,   "--march", "axis"};
    words.insert(words.end(), options.begin(), options.end());
    const ProgramResult result = run_taut(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::pair{cells_shown(file_bytes(file)), json::parse(result.out)["cells"].get<int>()};
  };
  const auto [far, all] = count("-1,0,0", {});
  EXPECT_NEAR(far, all / 2, 0.1 * all) << "the other sphere was not walked";
  const auto [near, all_again] = count("0.8,0.6,0", {});
  EXPECT_EQ(all_again, all);
  EXPECT_GT(near, 10);
  EXPECT_LT(near, 0.5 * far);
  const auto [grown, one] = count("-1,0,0", {"--grid", "grow"});
  EXPECT_LE(grown, one);
  EXPECT_NEAR(grown, far, 0.1 * far);
  const auto [thick, envelope] = count("0.8,0.6,0", {"--envelope", "2"});
  EXPECT_GT(thick, near);
  EXPECT_LT(thick, envelope);
}

TEST(PathPictures, SayThatThereWereNoCells) {
  const TempFolder folder;
  const std::string file = (folder.path() / "seven.svg").string();
  const ProgramResult result = run_taut({"path", "x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2=1", "--from", "1,0,0,0,0,0,0",
                                         "--to", "0,1,0,0,0,0,0", "--show", "cells", "--out", file});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no cells are shown"));
}

TEST(PathPictures, ShowAllWays) {
  const std::string torus = "(x^2+y^2+z^2+0.84)^2=4*(x^2+y^2)";
  const std::string alone = picture_of({"path", torus, "--from", "1.4,0,0", "--to", "-1,0,0.4"});
  const std::string all = picture_of({"path", torus, "--from", "1.4,0,0", "--to", "-1,0,0.4", "--all"});
  EXPECT_GT(occurrences(all, ">another way, "), 1);
  EXPECT_LT(occurrences(alone, ">another way, "), occurrences(all, ">another way, "));
}

TEST(PathPictures, AreTitledByTheFilesName) {
  const TempFolder folder;
  std::string points;
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1) / 200.0;
    const double a = i * std::numbers::phi * 2 * std::numbers::pi;
    const double r = std::sqrt(1 - z * z);
    points += std::to_string(r * std::cos(a)) + "," + std::to_string(r * std::sin(a)) + "," + std::to_string(z) + "\n";
  }
  const std::string cloud = folder.write("ball.csv", points);
  const std::string svg = picture_of({"path", cloud, "--from", "@0", "--to", "@150"});
  EXPECT_THAT(svg, HasSubstr("<title>ball.csv</title>"));
}

TEST(PathPictures, OfCurvesShowTheCurve) {
  const std::string svg = picture_of({"path", "x^2+y^2=1", "--from", "1,0", "--to", "0,1"});
  EXPECT_EQ(occurrences(svg, "stroke=\"#5b6b7c\""), 1);  // the circle
  EXPECT_GE(occurrences(svg, "stroke=\"#e4482b\""), 1);  // the quarter of it
}

TEST(PathPictures, OptionsWithoutAPictureAreRefused) {
  const std::vector<std::string> path = {"path", kSphere, "--from", "1,0,0", "--to", "0,1,0"};
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{"--view", "10,20"},
                                                                                    {"--show", "cells"},
                                                                                    {"--field"},
                                                                                    {"--view", "10"},
                                                                                    {"--view", "0,100"},
                                                                                    {"--show", "tea"}}) {
    std::vector<std::string> arguments = path;
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run_taut(arguments);
    EXPECT_EQ(result.exit_code, 2) << more.front();
    EXPECT_EQ(lines_of(result.err).size(), 1U) << result.err;
  }
}

}  // namespace
}  // namespace taut::test
