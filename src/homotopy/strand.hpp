#pragma once

#include <memory>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A polyline on a surface, dense enough to stand for a curve on it: which way round the surface a segment goes is in
/// no doubt.
struct Strand {
  Points points;        ///< d x n, on the surface, no two neighbours equal
  Points normals;       ///< d k x n: an orthonormal basis of the normal space at each, as project_to_surface gives it
  bool closed = false;  ///< the last point is joined to the first

  [[nodiscard]] Index num_points() const { return points.cols(); }
  [[nodiscard]] Index num_segments() const { return closed ? points.cols() : points.cols() - 1; }
  [[nodiscard]] Index after(Index i) const { return i + 1 < points.cols() ? i + 1 : 0; }
  [[nodiscard]] double segment(Index i) const { return (points.col(after(i)) - points.col(i)).norm(); }
  [[nodiscard]] double length() const;
  /// The points in order, the first again at the end of a closed one.
  [[nodiscard]] Points polyline() const;
};

/// Makes strands on one surface. One thread's.
class StrandMaker {
 public:
  /// `most_points`: a strand that needs more throws OutOfMemory.
  explicit StrandMaker(const Surface& surface, Index most_points = 2'000'000);

  /// `polyline` (d x m, finite), projected and cut until no segment is longer than `gap` and the normal turns by less
  /// than 0.35 radians along each. Throws InvalidArgument, naming the points (from 1), where a point lies more than
  /// `off` from the surface, or two neighbours are so far apart that it is not plain which way is meant.
  [[nodiscard]] Strand make(const PointsIn& polyline, bool closed, double gap, double off) const;

  /// Cuts the segments longer than `gap` or along which the normal turns by more than `turn`. Returns the first segment
  /// whose middle is not plain, or -1. Throws OutOfMemory.
  [[nodiscard]] Index refine(Strand& strand, double gap, double turn, std::vector<Index>* origin = nullptr) const;

  /// Projects points (d x n) in place and fills their normals. False for a point that found no surface within `off`.
  Eigen::Array<bool, Eigen::Dynamic, 1> project(Points& points, Points& normals, double off) const;

  /// True when points at equal parts of the lengths of two curves (d x m each, near the surface) are no farther apart
  /// than `distance` and their normals within 0.6 radians: then no handle is between them, and both are of one class.
  [[nodiscard]] bool is_near(const PointsIn& line, const PointsIn& curve, double distance) const;

  /// The largest angle between the normal spaces at two points (d k each), radians; pi where the orientation differs.
  [[nodiscard]] double turn(const VectorIn& a, const VectorIn& b) const;

  /// Points projected so far: what a budget of work is counted in.
  [[nodiscard]] Index num_projected() const { return num_projected_; }

 private:
  Index dim_;
  Index codim_;
  Index most_points_;
  std::unique_ptr<Evaluator> evaluator_;
  mutable Index num_projected_ = 0;
};

}  // namespace taut::detail
