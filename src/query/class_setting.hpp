#pragma once

#include "query/shortening.hpp"
#include "query/strand.hpp"
#include "taut/query/path.hpp"

namespace taut::detail {

/// A user's polyline made ready for shortening in its class.
struct ClassSetting {
  double cell = 0;  ///< h, model units
  double gap = 0;   ///< the longest segment of a strand
  Strand strand;
};

/// Checks the request, chooses h as for marching, and projects and refines the polyline. Throws as path_in_class says.
[[nodiscard]] ClassSetting class_setting(const Surface& surface, const StrandMaker& maker, const PointsIn& polyline,
                                         bool closed, const PathOptions& options, const Context& context);

/// How near to rest a strand is brought before it is corrected (part of its gap), and when the correction has left it.
inline constexpr double kSettled[] = {1, 0.2, 0.02, 1e-3};

}  // namespace taut::detail
