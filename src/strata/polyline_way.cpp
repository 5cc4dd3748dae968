// The row of faces under a polyline. Neighbours that share a face are joined on it, if it goes there; between others
// the edge that parts them is found by Newton's method, and where none does, a point over their middle.
#include "strata/polyline_way.hpp"

#include <algorithm>
#include <vector>

#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

/// A step on one face is no longer than this part of the model, so that it says which way round it goes.
constexpr double kStep = 1.0 / 24;
/// The edge between two points is no farther from their middle than this, of their distance.
constexpr double kFarEdge = 1.5;
constexpr int kMostHalvings = 30;
/// Halves looked at between two given points: steps of 1 / 24 across a whole model and back are some hundred.
constexpr int kMostHalves = 4096;
/// Conditions that vanish within this, of the model, meet in one point.
constexpr double kAround = 1e-8;
/// The foot of a given point is no farther than this part of the model, and that of the middle between two points of
/// the surface no farther than the second: of their distance on one face, else of the model.
constexpr double kFarFoot = 0.1;
constexpr double kFarMiddle = 0.5;

class PolylineWay {
 public:
  explicit PolylineWay(FacetedSurface& surface) : s_(surface) {}

  [[nodiscard]] std::optional<FacetWay> run(const Points& polyline) {
    for (Index j = 0; j < polyline.cols(); ++j) {
      const std::optional<Node> node = foot(polyline.col(j), kFarFoot);
      if (!node) return std::nullopt;
      halves_left_ = kMostHalves;
      if (j == 0) {
        add(*node);
      } else if (!connect(last_, *node, 0)) {
        return std::nullopt;
      }
    }
    return way_;
  }

 private:
  struct Node {
    Point3 x;
    std::vector<int> faces;
    int edge = -1;
    bool corner = false;
  };

  /// All that meets at a surface point.
  [[nodiscard]] std::optional<Node> node_at(const Point3& x) {
    const std::optional<Star> star = s_.star(x, kAround * s_.scale);
    if (!star || star->wedges.empty()) return std::nullopt;
    Node node{x, {}};
    for (const Wedge& wedge : star->wedges) node.faces.push_back(wedge.face);
    const std::size_t n = star->wedges.size();
    node.corner = n > 2 || (n == 2 && !star->closed);
    if (!node.corner && n == 2) node.edge = star->wedges.front().second_edge;
    return node;
  }

  /// The face at the foot may be another one than that at the point: then the foot is on it.
  [[nodiscard]] std::optional<Node> foot(const Point3& at, double farthest) {
    Point3 x = at;
    for (int round = 0; round < 3; ++round) {
      const int face = s_.face_at(x);
      Point3 to = x;
      if (!s_.project(face, {}, to) || (to - at).norm() > farthest * s_.scale) return std::nullopt;
      x = to;
      if (s_.violation(face, x) <= ChainTolerances::on_edge * s_.scale) return node_at(x);
    }
    return std::nullopt;
  }

  [[nodiscard]] static int common_face(const Node& a, const Node& b) {
    for (const int face : a.faces) {
      if (std::find(b.faces.begin(), b.faces.end(), face) != b.faces.end()) return face;
    }
    return -1;
  }

  void add(const Node& node) {
    way_.points.push_back(node.x);
    way_.edge.push_back(node.edge);
    way_.corner.push_back(node.corner);
    last_ = node;
  }

  void step_to(const Node& node, int face) {
    way_.length += (node.x - last_.x).norm();
    way_.faces.push_back({face});
    add(node);
  }

  [[nodiscard]] bool connect(const Node& a, const Node& b, int halvings) {
    const double apart = (b.x - a.x).norm();
    const int face = common_face(a, b);
    if (face >= 0 && apart <= kStep * s_.scale) {
      step_to(b, face);
      return true;
    }
    if (halvings >= kMostHalvings || --halves_left_ < 0) return false;
    const Point3 middle = (a.x + b.x) / 2;
    if (face >= 0) {
      Point3 x = middle;
      if (s_.project(face, {}, x) && (x - middle).norm() <= kFarMiddle * apart &&
          s_.violation(face, x) <= ChainTolerances::on_edge * s_.scale) {
        const std::optional<Node> between = node_at(x);
        return between && connect(a, *between, halvings + 1) && connect(last_, b, halvings + 1);
      }
    } else {
      // The edge beyond which b lies, seen from a.
      for (const int from : a.faces) {
        int condition = -1;
        if (!(s_.violation(from, b.x, &condition) > 0) || condition < 0) continue;
        Point3 x = middle;
        if (!s_.project(from, {condition}, x) || (x - middle).norm() > kFarEdge * apart) continue;
        const std::optional<Node> edge = node_at(x);
        if (!edge || common_face(a, *edge) < 0 || common_face(*edge, b) < 0) continue;
        return connect(a, *edge, halvings + 1) && connect(last_, b, halvings + 1);
      }
    }
    const std::optional<Node> between = foot(middle, kFarMiddle);
    return between && connect(a, *between, halvings + 1) && connect(last_, b, halvings + 1);
  }

  FacetedSurface& s_;
  FacetWay way_;
  Node last_;
  int halves_left_ = 0;
};

}  // namespace

std::optional<FacetWay> way_along_polyline(FacetedSurface& surface, const Points& polyline) {
  return PolylineWay(surface).run(polyline);
}

}  // namespace taut::detail
