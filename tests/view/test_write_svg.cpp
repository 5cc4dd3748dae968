#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "taut/view/write_scene.hpp"
#include "view/scenes.hpp"

namespace taut {
namespace {

const PictureOptions kFront{.width = 400, .height = 300};

PictureOptions from(const Eigen::Vector3d& direction) {
  PictureOptions options = kFront;
  options.towards_viewer = direction;
  return options;
}

/// Every tag is closed by its own, attributes are quoted, and no bare < or & is left in the text.
::testing::AssertionResult is_well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < xml.size(); ++i) {
    if (xml[i] == '&') {
      const std::size_t end = xml.find(';', i);
      if (end == std::string::npos || end - i > 8) return ::testing::AssertionFailure() << "bare & at " << i;
    }
    if (xml[i] != '<') continue;
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return ::testing::AssertionFailure() << "tag without end at " << i;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    if (tag.find('<') != std::string::npos) return ::testing::AssertionFailure() << "bare < at " << i;
    if (std::count(tag.begin(), tag.end(), '"') % 2 != 0) return ::testing::AssertionFailure() << "quotes in " << tag;
    const std::string name = tag.substr(0, tag.find_first_of(" /", 1));
    if (tag[0] == '/') {
      if (open.empty() || "/" + open.back() != tag) return ::testing::AssertionFailure() << "unexpected </" << tag;
      open.pop_back();
    } else if (tag.back() != '/') {
      open.push_back(name);
    }
    i = end;
  }
  if (!open.empty()) return ::testing::AssertionFailure() << "not closed: " << open.back();
  return ::testing::AssertionSuccess();
}

int occurrences(const std::string& text, const std::string& part) {
  int n = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + 1)) ++n;
  return n;
}

TEST(WriteSvg, IsWellFormedWhateverTheTextSays) {
  const std::string svg = to_svg(test::ball_scene(), kFront);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(svg.find("</script>"), std::string::npos);
  EXPECT_NE(svg.find("quarter &lt;turn&gt; &amp; &quot;more&quot;, length 1.570"), std::string::npos);
  EXPECT_NE(svg.find("data:image/png;base64,iVBORw0KGgo"), std::string::npos);
  EXPECT_EQ(svg.find('\xFF'), std::string::npos);
}

TEST(WriteSvg, PathIsSolidInFrontAndDashedBehind) {
  EXPECT_EQ(occurrences(to_svg(test::ball_scene(), from({1, 1, 0})), "stroke-dasharray"), 0);
  const std::string behind = to_svg(test::ball_scene(), from({-1, -1, 0}));
  EXPECT_EQ(occurrences(behind, "stroke-dasharray"), 1);
  // Seen from the side, half of it: one run of either kind (and the swatch of the legend).
  Scene scene = test::ball_scene();
  for (Index i = 0; i < 50; ++i) {
    const double a = 3.0 * static_cast<double>(i) / 49 - 1.5;
    scene.paths[0].points.col(i) << std::cos(a), std::sin(a), 0;
  }
  const std::string side = to_svg(scene, from({0.1, 1, 0.6}));
  EXPECT_EQ(occurrences(side, "stroke-dasharray"), 1);
  EXPECT_EQ(occurrences(side, "stroke=\"#ff0000\""), 3);
}

TEST(WriteSvg, HasAColourBarForScalars) {
  Scene scene = test::ball_scene();
  EXPECT_EQ(occurrences(to_svg(scene, kFront), "linearGradient"), 0);
  scene.meshes[0].coloured_by = "polar angle";
  const std::string svg = to_svg(scene, kFront);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(occurrences(svg, "<linearGradient"), 1);
  EXPECT_EQ(occurrences(svg, ">polar angle<"), 1);
  EXPECT_EQ(occurrences(svg, ">3<"), 1);
}

TEST(WriteSvg, ManyPathsAreSummedUpInTheLegend) {
  Scene scene = test::ball_scene();
  while (scene.paths.size() < 20) scene.paths.push_back(scene.paths.front());
  EXPECT_NE(to_svg(scene, {.width = 800, .height = 500}).find("20 paths, lengths 1.57"), std::string::npos);
}

TEST(WriteSvg, PathsOfOneSourceShareAColourAndALegendLine) {
  Scene scene = test::ball_scene();
  scene.paths.clear();
  for (int source = 0; source < 3; ++source) {
    for (int k = 0; k < 4; ++k) {
      ScenePath path{.label = "from @" + std::to_string(source),
                     .colour = path_colour(static_cast<std::size_t>(source))};
      path.points.resize(3, 20);
      for (Index i = 0; i < 20; ++i) {
        const double a = 0.5 * source + 0.03 * static_cast<double>(i);
        path.points.col(i) << std::cos(0.2 * k) * std::cos(a), std::cos(0.2 * k) * std::sin(a), std::sin(0.2 * k);
      }
      scene.paths.push_back(path);
    }
  }
  const std::string svg = to_svg(scene, from({1, 1, 1}));
  EXPECT_TRUE(is_well_formed(svg));
  // One stroke a path in its source's colour, all of them in sight, and one for the legend.
  for (const char* colour : {"#e4482b", "#1f77c9", "#f0a202"}) {
    EXPECT_EQ(occurrences(svg, std::string("stroke=\"") + colour + "\""), 4 + 1) << colour;
  }
  EXPECT_EQ(occurrences(svg, "4 paths, lengths"), 3);
}

TEST(WriteSvg, LegendOfVeryManyKindsOfPathsStaysShort) {
  Scene scene = test::ball_scene();
  const ScenePath path = scene.paths.front();
  for (int k = 0; k < 30; ++k) {
    scene.paths.push_back(path);
    scene.paths.back().label = "way " + std::to_string(k);
  }
  const std::string svg = to_svg(scene, kFront);
  EXPECT_EQ(occurrences(svg, ">way "), 6);
  EXPECT_NE(svg.find("others, 24 paths, lengths"), std::string::npos);
}

TEST(WriteSvg, FailedPathIsDashedInAmberAndNamed) {
  Scene scene = test::ball_scene();
  scene.paths[0].failed = true;
  scene.paths[0].colour.reset();
  scene.paths[0].label = "not converged";
  const std::string svg = to_svg(scene, from({1, 1, 0}));
  EXPECT_EQ(occurrences(svg, "stroke=\"#c77700\""), 2);
  EXPECT_EQ(occurrences(svg, "stroke-dasharray"), 2);
  EXPECT_EQ(occurrences(svg, ">not converged, length"), 1);
}

TEST(WriteSvg, NamesOfPointsInOnePlaceAreJoined) {
  Scene scene = test::ball_scene();
  scene.points[1].position = scene.points[0].position;
  EXPECT_EQ(occurrences(to_svg(scene, kFront), ">from, to<"), 1);
}

TEST(WriteSvg, FlatScenesAreVectorsOnly) {
  Scene scene;
  SceneLines lines;
  lines.vertices = Points::Random(2, 4);
  lines.segments.resize(2, 3);
  lines.segments << 0, 1, 2, 1, 2, 3;
  scene.lines.push_back(lines);
  scene.paths.push_back({.points = Points::Random(2, 3), .label = "p"});
  const std::string svg = to_svg(scene, kFront);
  EXPECT_TRUE(is_well_formed(svg));
  EXPECT_EQ(occurrences(svg, "<image"), 0);
}

TEST(WriteSvg, SaysThatManyDimensionsAreProjected) {
  Scene scene;
  scene.paths.push_back({.points = Points::Random(6, 30)});
  EXPECT_NE(to_svg(scene, kFront).find("in 6 dimensions"), std::string::npos);
}

TEST(WriteSvg, BytesAreTheSameEveryTime) {
  EXPECT_EQ(to_svg(test::ball_scene(), kFront), to_svg(test::ball_scene(), kFront));
}

}  // namespace
}  // namespace taut
