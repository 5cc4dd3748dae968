#pragma once

#include <vector>

#include "taut/curve/newton.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// What may lead to the shortest path: a start, and the geodesic that it leads to, known to a few digits.
struct Contender {
  Points start;
  PathCandidate geodesic;
  SpectralCurve curve;  ///< the geodesic, to go on from
  double error;         ///< of its length, at most
  double alike;         ///< another one of the same kind is the same geodesic if its length differs by no more

  [[nodiscard]] double at_least() const { return geodesic.length - error; }
  [[nodiscard]] double at_most() const { return geodesic.length + error; }
};

[[nodiscard]] Contender contender(Points start, NewtonResult geodesic);

/// Files a contender, unless it is known. To take one for another may hide the shortest path; to correct one twice
/// costs microseconds.
void add_contender(std::vector<Contender>& contenders, Contender added);

}  // namespace taut::detail
