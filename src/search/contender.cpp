#include "search/contender.hpp"

#include <algorithm>
#include <utility>

#include "search/candidates.hpp"

namespace taut::detail {
namespace {

/// Lengths are taken to be no better known than this.
constexpr double kLeastError = 1e-4;
/// Next to a singular point errors are large as a precaution. Curves on two sides of a spike differ by less, but by
/// more than this part of their length.
constexpr double kSingularAlike = 1e-7;

}  // namespace

Contender contender(Points start, NewtonResult geodesic) {
  const double error = std::max(geodesic.length_error, kLeastError * geodesic.length);
  // The error itself would make the ways on both sides of a singular point one.
  const double alike = geodesic.status == Status::ok ? geodesic.length_error : kSingularAlike * geodesic.length;
  return {std::move(start), candidate_of(geodesic), std::move(geodesic.curve), error, alike};
}

void add_contender(std::vector<Contender>& contenders, Contender added) {
  const auto same = std::ranges::find_if(contenders, [&](const Contender& known) {
    return same_curve(known.geodesic, added.geodesic, std::min(known.alike, added.alike));
  });
  if (same == contenders.end()) {
    contenders.push_back(std::move(added));
  } else if (added.at_most() < same->at_most()) {
    *same = std::move(added);
  }
}

}  // namespace taut::detail
