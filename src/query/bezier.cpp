// Geodesic de Casteljau.
//
// Notation: G(r, i) the geodesic of level r = 1 .. n from the point of G(r-1, i) to that of G(r-1, i+1) at the same
// parameter t; G(1, i) joins control points i and i+1 and does not move. The curve is the point of G(n, 0) at t.
// At t = 0 each G(r, i) is G(1, i), which is where the continuation begins; at t = 1 it must have become G(1, i+r-1):
// if it has not, the construction from the other end gives another curve.

#include "taut/query/bezier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "taut/core/error.hpp"
#include "taut/curve/newton.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

/// One geodesic of the construction. Without an element it is a point: its ends are the same.
struct Arc {
  Points points;  // d x m, what the next one starts from
  SpectralCurve curve;
  double length = 0;
  bool locally_shortest = true;
};

class Casteljau {
 public:
  Casteljau(PathSolver& solver, const Context& context)
      : solver_(solver), newton_(solver.surface(), {.tolerance = 1e-12, .leave_saddles = false}), context_(context) {}

  Status status = Status::ok;
  std::string message;
  bool unique = true;

  /// The paths between control points. False where there is none.
  [[nodiscard]] bool join(const PointsIn& controls) {
    for (Index i = 0; i + 1 < controls.cols(); ++i) {
      const PathResult path = solver_.solve(controls.col(i), controls.col(i + 1));
      if (path.status != Status::ok) return fail(path.status, "between control points", i, path.message);
      // A geodesic that bends at an edge cannot be carried on by Newton's method.
      if (path.pieces.size() > 1) {
        return fail(Status::not_converged, "between control points", i,
                    "the path crosses an edge, which is not smooth");
      }
      unique = unique && path.unique;
      Arc arc{.points = path.points, .curve = {}};
      if (path.length > 0 && !correct(path.points, arc)) return fail(status, "between control points", i, message);
      base_.push_back(std::move(arc));
    }
    for (std::size_t r = 1; r < base_.size(); ++r) levels_.emplace_back(base_.begin(), base_.end() - r);
    return true;
  }

  /// The curve's point at t, a little farther than the last one. False where a geodesic cannot be continued.
  [[nodiscard]] bool move_to(double t) {
    const std::vector<Arc>* below = &base_;
    for (auto& level : levels_) {
      for (std::size_t i = 0; i < level.size(); ++i) {
        if (!carry(level[i], at((*below)[i], t), at((*below)[i + 1], t))) {
          message = fmt::format(
              "at parameter {:.6g} a geodesic between two points of the construction cannot be "
              "continued: {}; control points that lie closer together help",
              t, message);
          return false;
        }
        unique = unique && level[i].locally_shortest;
      }
      below = &level;
    }
    here_ = at(below->front(), t);
    return true;
  }

  [[nodiscard]] const Vector& here() const { return here_; }
  [[nodiscard]] Vector first() const { return base_.front().points.col(0); }
  [[nodiscard]] Vector last() const { return base_.back().points.rightCols(1); }
  [[nodiscard]] double longest() const { return std::ranges::max(base_, {}, &Arc::length).length; }

  /// At t = 1: has every geodesic arrived at the one between control points that it is to be.
  [[nodiscard]] bool arrived() const {
    constexpr double kSame = 1e-6;  // of the longest: two classes differ by far more, two corrections by far less
    for (const auto& level : levels_) {
      const std::size_t r = base_.size() - level.size();
      for (std::size_t i = 0; i < level.size(); ++i) {
        if (std::abs(level[i].length - base_[i + r].length) > kSame * longest()) return false;
      }
    }
    return true;
  }

 private:
  bool fail(Status why, const char* where, Index i, const std::string& what) {
    status = why;
    message = fmt::format("{} {} and {}: {}", where, i, i + 1, what);
    return false;
  }

  /// Makes `start` a geodesic.
  bool correct(const PointsIn& start, Arc& arc) {
    const NewtonResult found = newton_.solve(start, context_);
    if (found.status != Status::ok) {
      status = found.status;
      message = std::string(found.reason);
      return false;
    }
    arc = {.points = found.points,
           .curve = found.curve,
           .length = found.length,
           .locally_shortest = found.locally_shortest};
    return true;
  }

  /// Moves the ends of a geodesic to `from` and `to`.
  bool carry(Arc& arc, const Vector& from, const Vector& to) {
    // Two points of the level below have met: a point is its own geodesic.
    if (from == to) {
      arc = {.points = from, .curve = {}};
      return true;
    }
    Points start(from.size(), 2);
    start << from, to;
    const Index m = arc.points.cols();
    if (arc.length > 0 && m > 2) {
      // What the ends move by is spread along it: the more it moves the nearer the end.
      const Vector s = arc_lengths(arc.points) / arc.length;
      const Vector head = from - arc.points.col(0);
      const Vector tail = to - arc.points.col(m - 1);
      start = arc.points;
      for (Index j = 0; j < m; ++j) {
        const double share = std::clamp(s(j), 0.0, 1.0);
        start.col(j) += (1 - share) * head + share * tail;
      }
      start.col(0) = from;
      start.col(m - 1) = to;
    }
    return correct(start, arc);
  }

  [[nodiscard]] Vector at(const Arc& arc, double t) const {
    if (t <= 0 || arc.curve.num_elements() == 0) return arc.points.col(0);
    if (t >= 1) return arc.points.rightCols(1);
    // Between its nodes the polynomial is off the surface by its error.
    return project_to_surface(solver_.surface(), arc.curve.point(t * arc.curve.period())).point;
  }

  PathSolver& solver_;
  NewtonSolver newton_;
  const Context& context_;
  std::vector<Arc> base_;
  std::vector<std::vector<Arc>> levels_;
  Vector here_;
};

}  // namespace

BezierCurve bezier_curve(PathSolver& solver, const PointsIn& controls, Index num_points, const Context& context) {
  const Index d = solver.surface().dim();
  if (controls.rows() != d || controls.cols() < 2) {
    throw InvalidArgument(
        fmt::format("the control points ({} x {}) must be {} x n, n >= 2", controls.rows(), controls.cols(), d));
  }
  if (num_points < 2) throw InvalidArgument("a Bezier curve takes two points or more");
  BezierCurve result;
  Casteljau construction(solver, context);
  if (!construction.join(controls)) {
    result.status = construction.status;
    result.message = construction.message;
    return result;
  }
  // Ends move by at most `degree` times the longest path in all; a tenth of it a step keeps Newton's starts near.
  constexpr Index kStepsADegree = 10;
  const Index intervals = num_points - 1;
  const Index substeps = (kStepsADegree * (controls.cols() - 1) + intervals - 1) / intervals;
  result.points.resize(d, num_points);
  result.parameter = Vector::LinSpaced(num_points, 0, 1);
  result.points.col(0) = construction.first();
  Index done = 1;
  bool moved = true;
  for (; moved && done < num_points; ++done) {
    for (Index step = 1; moved && step <= substeps; ++step) {
      const double t = (static_cast<double>(done - 1) + static_cast<double>(step) / static_cast<double>(substeps)) /
                       static_cast<double>(intervals);
      // The last parameter is 1 exactly: arrived() is asked there.
      moved = construction.move_to(done == intervals && step == substeps ? 1 : t);
    }
    if (!moved) break;
    result.points.col(done) = construction.here();
    context.report("curve", static_cast<double>(done) / static_cast<double>(intervals));
  }
  result.points.conservativeResize(d, done);
  result.parameter.conservativeResize(done);
  if (done > 1) result.length = arc_lengths(result.points)(done - 1);
  result.status = moved ? Status::ok : construction.status;
  result.message = construction.message;
  result.unique = moved && construction.unique && construction.arrived();
  if (moved && !result.unique) {
    result.message = "the control points lie so far apart that another curve would be as right";
  }
  return result;
}

}  // namespace taut
