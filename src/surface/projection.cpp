#include "taut/surface/projection.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "surface/describe.hpp"
#include "surface/normal_space.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"

// Notation. x: the point so far; s = -J^+ F(x): its Newton step; t: the fraction of s on trial; x_t = x + t s.
//   r = |s|            residual, a length
//   r_t = |J^+ F(x_t)| natural monotonicity test (Deuflhard 2004, Newton Methods for Nonlinear Problems, sec. 3.3)
//   bend = |J^+ (J(x_t) - J(x)) t s|   how far F is from linear along the step, as a length
// A step that does not shrink r although F is linear along it has met rounding: the point is as good as it gets. This
// needs no knowledge of the model's scale, and no noise model of F.

namespace taut {
namespace {

using detail::describe;
using detail::NormalSpace;

enum class Outcome : unsigned char {
  moving,
  converged,
  singular,    // J loses rank at x, or x runs into a point where it does
  non_finite,  // x, or F at x, is not finite
  stuck,       // no fraction of the step helps
  too_far,
  out_of_steps,
};

// A step must shrink the residual by a quarter of what the linear model promises (Deuflhard's restricted test).
constexpr double kSufficient = 0.25;
constexpr double kSmallestFraction = 0x1p-20;
// F counts as linear along a step where bend is below this part of the step.
constexpr double kLinear = 0.1;
// Running into a singular point: J still changes by this part a step (a double root: by one half; the root of a sum of
// squares: by anything up to 2, so that the last few steps are looked at) ...
constexpr double kTurn = 0.25;
// ... although the steps have shrunk to this part of the way gone.
constexpr double kShrunk = 1e-6;
// A residual below this part of the coordinates or of the way gone is rounding without further proof.
constexpr double kSurelyRounding = 1e-9;
// ... and above this one never is.
constexpr double kNeverRounding = 1e-4;

/// Projects points in blocks. The state of a point stands in slot arrays, so that every visit is one dense batch.
template <int D, int K>
class Projector {
 public:
  Projector(Evaluator& evaluator, Index dim, Index codim, const ProjectionOptions& options)
      : evaluator_(evaluator), d_(D > 0 ? D : dim), k_(codim), options_(options) {}

  /// `points` d x n in place; outcome n; residual n and steps n may be null; normals d k x n may be null. Points that
  /// do not converge keep their best iterate.
  void run(Index n, double* points, Outcome* outcome, double* residual, int* steps, double* normals) {
    for (Index begin = 0; begin < n; begin += kBlock) {
      const Index count = std::min(kBlock, n - begin);
      run_block(count, points + begin * d_, outcome + begin);
      for (Index j = 0; j < count; ++j) {
        if (residual != nullptr) residual[begin + j] = r_[idx(j)];
        if (steps != nullptr) steps[begin + j] = steps_[idx(j)];
        if (normals == nullptr) continue;
        double* to = normals + (begin + j) * d_ * k_;
        const bool good = outcome[begin + j] == Outcome::converged;
        for (Index c = 0; c < d_ * k_; ++c) to[c] = good ? q_[idx(j * d_ * k_ + c)] : 0.0;
      }
    }
  }

 private:
  static constexpr Index kBlock = 256;
  static std::size_t idx(Index i) { return static_cast<std::size_t>(i); }
  [[nodiscard]] Index dim() const { return D > 0 ? D : d_; }
  [[nodiscard]] Index codim() const { return K > 0 ? K : k_; }

  void resize(Index n) {
    const std::size_t dk = idx(dim() * codim());
    const std::size_t count = idx(n);
    for (auto* a : {&start_, &step_, &trial_x_}) a->resize(count * idx(dim()));
    for (auto* a : {&value_, &trial_value_}) a->resize(count * idx(codim()));
    for (auto* a : {&jacobian_, &q_, &trial_jacobian_}) a->resize(count * dk);
    r_factor_.resize(count * idx(codim() * codim()));
    for (auto* a : {&r_, &t_, &turn_}) a->resize(count);
    steps_.assign(count, 0);
    active_.clear();
    y_.resize(idx(codim()));
    bend_.resize(idx(codim()));
  }

  void run_block(Index n, double* points, Outcome* outcome) {
    resize(n);
    std::copy(points, points + n * dim(), start_.begin());
    evaluator_.evaluate({.n = n, .x = points, .value = value_.data(), .jacobian = jacobian_.data()});
    for (Index j = 0; j < n; ++j) {
      turn_[idx(j)] = 0;
      t_[idx(j)] = 1;
      r_[idx(j)] = std::numeric_limits<double>::quiet_NaN();
      outcome[j] = start(j, points + j * dim());
      if (outcome[j] == Outcome::moving) active_.push_back(j);
    }
    for (int step = 0; step < options_.max_steps && !active_.empty(); ++step) visit(points, outcome);
    for (const Index j : active_) {
      const double* x = points + j * dim();
      const bool at_root = runs_into_root(j, x) && r_[idx(j)] <= 1e-4 * kShrunk * distance_gone(j, x);
      outcome[j] = at_root ? Outcome::singular : Outcome::out_of_steps;
    }
  }

  Outcome start(Index j, const double* x) {
    for (Index c = 0; c < dim(); ++c) {
      if (!std::isfinite(x[c])) return Outcome::non_finite;
    }
    for (Index i = 0; i < codim(); ++i) {
      if (!std::isfinite(value_[idx(j * codim() + i)])) return Outcome::non_finite;
    }
    return linearise(j);
  }

  /// Factors J at x and finds the Newton step.
  Outcome linearise(Index j) {
    double* q = &q_[idx(j * dim() * codim())];
    double* r = &r_factor_[idx(j * codim() * codim())];
    if (NormalSpace<D>::factor(dim(), codim(), &jacobian_[idx(j * dim() * codim())], q, r) < codim())
      return Outcome::singular;
    NormalSpace<D>::solve(codim(), r, &value_[idx(j * codim())], y_.data());
    double* s = &step_[idx(j * dim())];
    std::fill(s, s + dim(), 0.0);
    for (Index i = 0; i < codim(); ++i) {
      for (Index c = 0; c < dim(); ++c) s[c] -= y_[idx(i)] * q[i * dim() + c];
    }
    r_[idx(j)] = NormalSpace<K>::norm(codim(), y_.data());
    if (!std::isfinite(r_[idx(j)])) return Outcome::singular;
    return r_[idx(j)] <= options_.tolerance ? Outcome::converged : Outcome::moving;
  }

  /// One evaluation at the trial points of everything that still moves.
  void visit(double* points, Outcome* outcome) {
    const Index n = static_cast<Index>(active_.size());
    for (Index a = 0; a < n; ++a) {
      const Index j = active_[idx(a)];
      for (Index c = 0; c < dim(); ++c) {
        trial_x_[idx(a * dim() + c)] = points[j * dim() + c] + t_[idx(j)] * step_[idx(j * dim() + c)];
      }
    }
    evaluator_.evaluate(
        {.n = n, .x = trial_x_.data(), .value = trial_value_.data(), .jacobian = trial_jacobian_.data()});
    Index kept = 0;
    for (Index a = 0; a < n; ++a) {
      const Index j = active_[idx(a)];
      ++steps_[idx(j)];
      outcome[j] = judge(j, a, points + j * dim());
      if (outcome[j] == Outcome::moving) active_[idx(kept++)] = j;
    }
    active_.resize(idx(kept));
  }

  /// Takes the trial point in slot `a` for point j, refuses it, or finds that point j has arrived.
  Outcome judge(Index j, Index a, double* x) {
    const double t = t_[idx(j)];
    const double r = r_[idx(j)];
    const double* factor = &r_factor_[idx(j * codim() * codim())];
    const double* jacobian = &jacobian_[idx(j * dim() * codim())];
    const double* trial_jacobian = &trial_jacobian_[idx(a * dim() * codim())];
    NormalSpace<D>::solve(codim(), factor, &trial_value_[idx(a * codim())], y_.data());
    const double r_t = NormalSpace<K>::norm(codim(), y_.data());
    double change = 0;
    double before_size = 0;
    double after_size = 0;
    for (Index i = 0; i < codim(); ++i) {
      double along = 0;
      for (Index c = 0; c < dim(); ++c) {
        const double before = jacobian[i * dim() + c];
        const double after = trial_jacobian[i * dim() + c];
        const double difference = after - before;
        along += difference * step_[idx(j * dim() + c)];
        change += difference * difference;
        before_size += before * before;
        after_size += after * after;
      }
      bend_[idx(i)] = t * along;
    }
    NormalSpace<D>::solve(codim(), factor, bend_.data(), bend_.data());
    const double bend = NormalSpace<K>::norm(codim(), bend_.data());
    const bool linear = bend <= kLinear * t * r;

    if (!(r_t <= (1 - kSufficient * t) * r)) {
      if (linear && at_rounding(j, x)) return runs_into_root(j, x) ? Outcome::singular : Outcome::converged;
      t_[idx(j)] = t / 2;
      if (t_[idx(j)] >= kSmallestFraction) return Outcome::moving;
      return std::isfinite(change) ? Outcome::stuck : Outcome::singular;
    }

    std::copy_n(&trial_x_[idx(a * dim())], dim(), x);
    std::copy_n(&trial_value_[idx(a * codim())], codim(), &value_[idx(j * codim())]);
    std::copy_n(trial_jacobian, dim() * codim(), &jacobian_[idx(j * dim() * codim())]);
    turn_[idx(j)] = std::max(std::sqrt(change / std::max(before_size, after_size)), 0.25 * turn_[idx(j)]);
    t_[idx(j)] = std::min(1.0, 2 * t);
    Outcome outcome = linearise(j);
    if (outcome == Outcome::singular) return outcome;
    const double way = distance_gone(j, x);
    if (way > options_.max_distance) return Outcome::too_far;
    if (runs_into_root(j, x)) {
      // A double root halves J a step, and so does a far start on a small surface for a while: keep going unless done.
      // But a late step along which F turns round has a kink or a pole under it.
      if (outcome == Outcome::converged || bend >= t * r) return Outcome::singular;
    } else if (outcome == Outcome::moving && linear && t == 1 && r_[idx(j)] > 0.5 * r && at_rounding(j, x)) {
      outcome = Outcome::converged;
    }
    return outcome;
  }

  /// F is linear along the step and yet the step left a good part of the residual. Rounding, or a Jacobian that is
  /// wrong? Where the residual is not plainly tiny, a step 1024 times as long the other way tells: there rounding is
  /// small against F, and F must have grown as J says.
  bool at_rounding(Index j, const double* x) {
    double scale = distance_gone(j, x);
    for (Index c = 0; c < dim(); ++c) scale = std::max(scale, std::abs(x[c]));
    if (r_[idx(j)] <= kSurelyRounding * scale) return true;
    if (r_[idx(j)] > kNeverRounding * scale) return false;  // a pole was jumped
    constexpr double kReach = 1024;
    std::vector<double> far(x, x + dim());
    for (Index c = 0; c < dim(); ++c) far[idx(c)] -= kReach * step_[idx(j * dim() + c)];
    std::vector<double> value(idx(codim()));
    evaluator_.evaluate({.n = 1, .x = far.data(), .value = value.data()});
    for (Index i = 0; i < codim(); ++i) value[idx(i)] -= (1 + kReach) * value_[idx(j * codim() + i)];
    NormalSpace<D>::solve(codim(), &r_factor_[idx(j * codim() * codim())], value.data(), value.data());
    return NormalSpace<K>::norm(codim(), value.data()) <= 0.25 * kReach * r_[idx(j)];
  }

  [[nodiscard]] double distance_gone(Index j, const double* x) const {
    double sum = 0;
    for (Index c = 0; c < dim(); ++c) {
      const double way = x[c] - start_[idx(j * dim() + c)];
      sum += way * way;
    }
    return std::sqrt(sum);
  }

  /// The steps have become tiny and J still turns or shrinks by a good part of itself each step: no regular point is
  /// ahead.
  [[nodiscard]] bool runs_into_root(Index j, const double* x) const {
    return turn_[idx(j)] >= kTurn && r_[idx(j)] <= kShrunk * distance_gone(j, x);
  }

  Evaluator& evaluator_;
  Index d_;
  Index k_;
  ProjectionOptions options_;

  // By point of the block: start, value, J, Q, R, step, residual, fraction on trial, recent relative change of J,
  // visits.
  std::vector<double> start_, value_, jacobian_, q_, r_factor_, step_, r_, t_, turn_;
  std::vector<int> steps_;
  // By slot of the visit.
  std::vector<double> trial_x_, trial_value_, trial_jacobian_;
  std::vector<Index> active_;
  std::vector<double> y_, bend_;
};

void project(Evaluator& evaluator, Index dim, Index codim, const ProjectionOptions& options, Index n, double* points,
             Outcome* outcome, double* residual, int* steps, double* normals) {
  const auto run = [&]<int D>() {
    if (codim == 1)
      return Projector<D, 1>(evaluator, dim, codim, options).run(n, points, outcome, residual, steps, normals);
    Projector<D, Eigen::Dynamic>(evaluator, dim, codim, options).run(n, points, outcome, residual, steps, normals);
  };
  switch (dim) {
    case 2: return run.template operator()<2>();
    case 3: return run.template operator()<3>();
    case 4: return run.template operator()<4>();
    default: return run.template operator()<Eigen::Dynamic>();
  }
}

[[noreturn]] void throw_singular(const Surface& surface, const VectorIn& x, const VectorIn& start) {
  std::string from;
  if ((x - start).norm() > 0) from = " (where the projection of " + describe(start) + " runs into)";
  if (const auto diagnosis = diagnose_rank(surface.function(), x)) throw SingularPoint(diagnosis->text() + from);
  throw SingularPoint("rank deficient: the surface has no normal at " + describe(x) + from +
                      ": an apex, a node, or an equation written as a square or as the root of a sum of squares; "
                      "take another point, or write the squared parts as equations of their own");
}

void require_options(const ProjectionOptions& options) {
  if (!(options.tolerance >= 0)) throw InvalidArgument("the projection's tolerance must be a length >= 0");
  if (options.max_steps < 0) throw InvalidArgument("the projection's max_steps must be >= 0");
  if (!(options.max_distance >= 0)) throw InvalidArgument("the projection's max_distance must be a length >= 0");
}

}  // namespace

ProjectionResult project_to_surface(const Surface& surface, const VectorIn& x, const ProjectionOptions& options) {
  require_options(options);
  if (x.size() != surface.dim()) {
    throw InvalidArgument("the point to project has " + std::to_string(x.size()) + " coordinates, the surface " +
                          std::to_string(surface.dim()) + " dimensions");
  }
  if (!x.allFinite()) throw InvalidArgument("the point to project is not finite: " + describe(x));
  ProjectionResult result;
  result.point = x;
  Outcome outcome = Outcome::moving;
  const auto evaluator = surface.make_evaluator();
  project(*evaluator, surface.dim(), surface.codim(), options, 1, result.point.data(), &outcome, &result.residual,
          &result.num_steps, nullptr);
  if (outcome == Outcome::singular) throw_singular(surface, result.point, x);
  result.distance = (result.point - x).norm();
  result.converged = outcome == Outcome::converged;
  return result;
}

Eigen::Array<bool, Eigen::Dynamic, 1> project_to_surface(Evaluator& evaluator, Index dim, Index codim,
                                                         Eigen::Ref<Eigen::MatrixXd> points,
                                                         const ProjectionOptions& options, Eigen::MatrixXd* normals) {
  require_options(options);
  if (points.rows() != dim) {
    throw InvalidArgument("the points to project have " + std::to_string(points.rows()) + " coordinates, the surface " +
                          std::to_string(dim) + " dimensions");
  }
  const Index n = points.cols();
  if (normals != nullptr) normals->resize(dim * codim, n);
  std::vector<Outcome> outcome(static_cast<std::size_t>(n), Outcome::moving);
  Eigen::MatrixXd moved = points;  // dense, whatever the block's stride
  project(evaluator, dim, codim, options, n, moved.data(), outcome.data(), nullptr, nullptr,
          normals != nullptr ? normals->data() : nullptr);
  Eigen::Array<bool, Eigen::Dynamic, 1> converged(n);
  for (Index j = 0; j < n; ++j) {
    converged(j) = outcome[static_cast<std::size_t>(j)] == Outcome::converged;
    if (converged(j)) points.col(j) = moved.col(j);
  }
  return converged;
}

}  // namespace taut
