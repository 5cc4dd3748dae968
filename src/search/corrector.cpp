// From starts to the shortest geodesic. With Newton's method: (1) all starts that may still win are corrected to three
// digits, several side by side; (2) geodesics that come near each other are spliced into further starts; (3) what may
// still be the shortest, least first, is corrected to the tolerance asked for; (4) a few starts from which nothing
// came, though they are as short as what was found, are brought to rest gently first. A start is given up when it is
// longer than the shortest found by more than starts' lengths are known to err (Hope). With the paper's flow, or none,
// every start within that bound is corrected or measured as it is.
//
// How many are worked on at a time changes the work done in vain, never what is taken: results are taken in order.
#include "search/corrector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "curve/normal_frame.hpp"
#include "curve/polyline.hpp"
#include "curve/polyline_residual.hpp"
#include "homotopy/shortening.hpp"
#include "search/candidates.hpp"
#include "search/contender.hpp"
#include "search/correction_rules.hpp"
#include "search/flow_options.hpp"
#include "search/splices.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// A geodesic, be it one through a singular point.
bool is_geodesic(const Geodesic& geodesic) {
  constexpr double kFar = 1e-2;
  return geodesic.status == Status::ok ||
         (geodesic.status == Status::rank_deficient && geodesic.length_error <= kFar * geodesic.length);
}

/// One that has come to rest beyond the domain.
bool is_beyond(const Geodesic& geodesic) {
  return geodesic.status == Status::left_domain && std::isfinite(geodesic.length_error);
}

/// Is it a curve between these ends, and no shorter than their distance. Whatever else goes wrong, no other leaves here
/// as a path.
bool joins(const Geodesic& geodesic, const VectorIn& p, const VectorIn& q) {
  constexpr double kRounding = 1e-9;
  const double chord = (q - p).norm();
  return geodesic.points.cols() >= 2 && std::isfinite(geodesic.length) &&
         geodesic.length + geodesic.length_error >= (1 - kRounding) * chord;
}

/// The point of a curve (d x m) at which the gradients are weakest or nearest to depending on each other, measured
/// against the rest of the curve: where a singular point is close.
Vector weakest_point(const Surface& surface, const Points& curve) {
  const Index n = curve.cols();
  const Index d = surface.dim();
  const Index k = surface.codim();
  Eigen::MatrixXd value(k, n);
  Eigen::MatrixXd jacobian(d * k, n);
  surface.make_evaluator()->evaluate({.n = n, .x = curve.data(), .value = value.data(), .jacobian = jacobian.data()});
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(k, n);
  NormalFrame frame;
  frame.resize(d, k);
  for (Index j = 0; j < n; ++j) {
    if (!frame.compute(Eigen::Map<const Eigen::MatrixXd>(jacobian.col(j).data(), d, k))) return curve.col(j);
    for (Index i = 0; i < k; ++i) own(i, j) = frame.own_gradient(i);
  }
  const Vector strongest = own.rowwise().maxCoeff();
  Index weakest = 0;
  (strongest.cwiseInverse().asDiagonal() * own).colwise().minCoeff().minCoeff(&weakest);
  return curve.col(weakest);
}

/// Of starts shortest first, how far down the list it is worth going.
class Hope {
 public:
  /// `error`: of the starts' lengths, relative.
  explicit Hope(double error) : error_(error) {}
  [[nodiscard]] bool is_lost(double length) const { return length > shortest_ * (1 + error_); }
  void found(double length) { shortest_ = std::min(shortest_, length); }
  /// A start that promised one length has led to another.
  void doubt(double promised, double length) {
    // Starts that came out shorter than promised: so may those behind them.
    error_ = std::max(error_, kCorrectionRules.error_factor * (promised / length - 1));
  }

 private:
  double shortest_ = std::numeric_limits<double>::infinity();
  double error_;
};

}  // namespace

Corrector::Corrector(const Surface& surface, const PathOptions& options, const Context& context)
    : surface_(surface), options_(options), context_(context) {}

NewtonSolver& Corrector::rough(std::size_t worker) {
  std::optional<NewtonSolver>& solver = rough_.at(worker);
  if (!solver)
    solver.emplace(surface_,
                   NewtonOptions{.tolerance = std::max(kCorrectionRules.rough_tolerance, options_.tolerance)});
  return *solver;
}

NewtonSolver& Corrector::newton(std::size_t worker) {
  std::optional<NewtonSolver>& solver = newton_.at(worker);
  if (!solver) solver.emplace(surface_, NewtonOptions{.tolerance = options_.tolerance});
  return *solver;
}

template <class Hopeful, class Work, class Take>
void Corrector::in_waves(std::size_t n, const Hopeful& hopeful, const Work& work, const Take& take) const {
  const auto at_a_time = std::min(CorrectionRules::kAtATime, static_cast<std::size_t>(num_threads(context_)));
  for (std::size_t first = 0; first < n && hopeful(first);) {
    std::size_t last = std::min(n, first + at_a_time);
    // Starts come shortest first: those without hope are at the end. The first one has it.
    while (!hopeful(last - 1)) --last;
    parallel_for(context_, 0, static_cast<Index>(last - first), 1,
                 [&](Index i, Index) { work(first + static_cast<std::size_t>(i), static_cast<std::size_t>(i)); });
    for (; first < last; ++first) {
      if (!hopeful(first)) return;
      take(first);
    }
  }
}

/// Newton's method from where the paper's flow brings the start to rest: that inserts nodes until the start follows the
/// surface. Round rims sharper than its nodes it does not get; there shortening does, whose small steps keep to the
/// sheet, if the start follows it. None where neither leads to a geodesic.
std::optional<NewtonResult> Corrector::correct_gently(const Points& start, const FlowLattice& lattice) {
  const auto solve = [&](const Points& from) -> std::optional<NewtonResult> {
    NewtonResult geodesic = newton(0).solve(from, context_);
    if (!is_geodesic(geodesic)) return std::nullopt;
    return geodesic;
  };
  if (num_gentle_nodes_ < kGentleRules.most_nodes) {
    const FlowOptions options{.lattice = lattice, .max_evaluated = kGentleRules.most_nodes - num_gentle_nodes_};
    const FlowResult flowed = correct_flow(surface_, start, options, context_);
    num_gentle_nodes_ += flowed.summary.num_evaluated;
    if (flowed.status == Status::ok) {
      if (auto geodesic = solve(flowed.points)) return geodesic;
    }
  }
  if (!maker_) maker_.emplace(surface_, kGentleRules.most_points);
  const Index left = last_gentle_projected_ - maker_->num_projected();
  if (left <= 0) return std::nullopt;
  const double length = polyline_length(start);
  const double gap = length / kGentleRules.segments;
  try {
    Shortening shortening(*maker_, maker_->make(start, false, gap, kGentleRules.off * length), gap, left);
    for (const double settled : kGentleRules.settled) {
      const Shortening::Outcome outcome = shortening.run(settled * gap, context_);
      if (auto geodesic = solve(shortening.strand().polyline())) return geodesic;
      if (outcome == Shortening::Outcome::stuck) break;
    }
  } catch (const InvalidArgument&) {  // too coarse to tell which way round it goes
  } catch (const OutOfMemory&) {      // rough on the scale of the segments
  }
  return std::nullopt;
}

Obstacle Corrector::obstacle_of(const Geodesic& geodesic) const {
  if (geodesic.status == Status::ok) return {};
  if (geodesic.status != Status::rank_deficient || geodesic.points.cols() == 0) return {Obstacle::Kind::no_geodesic};
  return {Obstacle::Kind::no_geodesic, weakest_point(surface_, geodesic.points)};
}

Corrector::Corrected Corrector::shorten(const Choice& choice, const FlowLattice& lattice, std::size_t worker) {
  const Points& start = choice.start;
  Corrected corrected{{}, {}, start, {}};
  Geodesic& geodesic = corrected.geodesic;
  const double start_length = polyline_length(start);
  switch (options_.method) {
    case CorrectionMethod::newton: {
      const bool begun = choice.rough.num_elements() > 0;
      if (begun) geodesic = newton(worker).refine(choice.rough, context_);
      // What three digits took for a geodesic may be none: then from the start itself.
      const bool at_rest = begun && (is_geodesic(geodesic) || is_beyond(geodesic));
      if (!at_rest) geodesic = newton(worker).solve(start, context_);
      break;
    }
    case CorrectionMethod::flow: {
      FlowResult flowed = correct_flow(surface_, start, flow_options(options_, lattice), context_);
      corrected.flow = flowed.summary;
      geodesic = std::move(static_cast<Geodesic&>(flowed));
      break;
    }
    case CorrectionMethod::grid:
      geodesic.points = start;
      geodesic.length = start_length;
      geodesic.length_error = std::numeric_limits<double>::infinity();  // nothing is known about it
      geodesic.residual = polyline_residual(surface_, start);
      geodesic.status = Status::ok;
      break;
  }
  corrected.obstacle = obstacle_of(geodesic);
  const bool may_have_jumped = options_.method == CorrectionMethod::newton;
  if (may_have_jumped && geodesic.status == Status::ok &&
      geodesic.length > kCorrectionRules.most_growth * start_length) {
    geodesic.status = Status::not_converged;
    corrected.obstacle = {Obstacle::Kind::jumped, {}, start_length};
  }
  return corrected;
}

/// The starts that may lead to the shortest path, corrected to a few digits, each geodesic once, and those that do not
/// converge as they are; least first.
std::vector<Corrector::Choice> Corrector::choose(const Starts& given) {
  const std::vector<StartPath>& starts = given.paths;
  std::vector<Contender> contenders;
  std::vector<Choice> choices;
  Hope hope(given.error);
  std::vector<NewtonResult> geodesics(starts.size());
  const auto correct_roughly = [&](const std::vector<StartPath>& from) {
    return [&](std::size_t j, std::size_t worker) { geodesics[j] = rough(worker).solve(from[j].points, context_); };
  };
  // False: no geodesic.
  const auto take = [&](const StartPath& start, NewtonResult& geodesic) {
    if (!is_geodesic(geodesic)) return false;
    hope.found(geodesic.length);
    hope.doubt(start.length, geodesic.length);
    add_contender(contenders, contender(start.points, std::move(geodesic)));
    return true;
  };
  in_waves(
      starts.size(), [&](std::size_t j) { return !hope.is_lost(starts[j].length); }, correct_roughly(starts),
      [&](std::size_t j) {
        const StartPath& start = starts[j];
        if (take(start, geodesics[j])) return;
        NewtonResult& curve = geodesics[j];
        // What the curve may yet come to, at least, if it came to rest.
        const bool at_rest = std::isfinite(curve.length_error);
        const double at_least = at_rest ? curve.length - curve.length_error : start.length;
        // Beyond the domain: within, this start leads to something longer, if anything. Else it is kept as it is, and
        // tried once more to the full tolerance.
        const bool beyond = is_beyond(curve);
        choices.push_back({beyond ? at_least : std::min(at_least, start.length / (1 + given.error)), start.points,
                           beyond ? std::move(curve.curve) : SpectralCurve{}});
      });
  std::vector<PathCandidate> known;
  double shortest = std::numeric_limits<double>::infinity();
  for (const Contender& contender : contenders) {
    known.push_back(contender.geodesic);
    shortest = std::min(shortest, contender.at_most());
  }
  const std::vector<StartPath> spliced = splices(surface_, known, (1 + kCorrectionRules.spliced) * shortest);
  geodesics.resize(std::max(geodesics.size(), spliced.size()));
  in_waves(
      spliced.size(), [](std::size_t) { return true; }, correct_roughly(spliced),
      [&](std::size_t j) { (void)take(spliced[j], geodesics[j]); });
  for (Contender& contender : contenders) {
    choices.push_back({contender.at_least(), std::move(contender.start), std::move(contender.curve)});
  }
  std::ranges::stable_sort(choices, {}, &Choice::length);
  return choices;
}

bool Corrector::correct(PathResult& result, const Starts& starts, bool last) {
  const Stopwatch watch;
  const bool selects = options_.method == CorrectionMethod::newton && !options_.all && starts.paths.size() > 1;
  std::vector<Choice> choices;
  if (selects) {
    choices = choose(starts);
  } else {
    for (const StartPath& start : starts.paths) choices.push_back({start.length, start.points, {}});
  }
  Corrected best;
  bool any = false;
  std::vector<PathCandidate> candidates;
  std::vector<const Choice*> failed;
  double promised = std::numeric_limits<double>::infinity();  // by curves that are not quite geodesics
  beyond_.clear();
  Hope hope(selects ? 0 : starts.error);
  std::vector<Corrected> corrected(choices.size());
  FlowLattice lattice;
  if (starts.cells) lattice = {starts.cells->grid().size(), starts.cells->grid().origin()};
  in_waves(
      choices.size(), [&](std::size_t j) { return options_.all || !hope.is_lost(choices[j].length); },
      [&](std::size_t j, std::size_t worker) { corrected[j] = shorten(choices[j], lattice, worker); },
      [&](std::size_t j) {
        const Geodesic& geodesic = corrected[j].geodesic;
        if (is_geodesic(geodesic)) {
          hope.found(geodesic.length + geodesic.length_error);
          if (!selects) hope.doubt(choices[j].length, geodesic.length);
        } else {
          // A geodesic beyond the domain is no fault of the start.
          if (geodesic.status != Status::left_domain) {
            failed.push_back(&choices[j]);
          } else {
            beyond_.push_back({geodesic.length - geodesic.length_error, choices[j].start});
          }
          promised = std::min(promised, geodesic.length + geodesic.length_error);
        }
        if (geodesic.status == Status::ok) add_candidate(candidates, candidate_of(geodesic));
        if (!any || is_better(geodesic, best.geodesic)) best = std::move(corrected[j]);
        any = true;
      });
  // A start from which nothing came, though it is as short as what was found, may lead to the shortest path. Where
  // nothing was found, finer cells are the better help.
  if (options_.method != CorrectionMethod::newton) failed.clear();
  int tries = kGentleRules.most;
  num_gentle_nodes_ = 0;
  last_gentle_projected_ = (maker_ ? maker_->num_projected() : 0) + kGentleRules.most_projected;
  for (const Choice* choice : failed) {
    const bool found = is_geodesic(best.geodesic);
    const bool promises =
        tries-- > 0 && polyline_length(choice->start) <= (1 + kGentleRules.promise) * best.geodesic.length;
    if (found ? !promises : !last) break;
    std::optional<NewtonResult> gently = correct_gently(choice->start, lattice);
    if (!gently) continue;
    if (gently->status == Status::ok) add_candidate(candidates, candidate_of(*gently));
    if (!is_better(*gently, best.geodesic)) continue;
    best.geodesic = *std::move(gently);
    best.obstacle = obstacle_of(best.geodesic);
    best.start = choice->start;
    best.flow.reset();
  }
  static_cast<Geodesic&>(result) = std::move(best.geodesic);
  result.obstacle = std::move(best.obstacle);
  result.flow = best.flow;
  result.grid_path = std::move(best.start);
  result.candidates = std::move(candidates);
  result.tied = !first_is_unique(result.candidates, options_.tolerance);
  const Points& way = starts.paths.front().points;
  if (result.status == Status::ok && !joins(result, way.leftCols(1), way.rightCols(1))) {
    result.status = Status::not_converged;
    result.obstacle = {Obstacle::Kind::loose_ends};
  }
  result.seconds.correct += watch.seconds();
  result.corrected = options_.method != CorrectionMethod::grid;
  if (!result.corrected) {
    result.candidates.clear();  // no geodesic among them
    return true;
  }
  return result.status == Status::ok && result.length <= (1 + starts.doubt) * starts.paths.front().length &&
         result.length <= promised;
}

bool is_better(const Geodesic& a, const Geodesic& b) {
  const bool a_there = is_geodesic(a);
  const bool b_there = is_geodesic(b);
  if (a_there != b_there) return a_there;
  if (!a_there) return a.length_error < b.length_error;
  // Of the same length within their errors: rather the one that is certain.
  const bool as_long = std::abs(a.length - b.length) <= a.length_error + b.length_error;
  if (as_long && a.status != b.status) return a.status == Status::ok;
  return a.length < b.length;
}

}  // namespace taut::detail
