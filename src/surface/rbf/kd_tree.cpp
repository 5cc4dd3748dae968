#include "surface/rbf/kd_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nanoflann.hpp>

namespace taut::detail {
namespace {

struct PointsView {
  const Points& points;
  [[nodiscard]] std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.cols()); }
  [[nodiscard]] double kdtree_get_pt(std::size_t i, std::size_t axis) const {
    return points(static_cast<Index>(axis), static_cast<Index>(i));
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;
  }
};

/// Dim = -1: any. Compiled for the plane and space, a query takes two thirds of the time.
template <int Dim>
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointsView>, PointsView, Dim, Index>;

bool closer(const Neighbour& a, const Neighbour& b) {
  return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.index < b.index;
}

// Result sets of our own: nanoflann's break ties by the order in which the tree is walked. Newer versions of it ask for
// sort().
struct NearestSet {
  using DistanceType = double;
  std::vector<Neighbour>& found;
  std::size_t capacity;
  [[nodiscard]] bool full() const { return found.size() == capacity; }
  // A hair above the worst distance, so that ties are still visited.
  [[nodiscard]] double worstDist() const {
    return full() ? std::nextafter(found.back().squared_distance, std::numeric_limits<double>::infinity())
                  : std::numeric_limits<double>::max();
  }
  bool addPoint(double squared_distance, Index index) {
    const Neighbour candidate{index, squared_distance};
    if (full()) {
      if (!closer(candidate, found.back())) return true;
      found.pop_back();
    }
    found.insert(std::upper_bound(found.begin(), found.end(), candidate, closer), candidate);
    return true;
  }
  void sort() {}
};

struct WithinSet {
  using DistanceType = double;
  std::vector<Neighbour>& found;
  double squared_radius;
  [[nodiscard]] bool full() const { return true; }
  [[nodiscard]] double worstDist() const {
    return std::nextafter(squared_radius, std::numeric_limits<double>::infinity());
  }
  bool addPoint(double squared_distance, Index index) {
    if (squared_distance <= squared_radius) found.push_back({index, squared_distance});
    return true;
  }
  void sort() { std::sort(found.begin(), found.end(), closer); }
};

}  // namespace

struct KdTree::Impl {
  explicit Impl(const Points& points) : view{points} {
    const auto dim = static_cast<int>(points.rows());
    const nanoflann::KDTreeSingleIndexAdaptorParams params(kLeafSize);
    if (dim == 2) {
      in_plane = std::make_unique<Tree<2>>(dim, view, params);
    } else if (dim == 3) {
      in_space = std::make_unique<Tree<3>>(dim, view, params);
    } else {
      in_any = std::make_unique<Tree<-1>>(dim, view, params);
    }
  }
  template <class Set>
  void find(Set& set, const double* x) const {
    if (in_plane) {
      in_plane->findNeighbors(set, x, {});
    } else if (in_space) {
      in_space->findNeighbors(set, x, {});
    } else {
      in_any->findNeighbors(set, x, {});
    }
  }

  static constexpr std::size_t kLeafSize = 12;
  PointsView view;
  // One of them.
  std::unique_ptr<Tree<2>> in_plane;
  std::unique_ptr<Tree<3>> in_space;
  std::unique_ptr<Tree<-1>> in_any;
};

KdTree::KdTree(const Points& points) : impl_(std::make_unique<Impl>(points)) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

Neighbour KdTree::nearest(const double* x) const {
  thread_local std::vector<Neighbour> found;
  nearest(x, 1, found);
  // Nothing compares as near to a NaN.
  return found.empty() ? Neighbour{0, std::numeric_limits<double>::quiet_NaN()} : found.front();
}

void KdTree::nearest(const double* x, Index k, std::vector<Neighbour>& out) const {
  out.clear();
  NearestSet set{out, static_cast<std::size_t>(std::min<Index>(k, impl_->view.points.cols()))};
  if (set.capacity > 0) impl_->find(set, x);
}

void KdTree::within(const double* x, double radius, std::vector<Neighbour>& out) const {
  out.clear();
  WithinSet set{out, radius * radius};
  impl_->find(set, x);
  set.sort();
}

}  // namespace taut::detail
