#pragma once

namespace taut::detail {

/// What counts as equal along a broken geodesic. Lengths are relative to the model (`FacetedSurface::scale`).
struct ChainTolerances {
  static constexpr double together = 1e-9;  ///< stops closer than this are one
  /// A stop at the end of its edge and a corner as close are one: an edge's end is found to the root of `on_edge` only.
  static constexpr double at_corner = 1e-7;
  static constexpr double on_edge = 1e-9;   ///< conditions hold within it
  static constexpr double off_face = 1e-8;  ///< an arc leaves its face where it is farther outside
  /// A corner's angles may be short of pi by this, radians; tangents agree within it.
  static constexpr double angle = 1e-7;
  /// A face draws a path off an edge where its pull (EdgePull), times the model's size, is more: curvatures along edges
  /// are good to some 1e-7.
  static constexpr double pressed = 1e-6;
};

}  // namespace taut::detail
