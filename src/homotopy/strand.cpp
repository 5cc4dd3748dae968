// Dense polylines on a surface. A segment is plain if its middle projects close by and the normal turns moderately
// along it: then there is one way over the surface between its ends. Cutting goes on until all are plain and short, or
// one is not plain: which way is meant there, the polyline does not say.
#include "homotopy/strand.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/linear_algebra.hpp"
#include "curve/polyline.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

constexpr double kPlainTurn = 1.75;  // beyond a right angle and a bit, a segment may go either way round
constexpr double kFineTurn = 0.35;
constexpr double kNearTurn = 0.6;
/// The middle of an arc over a right angle moves by 0.21 of its chord, and its halves are 0.54 of it.
constexpr double kMostMoved = 0.4;
constexpr double kLongestHalf = 0.85;
/// At a crease the normal turns however short the segments: they are not cut below this part of the gap.
constexpr double kShortest = 1e-3;

}  // namespace

double Strand::length() const {
  double sum = 0;
  for (Index i = 0; i < num_segments(); ++i) sum += segment(i);
  return sum;
}

Points Strand::polyline() const {
  if (!closed) return points;
  Points line(points.rows(), points.cols() + 1);
  line << points, points.col(0);
  return line;
}

StrandMaker::StrandMaker(const Surface& surface, Index most_points)
    : dim_(surface.dim()), codim_(surface.codim()), most_points_(most_points), evaluator_(surface.make_evaluator()) {}

Eigen::Array<bool, Eigen::Dynamic, 1> StrandMaker::project(Points& points, Points& normals, double off) const {
  Eigen::MatrixXd basis;
  num_projected_ += points.cols();
  const auto found = project_to_surface(*evaluator_, dim_, codim_, points, {.max_distance = off}, &basis);
  normals = std::move(basis);
  return found;
}

double StrandMaker::turn(const VectorIn& a, const VectorIn& b) const {
  const Eigen::Map<const Eigen::MatrixXd> na(a.data(), dim_, codim_);
  const Eigen::Map<const Eigen::MatrixXd> nb(b.data(), dim_, codim_);
  if (codim_ == 1) return std::acos(std::clamp(na.col(0).dot(nb.col(0)), -1.0, 1.0));
  const Eigen::MatrixXd overlap = na.transpose() * nb;
  const auto k = static_cast<double>(codim_);
  const double squared = overlap.squaredNorm();
  const double sines = k - squared;  // squared, of all principal angles
  // |N_a - N_b|^2 in short: are the bases themselves alike, and not only the spaces.
  const bool near = squared - 2 * overlap.trace() + k < 1;
  // Small angles, by far the most: the root of the sum of squares bounds the largest, without a decomposition.
  if (near && sines < 0.02) return std::sqrt(std::max(0.0, sines));
  if (!near && !(determinant(overlap) > 0)) return std::numbers::pi;
  const Vector cosines = singular_values(overlap);
  return std::acos(std::clamp(cosines.minCoeff(), -1.0, 1.0));
}

bool StrandMaker::is_near(const PointsIn& line, const PointsIn& curve, double distance) const {
  const double stretch = polyline_length(curve) / std::max(polyline_length(line), 1e-300);
  std::vector<double> arcs(1, 0.0);
  for (Index i = 1; i < line.cols(); ++i) {
    // At equal parts of both lengths, not at the nearest points: those would hide a loop more or less.
    arcs.push_back(arcs.back() + stretch * (line.col(i) - line.col(i - 1)).norm());
  }
  Points along = at_arc_lengths(curve, arcs);
  Points beside = line;
  Points normals;
  Points others;
  if (!project(along, normals, distance).all() || !project(beside, others, distance).all()) return false;
  for (Index i = 0; i < line.cols(); ++i) {
    if ((along.col(i) - beside.col(i)).norm() > distance) return false;
    if (turn(normals.col(i), others.col(i)) > kNearTurn) return false;
  }
  return true;
}

Index StrandMaker::refine(Strand& strand, double gap, double most_turn, std::vector<Index>* origin) const {
  while (true) {
    const Index n = strand.num_points();
    const Index m = strand.num_segments();
    std::vector<Index> cut;
    for (Index i = 0; i < m; ++i) {
      const double length = strand.segment(i);
      const double angle = turn(strand.normals.col(i), strand.normals.col(strand.after(i)));
      // Cutting would not help: the halves turn one way or the other.
      if (angle > kPlainTurn) return i;
      if (length > gap || (angle > most_turn && length > kShortest * gap)) cut.push_back(i);
    }
    if (cut.empty()) return -1;
    const auto added = static_cast<Index>(cut.size());
    if (n + added > most_points_) {
      throw OutOfMemory(fmt::format("the polyline needs more than {} points on this surface", most_points_));
    }
    Points middle(dim_, added);
    for (Index c = 0; c < added; ++c) {
      const Index i = cut[static_cast<std::size_t>(c)];
      middle.col(c) = (strand.points.col(i) + strand.points.col(strand.after(i))) / 2;
    }
    Points on = middle;
    Points normals;
    const auto found = project(on, normals, std::numeric_limits<double>::infinity());
    for (Index c = 0; c < added; ++c) {
      const Index i = cut[static_cast<std::size_t>(c)];
      const double length = strand.segment(i);
      const double half =
          std::max((on.col(c) - strand.points.col(i)).norm(), (on.col(c) - strand.points.col(strand.after(i))).norm());
      const bool plain =
          found(c) && (on.col(c) - middle.col(c)).norm() <= kMostMoved * length && half <= kLongestHalf * length;
      if (!plain) return i;
    }
    Strand finer{Points(dim_, n + added), Points(dim_ * codim_, n + added), strand.closed};
    std::vector<Index> new_origin;
    Index next = 0;
    Index c = 0;
    for (Index i = 0; i < n; ++i) {
      finer.points.col(next) = strand.points.col(i);
      finer.normals.col(next++) = strand.normals.col(i);
      if (origin != nullptr && i < m) new_origin.push_back((*origin)[static_cast<std::size_t>(i)]);
      if (c == added || cut[static_cast<std::size_t>(c)] != i) continue;
      finer.points.col(next) = on.col(c);
      finer.normals.col(next++) = normals.col(c++);
      if (origin != nullptr) new_origin.push_back((*origin)[static_cast<std::size_t>(i)]);
    }
    strand = std::move(finer);
    if (origin != nullptr) *origin = std::move(new_origin);
  }
}

Strand StrandMaker::make(const PointsIn& polyline, bool closed, double gap, double off) const {
  Points points = polyline;
  Points normals;
  const auto found = project(points, normals, off);
  for (Index j = 0; j < points.cols(); ++j) {
    if (!found(j)) {
      throw InvalidArgument(fmt::format(
          "point {} of the polyline: no regular point of the surface was found within {:.3g} of it", j + 1, off));
    }
  }
  Strand strand{Points(dim_, points.cols()), Points(dim_ * codim_, points.cols()), closed};
  std::vector<Index> origin;
  for (Index j = 0; j < points.cols(); ++j) {
    const auto count = static_cast<Index>(origin.size());
    if (count > 0 && points.col(j) == strand.points.col(count - 1)) continue;
    strand.points.col(count) = points.col(j);
    strand.normals.col(count) = normals.col(j);
    origin.push_back(j);
  }
  auto count = static_cast<Index>(origin.size());
  // A loop may be written with its first point again at the end.
  const double same = 1e-12 * points.cwiseAbs().maxCoeff();
  while (closed && count > 1 && (strand.points.col(count - 1) - strand.points.col(0)).norm() <= same) --count;
  strand.points.conservativeResize(Eigen::NoChange, count);
  strand.normals.conservativeResize(Eigen::NoChange, count);
  if (count == 1) return strand;
  origin.resize(static_cast<std::size_t>(strand.num_segments()));
  const Index doubtful = refine(strand, gap, kFineTurn, &origin);
  if (doubtful >= 0) {
    const Index first = origin[static_cast<std::size_t>(doubtful)];
    Index second = first + 1;
    while (second < points.cols() && points.col(second) == points.col(first)) ++second;
    second %= points.cols();
    throw InvalidArgument(
        fmt::format("points {} and {} of the polyline are too far apart to tell which way over the surface is meant "
                    "between them; put more points there",
                    first + 1, second + 1));
  }
  return strand;
}

}  // namespace taut::detail
