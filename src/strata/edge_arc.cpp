// The arc of a chain along an edge: pieces between points of it, each a graph over its chord. The length of a piece is
// the integral of 1 / |t . e| over the chord (t the edge's tangent, e the chord's direction) by Gauss's rule with eight
// points. Those points also tell the integrand's Legendre coefficients, whose decay says how good the rule is: where
// the last two are not small, the piece is halved.
#include "strata/edge_arc.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "curve/polyline.hpp"
#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

constexpr int kPoints = 8;
/// Abscissae on [-1, 1] and weights, from one end to the other.
constexpr std::array<double, kPoints> kNode = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290,
                                               -0.1834346424956498, 0.1834346424956498,  0.5255324099163290,
                                               0.7966664774136267,  0.9602898564975363};
constexpr std::array<double, kPoints> kWeight = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873,
                                                 0.3626837833783620, 0.3626837833783620, 0.3137066458778873,
                                                 0.2223810344533745, 0.1012285362903763};
/// Coefficients fall like r^-n, and the rule's error like r^-16: where those of degree 6 and 7 are below this, that is
/// rounding.
constexpr double kResolved = 2e-6;
/// A piece turns from its chord by no more than an angle with this cosine, and strays from it by this part.
constexpr double kStraight = 0.9;
constexpr double kStray = 0.2;
/// Marks in line with their neighbours, cosine, are left out: the fewer pieces.
constexpr double kInLine = 0.99;
/// A mark lies ahead of an end of the arc, cosine.
constexpr double kAhead = 0.02;
/// Halvings of one arc.
constexpr int kBudget = 400;
constexpr int kMostSteps = 12;
constexpr double kRounding = 1e-14;
/// Points that move by no more than this, of the model's size, are found. Where rounding is larger the steps run out.
constexpr double kSettled = 1e-15;

double legendre(int degree, double x) {
  double before = 1;
  double value = x;
  for (int n = 1; n < degree; ++n) before = std::exchange(value, ((2 * n + 1) * x * value - n * before) / (n + 1));
  return value;
}

class EdgeTracer {
 public:
  EdgeTracer(FacetedSurface& surface, int edge) : s_(surface), edge_(edge) {}

  /// Points of the edge from a to b: those of `guide` between them, thinned out.
  [[nodiscard]] std::vector<Point3> marks(const Points& guide, const Point3& a, const Point3& b) {
    std::vector<Point3> all{a};
    const Index count = guide.cols();
    if (count > 1) {
      const Point3 ta = towards(a, Point3(guide.col(1) - guide.col(0)));
      const Point3 tb = towards(b, Point3(guide.col(count - 1) - guide.col(count - 2)));
      const double together = ChainTolerances::together * s_.scale;
      for (Index i = 0; i < count; ++i) {
        const Point3 x = guide.col(i);
        // Those that an end has passed are left out.
        const bool ahead = i < count / 2 ? (x - a).dot(ta) > kAhead * (x - a).norm() + together
                                         : (b - x).dot(tb) > kAhead * (b - x).norm() + together;
        if (ahead) all.push_back(x);
      }
    }
    all.push_back(b);
    std::vector<Point3> kept{a};
    for (std::size_t i = 1; i + 1 < all.size(); ++i) {
      const Point3 ahead = (all[i + 1] - kept.back()).normalized();
      if (std::min(along(kept.back(), ahead), along(all[i + 1], ahead)) < kInLine) kept.push_back(all[i]);
    }
    kept.push_back(b);
    return kept;
  }

  /// The edge's tangent at x, on the side of v.
  [[nodiscard]] Point3 towards(const Point3& x, const Point3& v) {
    const Point3 t = s_.tangent(edge_, x);
    return t.dot(v) < 0 ? Point3(-t) : t;
  }

  /// From one point of the edge to another. False where it cannot be followed.
  [[nodiscard]] bool add(const Point3& from, const Point3& to) {
    std::vector<std::pair<Point3, Point3>> open{{from, to}};
    while (!open.empty()) {
      const auto [first, last] = open.back();
      open.pop_back();
      if ((last - first).norm() <= kRounding * s_.scale) continue;
      Point3 middle;
      const Piece piece = add_piece(first, last, middle);
      if (piece == Piece::added) continue;
      if (piece == Piece::lost || --budget_ < 0) return false;
      open.emplace_back(middle, last);
      open.emplace_back(first, middle);
    }
    return true;
  }

  [[nodiscard]] double length() const { return length_; }
  /// On the edge, without the first.
  [[nodiscard]] const std::vector<Point3>& line() const { return line_; }

 private:
  enum class Piece { added, halve, lost };

  [[nodiscard]] double along(const Point3& x, const Point3& e) { return std::abs(s_.tangent(edge_, x).dot(e)); }

  /// The points of the edge near those of x in the planes across e through those of `at`, and how fast the edge runs
  /// along e there.
  [[nodiscard]] bool cut(const Points& at, const Point3& e, Points& x, Vector& along) {
    const SharpEdge edge = s_.edge(edge_);
    Vector value_f;
    Vector value_c;
    Points f;
    Points c;
    along.resize(x.cols());
    for (int step = 0; step < kMostSteps; ++step) {
      s_.functions(edge.a, x, value_f, f);
      s_.conditions(edge.condition, x, value_c, c);
      double largest = 0;
      for (Index j = 0; j < x.cols(); ++j) {
        const Point3 a = f.col(j);
        const Point3 b = c.col(j);
        // Of the equations a . change = value_f, b . change = value_c, e . change = off.
        const Point3 across = a.cross(b);
        const double det = across.dot(e);
        const double off = (Point3(x.col(j)) - Point3(at.col(j))).dot(e);
        const Point3 change = (value_f(j) * b.cross(e) + value_c(j) * e.cross(a) + off * across) / det;
        if (!change.allFinite()) return false;
        x.col(j) -= change;
        along(j) = std::abs(det) / across.norm();
        largest = std::max(largest, change.norm());
      }
      if (largest <= kSettled * s_.scale) return true;
    }
    return true;
  }

  Piece add_piece(const Point3& from, const Point3& to, Point3& middle) {
    const double chord = (to - from).norm();
    const Point3 e = (to - from) / chord;
    const Point3 centre = (from + to) / 2;
    Vector rate;
    at_ = centre;
    x_ = centre;
    if (!cut(at_, e, x_, rate)) return Piece::lost;
    middle = x_.col(0);
    const Point3 bulge = middle - centre;
    if (bulge.norm() > kStray * chord) return Piece::halve;
    if (std::min({along(from, e), along(to, e), rate(0)}) < kStraight) return Piece::halve;
    at_.resize(3, kPoints);
    x_.resize(3, kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      const auto j = static_cast<Index>(i);
      at_.col(j) = centre + kNode[i] / 2 * (to - from);
      x_.col(j) = at_.col(j) + (1 - kNode[i] * kNode[i]) * bulge;
    }
    if (!cut(at_, e, x_, rate)) return Piece::lost;
    double mean = 0;
    double sixth = 0;
    double seventh = 0;
    for (std::size_t i = 0; i < kPoints; ++i) {
      const double speed = kWeight[i] / rate(static_cast<Index>(i));
      mean += speed / 2;
      sixth += speed * 6.5 * legendre(6, kNode[i]);
      seventh += speed * 7.5 * legendre(7, kNode[i]);
    }
    if (!(std::max(std::abs(sixth), std::abs(seventh)) <= kResolved * mean)) return Piece::halve;
    length_ += mean * chord;
    for (Index j = 0; j < kPoints; ++j) line_.emplace_back(x_.col(j));
    line_.push_back(to);
    return Piece::added;
  }

  FacetedSurface& s_;
  int edge_;
  double length_ = 0;
  std::vector<Point3> line_;
  Points at_;  // scratch of add_piece
  Points x_;
  int budget_ = kBudget;
};

}  // namespace

bool trace_edge_arc(FacetedSurface& surface, ChainArc& arc, const Point3& a, const Point3& b) {
  EdgeTracer tracer(surface, arc.edge);
  const std::vector<Point3> marks = tracer.marks(arc.start, a, b);
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    if (!tracer.add(marks[i], marks[i + 1])) return false;
  }
  arc.length = tracer.length();
  arc.error = kRounding * arc.length;
  std::vector<Point3> line = tracer.line();
  line.insert(line.begin(), a);
  if (line.size() < 2) line.push_back(b);
  const std::size_t m = line.size();
  arc.points.resize(3, static_cast<Index>(m));
  for (std::size_t i = 0; i < m; ++i) arc.points.col(static_cast<Index>(i)) = line[i];
  arc.first = tracer.towards(a, line[1] - a);
  arc.last = tracer.towards(b, b - line[m - 2]);
  return true;
}

}  // namespace taut::detail
