#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "curve/curve_check.hpp"
#include "curve/looks_at_border.hpp"
#include "curve/newton_backend.hpp"
#include "curve/newton_kernel.hpp"
#include "curve/polyline.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// The adaptive part of Newton's correction: a coarse polyline (p = 1) takes the start to the valley of a geodesic;
/// then elements of high degree, sized by how fast the normal turns, are solved, inspected between their nodes, and cut
/// where the error is, until the length is good enough.
template <class System>
class NewtonDriver : public NewtonSolver::Backend {
 public:
  using Kernel = NewtonKernel<System>;
  using Frame = typename System::Frame;
  static constexpr int D = Kernel::D;
  static constexpr int K = Kernel::K;
  using Nodes = typename Kernel::Nodes;
  using VectorD = typename Kernel::VectorD;

  NewtonDriver(const Surface& surface, const NewtonOptions& options)
      : surface_(surface),
        options_(options),
        evaluator_(surface.make_evaluator()),
        kernel_(surface.dim(), surface.codim()),
        checker_(surface.dim(), surface.codim()) {}

  [[nodiscard]] Index dim() const override { return surface_.dim(); }

  NewtonResult solve(const PointsIn& start, const Context& context) override {
    begin(start, context);
    const Points path = without_repeats(start);
    const double length = polyline_length(path);
    NewtonResult result;
    if (path.cols() < 2 || length <= 1e-15 * scale_) return of_a_point(start);
    Relaxation outcome = Relaxation::stalled;
    for (const double turn : {0.6, 0.2}) {  // a second, finer attempt where the first got lost
      outcome = solve_coarse(path, length, turn);
      // A loop that shrinks to its only end is the geodesic of length 0.
      if (outcome == Relaxation::collapsed && path.col(0) == path.col(path.cols() - 1)) return of_a_point(start);
      if (outcome == Relaxation::converged || outcome == Relaxation::saddle || outcome == Relaxation::stalled) {
        const Nodes coarse = kernel_.nodes();
        std::vector<double> breaks(lengths_.size() + 1, 0.0);
        std::partial_sum(lengths_.begin(), lengths_.end(), breaks.begin() + 1);
        start_fine([&](double t) { return cubic(coarse, breaks, t); });
        outcome = solve_fine();
      } else {
        checker_.inspect(*evaluator_, kernel_, check_);
      }
      // Only these may have come from too coarse a start.
      if (outcome != Relaxation::stalled && outcome != Relaxation::off_surface) break;
      if (kernel_.num_iterations() >= options_.max_iterations) break;
    }
    finish(start, outcome, result);
    return result;
  }

  NewtonResult refine(const SpectralCurve& curve, const Context& context) override {
    const Points& nodes = curve.nodes();
    Points ends(nodes.rows(), 2);
    ends << nodes.col(0), nodes.rightCols<1>();
    begin(nodes, context);
    NewtonResult result;
    if (curve.period() <= 1e-15 * scale_) return of_a_point(ends);
    // The nodes as a polyline, to see how the normal turns from one to the next.
    const ReferenceElement& element = ReferenceElement::of_degree(curve.degree());
    lengths_.clear();
    for (const double h : curve.lengths()) {
      for (int i = 0; i < curve.degree(); ++i) lengths_.push_back(h * (element.node(i + 1) - element.node(i)) / 2);
    }
    kernel_.set_mesh(1, lengths_);
    kernel_.nodes() = nodes;
    // No iterations: only the projection, and what a visit finds at the nodes.
    Relaxation outcome = kernel_.relax(*evaluator_, {.energy = 1, .off_surface = scale_, .max_iterations = 0}, context);
    if (outcome == Relaxation::converged || outcome == Relaxation::stalled) {
      start_fine([&](double t) -> VectorD { return curve.point(t); });
      outcome = solve_fine();
    } else {
      checker_.inspect(*evaluator_, kernel_, check_);
    }
    finish(ends, outcome, result);
    return result;
  }

 private:
  static constexpr double kWideTurn = 0.9;  // radians between nodes beyond which a coarse curve is not trusted
  static constexpr Index kCoarseSegments = 24;
  static constexpr int kMostCuts = 11;          // of a coarse segment, into halves
  static constexpr double kShortestCut = 1e-6;  // of the whole: segments that short are left as they are
  // Of the lengths of neighbouring elements, at most. Without it Newton's method loses paths over the rims of
  // ellipsoids 1:1:0.01 and 1:1:0.005 at any tolerance; with it they are found at all, down to 1:1:0.002.
  static constexpr double kGrading = 4;
  static constexpr int kMaxCycles = 14;
  static constexpr double kClosingIn = 0.8;       // the weakest gradient seen falls by this from cycle to cycle
  static constexpr double kSoftRounding = 1e-11;  // of the length: differences along neutral directions below
  static constexpr double kTooWeak = 3e-5;       // gradients, of the strongest: the second variation says nothing below
  static constexpr double kShortestDip = 1e-5;   // of the whole: how closely a near singular point is looked at...
  static constexpr double kDipTolerance = 1e-5;  // ... when asked for no less than this

  NewtonResult of_a_point(const PointsIn& start) const {
    NewtonResult result;
    result.points.resize(start.rows(), 2);
    result.points << start.col(0), start.col(start.cols() - 1);
    result.status = Status::ok;
    result.length = (result.points.col(1) - result.points.col(0)).norm();
    result.locally_shortest = true;
    result.index = 0;
    result.curve = SpectralCurve(1, {1.0}, result.points);
    return result;
  }

  void begin(const PointsIn& start, const Context& context) {
    kernel_.reset_counters();
    checker_.reset_counters();
    nonsmooth_ = false;
    context_ = &context;
    scale_ = start.cwiseAbs().maxCoeff();
  }

  // The coarse curve.

  Relaxation solve_coarse(const Points& path, double length, double coarse_turn) {
    std::vector<double> arcs(kCoarseSegments + 1);
    for (Index i = 0; i <= kCoarseSegments; ++i) {
      arcs[static_cast<std::size_t>(i)] = length * static_cast<double>(i) / kCoarseSegments;
    }
    lengths_.assign(kCoarseSegments, length / kCoarseSegments);
    kernel_.set_mesh(1, lengths_);
    kernel_.nodes() = at_arc_lengths(path, arcs);
    RelaxationGoal goal{.energy = 1e-5, .off_surface = 1e-3 * length, .max_iterations = 0, .minimum = true};
    // Nodes first: enough of them that the normal turns moderately from one to the next.
    for (int cycle = 0;; ++cycle) {
      const Relaxation outcome = kernel_.relax(*evaluator_, goal, *context_);
      if (outcome != Relaxation::stalled) return outcome;
      // Without iterations a relaxation ends as stalled: here that means that the nodes are on the surface.
      if (cycle == kMostCuts || !refine_coarse(options_.leave_saddles ? kWideTurn : 0.25, &path, arcs)) break;
    }
    if (!options_.leave_saddles)
      return Relaxation::converged;  // a saddle must not be slid off: straight to high degree
    goal.max_iterations = std::min(60, options_.max_iterations);
    for (int cycle = 0;; ++cycle) {
      const Relaxation outcome = kernel_.relax(*evaluator_, goal, *context_);
      if (outcome != Relaxation::converged) return outcome;
      if (cycle == kMostCuts || !refine_coarse(coarse_turn, nullptr, arcs)) break;
      goal.max_iterations = std::min(60, std::max(0, options_.max_iterations - kernel_.num_iterations()));
    }
    return Relaxation::converged;
  }

  // How much the tangent space turns over each segment of a curve of degree 1 (an angle, radians, for small ones).
  void measure_turning() {
    const Index m = kernel_.num_elements();
    turning_.assign(static_cast<std::size_t>(m), 0.0);
    const auto seen = [&](Index e) { return kernel_.regular(e) && kernel_.regular(e + 1); };
    for (Index e = 0; e < m; ++e) {
      // Tangent spaces do not see the normal's sign: a turn by more than a right angle shows in it only.
      if (seen(e)) turning_[static_cast<std::size_t>(e)] = flipped(e) ? 2 : kernel_.turn(e, e + 1);
    }
    if (m >= 3) {
      // A singular end has no tangent space: its segment is taken to turn as the next one.
      if (!seen(0)) turning_.front() = turning_[1];
      if (!seen(m - 1)) turning_.back() = turning_[static_cast<std::size_t>(m - 2)];
    }
  }
  [[nodiscard]] bool flipped(Index e) const {
    return kernel_.normal(e).dot(kernel_.normal(e + 1)) < 0 && kernel_.codim() == 1;
  }

  // Halves the segments over which the normal turns by more than `limit`; new nodes from `path` (at arc lengths `arcs`)
  // or from the curve itself. False when there is none.
  bool refine_coarse(double limit, const Points* path, std::vector<double>& arcs) {
    measure_turning();
    const Index m = kernel_.num_elements();
    const double shortest = kShortestCut * kernel_.period();
    std::vector<double> lengths;
    std::vector<double> new_arcs{0.0};
    const bool by_arc = path != nullptr;
    if (by_arc) {  // the path's own bends count as well: the normal may be the same again after a full turn
      const std::vector<double> strays = straying(*path, arcs);
      for (std::size_t e = 0; e < strays.size(); ++e) turning_[e] = std::max(turning_[e], 8 * strays[e]);
    }
    Nodes nodes(kernel_.nodes().rows(), 2 * m + 1);
    Index count = 0;
    nodes.col(count++) = kernel_.nodes().col(0);
    for (Index e = 0; e < m; ++e) {
      const double h = lengths_[static_cast<std::size_t>(e)];
      const bool cut = turning_[static_cast<std::size_t>(e)] > limit && h > shortest &&
                       static_cast<Index>(lengths.size()) < options_.max_elements;
      if (cut) {
        nodes.col(count++) = (kernel_.nodes().col(e) + kernel_.nodes().col(e + 1)) / 2;
        lengths.insert(lengths.end(), 2, h / 2);
        new_arcs.push_back(new_arcs.back() + h / 2);
      } else {
        lengths.push_back(h);
      }
      nodes.col(count++) = kernel_.nodes().col(e + 1);
      new_arcs.push_back(new_arcs.back() + lengths.back());
    }
    if (static_cast<Index>(lengths.size()) == m) return false;
    lengths_ = std::move(lengths);
    kernel_.set_mesh(1, lengths_);
    if (by_arc) {
      arcs = std::move(new_arcs);
      kernel_.nodes() = at_arc_lengths(*path, arcs);
    } else {
      kernel_.nodes() = nodes.leftCols(count);
    }
    return true;
  }

  // The fine curve.

  // The turn of the normal an element of degree p may see at this tolerance; measured (docs/newton.md).
  [[nodiscard]] double turn_allowed(int p) const {
    double at_1e12 = System::kFactors && p > 4 ? 0.4 : 0.6;
    if (!options_.leave_saddles) at_1e12 = 0.35;  // a saddle wants a start that is resolved
    return std::min(1.2, at_1e12 * std::pow(options_.tolerance / 1e-12, 1.0 / (2 * p)));
  }

  [[nodiscard]] int first_degree() const {
    return options_.tolerance > 1e-6 ? 4 : System::high_degree(surface_.dim() - surface_.codim());
  }

  // Elements for the polyline in the kernel, their nodes by `point` (of the polyline's parameter).
  template <class Point>
  void start_fine(const Point& point) {
    const int p = first_degree();
    measure_turning();
    double turn = 0;
    std::vector<double> density(turning_.size());
    for (std::size_t e = 0; e < turning_.size(); ++e) {
      turn += turning_[e];
      density[e] = turning_[e] / lengths_[e];
    }
    const auto wanted = static_cast<Index>(std::ceil(turn / turn_allowed(p)));
    // The order of the method does the rest: elements that err are cut later.
    std::vector<double> lengths =
        graded(equidistribute(lengths_, density, std::clamp<Index>(wanted, 1, options_.max_elements)));
    const auto m = static_cast<Index>(lengths.size());
    // Arc length as parameter: scale to the length found.
    const double stretch = kernel_.length() / kernel_.period();
    const ReferenceElement& element = ReferenceElement::of_degree(p);
    const Nodes coarse = kernel_.nodes();
    Nodes nodes(coarse.rows(), m * p + 1);
    nodes.col(0) = coarse.col(0);
    double left = 0;
    for (Index e = 0; e < m; ++e) {
      const double h = lengths[static_cast<std::size_t>(e)];
      for (int i = 1; i <= p; ++i) nodes.col(e * p + i) = point(left + h * (element.node(i) + 1) / 2);
      left += h;
    }
    nodes.col(m * p) = coarse.col(coarse.cols() - 1);
    lengths_ = std::move(lengths);
    for (double& h : lengths_) h *= stretch;
    kernel_.set_mesh(p, lengths_);
    kernel_.nodes() = nodes;
  }

  // Cuts elements into halves until none is longer than kGrading times a neighbour, or there would be too many: towards
  // a bend that is far sharper than the rest a polynomial over all that leads there would miss it.
  [[nodiscard]] std::vector<double> graded(std::vector<double> lengths) const {
    for (bool cut = true; cut;) {
      std::vector<double> finer;
      for (std::size_t e = 0; e < lengths.size(); ++e) {
        double least = lengths[e];
        if (e > 0) least = std::min(least, lengths[e - 1]);
        if (e + 1 < lengths.size()) least = std::min(least, lengths[e + 1]);
        const bool halve = lengths[e] > kGrading * least;
        finer.insert(finer.end(), halve ? 2 : 1, halve ? lengths[e] / 2 : lengths[e]);
      }
      cut = finer.size() > lengths.size() && static_cast<Index>(finer.size()) <= options_.max_elements;
      if (cut) lengths = std::move(finer);
    }
    return lengths;
  }

  // The cubic through the four nodes of a polyline around parameter t.
  static VectorD cubic(const Nodes& nodes, const std::vector<double>& breaks, double t) {
    const auto count = static_cast<Index>(breaks.size());
    const auto above = std::upper_bound(breaks.begin() + 1, breaks.end() - 1, t);
    const Index segment = above - breaks.begin() - 1;
    const Index first = std::clamp<Index>(segment - 1, 0, std::max<Index>(0, count - 4));
    const Index last = std::min(first + 4, count);
    VectorD result = VectorD::Zero(nodes.rows());
    for (Index i = first; i < last; ++i) {
      double basis = 1;
      for (Index j = first; j < last; ++j) {
        if (j == i) continue;
        const auto a = static_cast<std::size_t>(i);
        const auto b = static_cast<std::size_t>(j);
        basis *= (t - breaks[b]) / (breaks[a] - breaks[b]);
      }
      result += basis * nodes.col(i);
    }
    return result;
  }

  [[nodiscard]] double surface_tolerance() const { return 3e-3 * std::sqrt(options_.tolerance); }  // relative to length

  Relaxation solve_fine() {
    Relaxation outcome = Relaxation::converged;
    double before = std::numeric_limits<double>::infinity();
    double weakest = 1;
    int slow = 0;
    int stalls = 0;
    nonsmooth_ = false;
    for (int cycle = 0; cycle < kMaxCycles; ++cycle) {
      // Relative energy left is twice the relative length: a hundredth of the tolerance is out of the way of what the
      // mesh errs.
      RelaxationGoal goal{.energy = 0.02 * options_.tolerance,
                          .off_surface = std::max(1e-2 * surface_tolerance() * kernel_.period(), 1e-15 * scale_),
                          .max_iterations = options_.max_iterations - kernel_.num_iterations(),
                          .minimum = options_.leave_saddles};
      outcome = kernel_.relax(*evaluator_, goal, *context_);
      checker_.inspect(*evaluator_, kernel_, check_);
      if (outcome == Relaxation::singular || outcome == Relaxation::off_surface || outcome == Relaxation::collapsed)
        break;
      if (!check_.regular) return Relaxation::singular;
      const double error = check_.length_error;
      if (outcome == Relaxation::converged && accurate(error) && kernel_.resolved()) break;
      // A finer mesh often frees an iteration that stalled.
      if (outcome == Relaxation::stalled && (++stalls > 2 || kernel_.num_iterations() >= options_.max_iterations))
        break;
      const bool precise = error <= 0.5 * options_.tolerance * check_.length;
      // Closer and closer to a singular point: what the surface does there has not been seen yet.
      const bool closing_in = check_.weakest_gradient < kClosingIn * weakest;
      weakest = check_.weakest_gradient;
      // An analytic surface gains far more than a digit a cycle.
      if (error > 0.1 * before && !precise && !closing_in) {
        nonsmooth_ = true;
        if (error > 0.9 * before && ++slow >= 4) break;
      }
      before = error;
      if (cycle + 1 == kMaxCycles || !refine_fine()) break;
    }
    return outcome;
  }

  /// Does the curve pass a singular point closer than the mesh can show.
  [[nodiscard]] bool dips() const { return std::ranges::find(check_.element_dips, true) != check_.element_dips.end(); }

  [[nodiscard]] bool looks_closely() const { return options_.tolerance <= kDipTolerance; }

  [[nodiscard]] bool accurate(double error) const {
    return !(dips() && looks_closely()) && error <= 0.5 * options_.tolerance * check_.length &&
           check_.corner <= CurveChecker<Frame>::kCorner &&
           check_.off_surface <= surface_tolerance() * check_.length + 1e-15 * scale_;
  }

  // Cuts the elements that err most, into as many pieces as order 2 p of the length (p + 1 of the distance to the
  // surface) predicts. False when the mesh may not grow.
  bool refine_fine() {
    const int p = kernel_.degree();
    const Index m = kernel_.num_elements();
    // Half of what accurate() allows: predictions are rough.
    const double share = 0.25 * options_.tolerance * check_.length / static_cast<double>(m);
    const double off_share = 0.5 * surface_tolerance() * check_.length;
    pieces_.assign(static_cast<std::size_t>(m), 1);
    Index total = 0;
    bool any = false;
    for (std::size_t e = 0; e < pieces_.size(); ++e) {
      const double by_error = std::pow(check_.element_error[e] / share, 1.0 / (2 * p));
      // Between the nodes the distance to the surface falls with the order of interpolation, p + 1.
      const double by_off = std::pow(check_.element_off[e] / off_share, 1.0 / (p + 1));
      const double wanted = std::max(by_error, by_off);
      if (wanted > 1) pieces_[e] = static_cast<int>(std::clamp(std::ceil(wanted), 2.0, 4.0));
      if (check_.element_corner[e] > CurveChecker<Frame>::kCorner) pieces_[e] = std::max(pieces_[e], 2);
      const bool dips_here = check_.element_dips[e] && looks_closely();
      if (dips_here && lengths_[e] > kShortestDip * kernel_.period()) pieces_[e] = 4;
      // Shorter elements drown in rounding; a kink is told by its corner.
      if (lengths_[e] < 1e-7 * kernel_.period()) pieces_[e] = 1;
      any = any || pieces_[e] > 1;
      total += pieces_[e];
    }
    // Accurate, but too coarse to tell minima: finer everywhere.
    if (!any && !kernel_.resolved()) {
      std::fill(pieces_.begin(), pieces_.end(), 2);
      total = 2 * m;
    } else if (!any) {
      return false;
    }
    if (total > options_.max_elements) return false;
    cut();
    return true;
  }

  // Applies pieces_, carrying the curve over.
  void cut() {
    const int p = kernel_.degree();
    const ReferenceElement& element = kernel_.element();
    const Nodes old = kernel_.nodes();
    std::vector<double> lengths;
    for (std::size_t e = 0; e < pieces_.size(); ++e) {
      lengths.insert(lengths.end(), static_cast<std::size_t>(pieces_[e]), lengths_[e] / pieces_[e]);
    }
    Nodes nodes(old.rows(), static_cast<Index>(lengths.size()) * p + 1);
    nodes.col(0) = old.col(0);
    Vector basis(p + 1);
    Index next = 1;
    for (std::size_t e = 0; e < pieces_.size(); ++e) {
      const auto block = old.middleCols(static_cast<Index>(e) * p, p + 1);
      for (int piece = 0; piece < pieces_[e]; ++piece) {
        for (int i = 1; i <= p; ++i) {
          const double xi = -1 + (2 * piece + 1 + element.node(i)) / pieces_[e];
          element.basis(std::min(xi, 1.0), basis);
          nodes.col(next++).noalias() = block * basis;
        }
      }
    }
    nodes.col(nodes.cols() - 1) = old.col(old.cols() - 1);
    lengths_ = std::move(lengths);
    kernel_.set_mesh(p, lengths_);
    kernel_.nodes() = nodes;
  }

  // The result.

  void finish(const PointsIn& start, Relaxation outcome, NewtonResult& result) {
    result.curve = SpectralCurve(kernel_.degree(), lengths_, kernel_.nodes());
    result.start_direction = result.curve.velocity(0).normalized();
    result.end_direction = result.curve.velocity(result.curve.period()).normalized();
    result.length = check_.length;
    result.length_error = check_.length_error + rounding();
    if (outcome != Relaxation::converged || !kernel_.settled()) {
      // Shortening steps, or a neutral direction: what is left may be many times what the next step would gain.
      // dL = dE T / L, since E = L^2 / (2 T).
      const double gain = kernel_.decrement() * kernel_.period() / std::max(check_.length, 1e-300);
      result.length_error += std::max(4 * gain, 0.25 * options_.tolerance * check_.length);
    } else {
      result.length_error += kernel_.left() * kernel_.period() / std::max(check_.length, 1e-300);
    }
    result.length_error += soft_error();
    for (const double off : check_.element_off) {  // where the curve cuts a corner
      if (off > surface_limit()) result.length_error += 2 * off;
    }
    result.residual = {.surface = check_.off_surface, .geodesic_curvature = check_.geodesic_curvature};
    result.num_iterations = kernel_.num_iterations();
    result.num_evaluated = kernel_.num_evaluated() + checker_.num_evaluated();
    // The certificate: second variation positive definite, on a mesh that can tell.
    result.locally_shortest = outcome == Relaxation::converged && kernel_.resolved() && kernel_.minimum();
    if (at_rest(outcome)) result.index = kernel_.num_negative();
    if (result.index.value_or(0) > 0) find_conjugate(result);
    const bool in_domain = sample(start, result);
    decide(outcome, in_domain, result);
  }

  static bool at_rest(Relaxation outcome) { return outcome == Relaxation::converged || outcome == Relaxation::saddle; }

  // The first conjugate point of a geodesic that is no minimum, and how many there are.
  void find_conjugate(NewtonResult& result) {
    if constexpr (System::kFactors) {
      if (const auto t = kernel_.conjugate_point()) result.conjugate_at = *t * (check_.length / kernel_.period());
    } else {  // the same geodesic as a ray, with its Jacobi fields
      const ExponentialOptions options{.tolerance = 1e-12, .points = false};
      if (surface_.dim() - surface_.codim() - 1 > options.max_fields) return;
      try {
        const ExponentialResult ray = exponential_map(surface_, kernel_.nodes().col(0), result.start_direction,
                                                      check_.length, options, *context_);
        result.conjugate_at = ray.conjugate_at;
        if (ray.status == Status::ok) result.index = std::max(*result.index, ray.index);
      } catch (const SingularPoint&) {
        return;
      }
    }
  }

  // What may be left to gain along curves of nearly the same length (ends that are nearly conjugate), model units.
  [[nodiscard]] double soft_error() const {
    return kernel_.soft_energy() * kernel_.period() / std::max(check_.length, 1e-300);
  }

  // What the end points' own rounding does to the length, and ours: no tolerance asks for less.
  [[nodiscard]] double rounding() const { return 8e-16 * check_.length + 2.2e-16 * scale_; }

  // How far off the surface a good curve may be between its nodes, model units.
  [[nodiscard]] double surface_limit() const { return 4 * surface_tolerance() * check_.length + 1e-14 * scale_; }

  // Of x'' by rounding of the nodes.
  [[nodiscard]] double curvature_noise() const {
    const double shortest = *std::min_element(lengths_.begin(), lengths_.end());
    return 4e-16 * scale_ * std::pow(kernel_.degree(), 4) / (shortest * shortest);
  }

  [[nodiscard]] bool bends_within_surface() const {
    return check_.geodesic_curvature > 0.3 * std::max(check_.curvature, 1 / check_.length) + curvature_noise();
  }

  void decide(Relaxation outcome, bool in_domain, NewtonResult& result) const {
    const bool finite = std::isfinite(result.length) && std::isfinite(result.length_error);
    result.status = Status::not_converged;
    if (outcome == Relaxation::singular || !check_.regular || !finite) {
      result.status = Status::rank_deficient;
      result.reason = "the curve runs into a point where the Jacobian of F loses rank";
    } else if (outcome != Relaxation::off_surface && outcome != Relaxation::collapsed &&
               (dips() || check_.weakest_gradient < kTooWeak)) {
      result.status = Status::rank_deficient;
      result.reason = "the curve runs through, or too close to tell by, a singular point of the surface";
    } else if (outcome == Relaxation::off_surface) {
      result.reason = "the start path does not project onto the surface";
    } else if (outcome == Relaxation::saddle) {
      result.reason = "a geodesic that is not locally shortest, and no way down was found";
    } else if (outcome != Relaxation::converged) {
      result.reason = "the iteration stalled before it met the tolerance";
    } else if (kernel_.ends_off() > surface_limit()) {
      result.reason = "an end of the path is not on the surface: project it first";
    } else if (check_.off_surface > surface_limit()) {
      result.reason = "the curve leaves the surface between its nodes";
    } else if (soft_error() > std::max(options_.tolerance, kSoftRounding) * result.length) {
      result.reason = "curves beside this one are as long to more digits than can be told (ends nearly conjugate)";
    } else if (check_.length_error > options_.tolerance * result.length) {
      result.reason = rounding() > options_.tolerance * result.length
                          ? "the rounding of coordinates this large forbids the tolerance"
                      : nonsmooth_ ? "the surface is not smooth enough here (a crease?) for the tolerance"
                                   : "the tolerance was not met with the elements allowed";
    } else if (check_.corner > CurveChecker<Frame>::kCorner) {
      result.reason = "the curve has a corner: it crosses a crease of the surface";
    } else if (bends_within_surface()) {
      result.reason = "the curve bends within the surface: a crease?";
    } else if (!in_domain) {
      result.status = Status::left_domain;
      result.reason = "the curve leaves the domain of the surface";
    } else {
      result.status = Status::ok;
    }
    if (result.status == Status::not_converged) {
      // Straightening a bend of angle a in a path of length L gains up to a^2 L / 8; where a curve that is no geodesic
      // would come to rest, nobody knows.
      const double gain = check_.turning * check_.turning * check_.length / 8;
      result.length_error =
          at_rest(outcome) ? std::max(result.length_error, gain) : std::numeric_limits<double>::infinity();
    }
    if (result.status == Status::not_converged && check_.weakest_gradient < 1e-3) {
      result.status = Status::rank_deficient;
      result.reason = "the curve passes close to a point where the Jacobian of F loses rank";
    }
    // The second variation of a curve over a crease says nothing.
    const bool creased = result.status == Status::not_converged &&
                         (nonsmooth_ || check_.corner > CurveChecker<Frame>::kCorner || bends_within_surface());
    if (creased || result.status == Status::rank_deficient) {
      result.locally_shortest = false;
      result.index.reset();
    }
    if (!finite) result.length_error = std::numeric_limits<double>::infinity();
  }

  // Dense points for display, projected onto the surface. False when one is outside the domain.
  bool sample(const PointsIn& start, NewtonResult& result) {
    const int p = kernel_.degree();
    const Index m = kernel_.num_elements();
    // 64 points at least on the whole curve, and twice as many as nodes.
    const Index each = std::max<Index>(2 * p, (64 + m - 1) / m);
    Points& points = result.points;
    points.resize(start.rows(), m * each + 1);
    const Points& nodes = result.curve.nodes();
    Eigen::MatrixXd basis(p + 1, each);
    for (Index i = 0; i < each; ++i) {
      kernel_.element().basis(-1 + 2 * static_cast<double>(i) / static_cast<double>(each), basis.col(i));
    }
    for (Index e = 0; e < m; ++e) points.middleCols(e * each, each).noalias() = nodes.middleCols(e * p, p + 1) * basis;
    points.col(0) = start.col(0);
    points.rightCols<1>() = start.rightCols<1>();
    project_points(points);
    if (surface_.domain() == nullptr) return true;
    const double slack = 1e-7 * check_.length;
    return surface_.inside_domain(points, slack).all() &&
           surface_.inside_domain(looks_at_border(surface_, *evaluator_, points), slack).all();
  }

  // Newton's steps onto the surface, all points a round; the ends stay. Polynomials leave it by their error only.
  void project_points(Points& points) {
    const Index n = points.cols();
    const Index d = surface_.dim();
    const Index k = surface_.codim();
    Eigen::MatrixXd value(k, n);
    Eigen::MatrixXd jacobian(d * k, n);
    Frame frame;
    frame.resize(d, k);
    Eigen::Matrix<double, K, 1> scratch(k);
    Eigen::Matrix<double, D, 1> step(d);
    double before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 6; ++round) {
      evaluator_->evaluate({.n = n, .x = points.data(), .value = value.data(), .jacobian = jacobian.data()});
      double largest = 0;
      for (Index j = 1; j + 1 < n; ++j) {
        Eigen::Map<const Eigen::Matrix<double, D, K>> gradients(jacobian.col(j).data(), d, k);
        if (!value.col(j).allFinite()) continue;
        if constexpr (K == 1) {
          step = gradients * (value(0, j) / gradients.squaredNorm());
        } else {
          if (!frame.compute(gradients)) continue;
          frame.pseudo_inverse(value.col(j), scratch, step);
        }
        const double size = step.norm();
        // A point that finds no surface near stays on the polynomial.
        if (!(size <= 0.1 * check_.length)) continue;
        largest = std::max(largest, size);
        points.col(j) -= step;
      }
      // quadratic: from 1e-8 to rounding in one step
      if (largest < 1e-8 * scale_ * std::min(1.0, 1 / (1 + check_.curvature * scale_)) || largest > 0.5 * before) break;
      before = largest;
    }
  }

  Surface surface_;
  NewtonOptions options_;
  std::unique_ptr<Evaluator> evaluator_;
  Kernel kernel_;
  CurveChecker<Frame> checker_;
  CurveCheck check_;
  const Context* context_ = nullptr;
  double scale_ = 1;
  bool nonsmooth_ = false;
  std::vector<double> lengths_;
  std::vector<double> turning_;
  std::vector<int> pieces_;
};

template <class System>
std::unique_ptr<NewtonSolver::Backend> make_newton_driver(const Surface& surface, const NewtonOptions& options) {
  return std::make_unique<NewtonDriver<System>>(surface, options);
}

}  // namespace taut::detail
