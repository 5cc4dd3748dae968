// An independent judge of shortest paths over edges: bodies made of planes, spheres, cylinders and cones, on each of
// which geodesics are closed forms. It shares nothing with the library.
//
//   judge_faces                             the names of the shapes
//   judge_faces SHAPE --formula             the shape's formula, as `taut path` takes it
//   judge_faces SHAPE --pairs N SEED        N random pairs of points on it, a line each
//   judge_faces SHAPE --judge PAIRS.csv     the length of the shortest way that it finds for each line
//
// All edges are sampled; two samples (or ends) on one primitive are joined by each of its closed-form geodesics that
// stays on the body. Dijkstra's algorithm finds the ways over that graph, one for each row of primitives within
// kAlike of the shortest; then the crossings of each slide along their edges until it gets no shorter. What comes of it
// is the length of a curve on the body: never less than the shortest, to rounding and to gaps between the points at
// which a curve is looked at.
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <queue>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using Point = Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kOn = 1e-9;        // |F| of a point on the body; all shapes are some units wide
constexpr double kAlike = 0.08;     // rows of primitives up to this part longer than the shortest are refined
constexpr int kMostRows = 48;       // of them
constexpr int kNodes = 400;         // samples of all edges, about
constexpr int kSweeps = 300;        // of sliding
constexpr double kShortest = 1e-9;  // step of sliding, of the reach
constexpr int kLooks = 16;          // points at which a geodesic is looked at

// --- Primitives ------------------------------------------------------------------------------------------------------

enum class Kind { plane, sphere, cylinder, cone };

/// n . x = d; |x - c| = r; distance r from the axis through c along n; the cone of apex c, axis n and half angle r.
struct Primitive {
  Kind kind;
  Point n = Point::Zero();
  Point c = Point::Zero();
  double r = 0;

  [[nodiscard]] double value(const Point& x) const {
    switch (kind) {
      case Kind::plane: return n.dot(x) - r;
      case Kind::sphere: return (x - c).norm() - r;
      case Kind::cylinder: return across(x).norm() - r;
      case Kind::cone: return across(x).norm() * std::cos(r) - n.dot(x - c) * std::sin(r);
    }
    return 0;
  }
  [[nodiscard]] Point gradient(const Point& x) const {
    switch (kind) {
      case Kind::plane: return n;
      case Kind::sphere: return (x - c).normalized();
      case Kind::cylinder: return across(x).normalized();
      case Kind::cone: return across(x).normalized() * std::cos(r) - n * std::sin(r);
    }
    return n;
  }
  [[nodiscard]] Point across(const Point& x) const { return x - c - n * n.dot(x - c); }
};

/// A geodesic of a primitive: its length, and its points.
struct Curve {
  double length = kFar;
  std::function<Point(double)> at;  // of 0 .. 1
};

/// Turns round the axis: the frame in which angles are measured.
double angle_of(const Primitive& s, const Point& x) {
  const Point first = s.n.unitOrthogonal();
  const Point away = s.across(x);
  return std::atan2(away.dot(s.n.cross(first)), away.dot(first));
}

Point on_axis_circle(const Primitive& s, double angle, double radius, double height) {
  const Point first = s.n.unitOrthogonal();
  return s.c + s.n * height + radius * (std::cos(angle) * first + std::sin(angle) * s.n.cross(first));
}

/// From one angle to another: the short way, or a whole turn less or more.
double turn_between(double from, double to, int winding) {
  const double turn = std::remainder(to - from, 2 * kPi);
  return winding == 0 ? turn : turn + (winding == 1 ? -2 : 2) * kPi;
}

/// All ways that geodesics of the primitive go from a to b: `winding` tells them apart.
constexpr int kWindings = 3;
Curve geodesic(const Primitive& s, const Point& a, const Point& b, int winding) {
  switch (s.kind) {
    case Kind::plane:
      if (winding != 0) return {};
      return {(b - a).norm(), [=](double t) -> Point { return a + t * (b - a); }};
    case Kind::sphere: {
      const Point u = (a - s.c) / s.r;
      const Point v = (b - s.c) / s.r;
      const Point side = v - u * u.dot(v);
      if (winding == 2 || side.norm() < 1e-12)
        return winding == 0 && u.dot(v) > 0 ? Curve{0, [=](double) { return a; }} : Curve{};
      const double turn = std::atan2(side.norm(), u.dot(v)) - (winding == 1 ? 2 * kPi : 0);
      const Point along = side.normalized();
      return {s.r * std::abs(turn),
              [=](double t) -> Point { return s.c + s.r * (std::cos(t * turn) * u + std::sin(t * turn) * along); }};
    }
    case Kind::cylinder: {
      const double from = angle_of(s, a);
      const double turn = turn_between(from, angle_of(s, b), winding);
      const double low = s.n.dot(a - s.c);
      const double rise = s.n.dot(b - s.c) - low;
      return {std::hypot(s.r * turn, rise),
              [=](double t) { return on_axis_circle(s, from + t * turn, s.r, low + t * rise); }};
    }
    case Kind::cone: {
      const double from = angle_of(s, a);
      const double turn = turn_between(from, angle_of(s, b), winding);
      // Unrolled, an angle shrinks by sin of the half angle.
      const double flat = turn * std::sin(s.r);
      if (std::abs(flat) >= kPi) return {};
      const double first = (a - s.c).norm();
      const double second = (b - s.c).norm();
      const Eigen::Vector2d p(first, 0);
      const Eigen::Vector2d q(second * std::cos(flat), second * std::sin(flat));
      return {(q - p).norm(), [=](double t) {
                const Eigen::Vector2d x = p + t * (q - p);
                const double slant = x.norm();
                const double angle = from + std::atan2(x.y(), x.x()) / std::sin(s.r);
                return on_axis_circle(s, angle, slant * std::sin(s.r), slant * std::cos(s.r));
              }};
    }
  }
  return {};
}

// --- Bodies ----------------------------------------------------------------------------------------------------------

/// max (meets) or min (joins) of parts, or a primitive with a sign.
struct Body {
  enum class Op { leaf, meet, join } op = Op::leaf;
  int primitive = -1;
  double sign = 1;
  std::vector<Body> parts;
};

struct Shape {
  std::vector<Primitive> primitives;
  std::string formula;
  Body body;
  double reach = 3;  // half the side of a box around it

  [[nodiscard]] double value(const Body& of, const Point& x) const {
    if (of.op == Body::Op::leaf) return of.sign * primitives[static_cast<std::size_t>(of.primitive)].value(x);
    double result = value(of.parts.front(), x);
    for (const Body& part : of.parts) {
      const double v = value(part, x);
      result = of.op == Body::Op::meet ? std::max(result, v) : std::min(result, v);
    }
    return result;
  }
  [[nodiscard]] bool holds(const Point& x) const { return std::abs(value(body, x)) <= kOn; }
};

/// Collects the primitives and the text of a shape.
class Builder {
 public:
  struct Part {
    Body body;
    std::string text;
  };
  Part plane(double a, double b, double c, double d) {
    const double size = std::hypot(a, b, c);
    return leaf({Kind::plane, Point(a, b, c) / size, Point::Zero(), d / size},
                "(" + number(a) + "*x+" + number(b) + "*y+" + number(c) + "*z-" + number(d) + ")");
  }
  Part ball(double a, double b, double c, double r) {
    return leaf({Kind::sphere, Point::Zero(), {a, b, c}, r},
                "((x-" + number(a) + ")^2+(y-" + number(b) + ")^2+(z-" + number(c) + ")^2-" + number(r * r) + ")");
  }
  /// Round an axis along x, y or z through (a, b) in the plane across it.
  Part round(char axis, double a, double b, double r) {
    const std::string u = axis == 'x' ? "y" : "x";
    const std::string v = axis == 'z' ? "y" : "z";
    const Point along = axis == 'x' ? Point::UnitX() : axis == 'y' ? Point::UnitY() : Point::UnitZ();
    const Point centre = axis == 'x' ? Point(0, a, b) : axis == 'y' ? Point(a, 0, b) : Point(a, b, 0);
    return leaf({Kind::cylinder, along, centre, r},
                "((" + u + "-" + number(a) + ")^2+(" + v + "-" + number(b) + ")^2-" + number(r * r) + ")");
  }
  /// Round the z axis, apex at height h, opening downwards (or upwards) with radius `slope` a unit.
  Part cone(double h, double slope, bool down) {
    const std::string depth = down ? "(" + number(h) + "-z)" : "(z-" + number(h) + ")";
    return leaf({Kind::cone, down ? Point(-Point::UnitZ()) : Point(Point::UnitZ()), {0, 0, h}, std::atan(slope)},
                "(sqrt(x^2+y^2)-" + number(slope) + "*" + depth + ")");
  }
  Part meet(std::vector<Part> parts) { return combine(Body::Op::meet, "max", std::move(parts)); }
  Part join(std::vector<Part> parts) { return combine(Body::Op::join, "min", std::move(parts)); }
  Part without(Part part) {
    flip(part.body);
    part.text = "(-" + part.text + ")";
    return part;
  }
  /// A box between two corners.
  Part box(const Point& a, const Point& b) {
    return meet({plane(1, 0, 0, b.x()), plane(-1, 0, 0, -a.x()), plane(0, 1, 0, b.y()), plane(0, -1, 0, -a.y()),
                 plane(0, 0, 1, b.z()), plane(0, 0, -1, -a.z())});
  }
  Part slab(double low, double high) { return meet({plane(0, 0, 1, high), plane(0, 0, -1, -low)}); }
  /// A prism of n sides, its faces at distance r from the z axis.
  Part prism(int n, double r) {
    std::vector<Part> sides;
    for (int i = 0; i < n; ++i) sides.push_back(plane(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0, r));
    return meet(std::move(sides));
  }
  Shape finish(Part part, double reach) {
    shape_.formula = part.text + "=0";
    shape_.body = part.body;
    shape_.reach = reach;
    return std::move(shape_);
  }

 private:
  static std::string number(double v) {
    char text[40];
    std::snprintf(text, sizeof text, "(%.17g)", v);
    return text;
  }
  /// Of planes that parts share there is one.
  Part leaf(const Primitive& primitive, std::string text) {
    std::vector<Primitive>& known = shape_.primitives;
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (known[i].kind != Kind::plane || primitive.kind != Kind::plane) continue;
      for (const double sign : {1.0, -1.0}) {
        if ((known[i].n - sign * primitive.n).norm() + std::abs(known[i].r - sign * primitive.r) > 1e-12) continue;
        return {{Body::Op::leaf, static_cast<int>(i), sign, {}}, std::move(text)};
      }
    }
    known.push_back(primitive);
    return {{Body::Op::leaf, static_cast<int>(known.size()) - 1, 1, {}}, std::move(text)};
  }
  static void flip(Body& body) {
    body.sign = -body.sign;
    if (body.op != Body::Op::leaf) body.op = body.op == Body::Op::meet ? Body::Op::join : Body::Op::meet;
    for (Body& part : body.parts) flip(part);
  }
  static Part combine(Body::Op op, const std::string& name, std::vector<Part> parts) {
    Part whole{{op, -1, 1, {}}, name + "("};
    for (std::size_t i = 0; i < parts.size(); ++i) {
      whole.text += (i > 0 ? "," : "") + parts[i].text;
      whole.body.parts.push_back(std::move(parts[i].body));
    }
    whole.text += ")";
    return whole;
  }

  Shape shape_;
};

using Make = std::function<Shape(Builder&)>;

const std::map<std::string, Make>& shapes() {
  static const std::map<std::string, Make> all = {
      {"box",
       [](Builder& b) {
         return b.finish(b.box({-2, -1, -0.7}, {2, 1, 0.7}), 2.2);
       }},
      {"brick30",
       [](Builder& b) {
         return b.finish(b.box({-15, -6, -6}, {15, 6, 6}), 15.5);
       }},
      {"wedge",
       [](Builder& b) {
         return b.finish(b.meet({b.plane(0, 0, -1, 0.5), b.plane(1, 0, 2, 1.2), b.plane(-1, 0, 0, 1.5),
                                 b.plane(0, 1, 0, 1), b.plane(0, -1, 0, 1)}),
                         2.7);
       }},
      {"house",
       [](Builder& b) {
         return b.finish(b.meet({b.box({-1, -1.5, -1}, {1, 1.5, 3}), b.plane(1, 0, 1, 1.2), b.plane(-1, 0, 1, 1.2)}),
                         1.8);
       }},
      {"pyramid",
       [](Builder& b) {
         return b.finish(b.meet({b.plane(0, 0, -1, 0.4), b.plane(1, 0, 1, 1), b.plane(-1, 0, 1, 1),
                                 b.plane(0, 1, 0.6, 1), b.plane(0, -1, 0.6, 1)}),
                         1.6);
       }},
      {"octahedron",
       [](Builder& b) {
         std::vector<Builder::Part> sides;
         for (int i = 0; i < 8; ++i) sides.push_back(b.plane(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1.3 : -1.3, 1.4));
         return b.finish(b.meet(std::move(sides)), 1.6);
       }},
      {"pentagon",
       [](Builder& b) {
         return b.finish(b.meet({b.prism(5, 1), b.slab(-0.6, 0.9)}), 1.4);
       }},
      {"hexagon_cut",
       [](Builder& b) {
         return b.finish(b.meet({b.prism(6, 1), b.slab(-1, 1), b.plane(1, 0.3, 1, 0.9)}), 1.4);
       }},
      {"angle",
       [](Builder& b) {
         return b.finish(b.join({b.box({-1, -1, -1}, {1, 1, -0.4}), b.box({-1, -1, -1}, {-0.4, 1, 1})}), 1.2);
       }},
      {"stairs",
       [](Builder& b) {
         return b.finish(b.join({b.box({-1.5, -1, -1}, {1.5, 1, -0.5}), b.box({-1.5, -1, -1}, {0.5, 1, 0.1}),
                                 b.box({-1.5, -1, -1}, {-0.6, 1, 0.8})}),
                         1.7);
       }},
      {"cross",
       [](Builder& b) {
         return b.finish(b.join({b.box({-2, -0.5, -0.4}, {2, 0.5, 0.4}), b.box({-0.6, -2, -0.7}, {0.6, 2, 0.3})}), 2.2);
       }},
      {"slot",
       [](Builder& b) {
         return b.finish(b.meet({b.box({-1.5, -1, -1}, {1.5, 1, 1}), b.without(b.box({-0.3, -3, 0.1}, {0.5, 3, 3}))}),
                         1.7);
       }},
      {"can",
       [](Builder& b) {
         return b.finish(b.meet({b.round('z', 0, 0, 1.3), b.slab(-0.8, 1)}), 1.5);
       }},
      {"pillar",
       [](Builder& b) {
         return b.finish(b.meet({b.round('z', 0, 0, 0.5), b.slab(-2, 2)}), 2.2);
       }},
      {"half_can",
       [](Builder& b) {
         return b.finish(b.meet({b.round('z', 0, 0, 1), b.slab(-1, 0.8), b.plane(0, 1, 0, 0.3)}), 1.2);
       }},
      {"slanted_can",
       [](Builder& b) {
         return b.finish(b.meet({b.round('z', 0, 0, 1), b.plane(0.5, 0.2, 1, 0.8), b.plane(0, 0, -1, 1)}), 1.8);
       }},
      {"pipe",
       [](Builder& b) {
         return b.finish(b.meet({b.round('z', 0, 0, 1.2), b.without(b.round('z', 0.1, 0, 0.7)), b.slab(-0.8, 0.8)}),
                         1.4);
       }},
      {"drilled_plate",
       [](Builder& b) {
         return b.finish(b.meet({b.box({-2, -1.2, -0.3}, {2, 1.2, 0.3}), b.without(b.round('z', 0.5, 0.1, 0.6))}), 2.2);
       }},
      {"two_holes",
       [](Builder& b) {
         return b.finish(b.meet({b.box({-2, -1.2, -0.4}, {2, 1.2, 0.4}), b.without(b.round('z', 0.9, 0.1, 0.5)),
                                 b.without(b.round('z', -0.8, -0.2, 0.6))}),
                         2.2);
       }},
      {"nut",
       [](Builder& b) {
         return b.finish(b.meet({b.prism(6, 1), b.slab(-0.5, 0.5), b.without(b.round('z', 0, 0, 0.55))}), 1.3);
       }},
      {"shaft",
       [](Builder& b) {
         return b.finish(b.join({b.meet({b.round('z', 0, 0, 1), b.slab(-1, 0)}),
                                 b.meet({b.round('z', 0, 0, 0.5), b.slab(-1, 1.2)})}),
                         1.4);
       }},
      {"dome",
       [](Builder& b) {
         return b.finish(b.meet({b.ball(0, 0, 0, 1), b.plane(0, 0, -1, 0.2)}), 1.2);
       }},
      {"lens",
       [](Builder& b) {
         return b.finish(b.meet({b.ball(0, 0, -0.5, 1), b.ball(0, 0, 0.6, 1.1)}), 1.2);
       }},
      {"notched_ball",
       [](Builder& b) {
         return b.finish(b.meet({b.ball(0, 0, 0, 1), b.plane(1, 0, 0, 0.6), b.plane(0, 0.3, 1, 0.5)}), 1.2);
       }},
      {"bored_ball",
       [](Builder& b) {
         return b.finish(b.meet({b.ball(0, 0, 0, 1.5), b.without(b.round('z', 0.2, 0, 0.6))}), 1.7);
       }},
      {"bitten_can",
       [](Builder& b) {
         return b.finish(b.meet({b.round('z', 0, 0, 1), b.slab(-0.7, 0.7), b.without(b.ball(0.8, 0, 0.7, 0.6))}), 1.2);
       }},
      {"snowman",
       [](Builder& b) {
         return b.finish(b.join({b.ball(0, 0, -0.4, 1), b.ball(0.1, 0, 0.8, 0.6)}), 1.6);
       }},
      {"lamp",
       [](Builder& b) {
         return b.finish(b.join({b.ball(0, 0, 1.1, 0.5), b.meet({b.round('z', 0, 0, 0.8), b.slab(-0.8, 0.8)})}), 1.8);
       }},
      {"hat",
       [](Builder& b) {
         return b.finish(b.meet({b.cone(1.2, 0.8, true), b.plane(0, 0, -1, 0.3)}), 1.5);
       }},
      {"spindle",
       [](Builder& b) {
         return b.finish(b.meet({b.cone(1, 0.7, true), b.cone(-1.3, 0.7, false)}), 1.5);
       }},
      {"bucket",
       [](Builder& b) {
         return b.finish(b.meet({b.cone(2.5, 0.5, true), b.slab(-0.8, 0.9)}), 1.8);
       }},
      {"cornet",
       [](Builder& b) {
         return b.finish(b.join({b.ball(0, 0, 0.3, 0.9), b.meet({b.cone(-1.8, 0.4, false), b.plane(0, 0, 1, 0.3)})}),
                         2);
       }},
      {"bicylinder",
       [](Builder& b) {
         return b.finish(b.meet({b.round('x', 0, 0, 1), b.round('y', 0, 0, 1)}), 1.2);
       }},
      {"tricylinder",
       [](Builder& b) {
         return b.finish(b.meet({b.round('x', 0, 0, 1), b.round('y', 0, 0, 1), b.round('z', 0, 0, 1)}), 1.2);
       }},
      {"tee",
       [](Builder& b) {
         return b.finish(b.join({b.meet({b.round('x', 0, 0, 0.6), b.plane(1, 0, 0, 1.5), b.plane(-1, 0, 0, 1.5)}),
                                 b.meet({b.round('z', 0.1, 0, 0.4), b.slab(0, 1.3)})}),
                         1.7);
       }},
  };
  return all;
}

// --- The graph -------------------------------------------------------------------------------------------------------

struct Node {
  Point x;
  std::uint64_t on = 0;  // bit i: on primitive i
};

struct Step {
  int to;
  int primitive;
  int winding;
  double length;
};

/// A way: points, and between two of them a geodesic of a primitive.
struct Way {
  std::vector<Node> nodes;
  std::vector<std::pair<int, int>> by;  // primitive, winding
};

class Judge {
 public:
  explicit Judge(const Shape& shape) : shape_(shape) {
    sample_edges();
    steps_.resize(nodes_.size());
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        for (const Step& step : steps_between(nodes_[i], nodes_[j], static_cast<int>(j))) {
          steps_[i].push_back(step);
          Step back = step;
          back.to = static_cast<int>(i);
          if (back.winding > 0 && shape_.primitives[static_cast<std::size_t>(step.primitive)].kind != Kind::sphere) {
            back.winding = 3 - back.winding;
          }
          steps_[j].push_back(back);
        }
      }
    }
  }

  [[nodiscard]] Node node_at(const Point& x) const {
    Node node{x, 0};
    for (std::size_t i = 0; i < shape_.primitives.size(); ++i) {
      if (std::abs(shape_.primitives[i].value(x)) < 1e-8) node.on |= std::uint64_t{1} << i;
    }
    return node;
  }

  /// The length of the shortest way found that is seen to stay on the body; infinite where there is none.
  [[nodiscard]] double operator()(const Point& from, const Point& to) const {
    const Node p = node_at(from);
    const Node q = node_at(to);
    double best = kFar;
    for (const Step& step : steps_between(p, q, -1)) {
      if (stays(curve(p, q, step.primitive, step.winding))) best = std::min(best, step.length);
    }
    std::vector<std::vector<Step>> first(2);  // from an end to nodes
    const std::vector<const Node*> ends = {&p, &q};
    std::vector<std::vector<double>> length(2, std::vector<double>(nodes_.size(), kFar));
    std::vector<std::vector<std::pair<int, Step>>> before(
        2, std::vector<std::pair<int, Step>>(nodes_.size(), {-1, Step{}}));
    for (std::size_t end = 0; end < 2; ++end) {
      using Entry = std::pair<double, int>;
      std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
      const auto reach = [&](int node, double d, int from_node, const Step& step) {
        if (d >= length[end][static_cast<std::size_t>(node)]) return;
        length[end][static_cast<std::size_t>(node)] = d;
        before[end][static_cast<std::size_t>(node)] = {from_node, step};
        front.emplace(d, node);
      };
      for (std::size_t j = 0; j < nodes_.size(); ++j) {
        for (const Step& step : steps_between(*ends[end], nodes_[j], static_cast<int>(j))) {
          reach(static_cast<int>(j), step.length, -1, step);
        }
      }
      while (!front.empty()) {
        const auto [d, node] = front.top();
        front.pop();
        if (d > length[end][static_cast<std::size_t>(node)]) continue;
        for (const Step& step : steps_[static_cast<std::size_t>(node)]) reach(step.to, d + step.length, node, step);
      }
    }
    std::vector<std::pair<double, int>> through;
    for (std::size_t j = 0; j < nodes_.size(); ++j) {
      const double total = length[0][j] + length[1][j];
      if (total < kFar) through.emplace_back(total, static_cast<int>(j));
    }
    std::sort(through.begin(), through.end());
    std::set<std::vector<int>> rows;
    for (const auto& [total, node] : through) {
      if (total > (1 + kAlike) * std::min(best, through.front().first) || rows.size() >= kMostRows) break;
      Way way = way_through(p, q, node, before);
      std::vector<int> row;
      for (std::size_t i = 0; i < way.by.size(); ++i) {
        row.push_back(way.by[i].first * kWindings + way.by[i].second);
        row.push_back(static_cast<int>(way.nodes[i + 1].on & 0xffff));
      }
      if (!rows.insert(row).second) continue;
      best = std::min(best, refine(std::move(way)));
    }
    return best;
  }

 private:
  [[nodiscard]] Curve curve(const Node& a, const Node& b, int primitive, int winding) const {
    return geodesic(shape_.primitives[static_cast<std::size_t>(primitive)], a.x, b.x, winding);
  }
  /// At kLooks points alone.
  [[nodiscard]] bool seems_to_stay(const Curve& along) const {
    if (!(along.length < kFar)) return false;
    for (int i = 1; i < kLooks; ++i) {
      if (!shape_.holds(along.at(static_cast<double>(i) / kLooks))) return false;
    }
    return true;
  }
  /// Cut where another primitive crosses it or comes near; each part is on the body if its middle is.
  [[nodiscard]] bool stays(const Curve& along) const {
    if (!seems_to_stay(along)) return false;
    std::vector<double> cuts = {0, 1};
    const double pitch = 1.0 / kLooks;
    for (const Primitive& s : shape_.primitives) {
      const auto f = [&](double t) { return s.value(along.at(t)); };
      const auto cut = [&](double low, double high) {  // between two signs
        const bool rises = f(low) < 0;
        for (int i = 0; i < 40; ++i) {
          const double middle = (low + high) / 2;
          (((f(middle) < 0) == rises) ? low : high) = middle;
        }
        cuts.push_back(low);
      };
      std::array<double, kLooks + 1> v;
      for (std::size_t i = 0; i <= kLooks; ++i) v[i] = f(pitch * static_cast<double>(i));
      for (std::size_t i = 1; i <= kLooks; ++i) {
        const double here = pitch * static_cast<double>(i);
        if ((v[i - 1] < 0) != (v[i] < 0)) cut(here - pitch, here);
      }
      for (std::size_t i = 0; i <= kLooks; ++i) {
        // A primitive's value is a distance: it cannot vanish within a pitch of one that is larger.
        if (std::abs(v[i]) > 2 * pitch * along.length) continue;
        const double sign = v[i == 0 ? 1 : i - 1] < 0 ? -1 : 1;
        const double first = i == 0 ? 0 : pitch * static_cast<double>(i - 1);
        const double last = i == kLooks ? 1 : pitch * static_cast<double>(i + 1);
        double low = first;
        double high = last;
        for (int k = 0; k < 24; ++k) {  // by golden section to where it is nearest, or beyond
          const double one = low + 0.382 * (high - low);
          const double two = high - 0.382 * (high - low);
          if (sign * f(one) < sign * f(two)) {
            high = two;
          } else {
            low = one;
          }
        }
        const double nearest = (low + high) / 2;
        cuts.push_back(nearest);
        if (sign * f(nearest) >= 0) continue;
        if (sign * f(first) > 0) cut(first, nearest);
        if (sign * f(last) > 0) cut(nearest, last);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if (!shape_.holds(along.at((cuts[i - 1] + cuts[i]) / 2))) return false;
    }
    return true;
  }
  [[nodiscard]] std::vector<Step> steps_between(const Node& a, const Node& b, int to) const {
    std::vector<Step> found;
    for (std::uint64_t both = a.on & b.on; both != 0; both &= both - 1) {
      const int primitive = std::countr_zero(both);
      for (int winding = 0; winding < kWindings; ++winding) {
        const Curve along = curve(a, b, primitive, winding);
        if (seems_to_stay(along)) found.push_back({to, primitive, winding, along.length});
      }
    }
    return found;
  }

  /// To where all these primitives vanish, by Gauss and Newton.
  [[nodiscard]] std::optional<Point> project(Point x, const std::vector<int>& primitives) const {
    for (int step = 0; step < 60; ++step) {
      Eigen::MatrixXd j(primitives.size(), 3);
      Eigen::VectorXd f(primitives.size());
      for (std::size_t i = 0; i < primitives.size(); ++i) {
        const Primitive& s = shape_.primitives[static_cast<std::size_t>(primitives[i])];
        j.row(static_cast<Eigen::Index>(i)) = s.gradient(x).transpose();
        f(static_cast<Eigen::Index>(i)) = s.value(x);
      }
      if (!j.allFinite()) return std::nullopt;
      const Point move = j.completeOrthogonalDecomposition().solve(f);
      x -= move;
      if (!(x.norm() < 100)) return std::nullopt;
      if (f.norm() < 1e-14 || (step > 6 && f.norm() < 1e-13)) return x;
      if (move.norm() < 1e-9 && f.norm() > 1e-6) return std::nullopt;  // they do not meet
    }
    return std::nullopt;
  }

  void sample_edges() {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> side(-shape_.reach, shape_.reach);
    const int n = static_cast<int>(shape_.primitives.size());
    std::vector<Node> found;
    const auto keep = [&](const std::optional<Point>& x) {
      if (x && x->cwiseAbs().maxCoeff() < 1.5 * shape_.reach && shape_.holds(*x)) found.push_back(node_at(*x));
    };
    std::vector<Node> corners;
    for (int i = 0; i < n; ++i) {
      const Primitive& s = shape_.primitives[static_cast<std::size_t>(i)];
      if (s.kind == Kind::cone) keep(s.c);
      for (int j = 0; j < i; ++j) {
        for (int k = 0; k < j; ++k) {
          for (int t = 0; t < 24; ++t) keep(project({side(random), side(random), side(random)}, {i, j, k}));
        }
      }
    }
    std::swap(found, corners);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        for (int t = 0; t < 2000; ++t) keep(project({side(random), side(random), side(random)}, {i, j}));
      }
    }
    // As far apart as makes about kNodes of them.
    for (double apart = 0.02 * shape_.reach;; apart *= 1.15) {
      nodes_.clear();
      const auto add = [&](const Node& node, double least) {
        for (const Node& other : nodes_) {
          if ((other.x - node.x).norm() < least) return;
        }
        nodes_.push_back(node);
      };
      for (const Node& node : corners) add(node, 1e-6);
      for (const Node& node : found) {
        add(node, apart);
        if (nodes_.size() > 2 * kNodes) break;
      }
      if (nodes_.size() <= kNodes) break;
    }
  }

  [[nodiscard]] Way way_through(const Node& p, const Node& q, int node,
                                const std::vector<std::vector<std::pair<int, Step>>>& before) const {
    Way way;
    for (int at = node; at >= 0; at = before[0][static_cast<std::size_t>(at)].first) {
      way.nodes.push_back(nodes_[static_cast<std::size_t>(at)]);
      const Step& step = before[0][static_cast<std::size_t>(at)].second;
      way.by.emplace_back(step.primitive, step.winding);
    }
    way.nodes.push_back(p);
    std::reverse(way.nodes.begin(), way.nodes.end());
    std::reverse(way.by.begin(), way.by.end());
    for (int at = node; at >= 0; at = before[1][static_cast<std::size_t>(at)].first) {
      const auto& [next, step] = before[1][static_cast<std::size_t>(at)];
      way.nodes.push_back(next >= 0 ? nodes_[static_cast<std::size_t>(next)] : q);
      int winding = step.winding;  // of the step the other way round
      if (winding > 0 && shape_.primitives[static_cast<std::size_t>(step.primitive)].kind != Kind::sphere) {
        winding = 3 - winding;
      }
      way.by.emplace_back(step.primitive, winding);
    }
    return way;
  }

  [[nodiscard]] double length_of(const Way& way) const {
    double sum = 0;
    for (std::size_t i = 0; i < way.by.size(); ++i) {
      sum += curve(way.nodes[i], way.nodes[i + 1], way.by[i].first, way.by[i].second).length;
    }
    return sum;
  }

  /// Leaves out points that a single geodesic passes by, then slides the others along their edges in turns. Infinite
  /// where that leads off the body.
  [[nodiscard]] double refine(Way way) const {
    for (bool fewer = true; fewer;) {
      fewer = false;
      for (std::size_t i = 1; i + 1 < way.nodes.size() && !fewer; ++i) {
        const double with = curve(way.nodes[i - 1], way.nodes[i], way.by[i - 1].first, way.by[i - 1].second).length +
                            curve(way.nodes[i], way.nodes[i + 1], way.by[i].first, way.by[i].second).length;
        for (const Step& step : steps_between(way.nodes[i - 1], way.nodes[i + 1], -1)) {
          if (step.length > with + 1e-14) continue;
          way.nodes.erase(way.nodes.begin() + static_cast<std::ptrdiff_t>(i));
          way.by.erase(way.by.begin() + static_cast<std::ptrdiff_t>(i));
          way.by[i - 1] = {step.primitive, step.winding};
          fewer = true;
          break;
        }
      }
    }
    for (std::size_t i = 0; i < way.by.size(); ++i) {
      if (!stays(curve(way.nodes[i], way.nodes[i + 1], way.by[i].first, way.by[i].second))) return kFar;
    }
    std::vector<double> steps(way.nodes.size(), 0.02 * shape_.reach);
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double longest = 0;
      for (std::size_t i = 1; i + 1 < way.nodes.size(); ++i) longest = std::max(longest, slide(way, i, steps[i]));
      if (longest < kShortest * shape_.reach) break;
    }
    return length_of(way);
  }

  /// Moves a crossing along its edge where that makes the way shorter, by about `step`, which follows what succeeds.
  /// Returns the step it goes on with; 0 at a corner.
  double slide(Way& way, std::size_t i, double& step) const {
    std::vector<int> edge;
    for (std::uint64_t on = way.nodes[i].on; on != 0; on &= on - 1) edge.push_back(std::countr_zero(on));
    if (edge.size() != 2 || step < kShortest * shape_.reach) return 0;
    const Node& here = way.nodes[i];
    const auto surface = [&](std::size_t e) -> const Primitive& {
      return shape_.primitives[static_cast<std::size_t>(edge[e])];
    };
    const Point along = surface(0).gradient(here.x).cross(surface(1).gradient(here.x)).normalized();
    if (!along.allFinite()) return 0;
    const auto before = [&](const Node& node) {
      return curve(way.nodes[i - 1], node, way.by[i - 1].first, way.by[i - 1].second);
    };
    const auto after = [&](const Node& node) {
      return curve(node, way.nodes[i + 1], way.by[i].first, way.by[i].second);
    };
    const auto length_at = [&](const std::optional<Node>& node) {
      return node ? before(*node).length + after(*node).length : kFar;
    };
    const auto moved = [&](double by) -> std::optional<Node> {
      const std::optional<Point> x = project(here.x + by * along, edge);
      if (!x || !shape_.holds(*x)) return std::nullopt;
      return Node{*x, here.on};
    };
    const double now = length_at(here);
    const std::optional<Node> left = moved(-step);
    const std::optional<Node> right = moved(step);
    const double down = length_at(left);
    const double up = length_at(right);
    std::vector<std::pair<double, std::optional<Node>>> tries = {{-step, left}, {step, right}};
    if (down > up) std::swap(tries[0], tries[1]);
    if (down < kFar && up < kFar && down + up > 2 * now) {
      const double by = std::clamp(0.5 * step * (down - up) / (down + up - 2 * now), -step, step);
      tries.insert(tries.begin(), {by, moved(by)});
    }
    for (const auto& [by, node] : tries) {
      // Round a rim a way gets shorter still where it cuts through.
      if (!(length_at(node) < now) || !stays(before(*node)) || !stays(after(*node))) continue;
      way.nodes[i] = *node;
      step = std::clamp(2 * std::abs(by), 0.25 * step, 1.5 * step);
      return step;
    }
    step *= 0.25;
    return step;
  }

  const Shape& shape_;
  std::vector<Node> nodes_;
  std::vector<std::vector<Step>> steps_;
};

void print_pairs(const Shape& shape, int count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> side(-shape.reach, shape.reach);
  // Where random chords leave the body: every face by its area, about.
  const auto draw = [&] {
    for (;;) {
      Point a(side(random), side(random), side(random));
      Point b(side(random), side(random), side(random));
      if (!(shape.value(shape.body, a) < 0) || !(shape.value(shape.body, b) > 0)) continue;
      for (int i = 0; i < 100; ++i) {
        const Point middle = (a + b) / 2;
        (shape.value(shape.body, middle) < 0 ? a : b) = middle;
      }
      return a;
    }
  };
  for (int i = 0; i < count; ++i) {
    const Point p = draw();
    const Point q = draw();
    std::printf("%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", p.x(), p.y(), p.z(), q.x(), q.y(), q.z());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    for (const auto& [name, make] : shapes()) std::printf("%s\n", name.c_str());
    return argc == 1 ? 0 : 2;
  }
  const auto made = shapes().find(argv[1]);
  if (made == shapes().end()) {
    std::fprintf(stderr, "judge_faces: no shape '%s'\n", argv[1]);
    return 2;
  }
  Builder builder;
  const Shape shape = made->second(builder);
  const std::string what = argv[2];
  if (what == "--formula") {
    std::printf("%s\n", shape.formula.c_str());
  } else if (what == "--pairs" && argc == 5) {
    print_pairs(shape, std::atoi(argv[3]), std::strtoull(argv[4], nullptr, 10));
  } else if (what == "--judge" && argc == 4) {
    const Judge judge(shape);
    std::ifstream file(argv[3]);
    for (std::string line; std::getline(file, line);) {
      std::replace(line.begin(), line.end(), ',', ' ');
      std::istringstream numbers(line);
      Point p;
      Point q;
      numbers >> p.x() >> p.y() >> p.z() >> q.x() >> q.y() >> q.z();
      std::printf("%.15g\n", judge(p, q));
    }
  } else {
    std::fprintf(stderr, "judge_faces: cannot read the command\n");
    return 2;
  }
  return 0;
}
