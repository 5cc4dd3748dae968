#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fan/geodesic_fan.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The longest and widest panel of a fan, in cells: its nodes are then closer than the cells that are known to follow
/// the surface.
inline constexpr double kPanelCells = 8;

/// Points at which a fan may evaluate F: some ten seconds' worth on one core. A formula takes about 20 ns a point, a
/// local fit or a volume 1 us, a dense fit of a few thousand centres 10 us.
[[nodiscard]] Index most_evaluated(const Surface& surface);

/// What a fan, grown as far as that takes, says of a target.
struct FanAnswer {
  enum class Kind : std::uint8_t {
    proved,  ///< `hit` holds the distance, along a geodesic inside the surface's domain
    beyond,  ///< farther than `max_distance`
    open,    ///< rays could not be followed as far; `hit` may hold an upper bound
  };
  Kind kind = Kind::open;
  FanHit hit;
};

/// Receives what is known of a target (its column) so far. Called for targets in blocks, from several threads, for one
/// target never at once; the last call for it counts.
using TakeAnswer = std::function<void(Index target, const FanAnswer& answer)>;

/// Grows `fan` on `surface` from `sources` (3 x m, with `values`) until each of the columns `asked` of `targets` (3 x
/// n, on the surface) is proved or beyond, or as far as it can be grown. Throws Cancelled.
void ask_fan(GeodesicFan& fan, const Surface& surface, const PointsIn& sources, const VectorIn& values,
             const PointsIn& targets, std::vector<Index> asked, double max_distance, const Context& context,
             const TakeAnswer& take);

/// The same of all targets.
[[nodiscard]] std::vector<FanAnswer> ask_fan(GeodesicFan& fan, const Surface& surface, const PointsIn& sources,
                                             const VectorIn& values, const PointsIn& targets, double max_distance,
                                             const Context& context);

}  // namespace taut::detail
