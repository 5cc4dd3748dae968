#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "homotopy/strand.hpp"
#include "search/correction_rules.hpp"
#include "search/start_finder.hpp"
#include "taut/curve/newton.hpp"
#include "taut/curve/spectral_curve.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// Shortens starts to geodesics by the method asked for, and tells which is the shortest. One thread's.
class Corrector {
 public:
  /// On the threads of `context`: several starts are corrected side by side.
  Corrector(const Surface& surface, const PathOptions& options, const Context& context);

  /// Corrects every start that may lead to the shortest path. The best one becomes the Geodesic part of `result`, with
  /// its obstacle, the others its candidates. False when the outcome is in doubt: nothing converged, or a start that
  /// promised a clearly shorter path has not led to one. `last`: no other starts will be tried.
  [[nodiscard]] bool correct(PathResult& result, const Starts& starts, bool last);

  /// Of the starts last corrected those whose geodesics leave the domain, with about the lengths of these, which are at
  /// most those of paths within: shortest first.
  [[nodiscard]] const std::vector<StartPath>& beyond() const { return beyond_; }

 private:
  struct Corrected {
    Geodesic geodesic;
    Obstacle obstacle;  // where it is none
    Points start;
    std::optional<FlowSummary> flow;
  };

  [[nodiscard]] std::optional<NewtonResult> correct_gently(const Points& start, const FlowLattice& lattice);
  /// What keeps a curve from being a geodesic, and where.
  [[nodiscard]] Obstacle obstacle_of(const Geodesic& geodesic) const;
  /// A start to be corrected to the end.
  struct Choice {
    double length;  // about that of the geodesic; where it is known to a few digits, the least that it may be
    Points start;
    SpectralCurve rough;  // the geodesic, to a few digits; empty: not there yet
  };

  /// Calls work(j, worker) for j = 0 .. n - 1, several at a time, each with its worker, and take(j) for one after the
  /// other, as long as hopeful(j), which may depend on what was taken. How many at a time only changes how much is done
  /// in vain.
  template <class Hopeful, class Work, class Take>
  void in_waves(std::size_t n, const Hopeful& hopeful, const Work& work, const Take& take) const;
  [[nodiscard]] Corrected shorten(const Choice& choice, const FlowLattice& lattice, std::size_t worker);
  [[nodiscard]] std::vector<Choice> choose(const Starts& given);

  /// The solvers of a worker, made when they are first needed.
  [[nodiscard]] NewtonSolver& rough(std::size_t worker);
  [[nodiscard]] NewtonSolver& newton(std::size_t worker);

  using Solvers = std::array<std::optional<NewtonSolver>, CorrectionRules::kAtATime>;

  const Surface& surface_;
  const PathOptions& options_;
  const Context& context_;
  Solvers rough_;
  Solvers newton_;
  std::vector<StartPath> beyond_;
  std::optional<StrandMaker> maker_;
  Index num_gentle_nodes_ = 0;       // evaluated by correct_gently for these starts
  Index last_gentle_projected_ = 0;  // of maker_'s count
};

/// A geodesic before a curve that is none, then the shorter one, be it through a singular point (rank_deficient): the
/// longer one would be no answer; of curves that are none the one that came nearer.
[[nodiscard]] bool is_better(const Geodesic& a, const Geodesic& b);

}  // namespace taut::detail
