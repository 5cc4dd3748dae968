#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "strata/faceted_surface.hpp"

namespace taut::detail {

/// A point of a face, an edge or a corner.
struct FacetNode {
  Point3 x;
  std::vector<int> faces;  ///< that it lies on, ascending
  int edge = -1;           ///< of which it is an inner point
  bool corner = false;
  std::vector<int> reflex = {};  ///< faces that a corner reaches into: they have more than 180 degrees there
};

/// A step from a node to another one over faces that both lie on.
struct FacetLink {
  std::uint32_t to = 0;
  float length = std::numeric_limits<float>::infinity();
  std::uint32_t faces = 0;  ///< bit i: over the i-th face of the node that it leaves
};

/// The steps between pairs of nodes, each infinite where there is none. More faces at one point than a link has bits
/// are not walked on.
class FacetSteps {
 public:
  /// A step may be longer than its chord by this: a quarter circle is by 1.11.
  static constexpr double kLongStep = 1.3;

  /// About so many steps will be added.
  FacetSteps(FacetedSurface& surface, std::size_t expected) : surface_(surface) { links_.reserve(expected); }

  /// The step from a to b will be `links()[n]`, n the number of calls before. The nodes must stay.
  void add(const FacetNode& a, const FacetNode& b);
  /// All of them: tried in blocks of one face.
  [[nodiscard]] std::vector<FacetLink> links();

 private:
  /// Over one face.
  struct Trial {
    std::uint32_t link;
    std::uint32_t bit;
    const FacetNode* a;
    const FacetNode* b;
  };
  void try_block(int face);

  FacetedSurface& surface_;
  std::vector<FacetLink> links_;
  std::vector<std::vector<Trial>> trials_;  // by face: not tried yet
};

/// One step.
[[nodiscard]] FacetLink step_between(FacetedSurface& surface, const FacetNode& a, const FacetNode& b);

}  // namespace taut::detail
