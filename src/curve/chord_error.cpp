// The error model of the paper's Appendix II: an interval eps of a curve of radius r is the chord of an arc of length r
// acos(1 - eps^2 / (2 r^2)). With Cst = eps / r the same for all intervals, the polyline of a curve of length L is too
// short by (A1), and (A2) tells the seconds that its nodes take. Radii are those of the polyline itself.
#include "curve/chord_error.hpp"

#include <cmath>
#include <numbers>

#include "curve/osculating_circles.hpp"

namespace taut::detail {

double relative_chord_error(double cst) {
  // acos(1 - c^2 / 2) = 2 asin(c / 2); below the switch the series' next term is c^6 * 5 / 7168 < 1e-15 of the first.
  // A chord has no more than two radii: intervals beyond that are far too long for their bend.
  if (cst >= 2) return std::numbers::pi / 2 - 1;
  const double c2 = cst * cst;
  if (cst < 1e-3) return c2 / 24 * (1 + c2 * (9.0 / 80));
  return 2 * std::asin(cst / 2) / cst - 1;
}

ChordError chord_error(const PointsIn& nodes) {
  ChordError error;
  const Vector intervals = interval_lengths(nodes);
  const Vector ratios = intervals.cwiseProduct(interval_curvatures(nodes));  // eps_i / r_i
  const double length = intervals.sum();
  if (!(length > 0)) return error;
  for (Index i = 0; i < intervals.size(); ++i) error.sum += intervals(i) * relative_chord_error(ratios(i));
  // The mean of squares, since the error of an interval goes with Cst^2 / 24 of its length.
  error.cst = std::sqrt(intervals.dot(ratios.cwiseAbs2()) / length);
  error.uniform = length * relative_chord_error(error.cst);  // (A1)
  return error;
}

FlowSummary summarise(const PointsIn& nodes) {
  const ChordError error = chord_error(nodes);
  FlowSummary summary;
  summary.num_intervals = nodes.cols() - 1;
  const Vector intervals = interval_lengths(nodes);
  summary.length = intervals.sum();
  summary.mean_interval = intervals.mean();
  summary.longest_interval = intervals.maxCoeff();
  summary.cst = error.cst;
  summary.error_a1 = error.uniform;
  summary.error_sum = error.sum;
  return summary;
}

void set_seconds(double seconds, FlowSummary& summary) {
  summary.seconds = seconds;
  summary.seconds_per_node = seconds / static_cast<double>(summary.num_intervals);  // K
  const double error_per_length = relative_chord_error(summary.cst);
  if (!(error_per_length > 0 && summary.mean_interval > 0)) return;  // a straight curve takes no nodes
  summary.seconds_a2 =
      summary.error_sum * summary.seconds_per_node / (summary.mean_interval * error_per_length);  // (A2)
}

}  // namespace taut::detail
