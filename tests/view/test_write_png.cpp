#include <gtest/gtest.h>
#include <png.h>

#include <vector>

#include "taut/core/error.hpp"
#include "taut/view/write_scene.hpp"
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
      decode(to_png(scene, {.width = 300, .height = 200, .towards_viewer = Eigen::Vector3d(1, 1, 1), .text = false}));
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
  const Picture picture = decode(to_png(
      test::ball_scene(), {.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(1, 1, 0), .text = false}));
  EXPECT_TRUE(is_red(picture.at(150, 150)));
  EXPECT_TRUE(is_red(picture.at(110, 150)));
  EXPECT_TRUE(is_red(picture.at(190, 150)));
  EXPECT_FALSE(is_red(picture.at(150, 170)));
}

TEST(WritePng, HiddenPathShowsThroughFaintly) {
  const PictureOptions from_behind{
      .width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(-1, -1, 0), .text = false};
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
    EXPECT_GT(count(decode(to_png(scene, {.width = 300, .height = 300, .text = false})), is_red), 150) << turn;
  }
}

TEST(WritePng, ScalarColoursFollowViridis) {
  Scene scene = test::ball_scene();
  scene.meshes[0].coloured_by = "polar angle";
  scene.paths.clear();
  scene.points.clear();
  const Picture picture =
      decode(to_png(scene, {.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(1, 0, 0), .text = false}));
  const unsigned char* low = picture.at(150, 40);
  const unsigned char* high = picture.at(150, 260);
  EXPECT_GT(low[2], low[1]);    // violet
  EXPECT_GT(high[1], high[2]);  // yellow
}

TEST(WritePng, IsolinesOfTheSceneTakeThePlaceOfDrawnOnes) {
  Scene scene = test::ball_scene();
  scene.meshes[0].coloured_by = "polar angle";
  scene.paths.clear();
  scene.points.clear();
  const auto picture = [&](bool isolines) {
    return to_png(scene, {.width = 200, .height = 200, .text = false, .isolines = isolines});
  };
  const std::string none = picture(false);
  EXPECT_NE(picture(true), none);
  // Two vertices inside the ball, where no line of theirs is seen.
  scene.lines.push_back({.vertices = Points::Zero(3, 2), .segments = Eigen::Vector2i(0, 1), .name = "isolines"});
  EXPECT_EQ(picture(true), none);
}

/// The mean place of the pixels that pass a test.
template <class Test>
Eigen::Vector2d centre_of(const Picture& picture, Test test) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int n = 0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (!test(picture.at(x, y))) continue;
      sum += Eigen::Vector2d(x, y);
      ++n;
    }
  }
  EXPECT_GT(n, 0);
  return sum / n;
}

TEST(WritePng, KnownPointsAreSeenWhereTheViewPutsThem) {
  // A red point on an axis before a ball round the origin: from `azimuth` and `elevation` it must be seen there.
  struct Case {
    Eigen::Vector3d point;
    Eigen::Vector3d up;
    double azimuth;
    double elevation;
    Eigen::Vector2d seen;  // x right, y down; 0 = in the middle
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  for (const Case& c :
       {Case{y, z, 0, 0, {1, 0}}, Case{z, z, 0, 0, {0, -1}}, Case{x, z, 90, 0, {-1, 0}}, Case{x, z, -90, 0, {1, 0}},
        Case{y, z, 0, 90, {1, 0}}, Case{x, z, 0, 90, {0, 1}}, Case{x, z, 0, -90, {0, -1}}, Case{y, y, 30, 0, {0, -1}},
        Case{x, y, -90, 0, {1, 0}}, Case{z, y, 0, 0, {-1, 0}}, Case{y, x, 90, 0, {-1, 0}},
        Case{x, -1 * x, 45, 0, {0, 1}}, Case{y, z, 0, 45, {1, 0}}, Case{z, z, 77, 45, {0, -std::sqrt(0.5)}}}) {
    Scene scene = test::ball_scene(12);
    scene.meshes[0].mesh.vertices *= 0.1;
    scene.paths.clear();
    scene.points = {{.position = c.point, .colour = Colour::hex(0xFF0000), .size = 0.5}};
    for (const Eigen::Vector3d& corner : {x, y, z}) {  // so that the origin stays in the middle
      for (const double sign : {-1.0, 1.0}) {
        scene.points.push_back({.position = sign * corner, .colour = Colour::hex(0x888888), .size = 0.1});
      }
    }
    scene.up = c.up;
    scene.towards_viewer = view_direction(c.azimuth, c.elevation, c.up);
    const Picture picture = decode(to_png(scene, {.width = 400, .height = 400, .text = false}));
    const Eigen::Vector2d seen = centre_of(picture, is_red) - Eigen::Vector2d(200, 200);
    // Perspective moves the picture's middle and makes what is nearer or farther larger or smaller.
    EXPECT_NEAR(seen.x() / 184, c.seen.x(), 0.2) << c.point.transpose() << " from " << c.azimuth << "," << c.elevation;
    EXPECT_NEAR(seen.y() / 184, c.seen.y(), 0.2) << c.point.transpose() << " from " << c.azimuth << "," << c.elevation;
  }
}

TEST(WritePng, OpenSurfacesAreSeenFromTheSideTheyFace) {
  for (const Eigen::Vector3d& side :
       {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-1, 0.3, 0.2), Eigen::Vector3d(0.4, 1, -0.5)}) {
    Scene scene = test::ball_scene();
    TriangleMesh& mesh = scene.meshes[0].mesh;
    Index kept = 0;
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
      if (mesh.vertices.col(mesh.faces(0, f)).dot(side.normalized()) > 0.2) mesh.faces.col(kept++) = mesh.faces.col(f);
    }
    mesh.faces.conservativeResize(3, kept);
    scene.points.clear();
    scene.meshes[0].colour = Colour::hex(0x8090FF);
    scene.paths.clear();
    const Picture picture = decode(to_png(scene, {.width = 200, .height = 200, .text = false}));
    // The inside is drawn warmer: from outside, blue prevails everywhere.
    const int outside = count(picture, [](const unsigned char* p) { return p[2] > p[0] + 40; });
    const int drawn = count(picture, [](const unsigned char* p) { return !is_white(p); });
    EXPECT_GT(outside, 0.9 * drawn) << side.transpose();
  }
}

TEST(WritePng, ColourBarShowsTheMapWithNumbers) {
  Scene scene = test::ball_scene();
  scene.meshes[0].coloured_by = "polar angle";
  const Picture with = decode(to_png(scene, {.width = 600, .height = 400}));
  const Picture without = decode(to_png(scene, {.width = 600, .height = 400, .text = false}));
  // The right margin holds nothing but the bar: yellow above violet, and beside it dark figures on white.
  const auto violet = [](const unsigned char* p) { return p[0] < 90 && p[1] < 40 && p[2] > 70 && p[2] < 120; };
  const auto yellow = [](const unsigned char* p) { return p[0] > 230 && p[1] > 210 && p[2] < 80; };
  const auto crop = [](const Picture& picture, int left) {
    Picture part{picture.width - left, picture.height, {}};
    for (int y = 0; y < picture.height; ++y) {
      part.rgb.insert(part.rgb.end(), picture.at(left, y), picture.at(left, y) + 3 * part.width);
    }
    return part;
  };
  const Picture bar = crop(with, 480);
  EXPECT_LT(centre_of(bar, yellow).y() + 60, centre_of(bar, violet).y());
  const Picture figures = crop(with, 515);
  EXPECT_GT(count(figures, [](const unsigned char* p) { return p[0] < 120 && p[1] < 130 && p[2] < 140; }), 60);
  EXPECT_GT(count(figures, is_white), 0.8 * figures.width * figures.height);
  EXPECT_EQ(count(crop(without, 570), [](const unsigned char* p) { return !is_white(p); }), 0);
}

TEST(WritePng, TitleAndLegendAreWritten) {
  Scene scene = test::ball_scene();
  scene.paths[0].label = "from @12";
  scene.title = "Every letter: {|}~ AZ az 09";
  const Picture with = decode(to_png(scene, {.width = 600, .height = 400}));
  const auto dark_above = [](const Picture& picture, int y) {
    int n = 0;
    for (int row = 0; row < y; ++row) {
      for (int x = 0; x < picture.width; ++x) n += picture.at(x, row)[0] < 110 ? 1 : 0;
    }
    return n;
  };
  EXPECT_GT(dark_above(with, 50), 300);
  scene.title.clear();
  EXPECT_LT(dark_above(decode(to_png(scene, {.width = 600, .height = 400})), 36), 5);
}

TEST(WritePng, CellsAreATranslucentSkinThatHidesNoPath) {
  Scene scene = test::ball_scene();
  scene.points.clear();
  const PictureOptions options{.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(1, 1, 0), .text = false};
  const int red_before = count(decode(to_png(scene, options)), is_red);
  SceneCells cells{.centres = Points(3, 0), .size = 0.25};
  for (int i = 0; i < 9 * 9 * 9; ++i) {  // those that the sphere crosses
    const Eigen::Vector3d centre = 0.25 * Eigen::Vector3d(i % 9 - 4, i / 9 % 9 - 4, i / 81 - 4);
    if (std::abs(centre.norm() - 1) > 0.2) continue;
    cells.centres.conservativeResize(3, cells.centres.cols() + 1);
    cells.centres.rightCols(1) = centre;
  }
  scene.cells = cells;
  const auto is_green = [](const unsigned char* p) { return p[1] > p[0] + 25 && p[1] > p[2] + 15; };
  const Picture picture = decode(to_png(scene, options));
  EXPECT_GT(count(picture, is_green), 20000);
  EXPECT_GT(count(picture, is_red), 0.9 * red_before);
  scene.cells->shown = false;
  EXPECT_EQ(count(decode(to_png(scene, options)), is_green), 0);
}

TEST(WritePng, FailedPathIsDashed) {
  Scene scene = test::ball_scene();
  scene.points.clear();
  const PictureOptions options{.width = 300, .height = 300, .towards_viewer = Eigen::Vector3d(1, 1, 0), .text = false};
  const int whole = count(decode(to_png(scene, options)), is_red);
  scene.paths[0].failed = true;
  const int dashed = count(decode(to_png(scene, options)), is_red);
  EXPECT_GT(dashed, 0.3 * whole);
  EXPECT_LT(dashed, 0.85 * whole);
}

TEST(ViewDirection, RefusesWhatIsNoView) {
  EXPECT_THROW((void)view_direction(0, 91), InvalidArgument);
  EXPECT_THROW((void)view_direction(std::nan(""), 0), InvalidArgument);
  EXPECT_THROW((void)view_direction(0, 0, Eigen::Vector3d::Zero()), InvalidArgument);
}

TEST(WritePng, FlatScenesAndManyDimensionsAreDrawn) {
  Scene flat;
  flat.paths.push_back({.points = Points::Random(2, 10), .colour = Colour::hex(0xFF0000)});
  EXPECT_GT(count(decode(to_png(flat, {.width = 200, .height = 200, .text = false})), is_red), 200);
  Scene high;
  high.paths.push_back({.points = Points::Random(7, 10), .colour = Colour::hex(0xFF0000)});
  EXPECT_GT(count(decode(to_png(high, {.width = 200, .height = 200, .text = false})), is_red), 200);
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
