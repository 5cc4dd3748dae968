// Paths that follow borders, in any dimension: p, a geodesic of the surface {F = 0}, one of the border {F = 0, g = 0}
// from the contact c_1 to c_2, a geodesic of the surface, ..., q.
//
//   T-, T+   unit tangents of the arcs before and after a contact
//   R        T- - T+, which is dL/dc for every move of c within the border, and has to vanish
//   t, W     T of the border's arc at c, and a basis of the other directions of the border
//
// Along W this is stationarity, and the length's second derivative is H = W^T dR/dW. Along t the length is stationary
// to second order already; there R says that the free arc arrives tangentially, to first order. So R = 0 is solved by
// Newton's method, its matrix by differences: one more geodesic of both arcs for each direction of a contact. Where H
// is not positive, steps go down along each of its eigenvectors until the length falls.
//
// 1. A string of points is pulled taut. Where it touches a border at several points in a row is an arc of it.
// 2. Contacts are solved for.
// 3. A free arc that leaves the domain gets an arc of the border that it leaves by; an arc of a border that has shrunk
//    to nothing goes. Again from 2.
// 4. An arc that is not pressed against its border says that the string was too coarse: from 1 with twice the points.
#include "strata/contact_chain.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "core/linear_algebra.hpp"
#include "curve/polyline.hpp"
#include "strata/taut_string.hpp"

namespace taut::detail {
namespace {

constexpr int kFree = BorderedSurface::kFree;

struct ContactRules {
  /// Parts of the first string, and how often they are doubled.
  Index parts = 48;
  int doublings = 2;
  Index touching = 3;  ///< points in a row that make an arc of a border: fewer come from an arc that leaves the domain
  int changes = 8;     ///< of the row of arcs
  int steps = 40;      ///< of Newton's method
  int halvings = 20;
  /// A step moves a contact by at most this share of the arcs that meet there.
  double longest_step = 0.3;
  /// The matrix by differences over this share of the shorter arc at a contact: good to about that. It is kept while
  /// steps make R smaller by `fast`.
  double difference = 1e-4;
  double fast = 0.1;
  /// |R| that one more step brings to rounding; good enough where steps no longer help: what it means for the length is
  /// its square.
  double settled = 1e-6;
  double tolerable = 1e-5;
  /// Eigenvalues of H below this part of the largest count as zero.
  double flat = 1e-6;
  /// A saddle is left by this share of the shortest arc, so often.
  double kick = 0.1;
  int kicks = 4;
  /// Of the path's length: a free arc may be so far outside (a graze of that depth is some 30,000 times as long), and
  /// an arc of a border as short as this has gone.
  double outside = 1e-9;
  double nothing = 1e-6;
  /// Curvature that draws an arc off its border, times the path's length.
  double pressed = 1e-6;
  int looks = 32;  ///< places of an arc where that is looked at
};
constexpr ContactRules kRules;

class ContactSolver {
 public:
  ContactSolver(BorderedSurface& surface, const Context& context) : s_(surface), context_(context) {}

  ContactChain run(const TautString& string) {
    take(string);
    for (int change = 0; change <= kRules.changes; ++change) {
      if (!settle()) return finish();
      if (!leave_borders() && !enter_borders()) {
        check();
        return finish();
      }
      if (c_.fault != ChainFault::none) return finish();
    }
    fail(ChainFault::unsettled_row, c_.contacts.cols() > 0 ? Vector(c_.contacts.col(0)) : Vector());
    return finish();
  }

 private:
  [[nodiscard]] Index num_contacts() const { return c_.contacts.cols(); }
  [[nodiscard]] ContactArc& arc(Index i) { return c_.arcs[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const ContactArc& arc(Index i) const { return c_.arcs[static_cast<std::size_t>(i)]; }
  /// Contact i is on the border that one of its arcs follows.
  [[nodiscard]] int border(Index i) const { return std::max(arc(i).border, arc(i + 1).border); }
  [[nodiscard]] Vector end(Index i) const { return i < 0 ? p_ : i < num_contacts() ? c_.contacts.col(i) : q_; }
  bool fail(ChainFault fault, const Vector& place) {
    c_.fault = fault;
    c_.place = place;
    return false;
  }
  ContactChain finish() {
    c_.solved = c_.fault == ChainFault::none;
    return std::move(c_);
  }

  void take(const TautString& string);
  [[nodiscard]] bool trace(Index i, const Vector& a, const Vector& b, NewtonResult& geodesic);
  [[nodiscard]] bool trace_all();
  [[nodiscard]] double length() const;
  [[nodiscard]] Vector residual() const;

  /// What Newton's method knows of the contacts: m - 1 directions of each, the first along its border's arc.
  struct System {
    std::vector<Eigen::MatrixXd> basis;  // d x (m - 1) each
    Eigen::MatrixXd matrix;              // dR / d moves
    Eigen::MatrixXd second;              // H, without its flat part; empty in a border of dimension 1
    Vector values;                       // its eigenvalues
    Eigen::MatrixXd vectors;
  };
  [[nodiscard]] Index directions() const { return s_.dim() - s_.codim(kFree) - 1; }
  /// `central`: by differences to both sides, for the certificate.
  [[nodiscard]] bool linearise(bool central, System& system);
  [[nodiscard]] bool add_differences(Index i, Index j, double step, System& system);
  [[nodiscard]] Eigen::MatrixXd along_border(Index i);
  [[nodiscard]] double part_of(const Vector& moves) const;
  [[nodiscard]] bool move(const System& system, const Vector& moves);
  [[nodiscard]] bool leave_saddle(const System& system);
  [[nodiscard]] static bool has_saddle(const System& system) {
    return system.values.size() > 0 && system.values(0) < -kRules.flat * system.values.cwiseAbs().maxCoeff();
  }
  [[nodiscard]] bool solve_contacts();
  [[nodiscard]] bool settle();

  [[nodiscard]] bool is_nothing(const ContactArc& one) const {
    return one.border != kFree && one.geodesic.length <= kRules.nothing * c_.length;
  }
  [[nodiscard]] bool has_gone() const {
    return std::ranges::any_of(c_.arcs, [&](const ContactArc& one) { return is_nothing(one); });
  }
  [[nodiscard]] bool leave_borders();
  [[nodiscard]] bool enter_borders();
  void check();

  BorderedSurface& s_;
  const Context& context_;
  Vector p_, q_;
  ContactChain c_;
};

/// Runs of points that touch one border. A run that begins at an end of the string, which is on that border itself,
/// begins there.
void ContactSolver::take(const TautString& string) {
  const Points& x = string.points;
  const Index n = x.cols();
  p_ = x.col(0);
  q_ = x.col(n - 1);
  c_.contacts.resize(x.rows(), 0);
  const double near = kRules.nothing * polyline_length(x);
  const auto touching = [&](Index i) { return string.touching[static_cast<std::size_t>(i)]; };
  const Points room = s_.room(Points(x(Eigen::all, std::vector<Index>{0, n - 1})));
  Index from = 0;  // of the free arc
  const auto add_contact = [&](Index i) {
    c_.contacts.conservativeResize(Eigen::NoChange, num_contacts() + 1);
    c_.contacts.rightCols<1>() = x.col(i);
  };
  for (Index i = 1; i + 1 < n;) {
    Index last = i;
    while (last + 2 < n && touching(last + 1) == touching(i)) ++last;
    if (touching(i) != kFree && last - i + 1 >= kRules.touching) {
      const bool from_start = i == 1 && room(touching(i), 0) <= near;
      const bool to_end = last + 2 == n && room(touching(i), 1) <= near;
      if (!from_start) {
        c_.arcs.push_back({kFree, x.middleCols(from, i - from + 1)});
        add_contact(i);
      }
      const Index first = from_start ? 0 : i;
      from = to_end ? n - 1 : last;
      c_.arcs.push_back({touching(i), x.middleCols(first, from - first + 1)});
      if (!to_end) add_contact(last);
    }
    i = last + 1;
  }
  if (from < n - 1) c_.arcs.push_back({kFree, x.middleCols(from, n - from)});
}

/// The geodesic of arc i between a and b: from the one it has, moved along, or else from its start.
bool ContactSolver::trace(Index i, const Vector& a, const Vector& b, NewtonResult& geodesic) {
  NewtonSolver& solver = s_.solver(arc(i).border);
  const SpectralCurve& old = geodesic.curve;
  if (old.num_elements() > 0) {
    Points nodes = old.nodes();
    const Vector at_start = a - nodes.col(0);
    const Vector at_end = b - nodes.col(nodes.cols() - 1);
    for (Index j = 0; j < nodes.cols(); ++j) {
      const double t = static_cast<double>(j) / static_cast<double>(nodes.cols() - 1);
      nodes.col(j) += (1 - t) * at_start + t * at_end;
    }
    nodes.col(0) = a;
    nodes.col(nodes.cols() - 1) = b;
    NewtonResult next = solver.refine(SpectralCurve(old.degree(), old.lengths(), std::move(nodes)), context_);
    if (next.status == Status::ok) {
      geodesic = std::move(next);
      return true;
    }
  }
  Points start = arc(i).start;
  start.col(0) = a;
  start.col(start.cols() - 1) = b;
  geodesic = solver.solve(start, context_);
  return geodesic.status == Status::ok;
}

bool ContactSolver::trace_all() {
  for (Index i = 0; i <= num_contacts(); ++i) {
    if (!trace(i, end(i - 1), end(i), arc(i).geodesic)) {
      return fail(ChainFault::no_arc, arc(i).start.col(arc(i).start.cols() / 2));
    }
  }
  return true;
}

double ContactSolver::length() const {
  double sum = 0;
  for (const ContactArc& one : c_.arcs) sum += one.geodesic.length;
  return sum;
}

Vector ContactSolver::residual() const {
  const Index d = s_.dim();
  Vector r(d * num_contacts());
  for (Index i = 0; i < num_contacts(); ++i) {
    r.segment(i * d, d) = arc(i).geodesic.end_direction - arc(i + 1).geodesic.start_direction;
  }
  return r;
}

/// d x (m - 1): an orthonormal basis of the border's tangent space at contact i, its arc's tangent first.
Eigen::MatrixXd ContactSolver::along_border(Index i) {
  const Index d = s_.dim();
  const Index k = s_.codim(border(i));
  Points at = c_.contacts.col(i);
  Eigen::MatrixXd normals;
  (void)s_.project(border(i), at, &normals);
  Eigen::MatrixXd known(d, k + 1);
  known.leftCols(k) = Eigen::Map<const Eigen::MatrixXd>(normals.data(), d, k);
  known.col(k) = arc(i).border != kFree ? arc(i).geodesic.end_direction : arc(i + 1).geodesic.start_direction;
  Eigen::MatrixXd basis(d, directions());
  basis.col(0) = known.col(k);
  if (directions() > 1) basis.rightCols(directions() - 1) = orthogonal_complement(known);
  return basis;
}

/// R of contact i and its neighbours where it is moved by `step` along direction j: added to the column, over twice the
/// step.
bool ContactSolver::add_differences(Index i, Index j, double step, System& system) {
  const Index d = s_.dim();
  Points moved = c_.contacts.col(i) + step * system.basis[static_cast<std::size_t>(i)].col(j);
  NewtonResult before = arc(i).geodesic;
  NewtonResult after = arc(i + 1).geodesic;
  if (!s_.project(border(i), moved)(0) || !trace(i, end(i - 1), moved, before) ||
      !trace(i + 1, moved, end(i + 1), after)) {
    return fail(ChainFault::undetermined, c_.contacts.col(i));
  }
  auto column = system.matrix.col(i * directions() + j);
  column.segment(i * d, d) += (before.end_direction - after.start_direction) / (2 * step);
  if (i > 0) {
    column.segment((i - 1) * d, d) += (arc(i - 1).geodesic.end_direction - before.start_direction) / (2 * step);
  }
  if (i + 1 < num_contacts()) {
    column.segment((i + 1) * d, d) += (after.end_direction - arc(i + 2).geodesic.start_direction) / (2 * step);
  }
  return true;
}

bool ContactSolver::linearise(bool central, System& system) {
  const Index d = s_.dim();
  const Index m = directions();
  const Index n = num_contacts();
  const Vector r = residual();
  system.basis.clear();
  for (Index i = 0; i < n; ++i) system.basis.push_back(along_border(i));
  system.matrix.setZero(d * n, m * n);
  for (Index i = 0; i < n; ++i) {
    const double step = kRules.difference * std::min(arc(i).geodesic.length, arc(i + 1).geodesic.length);
    const Index first = std::max<Index>(i - 1, 0) * d;
    const Index last = std::min(i + 2, n) * d;
    for (Index j = 0; j < m; ++j) {
      if (!add_differences(i, j, step, system)) return false;
      if (central) {
        if (!add_differences(i, j, -step, system)) return false;
      } else {
        auto column = system.matrix.col(i * m + j);
        column *= 2;
        column.segment(first, last - first) -= r.segment(first, last - first) / step;
      }
    }
  }
  if (m == 1) return true;
  // H, and steps down along each of its eigenvectors.
  const Index w = m - 1;
  Eigen::MatrixXd second(w * n, w * n);
  for (Index a = 0; a < n; ++a) {
    const auto across = system.basis[static_cast<std::size_t>(a)].rightCols(w);
    for (Index b = 0; b < n; ++b) {
      second.block(a * w, b * w, w, w) = across.transpose() * system.matrix.block(a * d, b * m + 1, d, w);
    }
  }
  second = (second + second.transpose()).eval() / 2;
  auto eigen = symmetric_eigen(second);
  system.values = std::move(eigen.values);
  system.vectors = std::move(eigen.vectors);
  const Vector change = system.values.cwiseAbs() - system.values;
  const Eigen::MatrixXd added = system.vectors * change.asDiagonal() * system.vectors.transpose();
  for (Index a = 0; a < n; ++a) {
    const auto across = system.basis[static_cast<std::size_t>(a)].rightCols(w);
    for (Index b = 0; b < n; ++b) {
      system.matrix.block(a * d, b * m + 1, d, w) += across * added.block(a * w, b * w, w, w);
    }
  }
  return true;
}

/// The share of a step that moves no contact too far.
double ContactSolver::part_of(const Vector& moves) const {
  double part = 1;
  for (Index i = 0; i < num_contacts(); ++i) {
    const Index m = directions();
    const double most = kRules.longest_step * std::min(arc(i).geodesic.length, arc(i + 1).geodesic.length);
    part = std::min(part, most / std::max(moves.segment(i * m, m).norm(), std::numeric_limits<double>::min()));
  }
  return part;
}

bool ContactSolver::move(const System& system, const Vector& moves) {
  for (Index i = 0; i < num_contacts(); ++i) {
    const Eigen::MatrixXd& basis = system.basis[static_cast<std::size_t>(i)];
    Points moved = c_.contacts.col(i) + basis * moves.segment(i * basis.cols(), basis.cols());
    if (!s_.project(border(i), moved)(0)) return fail(ChainFault::unsettled_stops, c_.contacts.col(i));
    c_.contacts.col(i) = moved;
  }
  return trace_all();
}

/// A little to that side along the direction in which the length falls fastest where it is the shorter.
bool ContactSolver::leave_saddle(const System& system) {
  const Index m = directions();
  double shortest = std::numeric_limits<double>::infinity();
  for (const ContactArc& one : c_.arcs) shortest = std::min(shortest, one.geodesic.length);
  const ContactChain before = c_;
  ContactChain best = c_;
  for (const double side : {1.0, -1.0}) {
    Vector moves = Vector::Zero(m * num_contacts());
    for (Index i = 0; i < num_contacts(); ++i) {
      moves.segment(i * m + 1, m - 1) =
          side * kRules.kick * shortest * system.vectors.col(0).segment(i * (m - 1), m - 1);
    }
    c_ = before;
    if (move(system, moves) && length() < before.length) {
      c_.length = length();
      if (c_.length < best.length) best = c_;
    }
  }
  const bool left = best.length < before.length;
  c_ = std::move(best);
  return left;
}

/// Newton's method for R = 0. It ends early where an arc of a border has shrunk to nothing.
bool ContactSolver::solve_contacts() {
  System system;
  bool fresh = false;  // the matrix is of this place
  bool last = false;
  for (int step = 0; step < kRules.steps; ++step, ++c_.steps) {
    context_.check_cancelled();
    const Vector r = residual();
    Index worst = 0;
    const double off = r.cwiseAbs().maxCoeff(&worst);
    if (last) break;
    last = off <= kRules.settled;
    if (system.matrix.size() == 0) {
      if (!linearise(false, system)) return false;
      fresh = true;
    }
    const Vector moves = least_squares(system.matrix, -r, kRules.flat);
    const bool saddle = has_saddle(system);
    const ContactChain before = c_;
    double part = part_of(moves);
    bool moved = false;
    for (int halving = 0; halving < kRules.halvings && !moved; ++halving, part /= 2) {
      c_ = before;
      moved = move(system, part * moves) && (saddle ? length() < before.length : residual().norm() < r.norm());
    }
    if (!moved) {
      c_ = before;
      if (off <= kRules.tolerable) break;
      if (fresh) return fail(ChainFault::unsettled_stops, c_.contacts.col(worst / s_.dim()));
      system = {};
      continue;
    }
    c_.length = length();
    if (has_gone()) return true;
    fresh = false;
    if (saddle || residual().norm() > kRules.fast * r.norm()) system = {};
  }
  Index worst = 0;
  if (residual().cwiseAbs().maxCoeff(&worst) <= kRules.tolerable) return true;
  return fail(ChainFault::unsettled_stops, c_.contacts.col(worst / s_.dim()));
}

/// Contacts at rest, at a minimum as far as that is found, and what is known of them then.
bool ContactSolver::settle() {
  if (!trace_all()) return false;
  c_.length = length();
  c_.error = 0;
  c_.index = 0;
  c_.locally_shortest = true;
  for (int kick = 0; num_contacts() > 0; ++kick) {
    if (!solve_contacts()) return false;
    if (has_gone()) return true;
    System system;
    if (!linearise(true, system)) return false;
    if (kick < kRules.kicks && has_saddle(system) && leave_saddle(system)) continue;
    const Vector r = residual();
    c_.error = r.norm() * least_squares(system.matrix, -r, kRules.flat).norm();
    if (system.values.size() > 0) {
      const double least = kRules.flat * system.values.cwiseAbs().maxCoeff();
      c_.index = static_cast<int>((system.values.array() < -least).count());
      c_.locally_shortest = system.values(0) > least;
    }
    break;
  }
  c_.length = length();
  for (const ContactArc& one : c_.arcs) {
    c_.error += one.geodesic.length_error;
    c_.index += one.geodesic.index.value_or(0);
    c_.locally_shortest = c_.locally_shortest && one.geodesic.locally_shortest;
  }
  return true;
}

/// Arcs of borders that have shrunk to nothing go: those beside them become one.
bool ContactSolver::leave_borders() {
  const auto gone = std::ranges::find_if(c_.arcs, [&](const ContactArc& one) { return is_nothing(one); });
  if (gone == c_.arcs.end()) return false;
  const Index i = gone - c_.arcs.begin();
  const Index n = num_contacts();
  // The contacts at its ends go, too, and of the free arcs there one, if there are two.
  const Index first = std::max<Index>(i - 1, 0);
  const Index last = std::min(i + 1, n);
  ContactArc joined{kFree, arc(last).geodesic.points};
  if (i > 0 && i < n) {
    const Points& before = arc(first).geodesic.points;
    joined.start.resize(s_.dim(), before.cols() + arc(last).geodesic.points.cols() - 1);
    joined.start << before, arc(last).geodesic.points.rightCols(arc(last).geodesic.points.cols() - 1);
  } else if (i > 0) {
    joined.start = arc(first).geodesic.points;
  }
  Points contacts(s_.dim(), n - (last - first));
  contacts << c_.contacts.leftCols(first), c_.contacts.rightCols(n - last);
  c_.contacts = std::move(contacts);
  c_.arcs.erase(c_.arcs.begin() + first, c_.arcs.begin() + last);
  arc(first) = std::move(joined);
  return true;
}

/// Where a free arc leaves the domain it follows the border by which it leaves, from one contact to the next.
bool ContactSolver::enter_borders() {
  const double most = kRules.outside * c_.length;
  for (Index i = 0; i <= num_contacts(); ++i) {
    const Points& points = arc(i).geodesic.points;
    const Points x = arc(i).border == kFree ? s_.looked_at(points) : points;
    const Points room = s_.room(x);
    Index broken = 0;
    Index deepest = 0;
    if (!(room.minCoeff(&broken, &deepest) < -most)) continue;
    const auto outside = [&](Index j) { return room(broken, j) < -most; };
    Index first = deepest;
    Index last = deepest;
    while (first > 0 && outside(first - 1)) --first;
    while (last + 1 < x.cols() && outside(last + 1)) ++last;
    // Where the path starts or ends on that border it may follow it from there.
    const bool from_start = i == 0 && first <= 1 && room(broken, 0) <= kRules.nothing * c_.length;
    const bool to_end =
        i == num_contacts() && last + 2 >= x.cols() && room(broken, x.cols() - 1) <= kRules.nothing * c_.length;
    // An arc of a border that leaves by another one, or an arc that comes from outside.
    if (arc(i).border != kFree || (first == 0 && !from_start) || (last + 1 == x.cols() && !to_end)) {
      (void)fail(arc(i).border != kFree ? ChainFault::no_corner : ChainFault::not_pressed, x.col(deepest));
      return true;
    }
    first = std::max<Index>(first - 1, 0);
    last = std::min(last + 1, x.cols() - 1);
    Points along = x.middleCols(first, last - first + 1);
    if (!s_.project(static_cast<int>(broken), along).all()) {
      (void)fail(ChainFault::no_edge, x.col(deepest));
      return true;
    }
    std::vector<ContactArc> added;
    Points contacts = c_.contacts.leftCols(i);
    const auto add_contact = [&](const Vector& at) {
      contacts.conservativeResize(s_.dim(), contacts.cols() + 1);
      contacts.rightCols<1>() = at;
    };
    if (!from_start) {
      Points before(s_.dim(), first + 2);
      before << x.leftCols(first + 1), along.col(0);
      added.push_back({kFree, std::move(before)});
      add_contact(along.col(0));
    }
    added.push_back({static_cast<int>(broken), along});
    if (!to_end) {
      Points after(s_.dim(), x.cols() - last + 1);
      after << along.rightCols<1>(), x.rightCols(x.cols() - last);
      added.push_back({kFree, std::move(after)});
      add_contact(along.rightCols<1>());
    }
    for (Index j = i; j < num_contacts(); ++j) add_contact(c_.contacts.col(j));
    c_.contacts = std::move(contacts);
    c_.arcs.erase(c_.arcs.begin() + i);
    c_.arcs.insert(c_.arcs.begin() + i, added.begin(), added.end());
    return true;
  }
  return false;
}

/// Every arc along a border is pressed against it.
void ContactSolver::check() {
  for (const ContactArc& one : c_.arcs) {
    if (one.border == kFree) continue;
    const SpectralCurve& curve = one.geodesic.curve;
    Points x(s_.dim(), kRules.looks + 1);
    Points tangents = x;
    for (int j = 0; j <= kRules.looks; ++j) {
      const double t = curve.period() * j / kRules.looks;
      x.col(j) = curve.point(t);
      tangents.col(j) = curve.velocity(t).normalized();
    }
    Index worst = 0;
    if (s_.pull(one.border, x, tangents).maxCoeff(&worst) * c_.length > kRules.pressed) {
      (void)fail(ChainFault::not_pressed, x.col(worst));
      return;
    }
  }
}

}  // namespace

ContactChain shorten_inside(BorderedSurface& surface, const Points& start, const Context& context) {
  ContactChain chain;
  Points line = start;
  for (int doubling = 0; doubling <= kRules.doublings; ++doubling) {
    TautString string = pull_string(surface, line, kRules.parts << doubling, context);
    chain = ContactSolver(surface, context).run(string);
    if (chain.solved) break;
    line = std::move(string.points);
  }
  return chain;
}

}  // namespace taut::detail
