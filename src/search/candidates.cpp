// Geodesics between the same points, told apart: two are one where lengths agree within errors and sixteen stations at
// equal parts of the length lie close together. `unique` rests on the two shortest.
#include "search/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

/// Geodesics are told apart where they are farther from each other than this part of their length: much more than the
/// error of a converged curve, even of one that ends near a conjugate point, where curves are least certain...
constexpr double kSamePlace = 1e-3;
/// ... or where their lengths differ by this many times the errors of both, and by more than rounding.
constexpr double kSameErrors = 10;
constexpr double kRounding = 1e-12;

constexpr Index kStations = 16;

}  // namespace

PathCandidate candidate_of(const Geodesic& geodesic) {
  return {geodesic.length, geodesic.length_error, geodesic.locally_shortest, geodesic.points};
}

bool same_curve(const PathCandidate& a, const PathCandidate& b, double apart) {
  if (std::abs(a.length - b.length) > apart + kRounding * a.length) return false;
  return (at_equal_parts(a.points, kStations) - at_equal_parts(b.points, kStations)).colwise().norm().maxCoeff() <=
         kSamePlace * a.length;
}

void add_candidate(std::vector<PathCandidate>& candidates, PathCandidate added) {
  const auto at_most = [](const PathCandidate& candidate) { return candidate.length + candidate.length_error; };
  const auto same = std::ranges::find_if(candidates, [&](const PathCandidate& known) {
    return same_curve(known, added, kSameErrors * (known.length_error + added.length_error));
  });
  if (same != candidates.end()) {
    if (at_most(*same) <= at_most(added)) return;
    candidates.erase(same);
  }
  const auto longer =
      std::upper_bound(candidates.begin(), candidates.end(), added.length,
                       [](double length, const PathCandidate& candidate) { return length < candidate.length; });
  candidates.insert(longer, std::move(added));
}

bool first_is_unique(const std::vector<PathCandidate>& candidates, double tolerance) {
  if (candidates.size() < 2) return true;
  const PathCandidate& first = candidates[0];
  const PathCandidate& second = candidates[1];
  const double errors = first.length_error + second.length_error;
  return second.length - first.length > std::max(errors, tolerance * first.length);
}

}  // namespace taut::detail
