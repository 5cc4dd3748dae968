// How long intervals should be: the least of eps_E, a share of the radius of curvature, and the length over which the
// normal turns by a given angle; then made graded, so that neighbours differ by at most kMostGrowth (a sweep each way).
// Nodes are spread by the integral of 1 / wanted, the number of wanted intervals up to a place.
#include "curve/interval_rule.hpp"

#include <algorithm>
#include <vector>

#include "curve/osculating_circles.hpp"
#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

constexpr double kMostGrowth = 1.25;  // of an interval over its neighbour

}  // namespace

Vector wanted_intervals(const PointsIn& points, const VectorIn& turns, const IntervalRule& rule) {
  const Vector lengths = interval_lengths(points);
  const Vector curvatures = interval_curvatures(points);
  const Index m = lengths.size();
  Vector wanted(m);
  for (Index i = 0; i < m; ++i) {
    wanted(i) = rule.longest;
    // Multiplied out, so that a straight interval or a normal that does not turn needs no case of its own.
    if (curvatures(i) * wanted(i) > rule.per_radius) wanted(i) = rule.per_radius / curvatures(i);
    if (turns(i) * wanted(i) > rule.per_turn * lengths(i)) wanted(i) = rule.per_turn * lengths(i) / turns(i);
  }
  // Growth over an interval of the polyline that will hold several of the wanted ones: so much for each of them.
  const auto reach = [&](Index i) { return wanted(i) + (kMostGrowth - 1) * std::max(lengths(i), wanted(i)); };
  for (Index i = 1; i < m; ++i) wanted(i) = std::min(wanted(i), reach(i - 1));
  for (Index i = m - 2; i >= 0; --i) wanted(i) = std::min(wanted(i), reach(i + 1));
  return wanted;
}

FlowCurve spread_nodes(const PointsIn& points, const VectorIn& wanted, Index num_intervals) {
  const Vector lengths = interval_lengths(points);
  const Index m = lengths.size();
  const double total = lengths.cwiseQuotient(wanted).sum();
  std::vector<double> arcs{0.0};
  FlowCurve curve;
  curve.widths.resize(num_intervals);
  double arc = 0;     // up to interval i
  double passed = 0;  // wanted intervals up to there
  Index i = 0;
  for (Index j = 1; j <= num_intervals; ++j) {
    const double place = total * static_cast<double>(j) / static_cast<double>(num_intervals);
    while (i + 1 < m && passed + lengths(i) / wanted(i) < place) {
      passed += lengths(i) / wanted(i);
      arc += lengths(i);
      ++i;
    }
    // Not past the end of the interval, which rounding of the sums could lead to.
    arcs.push_back(std::min(arc + (place - passed) * wanted(i), arc + lengths(i)));
    curve.widths(j - 1) = wanted(i);
  }
  curve.points = at_arc_lengths(points, arcs);
  return curve;
}

}  // namespace taut::detail
