#include <gtest/gtest.h>
#include <png.h>

#include <vector>

#include "taut/core/error.hpp"
#include "taut/view/write_picture.hpp"
#include "view/scenes.hpp"

namespace taut {
namespace {

/// A picture as libpng reads it.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<unsigned char> rgb;

  [[nodiscard]] const unsigned char* at(int x, int y) const { return rgb.data() + 3 * (y * width + x); }
};

Picture decode(const std::string& bytes) {
  Picture picture;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  picture.width = static_cast<int>(image.width);
  picture.height = static_cast<int>(image.height);
  picture.rgb.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr), 0) << image.message;
  return picture;
}

template <class Test>
int count(const Picture& picture, Test test) {
  int n = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) n += test(picture.at(x, y)) ? 1 : 0;
  }
  return n;
}

bool is_red(const unsigned char* p) { return p[0] > 110 && p[1] < 70 && p[2] < 70; }
bool is_white(const unsigned char* p) { return p[0] == 255 && p[1] == 255 && p[2] == 255; }

TEST(WritePng, ShowsTheBallRoundAndInTheMiddle) {
  Scene scene = test::ball_scene();
  scene.paths.clear();
  scene.points.clear();
  const Picture picture =
      decode(to_png(scene, {.width = 300, .height = 200, .towards_viewer = Eigen::Vector3d(1, 1, 1)}));
  ASSERT_EQ(picture.width, 300);
  ASSERT_EQ(picture.height, 200);
  EXPECT_TRUE(is_white(picture.at(5, 100)));
  EXPECT_FALSE(is_white(picture.at(150, 100)));
  // The ball fills the height but for margins of 4 %: radius 92 pixels.
  const int covered = count(picture, [](const unsigned char* p) { return !is_white(p); });
  EXPECT_NEAR(covered, 3.14159 * 92 * 92, 0.02 * 3.14159 * 92 * 92);
}

TEST(WritePng, DrawsThePathInItsColourWhereItRuns) {
  // From (1, 1, 0) the quarter turn runs level through the middle of the picture.
  const Picture picture =
      decode(to_png(test::ball_scene(), {.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(1, 1, 0)}));
  EXPECT_TRUE(is_red(picture.at(150, 150)));
  EXPECT_TRUE(is_red(picture.at(110, 150)));
  EXPECT_TRUE(is_red(picture.at(190, 150)));
  EXPECT_FALSE(is_red(picture.at(150, 170)));
}

TEST(WritePng, HiddenPathShowsThroughFaintly) {
  const PictureOptions from_behind{.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(-1, -1, 0)};
  const Picture picture = decode(to_png(test::ball_scene(), from_behind));
  EXPECT_FALSE(is_red(picture.at(150, 150)));
  const unsigned char* on = picture.at(150, 150);
  const unsigned char* off = picture.at(150, 165);
  EXPECT_GT(on[0] - on[2], off[0] - off[2] + 20);
}

TEST(WritePng, ChoosesAViewThatShowsThePath) {
  Scene scene = test::ball_scene();
  for (const double turn : {0.0, 1.0, 2.5, 4.0}) {
    for (Index i = 0; i < 50; ++i) {
      const double a = turn + 0.03 * static_cast<double>(i);
      scene.paths[0].points.col(i) << 0.6 * std::cos(a), 0.6 * std::sin(a), -0.8;  // on the under side
    }
    scene.points.clear();
    EXPECT_GT(count(decode(to_png(scene, {.width = 300, .height = 300})), is_red), 150) << turn;
  }
}

TEST(WritePng, ScalarColoursFollowViridis) {
  Scene scene = test::ball_scene();
  scene.meshes[0].coloured_by = "polar angle";
  scene.paths.clear();
  scene.points.clear();
  const Picture picture =
      decode(to_png(scene, {.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(1, 0, 0)}));
  const unsigned char* low = picture.at(150, 40);
  const unsigned char* high = picture.at(150, 260);
  EXPECT_GT(low[2], low[1]);    // violet
  EXPECT_GT(high[1], high[2]);  // yellow
}

TEST(WritePng, FlatScenesAndManyDimensionsAreDrawn) {
  Scene flat;
  flat.paths.push_back({.points = Points::Random(2, 10), .colour = Colour::hex(0xFF0000)});
  EXPECT_GT(count(decode(to_png(flat, {.width = 200, .height = 200})), is_red), 200);
  Scene high;
  high.paths.push_back({.points = Points::Random(7, 10), .colour = Colour::hex(0xFF0000)});
  EXPECT_GT(count(decode(to_png(high, {.width = 200, .height = 200})), is_red), 200);
}

TEST(WritePng, FarFromTheOriginIsNoDifferent) {
  Scene scene = test::ball_scene();
  const PictureOptions options{.width = 200, .height = 200, .towards_viewer = Eigen::Vector3d(1, 2, 3)};
  const Picture near = decode(to_png(scene, options));
  const Eigen::Vector3d shift(4e6, -5e6, 3e6);
  scene.meshes[0].mesh.vertices.colwise() += shift;
  scene.paths[0].points.colwise() += shift;
  for (ScenePoint& point : scene.points) point.position += shift;
  const Picture far = decode(to_png(scene, options));
  int different = 0;
  for (std::size_t i = 0; i < near.rgb.size(); ++i) different += std::abs(near.rgb[i] - far.rgb[i]) > 8 ? 1 : 0;
  EXPECT_LT(different, 30);
}

TEST(WritePng, BytesAreTheSameOnAnyNumberOfThreads) {
  const Scene scene = test::ball_scene();
  EXPECT_EQ(to_png(scene, {.width = 200, .height = 150, .threads = 1}),
            to_png(scene, {.width = 200, .height = 150, .threads = 2}));
}

TEST(WritePng, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW((void)to_png(Scene{}), InvalidArgument);
  EXPECT_THROW((void)to_png(test::ball_scene(), {.width = 0}), InvalidArgument);
  EXPECT_THROW((void)to_png(test::ball_scene(), {.height = 1000000}), InvalidArgument);
  Scene scene = test::ball_scene();
  scene.paths[0].points(1, 3) = std::nan("");
  EXPECT_THROW((void)to_png(scene), InvalidArgument);
  scene = test::ball_scene();
  scene.meshes[0].mesh.faces(0, 0) = 1000000;
  EXPECT_THROW((void)to_png(scene), InvalidArgument);
  scene = test::ball_scene();
  scene.paths.push_back({.points = Points::Zero(4, 2)});
  EXPECT_THROW((void)to_png(scene), InvalidArgument);
  scene = test::ball_scene();
  scene.meshes[0].coloured_by = "temperature";
  EXPECT_THROW((void)to_png(scene), InvalidArgument);
  EXPECT_THROW(write_png("/nonexistent/folder/a.png", test::ball_scene(), {.width = 16, .height = 16}), IoError);
}

}  // namespace
}  // namespace taut
