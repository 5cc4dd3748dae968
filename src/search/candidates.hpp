#pragma once

#include "taut/search/path_result.hpp"

namespace taut::detail {

[[nodiscard]] PathCandidate candidate_of(const Geodesic& geodesic);

/// Are two curves between the same points one: of lengths that differ by no more than `apart`, and nowhere far from
/// each other.
[[nodiscard]] bool same_curve(const PathCandidate& a, const PathCandidate& b, double apart);

/// Files a geodesic among the candidates, shortest first; of two that cannot be told apart, the one that is the shorter
/// for certain.
void add_candidate(std::vector<PathCandidate>& candidates, PathCandidate added);

/// True when no other candidate is as short as the first, within the errors of both or `tolerance` of the length.
[[nodiscard]] bool first_is_unique(const std::vector<PathCandidate>& candidates, double tolerance);

}  // namespace taut::detail
