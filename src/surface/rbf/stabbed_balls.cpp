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
  ordered_ = centres_(Eigen::all, order_);
  reach2_.resize(centres.cols());
  for (Index k = 0; k < centres.cols(); ++k) {
    const double r = radius_(order_[static_cast<std::size_t>(k)]);
    reach2_(k) = kHair * r * r;
  }
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

template <int D>
double StabbedBalls::squared_to_box(Index node, const double* lower, const double* upper) const {
  const Index d = D > 0 ? D : centres_.rows();
  const double* corner = corners_.data() + 2 * d * node;
  double sum = 0;
  for (Index a = 0; a < d; ++a) {
    const double off = std::max({corner[a] - upper[a], lower[a] - corner[d + a], 0.0});
    sum += off * off;
  }
  return sum;
}

/// From the k-th centre in the order of the leaves.
template <int D>
double StabbedBalls::squared_to(Index k, const double* lower, const double* upper) const {
  const Index d = D > 0 ? D : centres_.rows();
  const double* const x = ordered_.data() + d * k;
  double sum = 0;
  for (Index a = 0; a < d; ++a) {
    const double off = std::max({x[a] - upper[a], lower[a] - x[a], 0.0});
    sum += off * off;
  }
  return sum;
}

void StabbedBalls::stabbed(const double* x, std::vector<Index>& out) const {
  (void)near_box(x, x, std::numeric_limits<std::size_t>::max(), out);
}

bool StabbedBalls::near_box(const double* lower, const double* upper, std::size_t most, std::vector<Index>& out) const {
  return centres_.rows() == 3 ? near_box_in<3>(lower, upper, most, out) : near_box_in<0>(lower, upper, most, out);
}

template <int D>
bool StabbedBalls::near_box_in(const double* lower, const double* upper, std::size_t most,
                               std::vector<Index>& out) const {
  out.clear();
  for (Index a = 0; a < centres_.rows(); ++a) {
    if (std::isnan(lower[a]) || std::isnan(upper[a])) return true;
  }
  const auto reached = [&](Index node) {
    const double most_radius = nodes_[static_cast<std::size_t>(node)].most;
    return !(squared_to_box<D>(node, lower, upper) > kHair * most_radius * most_radius);
  };
  std::array<Index, kDeepest> open{};
  std::size_t count = 0;
  if (!nodes_.empty() && reached(0)) open[count++] = 0;
  while (count > 0) {
    const Index at = open[--count];
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (node.right >= 0) {
      if (reached(node.right)) open[count++] = node.right;
      if (reached(at + 1)) open[count++] = at + 1;
      continue;
    }
    for (Index k = node.first; k < node.last; ++k) {
      if (squared_to<D>(k, lower, upper) > reach2_(k)) continue;
      if (out.size() == most) return false;
      out.push_back(order_[static_cast<std::size_t>(k)]);
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
  if (!nodes_.empty()) open[count++] = {0, squared_to_box<0>(0, x, x)};
  while (count > 0) {
    const Open next = open[--count];
    if (!(next.squared <= least)) continue;  // for NaN, too
    const Node& node = nodes_[static_cast<std::size_t>(next.node)];
    if (node.right >= 0) {
      Open near{next.node + 1, squared_to_box<0>(next.node + 1, x, x)};
      Open far{node.right, squared_to_box<0>(node.right, x, x)};
      if (far.squared < near.squared) std::swap(near, far);
      open[count++] = far;
      open[count++] = near;
      continue;
    }
    for (Index k = node.first; k < node.last; ++k) {
      const Index i = order_[static_cast<std::size_t>(k)];
      const double squared = squared_to<0>(k, x, x);
      if (squared < least || (squared == least && i < best)) {
        least = squared;
        best = i;
      }
    }
  }
  return best;
}

}  // namespace taut::detail
