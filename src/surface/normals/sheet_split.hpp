#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "surface/normals/neighbour_graph.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Two sheets side by side, nearer to each other than the samples on each are (the faces of a plate, the turns of a
/// tight roll): which of a sample's nearest lie on the other one, where that can be told. In the plane and in space;
/// in more dimensions nothing is found.
class SheetSplit {
 public:
  SheetSplit(const Points& points, const KdTree& tree, const Context& context);

  /// Was a second sheet found beside any sample.
  [[nodiscard]] bool any() const { return !found_.empty(); }
  [[nodiscard]] Index num_split() const { return static_cast<Index>(found_.size()); }
  [[nodiscard]] bool is_split(Index i) const { return slot_[static_cast<std::size_t>(i)] >= 0; }
  /// The normal at sample i, which is split, by the samples of both sheets; its sign is arbitrary.
  [[nodiscard]] Vector normal(Index i) const { return at(i).normal; }
  /// The nearest samples of sample i, which is split, that lie on its own sheet.
  [[nodiscard]] std::vector<Index> beside(Index i) const;
  /// The nearest sample on the other sheet, i being split.
  [[nodiscard]] Index opposite(Index i) const { return static_cast<Index>(at(i).opposite); }

  enum class Relation : std::uint8_t {
    unknown,  ///< neither end is split, or the ends contradict each other
    within,   ///< both ends see the other on their own sheet
    across,   ///< both see it on another one
    perhaps_within,
    perhaps_across,  ///< one end sees it so, the other sees nothing
  };
  [[nodiscard]] Relation relation(NeighbourGraph::Edge edge) const;

  static constexpr int kNearest = 24;

 private:
  struct Found {
    std::array<std::uint32_t, kNearest> near{};
    std::uint32_t across = 0;  // bit j: near[j] lies on the other sheet
    std::uint32_t opposite = 0;
    Vector normal;
  };
  [[nodiscard]] const Found& at(Index i) const {
    return found_[static_cast<std::size_t>(slot_[static_cast<std::size_t>(i)])];
  }
  [[nodiscard]] Relation as_seen_from(std::uint32_t i, std::uint32_t j) const;
  void find(const Points& points, const KdTree& tree, const Context& context);

  std::vector<std::int32_t> slot_;  // of each sample in found_, or -1
  std::vector<Found> found_;
};

}  // namespace taut::detail
