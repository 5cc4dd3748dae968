#include "surface/rbf/stabbed_balls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace taut::detail {
namespace {

/// Balls in a leaf: looking at eight centres costs about what another level does.
constexpr Index kLeaf = 8;
/// The tree is halved at each level, so that this is deep enough for any number of balls.
constexpr std::size_t kDeepest = 64;
/// A hair more: coordinates are compared that round otherwise.
constexpr double kHair = 1 + 1e-12;

}  // namespace

StabbedBalls::StabbedBalls(const Points& centres, Vector radius)
    : centres_(centres), radius_(std::move(radius)), order_(static_cast<std::size_t>(centres.cols())) {
  std::iota(order_.begin(), order_.end(), Index{0});
  if (!order_.empty()) (void)grow(0, centres.cols());
}

Index StabbedBalls::grow(Index first, Index last) {
  const auto node = static_cast<Index>(nodes_.size());
  nodes_.push_back({first, last, -1, 0});
  const Index d = centres_.rows();
  Vector lower = centres_.col(order_[static_cast<std::size_t>(first)]);
  Vector upper = lower;
  double most = 0;
  for (Index k = first; k < last; ++k) {
    const Index i = order_[static_cast<std::size_t>(k)];
    lower = lower.cwiseMin(centres_.col(i));
    upper = upper.cwiseMax(centres_.col(i));
    most = std::max(most, radius_(i));
  }
  nodes_.back().most = most;
  corners_.insert(corners_.end(), lower.data(), lower.data() + d);
  corners_.insert(corners_.end(), upper.data(), upper.data() + d);
  if (last - first <= kLeaf) return node;
  Index axis = 0;
  (upper - lower).maxCoeff(&axis);
  const Index middle = first + (last - first) / 2;
  const auto before = [&](Index i, Index j) {
    return centres_(axis, i) != centres_(axis, j) ? centres_(axis, i) < centres_(axis, j) : i < j;
  };
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, before);
  (void)grow(first, middle);
  const Index right = grow(middle, last);
  nodes_[static_cast<std::size_t>(node)].right = right;
  return node;
}

double StabbedBalls::squared_to_box(Index node, const double* lower, const double* upper) const {
  const Index d = centres_.rows();
  const double* corner = corners_.data() + 2 * d * node;
  double sum = 0;
  for (Index a = 0; a < d; ++a) {
    const double off = std::max({corner[a] - upper[a], lower[a] - corner[d + a], 0.0});
    sum += off * off;
  }
  return sum;
}

double StabbedBalls::squared_to(Index i, const double* lower, const double* upper) const {
  double sum = 0;
  for (Index a = 0; a < centres_.rows(); ++a) {
    const double off = std::max({centres_(a, i) - upper[a], lower[a] - centres_(a, i), 0.0});
    sum += off * off;
  }
  return sum;
}

void StabbedBalls::stabbed(const double* x, std::vector<Index>& out) const {
  (void)near_box(x, x, std::numeric_limits<std::size_t>::max(), out);
}

bool StabbedBalls::near_box(const double* lower, const double* upper, std::size_t most, std::vector<Index>& out) const {
  out.clear();
  for (Index a = 0; a < centres_.rows(); ++a) {
    if (std::isnan(lower[a]) || std::isnan(upper[a])) return true;
  }
  std::array<Index, kDeepest> open{};
  std::size_t count = 0;
  if (!nodes_.empty()) open[count++] = 0;
  while (count > 0) {
    const Index at = open[--count];
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (squared_to_box(at, lower, upper) > kHair * node.most * node.most) continue;
    if (node.right >= 0) {
      open[count++] = node.right;
      open[count++] = at + 1;
      continue;
    }
    for (Index k = node.first; k < node.last; ++k) {
      const Index i = order_[static_cast<std::size_t>(k)];
      if (squared_to(i, lower, upper) > kHair * radius_(i) * radius_(i)) continue;
      if (out.size() == most) return false;
      out.push_back(i);
    }
  }
  return true;
}

Index StabbedBalls::nearest(const double* x) const {
  Index best = -1;
  double least = std::numeric_limits<double>::infinity();
  struct Open {
    Index node;
    double squared;
  };
  std::array<Open, kDeepest> open{};
  std::size_t count = 0;
  if (!nodes_.empty()) open[count++] = {0, squared_to_box(0, x, x)};
  while (count > 0) {
    const Open next = open[--count];
    if (!(next.squared <= least)) continue;  // for NaN, too
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.right >= 0) {
      Open near{next.node + 1, squared_to_box(next.node + 1, x, x)};
      Open far{node.right, squared_to_box(node.right, x, x)};
      if (far.squared < near.squared) std::swap(near, far);
      open[count++] = far;
      open[count++] = near;
      continue;
    }
    for (Index k = node.first; k < node.last; ++k) {
      const Index i = order_[static_cast<std::size_t>(k)];
      const double squared = squared_to(i, x, x);
      if (squared < least || (squared == least && i < best)) {
        least = squared;
        best = i;
      }
    }
  }
  return best;
}

}  // namespace taut::detail
