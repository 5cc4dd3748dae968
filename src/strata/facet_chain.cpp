// Broken geodesics on a surface made of faces.
//
//   T-, T+   unit tangents of the arcs before and after a stop
//   t, kappa tangent and curvature vector of the edge through it
//   L(s)     length of the chain, s_i the position of stop i along its edge
//
// Stationary chains: at a crossing the tangents agree along the edge, dL/ds = (T- - T+) . t = 0; where the path follows
// an edge it comes and leaves along it, T x t = 0; a corner has an angle of at least pi on either side.
// Second derivatives come from the Jacobi field j'' + K j = 0 of every arc: with a = t . N at the start and b at the
// end (N across the arc, in the face), reduced length m12 and M12,
//   L_aa = -T . kappa + a^2 M12 / m12,   L_bb = T . kappa + b^2 m12' / m12,   L_ab = -a b / m12,
// so Newton's method has the exact, tridiagonal Hessian.
#include "strata/facet_chain.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

using Kind = ChainStop::Kind;
constexpr double kPi = std::numbers::pi;
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Relative to the model: stops closer than this are one; conditions hold within it.
constexpr double kTogether = 1e-9;
constexpr double kOnEdge = 1e-9;
constexpr double kOffFace = 1e-8;  // an arc leaves its face where it is farther outside
/// A corner's angles may be short of pi by this, radians; tangents agree within this.
constexpr double kAngleSlack = 1e-7;
constexpr int kMostRounds = 60;
constexpr int kMostSteps = 60;
constexpr int kMostHalvings = 30;
/// A stop moves by at most this part of the longer of its arcs, even where the other is short.
constexpr double kBoldStep = 0.3;
/// Arcs traced for one chain, in all; chains that settle take 10 to 100.
constexpr int kMostTraced = 1000;
/// Crossings moved to the other side of their edge in one chain, before the path is made to follow the edge.
constexpr int kMostShifts = 4;

/// Unit tangent of the curve element an arc leaves its stop with.
Point3 across(const Point3& normal, const Point3& tangent) { return normal.cross(tangent); }

class Shortener {
 public:
  Shortener(FacetedSurface& surface, FacetChain& chain, const Context& context)
      : s_(surface), c_(chain), context_(context), together_(kTogether * surface.scale) {}

  void run();

 private:
  [[nodiscard]] Point3 normal(int face, const Point3& x) {
    Point3 f;
    (void)s_.function(face, x, f);
    return f.normalized();
  }
  [[nodiscard]] bool trace(ChainArc& arc, const Point3& a, const Point3& b);
  [[nodiscard]] bool trace_face(ChainArc& arc, const Point3& a, const Point3& b);
  [[nodiscard]] bool trace_edge(ChainArc& arc, const Point3& a, const Point3& b);
  [[nodiscard]] bool trace_all();
  [[nodiscard]] bool slide();
  [[nodiscard]] bool move_along(ChainStop& stop, double step, int& out, int& condition);
  [[nodiscard]] bool change(bool& changed);
  [[nodiscard]] bool drop_empty_arcs();
  [[nodiscard]] bool go_round(std::size_t i);
  [[nodiscard]] bool follow_edges();
  [[nodiscard]] bool stay_on_face(std::size_t i, bool& changed);
  [[nodiscard]] double pressed(int edge, const Point3& x);
  void erase_stop(std::size_t i, int face);
  [[nodiscard]] bool fail(std::string why) {
    c_.why = std::move(why);
    return false;
  }

  FacetedSurface& s_;
  FacetChain& c_;
  const Context& context_;
  double together_;
  std::vector<std::size_t> at_end_;  // stops that Newton's method drives beyond the end of their edge
  std::vector<int> end_condition_;
  double hessian_least_ = kFar;
  int num_traced_ = 0;
  int num_shifted_ = 0;
};

bool Shortener::trace(ChainArc& arc, const Point3& a, const Point3& b) {
  if (arc.done) return arc.ok;
  if (++num_traced_ > kMostTraced) return false;
  arc.done = true;
  arc.ok = arc.face >= 0 ? trace_face(arc, a, b) : trace_edge(arc, a, b);
  return arc.ok;
}

bool Shortener::trace_face(ChainArc& arc, const Point3& a, const Point3& b) {
  SmoothFace& face = s_.face(arc.face);
  if (!face.solver) face.solver.emplace(face.surface, NewtonOptions{.tolerance = 1e-13, .leave_saddles = false});
  if ((b - a).norm() <= together_) {
    arc.length = (b - a).norm();
    arc.first = arc.last = arc.length > 0 ? Point3((b - a).normalized()) : Point3::Zero();
    arc.points = chord(a, b);
    arc.m12 = std::max(arc.length, 1e-300);
    arc.m = arc.slope = 1;
    arc.shortest = true;
    return true;
  }
  // The curve it had, its ends moved.
  Points start = arc.start.cols() >= 2 ? arc.start : Points(chord(a, b));
  constexpr Index kMostStart = 24;
  if (start.cols() > kMostStart) start = at_equal_parts(start, kMostStart);
  const Point3 first = a - Point3(start.col(0));
  const Point3 last = b - Point3(start.col(start.cols() - 1));
  const auto parts = static_cast<double>(start.cols() - 1);
  for (Index i = 0; i < start.cols(); ++i) {
    const double u = static_cast<double>(i) / parts;
    start.col(i) += (1 - u) * first + u * last;
  }
  start.col(0) = a;
  start.col(start.cols() - 1) = b;
  NewtonResult found = face.solver->solve(start, context_);
  if (found.status != Status::ok || found.curve.num_elements() == 0) return false;
  arc.length = found.length;
  arc.error = found.length_error;
  arc.points = found.points;
  arc.start = found.points;
  const double period = found.curve.period();
  arc.first = Point3(found.curve.velocity(0)).normalized();
  arc.last = Point3(found.curve.velocity(period)).normalized();
  arc.shortest = found.locally_shortest;
  arc.residual = found.residual;
  arc.iterations = found.num_iterations;

  // j'' = -K j by Runge and Kutta; the end's slope and value to 1e-6 or so are all that Newton's method wants.
  constexpr int kSteps = 24;
  Vector t = Vector::LinSpaced(2 * kSteps + 1, 0, period);
  const Points x = found.curve.sample(t);
  Points value(1, x.cols());
  Points jacobian(3, x.cols());
  Points hessian(9, x.cols());
  const Points weight = Points::Ones(1, x.cols());
  jacobian.setZero();
  hessian.setZero();
  face.evaluator->evaluate({.n = x.cols(),
                            .x = x.data(),
                            .value = value.data(),
                            .jacobian = jacobian.data(),
                            .weight = weight.data(),
                            .hessian = hessian.data()});
  std::vector<double> curvature(static_cast<std::size_t>(x.cols()));
  for (Index i = 0; i < x.cols(); ++i) {
    const Point3 g = jacobian.col(i);
    const Eigen::Matrix3d h = Eigen::Map<const Eigen::Matrix3d>(hessian.col(i).data());
    Eigen::Matrix3d adjugate;
    adjugate.col(0) = Point3(h.row(1)).cross(Point3(h.row(2)));
    adjugate.col(1) = Point3(h.row(2)).cross(Point3(h.row(0)));
    adjugate.col(2) = Point3(h.row(0)).cross(Point3(h.row(1)));
    const double g2 = g.squaredNorm();
    curvature[static_cast<std::size_t>(i)] = g.dot(adjugate * g) / (g2 * g2);
  }
  Eigen::Vector2d field(0, 1);   // m12 and its slope
  Eigen::Vector2d field2(1, 0);  // M12
  const double h = arc.length / kSteps;
  const auto step = [&](Eigen::Vector2d& y, std::size_t i) {
    const auto slope = [&](const Eigen::Vector2d& v, double k) { return Eigen::Vector2d(v.y(), -k * v.x()); };
    const Eigen::Vector2d k1 = slope(y, curvature[i]);
    const Eigen::Vector2d k2 = slope(y + h / 2 * k1, curvature[i + 1]);
    const Eigen::Vector2d k3 = slope(y + h / 2 * k2, curvature[i + 1]);
    const Eigen::Vector2d k4 = slope(y + h * k3, curvature[i + 2]);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  };
  for (std::size_t i = 0; i < 2 * kSteps; i += 2) {
    step(field, i);
    step(field2, i);
  }
  arc.m12 = field.x();
  arc.slope = field.y();
  arc.m = field2.x();
  return std::isfinite(arc.m12) && std::isfinite(arc.m) && arc.m12 != 0;
}

/// Pieces of the edge between points of it, each a graph over its chord: the length by Gauss's rule.
bool Shortener::trace_edge(ChainArc& arc, const Point3& a, const Point3& b) {
  const SharpEdge edge = s_.edge(arc.edge);
  std::vector<Point3> marks{a};
  // Marks that the ends have passed are left out.
  const Points& start = arc.start;
  const Index count = start.cols();
  if (count > 1) {
    Point3 ta = s_.tangent(arc.edge, a);
    Point3 tb = s_.tangent(arc.edge, b);
    if (ta.dot(Point3(start.col(1) - start.col(0))) < 0) ta = -ta;
    if (tb.dot(Point3(start.col(count - 1) - start.col(count - 2))) < 0) tb = -tb;
    constexpr double kAhead = 0.02;  // cosine
    for (Index i = 0; i < count; ++i) {
      const Point3 x = start.col(i);
      const double from_a = (x - a).norm();
      const double from_b = (x - b).norm();
      if (i < count / 2 && (x - a).dot(ta) <= kAhead * from_a + together_) continue;
      if (i >= count / 2 && (b - x).dot(tb) <= kAhead * from_b + together_) continue;
      marks.push_back(x);
    }
  }
  marks.push_back(b);
  // Abscissae and weights of Gauss's rule with 8 points on [0, 1].
  static constexpr double kNode[4] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  static constexpr double kWeight[4] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  double length = 0;
  std::vector<Point3> line{a};
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    // Halved until the edge turns little.
    std::vector<std::pair<Point3, Point3>> open{{marks[i], marks[i + 1]}};
    int budget = 400;
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      const double chord_length = (to - from).norm();
      if (chord_length <= 1e-14 * s_.scale) continue;
      const Point3 e = (to - from) / chord_length;
      const double begin = std::abs(s_.tangent(arc.edge, from).dot(e));
      const double end = std::abs(s_.tangent(arc.edge, to).dot(e));
      Point3 middle = (from + to) / 2;
      const auto on_edge = [&](double u, Point3& x) {
        // The point of the edge in the plane across the chord at u.
        for (int step = 0; step < 30; ++step) {
          Point3 f;
          Point3 c;
          const double vf = s_.function(edge.a, x, f);
          const double vc = s_.condition(edge.condition, x, c);
          Eigen::Matrix3d j;
          j.row(0) = f.transpose() / f.norm();
          j.row(1) = c.transpose() / c.norm();
          j.row(2) = e.transpose();
          const Point3 r(vf / f.norm(), vc / c.norm(), (x - from).dot(e) - u * chord_length);
          const Point3 d = j.partialPivLu().solve(r);
          if (!d.allFinite()) return false;
          x -= d;
          if (d.norm() <= 1e-15 * s_.scale) return true;
        }
        return true;
      };
      if (!on_edge(0.5, middle)) return false;
      constexpr double kStraight = 0.995;  // cos of 6 degrees: eight points then reach rounding
      const double mid = std::abs(s_.tangent(arc.edge, middle).dot(e));
      if (std::min({begin, end, mid}) < kStraight || (middle - (from + to) / 2).norm() > 0.1 * chord_length) {
        if (--budget < 0) return false;
        open.emplace_back(middle, to);
        open.emplace_back(from, middle);
        continue;
      }
      double sum = 0;
      for (int g = 0; g < 8; ++g) {
        const double u = 0.5 + (g < 4 ? -0.5 : 0.5) * kNode[g % 4];
        Point3 x = from + u * (to - from) + 4 * u * (1 - u) * (middle - (from + to) / 2);
        if (!on_edge(u, x)) return false;
        sum += 0.5 * kWeight[g % 4] / std::abs(s_.tangent(arc.edge, x).dot(e));
      }
      length += sum * chord_length;
      line.push_back(middle);
      line.push_back(to);
    }
  }
  arc.length = length;
  arc.error = 1e-14 * length;
  arc.points.resize(3, static_cast<Index>(line.size()));
  for (std::size_t i = 0; i < line.size(); ++i) arc.points.col(static_cast<Index>(i)) = line[i];
  if (line.size() < 2) arc.points = chord(a, b);
  arc.first = s_.tangent(arc.edge, a);
  arc.last = s_.tangent(arc.edge, b);
  const Index m = arc.points.cols();
  if (arc.first.dot(Point3(arc.points.col(1) - arc.points.col(0))) < 0) arc.first = -arc.first;
  if (arc.last.dot(Point3(arc.points.col(m - 1) - arc.points.col(m - 2))) < 0) arc.last = -arc.last;
  return true;
}

bool Shortener::trace_all() {
  c_.length = 0;
  for (std::size_t i = 0; i < c_.arcs.size(); ++i) {
    if (!trace(c_.arcs[i], c_.stops[i].x, c_.stops[i + 1].x)) return false;
    c_.length += c_.arcs[i].length;
  }
  return std::isfinite(c_.length);
}

/// Newton's method for the positions of crossings and contacts. False where an arc cannot be traced.
bool Shortener::slide() {
  at_end_.clear();
  end_condition_.clear();
  hessian_least_ = kFar;
  std::vector<std::size_t> moving;
  bool contacts = false;
  for (std::size_t i = 0; i < c_.stops.size(); ++i) {
    if (c_.stops[i].kind == Kind::crossing || c_.stops[i].kind == Kind::contact) moving.push_back(i);
    contacts = contacts || c_.stops[i].kind == Kind::contact;
  }
  if (!trace_all()) return fail("a geodesic on one face was not found");
  if (moving.empty()) return true;
  const auto n = static_cast<Index>(moving.size());
  // Stops at the end of their edge: which way it ends (+1: along the tangent; 0: not at an end), and the condition
  // there.
  std::vector<int> outwards(static_cast<std::size_t>(n), 0);
  std::vector<int> ends_by(static_cast<std::size_t>(n), -1);
  int finished = 0;
  for (int round = 0; round < kMostSteps; ++round) {
    context_.check_cancelled();
    Vector g(n);
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
    double off = 0;
    for (Index i = 0; i < n; ++i) {
      const std::size_t at = moving[static_cast<std::size_t>(i)];
      const ChainStop& stop = c_.stops[at];
      const ChainArc& before = c_.arcs[at - 1];
      const ChainArc& after = c_.arcs[at];
      const Point3 t = s_.tangent(stop.edge, stop.x);
      const Point3 kappa = s_.curvature(stop.edge, stop.x);
      const auto coupled = [&](std::size_t other) -> Index {
        const auto found = std::find(moving.begin(), moving.end(), other);
        return found == moving.end() ? -1 : found - moving.begin();
      };
      if (stop.kind == Kind::crossing) {
        g(i) = (before.last - after.first).dot(t);
        const double b = t.dot(across(normal(before.face, stop.x), before.last));
        const double a = t.dot(across(normal(after.face, stop.x), after.first));
        h(i, i) = before.last.dot(kappa) + b * b * before.slope / before.m12 - after.first.dot(kappa) +
                  a * a * after.m / after.m12;
        if (const Index j = coupled(at - 1); j >= 0) {
          const ChainStop& other = c_.stops[at - 1];
          const double a0 = s_.tangent(other.edge, other.x).dot(across(normal(before.face, other.x), before.first));
          h(i, j) = -a0 * b / before.m12;
        }
        if (const Index j = coupled(at + 1); j >= 0) {
          const ChainStop& other = c_.stops[at + 1];
          const double b1 = s_.tangent(other.edge, other.x).dot(across(normal(after.face, other.x), after.last));
          h(i, j) = -a * b1 / after.m12;
        }
      } else {
        // The face arc's tangent must have no part across the edge.
        const bool arrives = before.face >= 0;
        const ChainArc& arc = arrives ? before : after;
        const Point3 tangent = arrives ? arc.last : arc.first;
        const Point3 face_normal = normal(arc.face, stop.x);
        const Point3 conormal = face_normal.cross(t);
        g(i) = tangent.dot(conormal);
        const Point3 side = across(face_normal, tangent);
        const double a = t.dot(side);
        // conormal' = normal' x t + normal x kappa; along a nearly parallel tangent only the part along t counts.
        const double turn = tangent.dot(face_normal.cross(kappa));
        const double slope = arrives ? a * arc.slope / arc.m12 : -a * arc.m / arc.m12;
        h(i, i) = slope * side.dot(conormal) + turn;
        const std::size_t next = arrives ? at - 1 : at + 1;
        if (const Index j = coupled(next); j >= 0) {
          const ChainStop& other = c_.stops[next];
          const Point3 there = arrives ? arc.first : arc.last;
          const double a1 = s_.tangent(other.edge, other.x).dot(across(normal(arc.face, other.x), there));
          h(i, j) = (arrives ? -a1 : a1) / arc.m12 * side.dot(conormal);
        }
      }
      off = std::max(off, std::abs(g(i)));
    }
    // Those that would leave their edge stay; the others move.
    const auto held = [&](Index i) {
      const int out = outwards[static_cast<std::size_t>(i)];
      return out != 0 && -g(i) * out > 0;
    };
    std::vector<Index> free;
    for (Index i = 0; i < n; ++i) {
      if (!held(i)) free.push_back(i);
    }
    const auto note_ends = [&] {
      for (Index i = 0; i < n; ++i) {
        if (!held(i)) continue;
        at_end_.push_back(moving[static_cast<std::size_t>(i)]);
        end_condition_.push_back(ends_by[static_cast<std::size_t>(i)]);
      }
    };
    off = 0;
    for (const Index i : free) off = std::max(off, std::abs(g(i)));
    Vector step = Vector::Zero(n);
    if (!free.empty()) {
      const Eigen::MatrixXd part_h = h(free, free);
      const Vector part_g = g(free);
      Vector part_step;
      if (!contacts) {
        const Eigen::MatrixXd symmetric = (part_h + part_h.transpose()) / 2;
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric);
        const double largest = eigen.eigenvalues().cwiseAbs().maxCoeff();
        hessian_least_ = eigen.eigenvalues()(0);
        Vector along = eigen.eigenvectors().transpose() * part_g;
        for (Index i = 0; i < along.size(); ++i) {
          along(i) = -along(i) / std::max(std::abs(eigen.eigenvalues()(i)), 1e-10 * largest + 1e-300);
        }
        part_step = eigen.eigenvectors() * along;
      } else {
        part_step = -part_h.fullPivLu().solve(part_g);
      }
      step(free) = part_step;
    }
    if (!step.allFinite()) return fail("the crossings of the edges are not determined");
    const double predicted = std::abs(g.dot(step)) / 2;
    if (finished > 0 || off <= 1e-13) {
      c_.error = predicted;
      note_ends();
      return true;
    }
    if (contacts && off <= 1e-9) finished = 1;
    if (!contacts && predicted <= 1e-15 * c_.length) finished = 1;
    // No farther than arcs are long: there the quadratic model ends.
    double part = 1;
    for (Index i = 0; i < n; ++i) {
      const std::size_t at = moving[static_cast<std::size_t>(i)];
      double room = std::min(c_.arcs[at - 1].length, c_.arcs[at].length);
      room = std::max(room, kBoldStep * std::max(c_.arcs[at - 1].length, c_.arcs[at].length));
      if (c_.stops[at].kind == Kind::contact) {
        room = kBoldStep * std::max(c_.arcs[at - 1].length, c_.arcs[at].length);
      }
      part = std::min(part, room / std::max(std::abs(step(i)), 1e-300));
    }
    const FacetChain before = c_;
    const std::vector<int> outwards_before = outwards;
    bool moved = false;
    for (int halving = 0; halving < kMostHalvings; ++halving, part /= 2) {
      c_ = before;
      outwards = outwards_before;
      bool possible = true;
      for (Index i = 0; i < n && possible; ++i) {
        if (step(i) == 0) continue;
        const std::size_t at = moving[static_cast<std::size_t>(i)];
        ChainStop& stop = c_.stops[at];
        int& out = outwards[static_cast<std::size_t>(i)];
        possible = move_along(stop, part * step(i), out, ends_by[static_cast<std::size_t>(i)]);
        c_.arcs[at - 1].done = false;
        c_.arcs[at].done = false;
      }
      if (!possible || !trace_all()) continue;
      if (!contacts && !(c_.length < before.length + 1e-15 * before.length)) continue;
      moved = true;
      break;
    }
    if (!moved) {
      c_ = before;
      outwards = outwards_before;
      if (off > 1e-6) return fail("the crossings of the edges do not settle");
      c_.error = predicted;
      note_ends();
      return true;
    }
    // An arc that has shrunk to nothing has no direction: it goes, before anything else is asked.
    if (std::any_of(c_.arcs.begin(), c_.arcs.end(), [&](const ChainArc& arc) { return arc.length <= together_; })) {
      return true;
    }
  }
  return fail("the crossings of the edges do not settle");
}

/// Moves a stop along its edge, at most to where that ends: `out` then says which way, `condition` what ends it.
bool Shortener::move_along(ChainStop& stop, double step, int& out, int& condition) {
  const SharpEdge edge = s_.edge(stop.edge);
  const Point3 from = stop.x;
  const auto beyond = [&](const Point3& x, int* which) {
    double most = s_.violation(edge.a, x, which);
    if (edge.b >= 0) {
      int other = -1;
      const double there = s_.violation(edge.b, x, &other);
      if (there > most) {
        most = there;
        *which = other;
      }
    }
    return most;
  };
  const double slack = kOnEdge * s_.scale;
  // Conditions alone do not tell where faces of one plane are joined (two bars with their tops level): there both hold
  // inside the face. The ring of faces does.
  const auto on_edge = [&](const Point3& x, int* which) {
    *which = -1;
    if (beyond(x, which) > slack) return false;
    const std::optional<Star> star = s_.star(x, slack);
    return star && std::any_of(star->wedges.begin(), star->wedges.end(), [&](const Wedge& wedge) {
             const auto same = [&](int e) { return e >= 0 && s_.edge(e).a == edge.a && s_.edge(e).b == edge.b; };
             return same(wedge.first_edge) || same(wedge.second_edge);
           });
  };
  out = 0;
  int which = -1;
  if (!s_.move(stop.edge, step, stop.x)) return false;
  if (on_edge(stop.x, &which)) return true;
  double good = 0;
  double bad = 1;
  Point3 last = from;
  constexpr int kBisections = 40;
  for (int k = 0; k < kBisections; ++k) {
    const double u = (good + bad) / 2;
    Point3 x = from;
    int c = -1;
    if (s_.move(stop.edge, u * step, x) && on_edge(x, &c)) {
      good = u;
      last = x;
    } else {
      bad = u;
      which = c;
    }
  }
  stop.x = last;
  out = step > 0 ? 1 : -1;
  condition = which;
  return true;
}

void Shortener::erase_stop(std::size_t i, int face) {
  ChainArc joined;
  joined.face = face;
  const Points& a = c_.arcs[i - 1].points;
  const Points& b = c_.arcs[i].points;
  joined.start.resize(3, a.cols() + b.cols() - 1);
  joined.start << a, b.rightCols(b.cols() - 1);
  if (joined.start.cols() > 2) joined.start = without_repeats(joined.start);
  c_.stops.erase(c_.stops.begin() + static_cast<std::ptrdiff_t>(i));
  c_.arcs.erase(c_.arcs.begin() + static_cast<std::ptrdiff_t>(i));
  c_.arcs[i - 1] = std::move(joined);
}

/// Arcs without length go: an end on an edge belongs to both faces; two stops in one place are a corner, or nothing.
bool Shortener::drop_empty_arcs() {
  bool changed = false;
  for (std::size_t i = 0; i < c_.arcs.size() && c_.arcs.size() > 1;) {
    if (c_.arcs[i].length > together_) {
      ++i;
      continue;
    }
    changed = true;
    ChainStop& a = c_.stops[i];
    ChainStop& b = c_.stops[i + 1];
    if (a.kind == Kind::end) {
      c_.stops.erase(c_.stops.begin() + 1);
      c_.arcs.erase(c_.arcs.begin());
      c_.arcs.front().done = false;
      continue;
    }
    if (b.kind == Kind::end) {
      c_.stops.erase(c_.stops.end() - 2);
      c_.arcs.pop_back();
      c_.arcs.back().done = false;
      continue;
    }
    // Of two stops the corner stays; two crossings of one edge are none; of different edges, they are a corner.
    const int before = c_.arcs[i - 1].face;
    const int after = c_.arcs[i + 1].face;
    if (a.kind != Kind::corner && b.kind != Kind::corner && a.edge == b.edge && before == after && before >= 0) {
      c_.stops.erase(c_.stops.begin() + static_cast<std::ptrdiff_t>(i));
      c_.arcs.erase(c_.arcs.begin() + static_cast<std::ptrdiff_t>(i));
      erase_stop(i, before);
      continue;
    }
    if (a.kind != Kind::corner) {
      if (b.kind != Kind::corner && a.edge != b.edge) b.kind = Kind::corner;
      c_.stops.erase(c_.stops.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      c_.stops.erase(c_.stops.begin() + static_cast<std::ptrdiff_t>(i + 1));
    }
    c_.arcs.erase(c_.arcs.begin() + static_cast<std::ptrdiff_t>(i));
    for (ChainArc& arc : c_.arcs) arc.done = false;
  }
  return changed;
}

/// Stop i is in a corner: leaves it on the side where there is room. True when it did.
bool Shortener::go_round(std::size_t i) {
  ChainStop& stop = c_.stops[i];
  const ChainArc before = c_.arcs[i - 1];
  const ChainArc after = c_.arcs[i];
  const std::optional<Star> found = s_.star(stop.x, 1e-8 * s_.scale);
  stop.left = stop.right = kFar;
  if (!found) return false;
  const Star& star = *found;
  const std::size_t n = star.wedges.size();
  // Where a direction lies: the wedge and the angle in it. Directions along rays are in both wedges.
  struct Place {
    std::size_t wedge = 0;
    double angle = 0;
    double off = kFar;
  };
  const auto locate = [&](const Point3& v, int face) {
    Place best;
    for (std::size_t w = 0; w < n; ++w) {
      const Wedge& wedge = star.wedges[w];
      if (face >= 0 && wedge.face != face) continue;
      double angle = 0;
      double beyond = 0;
      if (wedge.angle > 6.28) {
        angle = 0;
      } else {
        const Point3 across_first = wedge.normal.cross(wedge.first);
        angle = std::atan2(v.dot(across_first), v.dot(wedge.first));
        // Of an angle outside, the nearer end.
        if (angle < -1e-12) {
          const double over = angle + 2 * kPi - wedge.angle;
          if (over > 0 && over < -angle) {
            beyond = over;
            angle = wedge.angle;
          } else if (over > 0) {
            beyond = -angle;
            angle = 0;
          } else {
            angle += 2 * kPi;
          }
        } else if (angle > wedge.angle) {
          const double over = angle - wedge.angle;
          const double under = 2 * kPi - angle;
          beyond = std::min(over, under);
          angle = over <= under ? wedge.angle : 0;
        }
      }
      const double off = beyond + std::abs(v.dot(wedge.normal));
      if (off < best.off) best = {w, angle, off};
    }
    return best;
  };
  const Place back = locate(-before.last, before.face);
  const Place ahead = locate(after.first, after.face);
  if (back.off > 0.1 || ahead.off > 0.1) return false;
  struct Ray {
    double angle;  // from the start of the sweep
    int edge;
    int face_after;
  };
  // Sweeps counterclockwise from one place to the other.
  const auto sweep = [&](const Place& from, const Place& to, std::vector<Ray>& rays) {
    rays.clear();
    if (from.wedge == to.wedge && to.angle >= from.angle) return to.angle - from.angle;
    if (n == 1 && star.wedges.front().angle > 6.28) return kFar;
    double angle = star.wedges[from.wedge].angle - from.angle;
    std::size_t w = from.wedge;
    for (std::size_t k = 0; k < n; ++k) {
      if (w + 1 == n && !star.closed) return kFar;
      const int edge = star.wedges[w].second_edge;
      w = (w + 1) % n;
      rays.push_back({angle, edge, star.wedges[w].face});
      if (w == to.wedge) return angle + to.angle;
      angle += star.wedges[w].angle;
    }
    return kFar;
  };
  // Counterclockwise about the outer normal from the way ahead to the way back is the left side.
  std::vector<Ray> left;
  std::vector<Ray> right;
  stop.left = sweep(ahead, back, left);
  stop.right = sweep(back, ahead, right);
  const double least = std::min(stop.left, stop.right);
  if (!(least < kPi - kAngleSlack)) return false;
  std::vector<Ray> rays = stop.right <= stop.left ? right : left;
  const double whole = least;
  if (stop.left < stop.right) {
    // Seen from the way back.
    std::reverse(rays.begin(), rays.end());
    for (std::size_t k = 0; k < rays.size(); ++k) {
      rays[k].angle = whole - rays[k].angle;
    }
    // The face after a ray, going the other way, is the one before it.
    for (Ray& ray : rays) {
      const SharpEdge& edge = s_.edge(ray.edge);
      ray.face_after = ray.face_after == edge.a ? edge.b : edge.a;
    }
  }
  // Where the straight line of the unfolded faces crosses the rays.
  const double reach = std::min(before.length, after.length);
  const double p = std::max(reach, 0.5 * before.length);
  const double q = std::max(reach, 0.5 * after.length);
  std::vector<ChainStop> stops;
  std::vector<ChainArc> arcs;
  Point3 last = c_.stops[i - 1].x;
  int face = before.face >= 0 ? before.face : star.wedges[back.wedge].face;
  for (const Ray& ray : rays) {
    double r = p * q * std::sin(whole) / (p * std::sin(ray.angle) + q * std::sin(whole - ray.angle));
    if (!(r > 0)) r = 1e-3 * reach;
    // A ray in line with an end has nowhere to go: its crossing begins near the corner.
    r = std::min(r, 0.5 * reach);
    // The edge's direction away from the corner.
    Point3 away = s_.tangent(ray.edge, stop.x);
    for (const Wedge& wedge : star.wedges) {
      const Point3* direction = wedge.second_edge == ray.edge  ? &wedge.second
                                : wedge.first_edge == ray.edge ? &wedge.first
                                                               : nullptr;
      if (direction == nullptr) continue;
      if (away.dot(*direction) < 0) away = -away;
      break;
    }
    const double sign = s_.tangent(ray.edge, stop.x).dot(away) < 0 ? -1 : 1;
    ChainStop crossing;
    crossing.kind = Kind::crossing;
    crossing.edge = ray.edge;
    const SharpEdge edge = s_.edge(ray.edge);
    bool placed = false;
    for (int halving = 0; halving < 30 && !placed; ++halving, r /= 2) {
      crossing.x = stop.x;
      placed = s_.move(ray.edge, sign * r, crossing.x) && s_.violation(edge.a, crossing.x) <= kOnEdge * s_.scale &&
               (edge.b < 0 || s_.violation(edge.b, crossing.x) <= kOnEdge * s_.scale);
    }
    if (!placed) return false;
    ChainArc arc;
    arc.face = face;
    arc.start = chord(last, crossing.x);
    arcs.push_back(std::move(arc));
    last = crossing.x;
    face = ray.face_after;
    stops.push_back(crossing);
  }
  ChainArc arc;
  arc.face = face;
  arc.start = chord(last, c_.stops[i + 1].x);
  arcs.push_back(std::move(arc));
  // Long arcs begin from what they were.
  const auto blend = [&](ChainArc& to, const ChainArc& old) {
    if (to.face == old.face && old.points.cols() > 2) to.start = old.points;
  };
  if (arcs.size() > 1) {
    blend(arcs.front(), before);
    blend(arcs.back(), after);
  } else if (before.points.cols() > 1 && after.points.cols() > 1) {
    Points both(3, before.points.cols() + after.points.cols() - 1);
    both << before.points, after.points.rightCols(after.points.cols() - 1);
    arcs.front().start = without_repeats(both);
  }
  const auto at = static_cast<std::ptrdiff_t>(i);
  c_.stops.erase(c_.stops.begin() + at);
  c_.stops.insert(c_.stops.begin() + at, stops.begin(), stops.end());
  c_.arcs.erase(c_.arcs.begin() + at - 1, c_.arcs.begin() + at + 1);
  c_.arcs.insert(c_.arcs.begin() + at - 1, arcs.begin(), arcs.end());
  return true;
}

/// How much the length falls when a path along the edge is moved off it, the same on both sides: the geodesic
/// curvatures of the edge towards the faces; at most 0 where it is pressed against the edge. On a border the free
/// side's.
double Shortener::pressed(int e, const Point3& x) {
  const SharpEdge edge = s_.edge(e);
  const Point3 kappa = s_.curvature(e, x);
  double sum = 0;
  const std::optional<Star> star = s_.star(x, 1e-7 * s_.scale);
  if (!star) return kFar;
  for (const Wedge& wedge : star->wedges) {
    if (wedge.face != edge.a && wedge.face != edge.b) continue;
    const Point3 ray = wedge.first;
    Point3 inwards = wedge.normal.cross(ray);
    sum += kappa.dot(inwards);
  }
  return sum;
}

/// Makes arcs between two crossings of one edge that is pressed against arcs along it. False where there are none.
bool Shortener::follow_edges() {
  bool found = false;
  for (std::size_t i = 1; i + 1 < c_.arcs.size(); ++i) {
    ChainArc& arc = c_.arcs[i];
    ChainStop& a = c_.stops[i];
    ChainStop& b = c_.stops[i + 1];
    if (arc.face < 0 || a.kind != Kind::crossing || b.kind != Kind::crossing || a.edge != b.edge) continue;
    const SharpEdge edge = s_.edge(a.edge);
    std::vector<Point3> marks;
    for (Index j = 0; j < arc.points.cols(); ++j) {
      Point3 x = arc.points.col(j);
      if (s_.project(edge.a, {edge.condition}, x)) marks.push_back(x);
    }
    if (marks.size() < 2 || pressed(a.edge, marks[marks.size() / 2]) > 1e-9 / s_.scale) continue;
    ChainArc along;
    along.edge = a.edge;
    along.start.resize(3, static_cast<Index>(marks.size()));
    for (std::size_t k = 0; k < marks.size(); ++k) along.start.col(static_cast<Index>(k)) = marks[k];
    arc = std::move(along);
    a.kind = b.kind = Kind::contact;
    found = true;
  }
  return found;
}

/// Arc i may leave its face: over an edge, which it then crosses or follows. False where it is not known what to do.
bool Shortener::stay_on_face(std::size_t i, bool& changed) {
  ChainArc& arc = c_.arcs[i];
  if (arc.face < 0 || arc.length <= together_) return true;
  const Points line = at_equal_parts(arc.points, 64);
  Index first = -1;
  Index last = -1;
  double deepest = 0;
  const double slack = kOffFace * s_.scale;
  std::vector<int> condition(static_cast<std::size_t>(line.cols()), -1);
  for (Index j = 0; j < line.cols(); ++j) {
    Point3 x = line.col(j);
    // Points between the nodes of a polyline are off the surface: the foot counts.
    if (j > 0 && j + 1 < line.cols()) (void)s_.project(arc.face, {}, x);
    const double out = s_.violation(arc.face, x, &condition[static_cast<std::size_t>(j)]);
    if (out > slack) {
      if (first < 0) first = j;
      if (last < 0 || last == j - 1) {
        last = j;
        deepest = std::max(deepest, out);
      }
    }
  }
  if (first < 0) return true;
  if (!std::isfinite(deepest)) return fail("a path leaves its face where no edge is known");
  const int enter = condition[static_cast<std::size_t>(first)];
  const int leave = condition[static_cast<std::size_t>(last)];
  if (enter < 0 || leave < 0) return fail("a path leaves its face where no edge is known");
  const int face = arc.face;
  // The edges it passes beyond, in order: over the corners between them, which reach into the face.
  std::vector<std::pair<Index, int>> row;
  for (Index j = first; j <= last; ++j) {
    const int c = condition[static_cast<std::size_t>(j)];
    if (c >= 0 && (row.empty() || row.back().second != c)) row.emplace_back(j, c);
  }
  if (row.size() > 1) {
    std::vector<ChainStop> corners;
    for (std::size_t k = 1; k < row.size(); ++k) {
      ChainStop corner;
      corner.kind = Kind::corner;
      corner.x = line.col(row[k].first);
      if (!s_.project(face, {row[k - 1].second, row[k].second}, corner.x) ||
          s_.violation(face, corner.x) > kOnEdge * s_.scale) {
        return fail("a path leaves its face by two edges that meet in no corner");
      }
      corners.push_back(corner);
    }
    std::vector<ChainArc> arcs;
    Point3 from = c_.stops[i].x;
    for (std::size_t k = 0; k <= corners.size(); ++k) {
      const Point3 to = k < corners.size() ? corners[k].x : c_.stops[i + 1].x;
      ChainArc part;
      part.face = face;
      part.start = chord(from, to);
      arcs.push_back(std::move(part));
      from = to;
    }
    const auto at = static_cast<std::ptrdiff_t>(i);
    c_.stops.insert(c_.stops.begin() + at + 1, corners.begin(), corners.end());
    c_.arcs.erase(c_.arcs.begin() + at);
    c_.arcs.insert(c_.arcs.begin() + at, arcs.begin(), arcs.end());
    changed = true;
    return true;
  }
  // One edge, out and back.
  const auto foot = [&](Index j, Point3& x) {
    x = line.col(j);
    return s_.project(face, {enter}, x);
  };
  // Its points: where the way over the graph touched it, which tells the side; else where the arc passes beyond.
  std::vector<Point3> marks;
  int edge = -1;
  for (std::size_t k = 0; k < arc.guide.size(); ++k) {
    const int touched = arc.guide_edges[k];
    if (touched < 0 || s_.edge(touched).condition != enter) continue;
    if (s_.edge(touched).a != face && s_.edge(touched).b != face) continue;
    edge = touched;
    marks.push_back(arc.guide[k]);
  }
  if (marks.size() < 2) {
    marks.clear();
    for (Index j = std::max<Index>(first - 1, 0); j <= std::min(last + 1, line.cols() - 1); ++j) {
      Point3 x;
      if (foot(j, x)) marks.push_back(x);
    }
  }
  if (marks.size() < 2) return fail("a path leaves its face over an edge that was not found");
  const Point3 a = marks.front();
  const Point3 b = marks.back();
  const Point3 middle = marks[marks.size() / 2];
  if (edge < 0) {
    const std::optional<Star> star = s_.star(middle, 1e-8 * s_.scale);
    if (!star) return fail("a path leaves its face at a singular point");
    for (const Wedge& wedge : star->wedges) {
      if (wedge.face == face && wedge.second_edge >= 0) edge = wedge.second_edge;
    }
  }
  if (edge < 0) return fail("a path leaves its face where no edge is known");
  const SharpEdge over = s_.edge(edge);
  const int other = over.a == face ? over.b : over.a;
  const bool follows = other < 0 || pressed(edge, middle) <= 1e-9 / s_.scale;
  const auto at = static_cast<std::ptrdiff_t>(i);
  // Next to a crossing of the same edge, the path comes to the edge, or leaves it, on the face beyond.
  const auto crosses = [&](std::size_t stop) {
    return follows && c_.stops[stop].kind == Kind::crossing && c_.stops[stop].edge == edge;
  };
  const bool from_beyond = crosses(i);
  const bool to_beyond = crosses(i + 1);
  if ((from_beyond || to_beyond) && num_shifted_ < kMostShifts) {
    // The arc came from, or went to, the wrong side of the edge: the crossing belongs where the arc first meets it.
    ++num_shifted_;
    const std::size_t stop = to_beyond ? i + 1 : i;
    ChainArc& beyond = to_beyond ? c_.arcs[i + 1] : c_.arcs[i - 1];
    Points joined(3, static_cast<Index>(marks.size()) + beyond.points.cols());
    for (std::size_t k = 0; k < marks.size(); ++k) {
      joined.col(to_beyond ? static_cast<Index>(k) : beyond.points.cols() + static_cast<Index>(k)) = marks[k];
    }
    if (to_beyond) {
      joined.rightCols(beyond.points.cols()) = beyond.points;
    } else {
      joined.leftCols(beyond.points.cols()) = beyond.points;
    }
    beyond.start = without_repeats(joined);
    beyond.done = false;
    c_.stops[stop].x = to_beyond ? a : b;
    arc.start = to_beyond ? chord(c_.stops[i].x, a) : chord(b, c_.stops[i + 1].x);
    arc.done = false;
    changed = true;
    return true;
  }
  ChainStop one;
  one.edge = edge;
  one.x = a;
  ChainStop two = one;
  two.x = b;
  ChainArc before;
  before.face = face;
  before.start = chord(c_.stops[i].x, a);
  ChainArc between;
  ChainArc after;
  after.face = face;
  after.start = chord(b, c_.stops[i + 1].x);
  if (follows) {
    one.kind = two.kind = Kind::contact;
    between.edge = edge;
    between.start.resize(3, static_cast<Index>(marks.size()));
    for (std::size_t k = 0; k < marks.size(); ++k) between.start.col(static_cast<Index>(k)) = marks[k];
  } else {
    one.kind = two.kind = Kind::crossing;
    between.face = other;
    between.start = chord(a, b);
  }
  std::vector<ChainStop> stops;
  std::vector<ChainArc> arcs;
  if (from_beyond) {
    c_.stops[i].kind = Kind::contact;
  } else {
    stops.push_back(one);
    arcs.push_back(std::move(before));
  }
  arcs.push_back(std::move(between));
  if (to_beyond) {
    c_.stops[i + 1].kind = Kind::contact;
  } else {
    stops.push_back(two);
    arcs.push_back(std::move(after));
  }
  c_.stops.insert(c_.stops.begin() + at + 1, stops.begin(), stops.end());
  c_.arcs.erase(c_.arcs.begin() + at);
  c_.arcs.insert(c_.arcs.begin() + at, arcs.begin(), arcs.end());
  changed = true;
  return true;
}

/// Looks for what a settled chain breaks, and mends one thing.
bool Shortener::change(bool& changed) {
  changed = false;
  if (drop_empty_arcs()) {
    changed = true;
    return true;
  }
  if (!at_end_.empty()) {
    const std::size_t at = at_end_.front();
    ChainStop& stop = c_.stops[at];
    const SharpEdge edge = s_.edge(stop.edge);
    // The corner: with the condition that fails beyond it, or one of those of the edges that meet there.
    std::vector<int> others{end_condition_.front()};
    if (const std::optional<Star> star = s_.star(stop.x, 1e-7 * s_.scale)) {
      for (const Wedge& wedge : star->wedges) {
        others.push_back(wedge.first_condition);
        others.push_back(wedge.second_condition);
      }
    }
    for (const int other : others) {
      if (other < 0 || other == edge.condition) continue;
      Point3 x = stop.x;
      if (!s_.project(edge.a, {edge.condition, other}, x) || (x - stop.x).norm() > 1e-6 * s_.scale) continue;
      const std::optional<Star> star = s_.star(x, kOnEdge * s_.scale);
      if (!star || (star->closed && star->wedges.size() < 3)) continue;
      stop.x = x;
      stop.kind = Kind::corner;
      c_.arcs[at - 1].done = c_.arcs[at].done = false;
      changed = true;
      return true;
    }
    return fail("a path runs over the end of an edge where no corner was found");
  }
  for (std::size_t i = 1; i + 1 < c_.stops.size(); ++i) {
    if (c_.stops[i].kind == Kind::corner && go_round(i)) {
      changed = true;
      return true;
    }
  }
  // An arc along an edge that runs backwards is none.
  for (std::size_t i = 1; i + 1 < c_.arcs.size(); ++i) {
    if (c_.arcs[i].face >= 0) continue;
    if (c_.arcs[i - 1].face < 0 || c_.arcs[i + 1].face < 0) continue;
    const bool backwards =
        c_.arcs[i - 1].last.dot(c_.arcs[i].first) < 0 && c_.arcs[i + 1].first.dot(c_.arcs[i].last) < 0;
    if (!backwards) continue;
    const int face = c_.arcs[i - 1].face;
    if (c_.arcs[i + 1].face != face || c_.stops[i].kind != Kind::contact || c_.stops[i + 1].kind != Kind::contact) {
      return fail("an arc along an edge turns back");
    }
    c_.stops.erase(c_.stops.begin() + static_cast<std::ptrdiff_t>(i));
    c_.arcs.erase(c_.arcs.begin() + static_cast<std::ptrdiff_t>(i));
    c_.arcs[i - 1].points = chord(c_.stops[i - 1].x, c_.stops[i].x);
    erase_stop(i, face);
    changed = true;
    return true;
  }
  for (std::size_t i = 0; i < c_.arcs.size(); ++i) {
    if (!stay_on_face(i, changed)) return false;
    if (changed) return true;
  }
  return true;
}

void Shortener::run() {
  bool changed = true;
  bool followed = false;
  for (c_.rounds = 0; c_.rounds < kMostRounds; ++c_.rounds) {
    if (!trace_all()) {
      c_.why = "a geodesic on one face was not found";
      return;
    }
    while (drop_empty_arcs()) {
      if (!trace_all()) {
        c_.why = "a geodesic on one face was not found";
        return;
      }
    }
    if (!slide()) {
      // Two crossings of an edge that the path is pressed against never settle: it follows the edge.
      if (followed || !follow_edges()) return;
      followed = true;
      c_.why.clear();
      continue;
    }
    if (!change(changed)) return;
    if (!changed) break;
  }
  if (changed) {
    c_.why = "the row of faces along the path does not settle";
    return;
  }
  // Everything is checked once more, on what is returned.
  bool shortest = true;
  c_.length = 0;
  for (const ChainArc& arc : c_.arcs) {
    c_.length += arc.length;
    c_.error += arc.error;
    shortest = shortest && arc.shortest;
  }
  for (std::size_t i = 1; i + 1 < c_.stops.size(); ++i) {
    const ChainStop& stop = c_.stops[i];
    const ChainArc& before = c_.arcs[i - 1];
    const ChainArc& after = c_.arcs[i];
    if (stop.kind == Kind::crossing) {
      const Point3 t = s_.tangent(stop.edge, stop.x);
      if (std::abs((before.last - after.first).dot(t)) > kAngleSlack) {
        c_.why = "the tangents at an edge do not agree";
        return;
      }
    } else if (stop.kind == Kind::contact) {
      if ((before.last - after.first).norm() > 1e-5) {
        c_.why = "the path does not meet an edge that it follows along it";
        return;
      }
    } else if (std::min(stop.left, stop.right) < kPi - 1e-5) {
      c_.why = "the path passes a corner that it could go round";
      return;
    }
  }
  for (const ChainArc& arc : c_.arcs) {
    if (arc.face >= 0) continue;
    for (const double u : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const auto j = static_cast<Index>(u * static_cast<double>(arc.points.cols() - 1));
      if (pressed(arc.edge, arc.points.col(j)) > 1e-6 / s_.scale) {
        c_.why = "the path is not pressed against an edge that it follows";
        return;
      }
    }
  }
  c_.solved = true;
  c_.locally_shortest = shortest && !(hessian_least_ < -1e-9 / s_.scale);
}

}  // namespace

Points FacetChain::points() const {
  std::vector<Point3> all;
  for (const ChainArc& arc : arcs) {
    for (Index j = 0; j < arc.points.cols(); ++j) {
      const Point3 x = arc.points.col(j);
      if (all.empty() || all.back() != x) all.push_back(x);
    }
  }
  Points result(3, static_cast<Index>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) result.col(static_cast<Index>(i)) = all[i];
  return result;
}

FacetChain chain_of(FacetedSurface& surface, const FacetWay& way) {
  FacetChain chain;
  const std::size_t steps = way.faces.size();
  chain.stops.push_back({.kind = Kind::end, .x = way.points.front()});
  std::vector<Point3> points{way.points.front()};
  std::vector<int> edges{way.edge.front()};
  std::vector<int> current;
  const auto close = [&](ChainStop stop) {
    ChainArc arc;
    arc.face = current.empty() ? -1 : current.front();
    arc.start.resize(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) arc.start.col(static_cast<Index>(i)) = points[i];
    arc.guide = points;
    arc.guide_edges = edges;
    chain.arcs.push_back(std::move(arc));
    chain.stops.push_back(std::move(stop));
  };
  for (std::size_t i = 0; i < steps; ++i) {
    const Point3& at = way.points[i];
    std::vector<int> both;
    for (const int face : way.faces[i]) {
      if (current.empty() || std::find(current.begin(), current.end(), face) != current.end()) both.push_back(face);
    }
    const bool corner = i > 0 && way.corner[i];
    if (both.empty() || (corner && !current.empty())) {
      ChainStop stop;
      stop.x = at;
      stop.kind = way.corner[i] || way.edge[i] < 0 ? Kind::corner : Kind::crossing;
      stop.edge = way.edge[i];
      close(stop);
      points = {at};
      edges = {way.edge[i]};
      both = way.faces[i];
    }
    current = std::move(both);
    // Corners that reach into the face, beside the way: the path may bend there. Those that it does not need are left
    // again.
    bool bent = false;
    for (const ReflexCorner& reflex : way.reflex) {
      if (reflex.step != i) continue;
      const auto face = std::find_if(current.begin(), current.end(), [&](int f) {
        return std::find(reflex.faces.begin(), reflex.faces.end(), f) != reflex.faces.end();
      });
      if (face == current.end()) continue;
      current = {*face};
      points.push_back(reflex.x);
      edges.push_back(-1);
      close({.kind = Kind::corner, .x = reflex.x});
      points = {reflex.x};
      edges = {-1};
      bent = true;
    }
    // From one edge of a face to the next: perhaps over the corner between them, which steps of the graph may cut.
    const int e = way.edge[i];
    const int f = way.edge[i + 1];
    if (!bent && i > 0 && i + 1 < steps && e >= 0 && f >= 0 && e != f) {
      const int face = current.front();
      const Point3 to = way.points[i + 1];
      Point3 x = (at + to) / 2;
      const SharpEdge one = surface.edge(e);
      const SharpEdge two = surface.edge(f);
      const auto of_face = [&](const SharpEdge& edge) { return edge.a == face || edge.b == face; };
      if (of_face(one) && of_face(two) && one.condition != two.condition &&
          surface.project(face, {one.condition, two.condition}, x) && (x - at).norm() < (to - at).norm() &&
          (x - to).norm() < (to - at).norm() && surface.violation(face, x) <= kOnEdge * surface.scale) {
        points.push_back(x);
        edges.push_back(-1);
        ChainStop stop;
        stop.x = x;
        stop.kind = Kind::corner;
        close(stop);
        points = {x};
        edges = {-1};
      }
    }
    points.push_back(way.points[i + 1]);
    edges.push_back(way.edge[i + 1]);
  }
  close({.kind = Kind::end, .x = way.points.back()});
  return chain;
}

void shorten_chain(FacetedSurface& surface, FacetChain& chain, const Context& context) {
  Shortener(surface, chain, context).run();
}

}  // namespace taut::detail
