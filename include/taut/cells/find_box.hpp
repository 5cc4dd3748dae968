#pragma once

#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Where a surface is.
struct SurfaceExtent {
  /// Holds what there is of it in `window`, tightly.
  Box box;
  /// Where it was looked for: everywhere but on endless axes.
  Box window;
  /// Holds all of it, as far as numbers go on endless axes.
  Box whole;
  /// By axis: does the surface go on beyond the window.
  Eigen::Array<bool, Eigen::Dynamic, 1> endless;
};

/// Where to look for a surface: its own box where it has one; else, in this order,
///  - a surface with samples: their box and 5 % of its diagonal around it;
///  - F with interval bounds: a box that holds the whole surface, proved within +-2^24 (16.8 million model units, more
///    where `near` asks for it), tight to about 1/24 of its size (1/8 above d = 3). A surface that goes on beyond (a
///    plane, a gyroid) is boxed, on the axes where it does so, around `near` with a margin of the points' spread, at
///    least half their largest coordinate; without points, +-5, doubled until there is a surface in it;
///  - else by trial: starts scattered over scales from 1e-3 to 1e6 around `near` (or 0) are projected; where three
///    scales in a row find the same extent the surface is taken as bounded by it (and 10 % more), else as going on
///    beyond, as above. Nothing is proved then: give a box if you know one.
/// `near`: points of interest, d x n, model units, may be d x 0. Throws EmptySurface when there is nothing,
/// InvalidArgument for a wrong dimension, non-finite points, or more than 12 dimensions to go
/// through by bounds.
[[nodiscard]] SurfaceExtent find_extent(const Surface& surface, const PointsIn& near, const Context& context = {});

/// find_extent(...).box.
[[nodiscard]] Box find_box(const Surface& surface, const PointsIn& near, const Context& context = {});

/// The same surface through another window, which meets it: with the tight box in there by
/// bounds, without bounds with the window itself.
[[nodiscard]] SurfaceExtent through_window(const Surface& surface, const SurfaceExtent& extent, const Box& window,
                                           const Context& context = {});

}  // namespace taut
