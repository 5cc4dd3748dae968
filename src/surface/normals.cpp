#include "taut/surface/point_cloud.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surface/normals/face_normals.hpp"
#include "surface/normals/given_normals.hpp"
#include "surface/normals/neighbour_graph.hpp"
#include "surface/normals/orientation.hpp"
#include "surface/normals/sheet_split.hpp"
#include "surface/normals/spread_normals.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::KdTree;
using detail::MergedPoints;
using detail::Neighbour;

Points by_spread(const Points& points, const KdTree& tree, Index neighbours, const Context& context) {
  std::vector<Index> all(static_cast<std::size_t>(points.cols()));
  std::iota(all.begin(), all.end(), Index{0});
  const detail::SheetSplit split(points, tree, context);
  const detail::NeighbourGraph graph(points, tree, neighbours, context);
  Points normals;
  std::vector<Index> piece;
  if (split.any()) {
    // The other sheet is no noise, which more neighbours would average.
    normals = detail::least_spread(points, tree, all, neighbours, context);
    for (const Index i : all) {
      if (split.is_split(i)) normals.col(i) = split.normal(i);
    }
    piece = detail::orient_sheets(points, graph, split, normals);
  } else {
    const Index enough = detail::neighbours_for_noise(points, tree, neighbours, context);
    normals = detail::least_spread(points, tree, all, enough, context);
    piece = detail::orient_along_forest(points, graph, normals);
  }
  detail::turn_outwards(points, detail::local_spacing(points, tree, context), piece, normals);
  if (split.any()) detail::turn_from_opposite(points, split, piece, normals);
  return normals;
}

/// Gives the zero columns the mean of their nearest known neighbours, weighted by inverse distance.
void repair(const Points& points, Points& normals, const Context& context) {
  std::vector<Index> known;
  std::vector<Index> unknown;
  for (Index i = 0; i < normals.cols(); ++i) (normals.col(i).isZero(0) ? unknown : known).push_back(i);
  if (unknown.empty()) return;
  const Points known_points = points(Eigen::all, known);
  const KdTree tree(known_points);
  std::vector<Neighbour> found;
  for (const Index i : unknown) {
    tree.nearest(points.col(i).data(), 6, found);
    Vector mean = Vector::Zero(points.rows());
    for (const Neighbour& q : found) {
      mean += normals.col(known[static_cast<std::size_t>(q.index)]) / std::sqrt(q.squared_distance);
    }
    if (!(mean.norm() > 0)) mean = normals.col(known[static_cast<std::size_t>(found.front().index)]);
    normals.col(i) = mean.normalized();
  }
  context.tell(std::to_string(unknown.size()) + " points without a usable normal took that of their neighbours");
}

/// Normals and faces that belong to the points.
void require_consistent(const PointCloud& cloud) {
  if (cloud.normals.cols() > 0 && (cloud.normals.rows() != cloud.dim() || cloud.normals.cols() != cloud.size())) {
    throw InvalidArgument("the normals are " + std::to_string(cloud.normals.rows()) + " x " +
                          std::to_string(cloud.normals.cols()) + ", the points " + std::to_string(cloud.dim()) + " x " +
                          std::to_string(cloud.size()));
  }
  for (Index f = 0; f < cloud.faces.cols(); ++f) {
    for (const int vertex : cloud.faces.col(f)) {
      if (vertex >= 0 && vertex < cloud.size()) continue;
      throw InvalidArgument("face " + std::to_string(f) + " names point " + std::to_string(vertex) + " of " +
                            std::to_string(cloud.size()));
    }
  }
}

}  // namespace

Points estimate_normals(const PointCloud& cloud, Index neighbours, const Context& context) {
  const Index d = cloud.dim();
  detail::require_finite(cloud.points, "point");
  require_consistent(cloud);
  const MergedPoints merged = detail::merge_duplicates(cloud.points);
  const Index rank = detail::affine_rank(merged.points);
  if (d < 2 || rank < d - 1) {
    const Index count = merged.points.cols();
    const bool could_be_reduced = d > 3 && rank >= 2;
    throw InvalidArgument(std::to_string(count) + (count == 1 ? " different point in " : " different points in ") +
                          std::to_string(d) + " dimensions span only " + std::to_string(rank) +
                          (rank == 1 ? " direction (they lie on a line)" : " directions") + ": a surface needs " +
                          std::to_string(std::max<Index>(d - 1, 1)) +
                          (could_be_reduced ? "; a fit is a hypersurface: reduce the dimension of the points first"
                                            : (count == 1 ? "; give more points" : "")));
  }
  const KdTree tree(merged.points);
  const Index enough = std::max<Index>(neighbours, 2 * d);
  std::optional<Points> normals;
  if (cloud.has_normals()) {
    normals = detail::checked_normals(cloud, merged, tree, enough, context);
  } else if (d == 3 && cloud.faces.cols() > 0) {
    normals = detail::face_normals(cloud, merged, context);
  }
  if (!normals || normals->isZero(0)) {
    normals = by_spread(merged.points, tree, enough, context);
  } else {
    repair(merged.points, *normals, context);
  }
  return (*normals)(Eigen::all, merged.merged_to);
}

}  // namespace taut
