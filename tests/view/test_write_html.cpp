#include "taut/view/write_scene.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/core/error.hpp"
#include "view/scenes.hpp"

namespace taut {
namespace {

std::string between(const std::string& text, const std::string& before, const std::string& after) {
  const std::size_t start = text.find(before);
  if (start == std::string::npos) return {};
  const std::size_t end = text.find(after, start + before.size());
  return text.substr(start + before.size(), end - start - before.size());
}

nlohmann::json scene_of(const std::string& html) {
  return nlohmann::json::parse(between(html, "<script type=\"application/json\" id=\"scene\">", "</script>"));
}

template <class Number>
std::vector<Number> decode(const std::string& base64) {
  static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int num_bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    num_bits += 6;
    if (num_bits < 8) continue;
    num_bits -= 8;
    bytes.push_back(static_cast<char>(bits >> num_bits & 255));
  }
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

TEST(WriteHtml, EmbeddedNumbersAreTheGivenOnes) {
  Scene scene = test::ball_scene(12);
  scene.meshes[0].coloured_by = "polar angle";
  const Eigen::Vector3d shift(1e6, 0, -3);  // float32 alone would lose the shape out there
  scene.meshes[0].mesh.vertices.colwise() += shift;
  scene.paths[0].points.colwise() += shift;
  for (ScenePoint& point : scene.points) point.position += shift;
  const TriangleMesh& mesh = scene.meshes[0].mesh;
  const nlohmann::json data = scene_of(to_html(scene));

  const std::vector<double> origin = data["origin"];
  const auto positions = decode<float>(data["meshes"][0]["positions"]);
  ASSERT_EQ(static_cast<Index>(positions.size()), mesh.vertices.size());
  for (Index i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR(origin[static_cast<std::size_t>(i % 3)] + positions[static_cast<std::size_t>(i)],
                mesh.vertices.data()[i], 2e-7);
  }
  const auto faces = decode<std::uint32_t>(data["meshes"][0]["faces"]);
  ASSERT_EQ(static_cast<Index>(faces.size()), mesh.faces.size());
  for (Index i = 0; i < mesh.faces.size(); ++i) {
    EXPECT_EQ(static_cast<int>(faces[static_cast<std::size_t>(i)]), mesh.faces.data()[i]);
  }
  const auto scalar = decode<float>(data["meshes"][0]["scalar"]);
  ASSERT_EQ(static_cast<Index>(scalar.size()), mesh.vertices.cols());
  EXPECT_FLOAT_EQ(scalar[20], static_cast<float>(mesh.scalars[0].values(20)));
  const auto path = decode<float>(data["paths"][0]["positions"]);
  ASSERT_EQ(path.size(), 150U);
  EXPECT_NEAR(origin[0] + path[0], 1e6 + 1, 2e-7);
  EXPECT_EQ(data["paths"][0]["label"], "quarter <turn> & \"more\"");
  EXPECT_EQ(data["scalar"]["name"], "polar angle");
}

TEST(WriteHtml, IsOnePageWithoutAnythingOutside) {
  const std::string html = to_html(test::ball_scene());
  EXPECT_EQ(html.find("http:"), std::string::npos);
  EXPECT_EQ(html.find("https:"), std::string::npos);
  EXPECT_EQ(html.find("{{"), std::string::npos);
  EXPECT_EQ(between(html, "<title>", "</title>"), "A ball &lt;/script&gt;&lt;b&gt;");
  EXPECT_NE(html.find("<dt>length</dt><dd>1.570796327</dd>"), std::string::npos);
  EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw0KGgo"), std::string::npos);
  EXPECT_EQ(html.find('\xFF'), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST(WriteHtml, BytesAreTheSameEveryTime) { EXPECT_EQ(to_html(test::ball_scene(12)), to_html(test::ball_scene(12))); }

TEST(WriteHtml, CellsFlatScenesAndManyDimensionsArePartOfIt) {
  Scene scene;
  scene.lines.push_back({.vertices = Points::Random(2, 3), .segments = Eigen::Matrix2Xi::Zero(2, 1)});
  scene.cells = SceneCells{Points::Random(2, 5), 0.25};
  nlohmann::json data = scene_of(to_html(scene));
  EXPECT_TRUE(data["flat"]);
  EXPECT_EQ(data["cells"]["size"], 0.25);
  EXPECT_EQ(decode<float>(data["cells"]["centres"]).size(), 15U);
  Scene high;
  high.paths.push_back({.points = Points::Random(9, 4)});
  data = scene_of(to_html(high));
  EXPECT_FALSE(data["flat"]);
  EXPECT_EQ(decode<float>(data["paths"][0]["positions"]).size(), 12U);
}

TEST(WriteHtml, OpensWithTheViewAndTheCellsAskedFor) {
  Scene scene = test::ball_scene(12);
  scene.towards_viewer = view_direction(20, 30);
  scene.cells = SceneCells{.centres = Points::Random(3, 5), .size = 0.25};
  nlohmann::json data = scene_of(to_html(scene));
  const std::vector<double> view = data["view"];
  for (Index i = 0; i < 3; ++i) EXPECT_NEAR(view[static_cast<std::size_t>(i)], scene.towards_viewer(i), 1e-12);
  EXPECT_TRUE(data["cells"]["shown"]);
  EXPECT_EQ(data["legend"].size(), 2U);
  EXPECT_EQ(data["legend"][1]["mark"], "square");
  scene.cells->shown = false;
  data = scene_of(to_html(scene));
  EXPECT_FALSE(data["cells"]["shown"]);
  EXPECT_EQ(data["legend"].size(), 1U);
}

TEST(WriteHtml, ScriptIsValidJavaScript) {
  if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no node here";
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "taut_page.mjs";
  const std::string html = to_html(test::ball_scene(12));
  const std::string script = between(html, "<script type=\"module\">\n", "</script>");
  ASSERT_GT(script.size(), 10000U);
  std::ofstream(file) << script;
  EXPECT_EQ(std::system(("node --check '" + file.string() + "'").c_str()), 0);
  std::filesystem::remove(file);
}

TEST(WriteHtml, SaysWhenItCannotWrite) {
  EXPECT_THROW(write_html("/nonexistent/folder/a.html", test::ball_scene(12)), IoError);
  EXPECT_THROW((void)to_html(Scene{}), InvalidArgument);
}

}  // namespace
}  // namespace taut
