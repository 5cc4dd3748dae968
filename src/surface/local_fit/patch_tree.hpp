#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "surface/local_fit/cubic.hpp"

namespace taut::detail {

/// Which balls hold a point: a tree of cubes halved in each direction (a quadtree, an octree) until few balls meet a
/// cube or it is small beside them. O(log n) for a point, whatever the number of balls; memory O(n).
template <int D>
class PatchTree {
 public:
  explicit PatchTree(const std::vector<Patch<D>>& patches);

  /// Patches whose balls may hold x, ascending: some that do not among them, none that does missing. Empty for NaN.
  [[nodiscard]] std::span<const std::uint32_t> at(const double* x) const;

  /// Appends the patches whose balls may meet the box, each at least once. Gives up and returns false beyond `most`.
  [[nodiscard]] bool within(const double* lower, const double* upper, std::size_t most,
                            std::vector<std::uint32_t>& out) const;

 private:
  using Corner = std::array<double, D>;
  static constexpr std::size_t kChildren = std::size_t{1} << D;

  struct Node {
    std::uint32_t first = 0;  // of the children in nodes_, or of the patches in lists_
    std::uint32_t count = 0;  // patches; kInner = has children
  };
  static constexpr std::uint32_t kInner = 0xFFFFFFFFU;

  void grow(std::size_t node, const Corner& lower, double edge, int depth, std::vector<std::uint32_t> candidates,
            const std::vector<Patch<D>>& patches);
  [[nodiscard]] bool collect(std::size_t node, const Corner& lower, double edge, const double* box_lower,
                             const double* box_upper, std::size_t most, std::vector<std::uint32_t>& out) const;
  static Corner child_corner(const Corner& lower, double half, std::size_t child);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> lists_;
  Corner lower_{};
  double edge_ = 0;
};

}  // namespace taut::detail
