#pragma once

#include <optional>
#include <string>
#include <vector>

#include "query/start_finder.hpp"
#include "query/strand.hpp"
#include "taut/curve/newton.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/query/path.hpp"

namespace taut::detail {

/// Shortens starts to geodesics by the method asked for, and tells which is the shortest. One thread's.
class Corrector {
 public:
  Corrector(const Surface& surface, const PathOptions& options, const Context& context);

  /// Corrects every start that may lead to the shortest path. The best one becomes the Geodesic part of `result`, the
  /// others its candidates. False when the outcome is in doubt: nothing converged, or a start that promised a clearly
  /// shorter path has not led to one. `last`: no other starts will be tried.
  [[nodiscard]] bool correct(PathResult& result, const Starts& starts, bool last);

 private:
  struct Corrected {
    Geodesic geodesic;
    std::string message;
    Points start;
  };

  [[nodiscard]] std::optional<NewtonResult> correct_gently(const Points& start);
  /// Fills the message.
  void explain(Corrected& corrected) const;
  /// A start to be corrected to the end.
  struct Choice {
    double length;  // about that of the geodesic; where it is known to a few digits, the least that it may be
    Points start;
    std::optional<SpectralCurve> rough;  // the geodesic, to a few digits
  };

  [[nodiscard]] Corrected shorten(const Choice& choice, double cell);
  [[nodiscard]] std::vector<Choice> choose(const std::vector<StartPath>& starts);

  const Surface& surface_;
  const PathOptions& options_;
  const Context& context_;
  std::optional<NewtonSolver> rough_;
  std::optional<NewtonSolver> newton_;
  std::optional<StrandMaker> maker_;
};

/// A geodesic before a curve that is none, then the shorter one, be it through a singular point (rank_deficient): the
/// longer one would be no answer; of curves that are none the one that came nearer.
[[nodiscard]] bool is_better(const Geodesic& a, const Geodesic& b);

}  // namespace taut::detail
