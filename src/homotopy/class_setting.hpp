#pragma once

#include "homotopy/strand.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A user's polyline made ready for shortening in its class.
struct ClassSetting {
  double cell = 0;  ///< h, model units
  double gap = 0;   ///< the longest segment of a strand
  Strand strand;
};

/// Throws InvalidArgument unless `polyline` (d x m) has finite points of the surface's dimension, two of them or, of a
/// closed one, three.
void check_polyline(const Surface& surface, const PointsIn& polyline, bool closed);

/// Projects and refines a polyline that is in order, for cells of size h = `cell`. Throws as path_in_class says.
[[nodiscard]] ClassSetting class_setting(const Surface& surface, const StrandMaker& maker, const PointsIn& polyline,
                                         bool closed, double cell);

/// How near to rest a strand is brought before it is corrected (part of its gap), and when the correction has left it.
inline constexpr double kSettled[] = {1, 0.2, 0.02, 1e-3};

}  // namespace taut::detail
