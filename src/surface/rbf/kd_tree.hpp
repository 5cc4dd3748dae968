#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// A sample and its squared distance.
struct Neighbour {
  Index index = 0;
  double squared_distance = 0;
};

/// Nearest-neighbour queries on d x n points, which must outlive the tree. Ties are broken by the smaller index, so
/// answers do not depend on how the tree was built. Safe to query from several threads.
class KdTree {
 public:
  explicit KdTree(const Points& points);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  [[nodiscard]] Neighbour nearest(const double* x) const;
  /// The min(k, n) nearest, nearest first.
  void nearest(const double* x, Index k, std::vector<Neighbour>& out) const;
  /// All at a distance of at most `radius`, nearest first.
  void within(const double* x, double radius, std::vector<Neighbour>& out) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut::detail
