#pragma once

#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::paper {

/// A band of fibre wound over a vessel of revolution about the z axis, symmetric in z, so that it closes:
/// `num_circuits` geodesic circuits from pole to pole and back, which go round the axis `num_turns` times in all.
struct WindingPattern {
  int num_circuits = 0;
  int num_turns = 0;
  double angle = 0;         ///< winding angle at the equator, from the meridian, radians
  double length = 0;        ///< of the whole fibre, model units
  Points fibre = {};        ///< 3 x m
  double closing_miss = 0;  ///< distance of the end from the start, model units
  double closing_turn = 0;  ///< angle between leaving and arriving, radians
  double clairaut_spread =
      0;  ///< largest relative change of r sin(angle) along the fibre, which is constant on geodesics
};

/// Finds the winding angle near `angle` for which `num_circuits` circuits close, by the secant method on how far round
/// the axis one circuit goes. `radius`: of the equator. Throws what `exponential_map` throws.
[[nodiscard]] WindingPattern close_winding(const Surface& vessel, double radius, double angle, int num_circuits,
                                           const Context& context = {});

}  // namespace taut::paper
