#include "surface/local_fit/patch_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut::detail {
namespace {

/// A cube that this many balls meet is not divided: looking at sixteen centres costs about what another level does.
constexpr std::size_t kFewPatches = 16;
/// Nor is one whose edge is below this part of the least radius in it: its pieces would meet the same balls.
constexpr double kSmallEdge = 0.35;
constexpr int kMaxDepth = 32;

/// Does the closed ball meet the cube?
template <int D>
bool meets(const Patch<D>& patch, const std::array<double, D>& lower, double edge) {
  double squared = 0;
  for (std::size_t a = 0; a < D; ++a) {
    const double below = lower[a] - patch.centre[a];
    const double above = patch.centre[a] - (lower[a] + edge);
    const double off = std::max({below, above, 0.0});
    squared += off * off;
  }
  // A hair more: at() decides by comparing coordinates, which round otherwise.
  constexpr double kHair = 1 + 1e-12;
  return squared <= kHair * patch.radius * patch.radius;
}

}  // namespace

template <int D>
PatchTree<D>::PatchTree(const std::vector<Patch<D>>& patches) {
  nodes_.emplace_back();
  if (patches.empty()) return;
  Corner upper{};
  lower_.fill(HUGE_VAL);
  upper.fill(-HUGE_VAL);
  for (const Patch<D>& patch : patches) {
    for (std::size_t a = 0; a < D; ++a) {
      lower_[a] = std::min(lower_[a], patch.centre[a] - patch.radius);
      upper[a] = std::max(upper[a], patch.centre[a] + patch.radius);
    }
  }
  for (std::size_t a = 0; a < D; ++a) edge_ = std::max(edge_, upper[a] - lower_[a]);
  std::vector<std::uint32_t> all(patches.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<std::uint32_t>(i);
  grow(0, lower_, edge_, 0, std::move(all), patches);
}

template <int D>
auto PatchTree<D>::child_corner(const Corner& lower, double half, std::size_t child) -> Corner {
  Corner corner = lower;
  for (std::size_t a = 0; a < D; ++a) {
    if ((child >> a & 1U) != 0) corner[a] += half;
  }
  return corner;
}

template <int D>
void PatchTree<D>::grow(std::size_t node, const Corner& lower, double edge, int depth,
                        std::vector<std::uint32_t> candidates, const std::vector<Patch<D>>& patches) {
  double smallest = HUGE_VAL;
  for (const std::uint32_t i : candidates) smallest = std::min(smallest, patches[i].radius);
  if (candidates.size() <= kFewPatches || edge <= kSmallEdge * smallest || depth >= kMaxDepth) {
    nodes_[node] = {static_cast<std::uint32_t>(lists_.size()), static_cast<std::uint32_t>(candidates.size())};
    lists_.insert(lists_.end(), candidates.begin(), candidates.end());
    return;
  }
  const std::size_t first = nodes_.size();
  nodes_[node] = {static_cast<std::uint32_t>(first), kInner};
  nodes_.resize(first + kChildren);
  for (std::size_t child = 0; child < kChildren; ++child) {
    const Corner corner = child_corner(lower, 0.5 * edge, child);
    std::vector<std::uint32_t> inside;
    for (const std::uint32_t i : candidates) {
      if (meets<D>(patches[i], corner, 0.5 * edge)) inside.push_back(i);
    }
    grow(first + child, corner, 0.5 * edge, depth + 1, std::move(inside), patches);
  }
}

template <int D>
std::span<const std::uint32_t> PatchTree<D>::at(const double* x) const {
  Corner lower = lower_;
  double edge = edge_;
  for (std::size_t a = 0; a < D; ++a) {
    if (!(x[a] >= lower[a] && x[a] <= lower[a] + edge)) return {};
  }
  std::size_t node = 0;
  while (nodes_[node].count == kInner) {
    edge *= 0.5;
    std::size_t child = 0;
    for (std::size_t a = 0; a < D; ++a) {
      const double middle = lower[a] + edge;
      if (x[a] >= middle) {
        child |= std::size_t{1} << a;
        lower[a] = middle;
      }
    }
    node = nodes_[node].first + child;
  }
  return {lists_.data() + nodes_[node].first, nodes_[node].count};
}

template <int D>
bool PatchTree<D>::collect(std::size_t node, const Corner& lower, double edge, const double* box_lower,
                           const double* box_upper, std::size_t most, std::vector<std::uint32_t>& out) const {
  for (std::size_t a = 0; a < D; ++a) {
    if (box_lower[a] > lower[a] + edge || box_upper[a] < lower[a]) return true;
  }
  if (nodes_[node].count != kInner) {
    const auto begin = lists_.begin() + nodes_[node].first;
    out.insert(out.end(), begin, begin + nodes_[node].count);
    return out.size() <= most;
  }
  for (std::size_t child = 0; child < kChildren; ++child) {
    if (!collect(nodes_[node].first + child, child_corner(lower, 0.5 * edge, child), 0.5 * edge, box_lower, box_upper,
                 most, out)) {
      return false;
    }
  }
  return true;
}

template <int D>
bool PatchTree<D>::within(const double* lower, const double* upper, std::size_t most,
                          std::vector<std::uint32_t>& out) const {
  return collect(0, lower_, edge_, lower, upper, most, out);
}

template class PatchTree<2>;
template class PatchTree<3>;

}  // namespace taut::detail
