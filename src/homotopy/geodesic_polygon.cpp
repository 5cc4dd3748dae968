// Newton's method on the corners b_i of a polygon of short geodesics. First variation: dL / db_i = t_in - t_out. Its
// derivatives are taken by central differences, a corner moved across the curve by kDifference of an arc to either
// side; only the two arcs beside it change, so the Hessian is block tridiagonal (cyclic for a loop) and costs 4 r arcs
// a corner, r = d - k - 1. Its eigenvalues tell: negative ones are directions down, those near zero neutral (loops on a
// surface of revolution). Steps leave neutral directions alone. All unknowns together are few: the matrix is dense.
#include "homotopy/geodesic_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/linear_algebra.hpp"
#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

constexpr double kArcTurn = 0.8;  // of the normal along an arc, radians
constexpr Index kFewestArcs = 5;
constexpr Index kMostArcs = 1024;
constexpr Index kMostUnknowns = 1500;
constexpr double kDifference = 1e-3;  // a corner's move for a difference, as a part of the arc
constexpr double kNeutral = 1e-5;     // curvatures below this part of the largest are not told from zero,
constexpr double kNoise = 1e-7;       // ... and below this they are but noise
constexpr double kGoodArc = 1e-11;    // relative error of an arc
constexpr double kMostMove = 0.3;     // of a corner in one step, as a part of the arc
constexpr double kWell = 3e-8;        // kinks worth no further step, radians: their square is what counts
constexpr double kSmall = 1e-3;       // kinks that no longer change the second derivatives, radians
constexpr int kMostSteps = 25;

}  // namespace

GeodesicPolygon::GeodesicPolygon(const Surface& surface, const StrandMaker& maker, double tolerance, double gap)
    : surface_(surface),
      maker_(maker),
      gap_(gap),
      solver_(surface, {.tolerance = std::clamp(tolerance / 1e4, 1e-13, 1e-12), .leave_saddles = false}) {}

double GeodesicPolygon::length() const {
  double sum = 0;
  for (const NewtonResult& arc : arcs_) sum += arc.length;
  return sum;
}

double GeodesicPolygon::length_error() const {
  double sum = left_;
  for (const NewtonResult& arc : arcs_) sum += arc.length_error;
  return sum;
}

double GeodesicPolygon::kink() const {
  double most = 0;
  for (Index i = 0; i < num_free(); ++i) {
    most = std::max(most, (ends_of(arc_into(i)).arriving - ends_of(arc_out_of(i)).leaving).norm());
  }
  return most;
}

const NewtonResult* GeodesicPolygon::bad_arc() const {
  for (const NewtonResult& arc : arcs_) {
    if (!ends_of(arc).good) return &arc;
  }
  return nullptr;
}

Points GeodesicPolygon::points() const {
  Index count = 0;
  for (const NewtonResult& arc : arcs_) count += arc.points.cols();
  Points all(surface_.dim(), count);
  Index next = 0;
  for (const NewtonResult& arc : arcs_) {
    all.middleCols(next, arc.points.cols()) = arc.points;
    next += arc.points.cols();
  }
  return without_repeats(all);
}

Geodesic GeodesicPolygon::geodesic(double tolerance) const {
  Geodesic result;
  result.points = points();
  result.length = length();
  result.length_error = length_error();
  result.locally_shortest = index_ == 0;
  result.index = index_;
  result.start_direction = arcs_.front().start_direction;
  result.end_direction = arcs_.back().end_direction;
  for (const NewtonResult& arc : arcs_) {
    result.residual.surface = std::max(result.residual.surface, arc.residual.surface);
    result.residual.geodesic_curvature = std::max(result.residual.geodesic_curvature, arc.residual.geodesic_curvature);
  }
  const bool accurate = result.length_error <= std::max(tolerance, 1e-12) * result.length;
  result.status = accurate ? Status::ok : Status::not_converged;
  if (!accurate) result.reason = "its arcs do not join smoothly enough for the tolerance";
  return result;
}

GeodesicPolygon::Ends GeodesicPolygon::ends_of(const NewtonResult& arc) {
  Ends ends;
  // The tolerance is at the edge of rounding: an arc that just misses it will do.
  const bool good = arc.status == Status::ok || arc.length_error <= kGoodArc * arc.length;
  ends.good = good && arc.index == 0 && arc.length > 0;
  if (arc.curve.num_elements() == 0) return ends;
  ends.leaving = arc.curve.velocity(0).normalized();
  ends.arriving = arc.curve.velocity(arc.curve.period()).normalized();
  return ends;
}

/// The arc from `from` to `to` near the curve `start`, which is bent there.
NewtonResult GeodesicPolygon::arc(const Points& start, const VectorIn& from, const VectorIn& to,
                                  const Context& context) {
  Points bent = start;
  const Index last = start.cols() - 1;
  const Vector at_start = from - start.col(0);
  const Vector at_end = to - start.col(last);
  for (Index j = 0; j <= last; ++j) {
    const double t = static_cast<double>(j) / static_cast<double>(last);
    bent.col(j) += (1 - t) * at_start + t * at_end;
  }
  bent.col(0) = from;
  bent.col(last) = to;
  return solver_.solve(bent, context);
}

/// False when an arc is no minimum or fails.
bool GeodesicPolygon::cut(const Strand& loop, Index num_arcs, const Context& context) {
  // Corners at equal shares of turn and length.
  const Index n = loop.num_segments();
  const double length = loop.length();
  std::vector<double> share(static_cast<std::size_t>(n) + 1, 0.0);
  double turned = 0;
  for (Index i = 0; i < n; ++i) turned += maker_.turn(loop.normals.col(i), loop.normals.col(loop.after(i)));
  for (Index i = 0; i < n; ++i) {
    const double turn = maker_.turn(loop.normals.col(i), loop.normals.col(loop.after(i)));
    share[static_cast<std::size_t>(i) + 1] =
        // Where the surface bends arcs are shorter, but none is longer than twice its share of the whole.
        share[static_cast<std::size_t>(i)] + loop.segment(i) / length + (turned > 0 ? turn / turned : 0);
  }
  std::vector<Index> corner(1, 0);
  for (Index i = 1; i < n && static_cast<Index>(corner.size()) < num_arcs; ++i) {
    const double wanted = share.back() * static_cast<double>(corner.size()) / static_cast<double>(num_arcs);
    if (share[static_cast<std::size_t>(i)] >= wanted) corner.push_back(i);
  }
  const auto m = static_cast<Index>(corner.size());
  corner.push_back(n);
  const Points line = loop.polyline();
  closed_ = loop.closed;
  corners_.resize(line.rows(), m + 1);
  corners_.col(m) = line.col(n);
  arcs_.clear();
  for (Index i = 0; i < m; ++i) {
    const Index first = corner[static_cast<std::size_t>(i)];
    const Index last = corner[static_cast<std::size_t>(i) + 1];
    corners_.col(i) = line.col(first);
    const Points piece = line.middleCols(first, last - first + 1);
    arcs_.push_back(solver_.solve(piece, context));
    if (!ends_of(arcs_.back()).good || !maker_.is_near(piece, arcs_.back().points, 2 * gap_)) return false;
  }
  return true;
}

void GeodesicPolygon::make_frames() {
  const Index dim = surface_.dim();
  const Index codim = surface_.codim();
  frames_.resize(static_cast<std::size_t>(num_free()));
  Points at = corners_;
  Points normals;
  (void)maker_.project(at, normals, 1e-6 * (1 + at.cwiseAbs().maxCoeff()));
  for (Index i = 0; i < num_free(); ++i) {
    Eigen::MatrixXd fixed(dim, codim + 1);
    fixed.leftCols(codim) = Eigen::Map<const Eigen::MatrixXd>(normals.col(corner_of(i)).data(), dim, codim);
    // Along the curve a corner may slide without changing the polygon: that direction is left out.
    fixed.col(codim) = (ends_of(arc_out_of(i)).leaving + ends_of(arc_into(i)).arriving).normalized();
    frames_[static_cast<std::size_t>(i)] = orthogonal_complement(fixed);
  }
}

/// The gradient of the length: t_in - t_out at each corner, across the curve.
Vector GeodesicPolygon::kinks() const {
  const Index r = frames_.front().cols();
  Vector result(num_free() * r);
  for (Index i = 0; i < num_free(); ++i) {
    const Vector jump = ends_of(arc_into(i)).arriving - ends_of(arc_out_of(i)).leaving;
    result.segment(i * r, r) = frames_[static_cast<std::size_t>(i)].transpose() * jump;
  }
  return result;
}

/// The Hessian of the length by central differences of the kinks, a corner moved at a time; its eigenvalues.
bool GeodesicPolygon::differentiate(const Context& context) {
  make_frames();
  const Index n = num_free();
  const Index r = frames_.front().cols();
  hessian_ = Eigen::MatrixXd::Zero(n * r, n * r);
  const auto frame = [&](Index i) -> const Eigen::MatrixXd& { return frames_[static_cast<std::size_t>(i)]; };
  for (Index i = 0; i < n; ++i) {
    const Index before = i > 0 ? i - 1 : (closed_ ? n - 1 : -1);
    const Index after = i + 1 < n ? i + 1 : (closed_ ? 0 : -1);
    const NewtonResult& in = arc_into(i);
    const NewtonResult& out = arc_out_of(i);
    const Vector here = corners_.col(corner_of(i));
    const double eta = kDifference * std::min(in.length, out.length);
    for (Index c = 0; c < r; ++c) {
      double moved = 0;
      Vector leaving = Vector::Zero(surface_.dim());   // of the arc in: changes
      Vector jump = Vector::Zero(surface_.dim());      // here
      Vector arriving = Vector::Zero(surface_.dim());  // of the arc out
      for (const double side : {1.0, -1.0}) {
        Points to = here + side * eta * frame(i).col(c);
        Points normals;
        if (!maker_.project(to, normals, eta).all()) return false;
        const Ends first = ends_of(arc(in.points, in.points.col(0), to.col(0), context));
        const Ends second = ends_of(arc(out.points, to.col(0), out.points.rightCols(1), context));
        if (first.leaving.size() == 0 || second.leaving.size() == 0) return false;
        leaving += side * first.leaving;
        jump += side * (first.arriving - second.leaving);
        arriving += side * second.arriving;
        // The projection onto the surface shortens a move a little: what counts is how far the corner went.
        moved += side * frame(i).col(c).dot(to.col(0) - here);
      }
      auto column = hessian_.col(i * r + c);
      column.segment(i * r, r) += frame(i).transpose() * jump / moved;
      if (before >= 0) column.segment(before * r, r) -= frame(before).transpose() * leaving / moved;
      if (after >= 0) column.segment(after * r, r) += frame(after).transpose() * arriving / moved;
    }
  }
  // Symmetric but for the error of the differences.
  hessian_ = (0.5 * (hessian_ + hessian_.transpose())).eval();
  if (!hessian_.allFinite()) return false;
  const auto eigen = symmetric_eigen(hessian_);
  modes_ = eigen.vectors;
  curvatures_ = eigen.values;
  const double least = kNeutral * curvatures_.cwiseAbs().maxCoeff();
  index_ = static_cast<int>((curvatures_.array() < -least).count());
  neutral_ = static_cast<int>((curvatures_.array().abs() <= least).count());
  return true;
}

/// -H^+ g: modes with a curvature below this part of the largest stay where they are.
Vector GeodesicPolygon::newton_step(const Vector& kinks, double least) const {
  Vector along = modes_.transpose() * kinks;
  const double most = curvatures_.cwiseAbs().maxCoeff();
  for (Index i = 0; i < along.size(); ++i) {
    along(i) = std::abs(curvatures_(i)) <= least * most ? 0 : -along(i) / curvatures_(i);
  }
  return modes_ * along;
}

/// What the length may still be off by: twice what the second derivatives predict.
double GeodesicPolygon::left_by(const Vector& kinks) const {
  const Vector along = modes_.transpose() * kinks;
  const double least = kNoise * curvatures_.cwiseAbs().maxCoeff();
  return (along.array().square() / curvatures_.array().abs().max(least)).sum();
}

/// Moves the corners across the curve. Leaves everything as it was, and returns false, when an arc fails or the kinks
/// grow.
bool GeodesicPolygon::move(const Vector& step, const Context& context) {
  const Index r = frames_.front().cols();
  Points to = corners_;
  double most = 0;
  double shortest = arcs_.front().length;
  for (const NewtonResult& arc : arcs_) shortest = std::min(shortest, arc.length);
  for (Index i = 0; i < num_free(); ++i) {
    to.col(corner_of(i)) += frames_[static_cast<std::size_t>(i)] * step.segment(i * r, r);
    most = std::max(most, step.segment(i * r, r).norm());
  }
  const double bound = std::min(kMostMove * shortest, gap_);
  // No corner goes farther than the class allows.
  if (most > bound) to = corners_ + bound / most * (to - corners_);
  Points on = to;
  Points normals;
  if (!maker_.project(on, normals, shortest).all()) return false;
  for (Index i = 0; i < num_free(); ++i) to.col(corner_of(i)) = on.col(corner_of(i));
  if (closed_) to.rightCols(1) = to.col(0);
  std::vector<NewtonResult> arcs;
  for (Index i = 0; i + 1 < to.cols(); ++i) {
    const Points& before = arcs_[static_cast<std::size_t>(i)].points;
    arcs.push_back(arc(before, to.col(i), to.col(i + 1), context));
    if (!ends_of(arcs.back()).good || !maker_.is_near(before, arcs.back().points, 2 * gap_)) return false;
  }
  const double before = kink();
  std::swap(arcs, arcs_);
  std::swap(to, corners_);
  // Kinks, not lengths, are to fall: Newton's method may go to a saddle.
  if (kink() < before) return true;
  std::swap(arcs, arcs_);
  std::swap(to, corners_);
  return false;
}

GeodesicPolygon::Outcome GeodesicPolygon::solve(const Strand& loop, const Context& context) {
  double turned = 0;
  for (Index i = 0; i < loop.num_segments(); ++i) {
    turned += maker_.turn(loop.normals.col(i), loop.normals.col(loop.after(i)));
  }
  const Index across = surface_.dim() - surface_.codim() - 1;
  Index num_arcs = std::max(kFewestArcs, static_cast<Index>(std::ceil(turned / kArcTurn)));
  while (true) {
    if (num_arcs * across > kMostUnknowns) return Outcome::too_many_unknowns;
    if (cut(loop, num_arcs, context)) break;
    // Some arc is no minimum, or has strayed: shorter ones are.
    num_arcs *= 2;
    if (num_arcs > std::min(kMostArcs, loop.num_points())) return Outcome::not_converged;
  }
  bool known = false;  // the Hessian, well enough: it is taken again while the kinks are large
  for (int i = 0; i < kMostSteps && across > 0; ++i) {
    context.check_cancelled();
    if (!known && !differentiate(context)) return Outcome::not_converged;
    known = kink() < kSmall;
    if (kink() <= kWell) break;
    if (!move(newton_step(kinks(), kNoise), context) && !move(newton_step(kinks(), kNeutral), context)) break;
  }
  if (across > 0) {
    if (!known && !differentiate(context)) return Outcome::not_converged;
    left_ = left_by(kinks());
  }
  return kink() <= kSmall ? Outcome::smooth : Outcome::not_converged;
}

}  // namespace taut::detail
