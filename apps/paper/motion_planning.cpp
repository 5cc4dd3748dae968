// Motion planning: the shortest motion of a linkage is a geodesic on the surface of its closed positions.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "applications.hpp"
#include "curves.hpp"
#include "taut/query/path.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

// A planar five-bar: hinges at (0, 0) and (kBase, 0), legs of 1 and 1.5 on either side that meet in one point. Its
// angles x, y (left leg, from the base) and w, z (right leg) close when both legs end in the same place: k = 2
// equations in d = 4.
constexpr double kBase = 1.2;
constexpr const char* kFiveBar = "cos(x)+1.5*cos(y)-1.2-cos(w)-1.5*cos(z)=0; sin(x)+1.5*sin(y)-sin(w)-1.5*sin(z)=0";

/// Both legs end here, to the bend of either leg given.
Vector five_bar_pose(double px, double py) {
  const auto leg = [&](double base, double bend) {
    const double dx = px - base;
    const double reach = std::hypot(dx, py);
    const double at_base = std::acos((1 + reach * reach - 1.5 * 1.5) / (2 * reach));
    const double first = std::atan2(py, dx) + bend * at_base;
    return Eigen::Vector2d(first, std::atan2(py - std::sin(first), dx - std::cos(first)));
  };
  const Eigen::Vector2d left = leg(0, 1);
  const Eigen::Vector2d right = leg(kBase, -1);
  return Eigen::Vector4d(left.x(), left.y(), right.y(), right.x());
}

void draw_five_bar(Drawing& drawing, const Vector& angles, const Colour& colour, double width) {
  const auto see = [](double x, double y) { return Eigen::Vector2d(300 + 105 * x, 330 - 105 * y); };
  const double x = std::cos(angles(0)), y = std::sin(angles(0));
  const double u = kBase + std::cos(angles(3)), v = std::sin(angles(3));
  Points chain(2, 5);
  chain << see(0, 0), see(x, y), see(x + 1.5 * std::cos(angles(1)), y + 1.5 * std::sin(angles(1))), see(u, v),
      see(kBase, 0);
  drawing.add(Stroke{.points = chain, .colour = colour, .width = width});
  for (const Index joint : {1, 2, 3})
    drawing.add(Disc{.centre = chain.col(joint), .radius = 1.4 * width, .colour = colour});
}

Drawing five_bar_drawing(const Points& path) {
  Drawing drawing{.width = 720, .height = 400, .title = "A five-bar linkage on its shortest motion"};
  constexpr int kPoses = 9;
  const double length = polyline_length(path);
  constexpr Index kTrack = 80;  // points of the way that the tip takes
  Points track(2, kTrack);
  for (Index i = 0; i < kTrack; ++i) {
    const Vector angles = point_along(path, static_cast<double>(i) / (kTrack - 1) * length);
    track.col(i) << 300 + 105 * (std::cos(angles(0)) + 1.5 * std::cos(angles(1))),
        330 - 105 * (std::sin(angles(0)) + 1.5 * std::sin(angles(1)));
  }
  drawing.add(Stroke{.points = track, .colour = kInk, .width = 2, .dash = 6});
  for (int i = 0; i < kPoses; ++i) {
    const float part = static_cast<float>(i) / (kPoses - 1);
    const Vector angles = point_along(path, static_cast<double>(part) * length);
    const Colour colour{0.12F + 0.66F * part, 0.37F - 0.17F * part, 0.75F - 0.57F * part};
    draw_five_bar(drawing, angles,
                  i == 0 || i == kPoses - 1
                      ? colour
                      : Colour{0.5F + 0.5F * colour.red, 0.5F + 0.5F * colour.green, 0.5F + 0.5F * colour.blue},
                  i == 0 || i == kPoses - 1 ? 4.5 : 2);
  }
  drawing.line({250, 336}, {490, 336}, kGrey, 3);
  for (const double x : {0.0, kBase}) drawing.add(Disc{.centre = {300 + 105 * x, 330}, .radius = 7, .colour = kInk});
  drawing.add(
      TextLine{.at = {24, 36}, .text = "start (blue), goal (red), and the way of the tip", .size = 19, .colour = kInk});
  return drawing;
}

/// Largest distance between the ends of the two legs along the straight line in joint space.
double gap_of_straight_motion(const Surface& linkage, const Vector& from, const Vector& to) {
  double gap = 0;
  constexpr int kProbes = 100;
  for (int i = 0; i <= kProbes; ++i)
    gap = std::max(gap, linkage.value(from + static_cast<double>(i) / kProbes * (to - from)).norm());
  return gap;
}

}  // namespace

void write_motion_planning(Study& study, Section& section) {
  Table table{.name = "motion_planning",
              .title = "Shortest motions in joint space (radians)",
              .columns = {{"linkage"},
                          {"joints d"},
                          {"equations k"},
                          {"straight line", "{:.6f}"},
                          {"worst error of closure on it", "{:.3f}"},
                          {"shortest motion", "{:.9f}"},
                          {"its error estimate", "{:.1e}"},
                          {"worst error of closure ", "{:.1e}"},
                          {"status"},
                          {"seconds", "{:.2f}"}}};
  const Surface five_bar = parse_surface(kFiveBar, {.dim = 4});
  const Vector start = five_bar_pose(-0.75, 1.55);
  const Vector goal = five_bar_pose(1.9, 1.35);
  const ProcessorClock clock;
  const PathResult motion = shortest_path(five_bar, start, goal, {}, study.context);
  table.add({std::string("five-bar"), Index(4), Index(2), (goal - start).norm(),
             gap_of_straight_motion(five_bar, start, goal), motion.length, motion.length_error, motion.residual.surface,
             std::string(to_string(motion.status)), clock.seconds()});
  section.text(
      "A closed linkage may only take positions in which its legs meet: an implicit surface of codimension 2 in the "
      "space of its "
      "four angles. A straight line between two positions tears it apart; the geodesic is its shortest motion. The "
      "second "
      "example is an arm of three joints whose hand keeps its height: a surface in space, which can be seen.");
  std::vector<Figure> pictures;
  if (motion.points.cols() > 1) {
    pictures.push_back(
        figure_of("motion_five_bar", "The five-bar on its shortest motion.", five_bar_drawing(motion.points)));
  }

  const Surface arm = parse_surface(
      "sin(x)+sin(x+y)+0.6*sin(x+y+z)=1.3",
      {.box = Box{Eigen::Vector3d::Constant(-std::numbers::pi), Eigen::Vector3d::Constant(std::numbers::pi)}});
  const ProcessorClock arm_clock;
  const Vector low = Eigen::Vector3d(0.3, 0.5, 0.3);
  const Vector high = Eigen::Vector3d(2.3, -0.6, -0.9);
  const PathResult reach = shortest_path(arm, low, high, {}, study.context);
  table.add({std::string("arm whose hand keeps its height"), Index(3), Index(1), (reach.to - reach.from).norm(),
             gap_of_straight_motion(arm, reach.from, reach.to), reach.length, reach.length_error,
             reach.residual.surface, std::string(to_string(reach.status)), arm_clock.seconds()});
  Scene scene;
  scene.title = "Three joints, one height";
  scene.meshes.push_back({.mesh = display_mesh(arm, {}, study.context), .colour = Colour::hex(0xd3dde6)});
  if (reach.points.cols() > 1)
    scene.paths.push_back({.points = reach.points, .label = "shortest motion", .colour = kRed, .length = reach.length});
  pictures.push_back(
      figure_of("motion_arm",
                "All positions of an arm (three angles between −π and π) whose hand keeps its height, and "
                "the shortest motion between two of them.",
                scene, {.width = 640, .height = 480, .towards_viewer = {-0.78, -0.55, -0.31}}));
  section.add_row(std::move(pictures));
  section.add(std::move(table));
}

}  // namespace taut::paper
