// Newton's method for the stops of a chain.
//
//   T-, T+   unit tangents of the arcs before and after a stop
//   t, kappa tangent and curvature vector of the edge through it
//   L(s)     length of the chain, s_i the position of stop i along its edge
//
// Stationary chains: at a crossing the tangents agree along the edge, dL/ds = (T- - T+) . t = 0; where the path follows
// an edge it comes and leaves along it, T x t = 0.
// Second derivatives come from the Jacobi field j'' + K j = 0 of every arc: with a = t . N at the start and b at the
// end (N across the arc, in the face), reduced length m12 and M12,
//   L_aa = -T . kappa + a^2 M12 / m12,   L_bb = T . kappa + b^2 m12' / m12,   L_ab = -a b / m12,
// so Newton's method has the exact, tridiagonal matrix. For crossings alone it is the Hessian of the length: steps go
// down along each of its eigenvectors, and are halved until the length falls. Of a chain that is to be stationary only,
// be it no minimum, plain steps are taken.
#include "strata/stop_newton.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear_algebra.hpp"
#include "strata/chain_tolerances.hpp"
#include "strata/edge_walk.hpp"

namespace taut::detail {
namespace {

using Kind = ChainStop::Kind;
constexpr int kMostSteps = 60;
constexpr int kMostHalvings = 30;
/// A stop moves by at most this part of the longer of its arcs, even where the other is short.
constexpr double kBoldStep = 0.3;
/// Residuals are sines of angles: these are rounding; beyond doubt settled once one more step is made (contacts); still
/// fit to go on with, where steps no longer shorten.
constexpr double kRounding = 1e-13;
constexpr double kSettledContact = 1e-9;
constexpr double kTolerable = 1e-6;
/// A step that promises to shorten a chain by no more than this part is the last.
constexpr double kLastGain = 1e-15;
/// Eigenvalues smaller than this part of the largest are taken for as large.
constexpr double kFlat = 1e-10;

/// Newton's equations of the stops that move.
class StopNewton {
 public:
  StopNewton(FacetedSurface& surface, ArcTracer& tracer, FacetChain& chain)
      : s_(surface), tracer_(tracer), c_(chain), together_(ChainTolerances::together * surface.scale) {}

  [[nodiscard]] SlidStops run(const Context& context);
  [[nodiscard]] Vector second_variation();

 private:
  /// One that moves.
  struct Mover {
    std::size_t stop;
    int out = 0;  // stands at the end of its edge: +1 along the tangent, -1 against it
    int condition = -1;
  };
  [[nodiscard]] Point3 normal(int face, const Point3& x) {
    Point3 f;
    (void)s_.function(face, x, f);
    return f.normalized();
  }
  [[nodiscard]] Index mover_at(std::size_t stop) const {
    const auto found =
        std::find_if(movers_.begin(), movers_.end(), [&](const Mover& mover) { return mover.stop == stop; });
    return found == movers_.end() ? -1 : found - movers_.begin();
  }
  [[nodiscard]] std::size_t stop_before(std::size_t stop) const { return stop > 0 ? stop - 1 : c_.end_inner() - 1; }
  /// The last stop of a closed chain is the first.
  [[nodiscard]] std::size_t stop_after(std::size_t stop) const {
    return c_.closed && stop + 1 == c_.end_inner() ? 0 : stop + 1;
  }
  void set_crossing(Index i);
  void set_contact(Index i);
  /// Those that would leave their edge stay; the others move.
  [[nodiscard]] bool is_held(Index i) const {
    const int out = movers_[static_cast<std::size_t>(i)].out;
    return out != 0 && -residual_(i) * out > 0;
  }
  [[nodiscard]] Vector solve(const std::vector<Index>& free);
  [[nodiscard]] double longest_part(const Vector& step) const;
  [[nodiscard]] bool move(const Vector& step);
  [[nodiscard]] bool fall_into_corners();

  FacetedSurface& s_;
  ArcTracer& tracer_;
  FacetChain& c_;
  double together_;
  std::vector<Mover> movers_;
  bool contacts_ = false;
  Vector residual_;
  Eigen::MatrixXd matrix_;
  SlidStops result_;
};

void StopNewton::set_crossing(Index i) {
  const std::size_t at = movers_[static_cast<std::size_t>(i)].stop;
  const ChainStop& stop = c_.stops[at];
  const ChainArc& before = c_.before(at);
  const ChainArc& after = c_.arcs[at];
  const Point3 t = s_.tangent(stop.edge, stop.x);
  const Point3 kappa = s_.curvature(stop.edge, stop.x);
  residual_(i) = (before.last - after.first).dot(t);
  const double b = t.dot(normal(before.face, stop.x).cross(before.last));
  const double a = t.dot(normal(after.face, stop.x).cross(after.first));
  matrix_(i, i) +=
      before.last.dot(kappa) + b * b * before.slope / before.m12 - after.first.dot(kappa) + a * a * after.m / after.m12;
  if (const Index j = mover_at(stop_before(at)); j >= 0) {
    const ChainStop& other = c_.stops[stop_before(at)];
    const double a0 = s_.tangent(other.edge, other.x).dot(normal(before.face, other.x).cross(before.first));
    matrix_(i, j) -= a0 * b / before.m12;
  }
  if (const Index j = mover_at(stop_after(at)); j >= 0) {
    const ChainStop& other = c_.stops[stop_after(at)];
    const double b1 = s_.tangent(other.edge, other.x).dot(normal(after.face, other.x).cross(after.last));
    matrix_(i, j) -= a * b1 / after.m12;
  }
}

/// The face arc's tangent must have no part across the edge.
void StopNewton::set_contact(Index i) {
  const std::size_t at = movers_[static_cast<std::size_t>(i)].stop;
  const ChainStop& stop = c_.stops[at];
  const bool arrives = c_.before(at).face >= 0;
  const ChainArc& arc = arrives ? c_.before(at) : c_.arcs[at];
  const Point3 t = s_.tangent(stop.edge, stop.x);
  const Point3 kappa = s_.curvature(stop.edge, stop.x);
  const Point3 tangent = arrives ? arc.last : arc.first;
  const Point3 face_normal = normal(arc.face, stop.x);
  const Point3 conormal = face_normal.cross(t);
  residual_(i) = tangent.dot(conormal);
  const Point3 side = face_normal.cross(tangent);
  const double a = t.dot(side);
  // conormal' = normal' x t + normal x kappa; along a nearly parallel tangent only the part along t counts.
  const double turn = tangent.dot(face_normal.cross(kappa));
  const double slope = arrives ? a * arc.slope / arc.m12 : -a * arc.m / arc.m12;
  matrix_(i, i) += slope * side.dot(conormal) + turn;
  const std::size_t next = arrives ? stop_before(at) : stop_after(at);
  if (const Index j = mover_at(next); j >= 0) {
    const ChainStop& other = c_.stops[next];
    const Point3 there = arrives ? arc.first : arc.last;
    const double a1 = s_.tangent(other.edge, other.x).dot(normal(arc.face, other.x).cross(there));
    matrix_(i, j) += (arrives ? -a1 : a1) / arc.m12 * side.dot(conormal);
  }
}

Vector StopNewton::solve(const std::vector<Index>& free) {
  Vector step = Vector::Zero(residual_.size());
  if (free.empty()) return step;
  const Eigen::MatrixXd matrix = matrix_(free, free);
  const Vector residual = residual_(free);
  if (contacts_) {
    step(free) = -matrix.fullPivLu().solve(residual);
    return step;
  }
  const Eigen::MatrixXd symmetric = (matrix + matrix.transpose()) / 2;
  const auto eigen = symmetric_eigen(symmetric);
  const double largest = eigen.values.cwiseAbs().maxCoeff();
  Vector along = eigen.vectors.transpose() * residual;
  for (Index i = 0; i < along.size(); ++i) {
    const double steepness = std::max(std::abs(eigen.values(i)), kFlat * largest + 1e-300);
    along(i) = -along(i) / (c_.stationary && eigen.values(i) < 0 ? -steepness : steepness);
  }
  step(free) = eigen.vectors * along;
  return step;
}

/// No farther than arcs are long: there the quadratic model ends.
double StopNewton::longest_part(const Vector& step) const {
  double part = 1;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    const std::size_t at = movers_[i].stop;
    const auto [shorter, longer] = std::minmax(c_.before(at).length, c_.arcs[at].length);
    double room = kBoldStep * longer;
    if (c_.stops[at].kind != Kind::contact) room = std::max(room, shorter);
    part = std::min(part, room / std::max(std::abs(step(static_cast<Index>(i))), 1e-300));
  }
  return part;
}

/// False where it leads to no chain, or to a longer one.
bool StopNewton::move(const Vector& step) {
  const double length = c_.length;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    if (step(static_cast<Index>(i)) == 0) continue;
    Mover& mover = movers_[i];
    ChainStop& stop = c_.stops[mover.stop];
    const EdgeWalk walk = walk_along(s_, stop.edge, stop.x, step(static_cast<Index>(i)));
    if (!walk.possible) return false;
    stop.x = walk.x;
    mover.out = walk.end;
    if (walk.end != 0) mover.condition = walk.condition;
    c_.before(mover.stop).done = false;
    c_.arcs[mover.stop].done = false;
  }
  if (c_.closed) c_.stops.back() = c_.stops.front();
  if (!tracer_.trace(c_)) return false;
  return contacts_ || c_.stationary || c_.length < length + kLastGain * length;
}

/// A stop that has come to the end of its edge, where the chain has a corner already, goes into it. Else it would turn
/// to and fro there, its arc to the corner too short to have a direction.
bool StopNewton::fall_into_corners() {
  bool fell = false;
  for (const Mover& mover : movers_) {
    if (mover.out == 0) continue;
    ChainStop& stop = c_.stops[mover.stop];
    for (const std::size_t other : {stop_before(mover.stop), stop_after(mover.stop)}) {
      if (c_.stops[other].kind != Kind::corner) continue;
      if ((c_.stops[other].x - stop.x).norm() > ChainTolerances::at_corner * s_.scale) continue;
      stop.x = c_.stops[other].x;
      c_.before(mover.stop).done = c_.arcs[mover.stop].done = false;
      fell = true;
    }
  }
  if (c_.closed) c_.stops.back() = c_.stops.front();
  return fell && tracer_.trace(c_);
}

Vector StopNewton::second_variation() {
  for (std::size_t i = c_.first_inner(); i < c_.end_inner(); ++i) {
    if (c_.stops[i].kind == Kind::crossing) movers_.push_back({i});
  }
  const auto n = static_cast<Index>(movers_.size());
  if (n == 0) return {};
  residual_.setZero(n);
  matrix_.setZero(n, n);
  for (Index i = 0; i < n; ++i) set_crossing(i);
  const Eigen::MatrixXd symmetric = (matrix_ + matrix_.transpose()) / 2;
  return symmetric_eigenvalues(symmetric);
}

SlidStops StopNewton::run(const Context& context) {
  const auto fail = [&](ChainFault fault, std::size_t stop) {
    result_.trouble = {fault, c_.stops[stop].x};
    return result_;
  };
  for (std::size_t i = c_.first_inner(); i < c_.end_inner(); ++i) {
    const Kind kind = c_.stops[i].kind;
    if (kind == Kind::crossing || kind == Kind::contact) movers_.push_back({i});
    contacts_ = contacts_ || kind == Kind::contact;
  }
  if (!tracer_.trace(c_)) return fail(ChainFault::no_arc, tracer_.lost());
  if (movers_.empty()) {
    result_.settled = true;
    return result_;
  }
  const auto n = static_cast<Index>(movers_.size());
  const auto settle = [&](double error) {
    c_.error = error;
    for (Index i = 0; i < n; ++i) {
      const Mover& mover = movers_[static_cast<std::size_t>(i)];
      if (is_held(i)) result_.at_end.push_back({mover.stop, mover.condition});
    }
    result_.settled = true;
    return result_;
  };
  bool last = false;
  for (int round = 0; round < kMostSteps; ++round) {
    context.check_cancelled();
    residual_.resize(n);
    matrix_.setZero(n, n);
    std::vector<Index> free;
    double off = 0;
    std::size_t worst = movers_.front().stop;
    for (Index i = 0; i < n; ++i) {
      if (c_.stops[movers_[static_cast<std::size_t>(i)].stop].kind == Kind::crossing) {
        set_crossing(i);
      } else {
        set_contact(i);
      }
      if (is_held(i)) continue;
      free.push_back(i);
      if (std::abs(residual_(i)) > off) {
        off = std::abs(residual_(i));
        worst = movers_[static_cast<std::size_t>(i)].stop;
      }
    }
    const Vector step = solve(free);
    if (!step.allFinite()) return fail(ChainFault::undetermined, worst);
    const double predicted = std::abs(residual_.dot(step)) / 2;
    if (last || off <= kRounding) return settle(predicted);
    last = contacts_ ? off <= kSettledContact : predicted <= kLastGain * c_.length;

    const FacetChain before = c_;
    const std::vector<Mover> movers_before = movers_;
    double part = longest_part(step);
    bool moved = false;
    for (int halving = 0; halving < kMostHalvings && !moved; ++halving, part /= 2) {
      c_ = before;
      movers_ = movers_before;
      moved = move(part * step);
    }
    if (!moved) {
      c_ = before;
      movers_ = movers_before;
      if (off > kTolerable) return fail(ChainFault::unsettled_stops, worst);
      return settle(predicted);
    }
    // An arc that has shrunk to nothing has no direction: it goes, before anything else is asked.
    if (fall_into_corners() ||
        std::any_of(c_.arcs.begin(), c_.arcs.end(), [&](const ChainArc& arc) { return arc.length <= together_; })) {
      result_.settled = true;
      return result_;
    }
  }
  return fail(ChainFault::unsettled_stops, movers_.front().stop);
}

}  // namespace

SlidStops slide_stops(FacetedSurface& surface, ArcTracer& tracer, FacetChain& chain, const Context& context) {
  return StopNewton(surface, tracer, chain).run(context);
}

Vector second_variation(FacetedSurface& surface, const FacetChain& chain) {
  FacetChain copy = chain;
  const Context context;
  ArcTracer tracer(surface, context);
  return StopNewton(surface, tracer, copy).second_variation();
}

}  // namespace taut::detail
