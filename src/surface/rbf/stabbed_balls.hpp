#pragma once

#include <cstddef>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Balls of different sizes around points, and which of them hold a point: a tree of boxes around the centres, each
/// with its largest radius. Answers come in an order that depends on the balls alone. Safe to query from several
/// threads.
class StabbedBalls {
 public:
  /// `centres` (d x n) must outlive this; `radius`: n.
  StabbedBalls(const Points& centres, Vector radius);

  [[nodiscard]] double radius(Index i) const { return radius_(i); }
  /// All balls that hold x.
  void stabbed(const double* x, std::vector<Index>& out) const;
  /// All balls that meet the box. False where they are more than `most`: then some of them.
  [[nodiscard]] bool near_box(const double* lower, const double* upper, std::size_t most,
                              std::vector<Index>& out) const;
  /// The nearest centre; -1 for NaN.
  [[nodiscard]] Index nearest(const double* x) const;

 private:
  struct Node {
    Index first = 0;  // of order_
    Index last = 0;
    Index right = -1;  // the left child comes next; -1: a leaf
    double most = 0;   // the largest radius
  };
  Index grow(Index first, Index last);
  // D: the dimension, 0 = whatever it is.
  template <int D>
  [[nodiscard]] bool near_box_in(const double* lower, const double* upper, std::size_t most,
                                 std::vector<Index>& out) const;
  template <int D>
  [[nodiscard]] double squared_to_box(Index node, const double* lower, const double* upper) const;
  template <int D>
  [[nodiscard]] double squared_to(Index k, const double* lower, const double* upper) const;

  const Points& centres_;
  Vector radius_;
  std::vector<Index> order_;
  Points ordered_;  // the centres in that order, and how far they reach, squared: leaves read them in a row
  Vector reach2_;
  std::vector<Node> nodes_;
  std::vector<double> corners_;  // of a node's box: lower d, upper d
};

}  // namespace taut::detail
