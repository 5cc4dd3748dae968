// A band along a border: the shortest curve near a given one among those that stay where the domain's components g_m
// are >= 0. It is a polyline, whose length is known to the third power of its parts.
//
// Nodes x_i move sideways, along b_i = N x t (N the surface's normal, t the band's direction), by u_i. With e_i, l_i
// the direction and length of part i and kappa_b the surface's curvature along b,
//   L = sum l_i,   dL/du_i = (e_{i-1} - e_i) . b_i,
//   d2L/du_i2 = sum over both parts of (1 - (b_i . e)^2) / l  -  kappa_b (e_{i-1} - e_i) . N,
//   d2L/du_i du_{i+1} = -(b_i . b_{i+1} - (b_i . e_i)(b_{i+1} . e_i)) / l_i,
// a tridiagonal matrix, and g_m + u_i (grad g_m . b_i) >= 0 bounds every u_i from below or above. Each step solves that
// quadratic problem by its active set: nodes at a bound that push against it stay. Without the kappa term the matrix is
// an M-matrix, for which the active set settles; the term is left out where it takes away positive definiteness.
//
// A band must not jump a gap that is narrower than its parts: where a step brings a part outside, its two nodes go back
// and may move half as far.
#include "strata/border_band.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "curve/polyline.hpp"
#include "surface/sign_evaluator.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

using Point3 = Eigen::Vector3d;

/// Parts of a first band: so many for a gap of the start, at least and at most.
constexpr double kPartsPerGap = 3;
constexpr Index kFewestParts = 48;
constexpr Index kMostParts = 500;
/// It is halved so often: the last two lengths tell the error.
constexpr int kHalvings = 3;
/// Steps for a band of one number of parts.
constexpr int kMostSteps = 40;
/// The set of active nodes grows and shrinks by a few nodes a round: as many rounds as there are nodes, at most.
constexpr Index kMostActiveSets = 8000;
/// The node that moves most moves by no more than this, in gaps, and the others in proportion.
constexpr double kTrust = 1;
/// Moves of this part of a part are the last, for a band that will be halved; and of the last one.
constexpr double kRough = 1e-2;
constexpr double kSettled = 1e-4;
/// The band meets a border at less than this (sine): else it cannot be pushed away from it sideways.
constexpr double kAcross = 1e-3;
/// Places of a part where it is looked whether it is inside, and how far outside is nothing, in gaps.
constexpr int kLooks = 3;
constexpr double kOutside = 0.02;
/// Parts are made even again where the longest is so many times the shortest.
constexpr double kUneven = 1.5;
/// Nodes that went back have neighbours that may have to.
constexpr int kMostRetreats = 4;
/// Newton steps that bring a node back into the domain.
constexpr int kMostReturns = 6;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class BandPuller {
 public:
  BandPuller(const Surface& surface, double gap, const Context& context)
      : surface_(surface),
        context_(context),
        function_(surface.make_evaluator()),
        domain_(surface.domain()->make_evaluator()),
        num_domain_(surface.domain()->codim()),
        gap_(gap) {}

  [[nodiscard]] BorderBand run(const Points& start) {
    BorderBand band;
    const Index parts =
        std::clamp(static_cast<Index>(kPartsPerGap * polyline_length(start) / gap_), kFewestParts, kMostParts);
    double before = 0;
    for (int halving = 0; halving <= kHalvings; ++halving) {
      x_ = at_equal_parts(halving == 0 ? start : x_, parts << halving);
      room_.setConstant(x_.cols(), kInfinity);
      trust_ = kTrust * gap_;
      if (!to_surface()) return {};
      come_inside();
      band.settled = settle(halving == kHalvings ? kSettled : kRough);
      before = std::exchange(band.length, arc_length());
    }
    band.error = std::abs(band.length - before);
    band.points = x_;
    band.touching = touching_;
    band.outside = outside().maxCoeff();
    return band;
  }

 private:
  /// Of the smooth curve through the nodes: an arc that turns by an angle a is longer than its chord by a^2 / 24.
  [[nodiscard]] double arc_length() const {
    const Index n = x_.cols();
    Vector turn = Vector::Zero(n);
    for (Index i = 1; i + 1 < n; ++i) {
      const Point3 before = (x_.col(i) - x_.col(i - 1)).normalized();
      turn(i) = (Point3(x_.col(i + 1) - x_.col(i)).normalized() - before).squaredNorm();
    }
    turn(0) = turn(1);
    turn(n - 1) = turn(n - 2);
    double sum = 0;
    for (Index i = 0; i + 1 < n; ++i) {
      sum += (x_.col(i + 1) - x_.col(i)).norm() * (1 + (turn(i) + turn(i + 1)) / 48);
    }
    return sum;
  }

  /// How far each part lies outside between its nodes, model units. There it is on the surface to the square of a part.
  [[nodiscard]] Vector outside() {
    const Index parts = x_.cols() - 1;
    Vector worst = Vector::Zero(parts);
    Eigen::Array<bool, Eigen::Dynamic, 1> inside(parts);
    Vector value(num_domain_);
    Points gradient(3, num_domain_);
    for (int k = 1; k <= kLooks; ++k) {
      const double t = static_cast<double>(k) / (kLooks + 1);
      const Points at = (1 - t) * x_.leftCols(parts) + t * x_.rightCols(parts);
      are_nonnegative(*domain_, num_domain_, parts, at.data(), inside.data());
      for (Index i = 0; i < parts; ++i) {
        if (inside(i)) continue;
        domain_->evaluate({.n = 1, .x = at.col(i).data(), .value = value.data(), .jacobian = gradient.data()});
        for (Index m = 0; m < num_domain_; ++m) {
          worst(i) = std::max(worst(i), -value(m) / std::max(gradient.col(m).norm(), 1e-300));
        }
      }
    }
    return worst;
  }

  /// Takes nodes whose parts have gone outside back to where they were.
  void retreat(const Points& before) {
    for (int round = 0; round < kMostRetreats; ++round) {
      const Vector out = outside();
      std::vector<bool> back(static_cast<std::size_t>(x_.cols()), false);
      bool any = false;
      for (Index i = 0; i < out.size(); ++i) {
        if (out(i) <= kOutside * gap_) continue;
        for (const Index node : {i, i + 1}) {
          if (x_.col(node) == before.col(node)) continue;
          back[static_cast<std::size_t>(node)] = any = true;
        }
      }
      if (!any) return;
      for (Index i = 1; i + 1 < x_.cols(); ++i) {
        if (!back[static_cast<std::size_t>(i)]) continue;
        room_(i) = std::min(room_(i), (x_.col(i) - before.col(i)).norm()) / 2;
        x_.col(i) = before.col(i);
      }
    }
  }

  [[nodiscard]] bool to_surface() {
    return project_to_surface(*function_, 3, 1, x_.middleCols(1, x_.cols() - 2), {.max_distance = 8 * gap_}).all();
  }

  void evaluate() {
    const Index n = x_.cols();
    value_.resize(n);
    gradient_.resize(3, n);
    hessian_.resize(9, n);
    weight_.setOnes(n);
    domain_value_.resize(num_domain_, n);
    domain_gradient_.resize(3, num_domain_ * n);
    function_->evaluate({.n = n,
                         .x = x_.data(),
                         .value = value_.data(),
                         .jacobian = gradient_.data(),
                         .weight = weight_.data(),
                         .hessian = hessian_.data()});
    domain_->evaluate({.n = n, .x = x_.data(), .value = domain_value_.data(), .jacobian = domain_gradient_.data()});
  }

  [[nodiscard]] Point3 normal(Index i) const { return Point3(gradient_.col(i)).normalized(); }
  /// The part of grad g_m in the surface.
  [[nodiscard]] Point3 slope(Index m, Index i) const {
    const Point3 g = domain_gradient_.col(num_domain_ * i + m);
    return g - g.dot(normal(i)) * normal(i);
  }
  /// Brings nodes that lie outside back, up the slope of what they break.
  void come_inside() {
    for (int round = 0; round < kMostReturns; ++round) {
      evaluate();
      bool all_inside = true;
      for (Index i = 1; i + 1 < x_.cols(); ++i) {
        for (Index m = 0; m < num_domain_; ++m) {
          const double g = domain_value_(m, i);
          if (!(g < 0)) continue;
          const Point3 up = slope(m, i);
          const double size = up.norm();
          if (!(size > 0)) continue;
          if (-g / size > 1e-12 * gap_) all_inside = false;
          x_.col(i) += std::min(-g / size, gap_) / size * up;
        }
      }
      if (all_inside || !to_surface()) return;
    }
    evaluate();
  }

  /// Nodes that move sideways come together on the inside of a bend.
  void spread_evenly() {
    const Vector parts = (x_.rightCols(x_.cols() - 1) - x_.leftCols(x_.cols() - 1)).colwise().norm();
    if (parts.maxCoeff() <= kUneven * parts.minCoeff()) return;
    const Points before = x_;
    x_ = at_equal_parts(x_, x_.cols() - 1);
    if (!to_surface()) x_ = before;
    come_inside();
  }

  /// Steps until nodes move by no more than `part` of a part.
  [[nodiscard]] bool settle(double part) {
    const Index n = x_.cols();
    touching_.assign(static_cast<std::size_t>(n), -1);
    active_.assign(static_cast<std::size_t>(n), 0);
    double length = polyline_length(x_);
    for (int step = 0; step < kMostSteps; ++step) {
      context_.check_cancelled();
      spread_evenly();
      const Points before = x_;
      set_equations();
      solve();
      const double part_of_move = std::min(1.0, trust_ / std::max(move_.cwiseAbs().maxCoeff(), 1e-300));
      for (Index i = 1; i + 1 < n; ++i) {
        const double u = part_of_move * move_(i);
        x_.col(i) += u * side_.col(i) - 0.5 * bend_(i) * u * u * normal(i);
      }
      if (!to_surface()) {
        x_ = before;
        evaluate();
        trust_ /= 4;
        if (trust_ < 1e-3 * gap_) return false;
        continue;
      }
      come_inside();
      retreat(before);
      evaluate();
      const double now = polyline_length(x_);
      if ((x_ - before).colwise().norm().maxCoeff() <= part * now / static_cast<double>(n)) return true;
      // Not shorter: the steps are too long for the quadratic model.
      trust_ = now > length && step > 2 ? trust_ / 2 : std::min(1.5 * trust_, kTrust * gap_);
      room_ *= 1.5;
      length = now;
    }
    return false;
  }

  void set_equations() {
    const Index n = x_.cols();
    side_.setZero(3, n);
    bend_.setZero(n);
    diagonal_.setOnes(n);
    curved_.setZero(n);
    beside_.setZero(n);
    force_.setZero(n);
    lower_.setZero(n);
    upper_.setZero(n);
    bound_.assign(static_cast<std::size_t>(n), {-1, -1});
    Points e(3, n - 1);
    Vector l(n - 1);
    for (Index i = 0; i + 1 < n; ++i) {
      const Point3 part = x_.col(i + 1) - x_.col(i);
      l(i) = std::max(part.norm(), 1e-300);
      e.col(i) = part / l(i);
    }
    for (Index i = 1; i + 1 < n; ++i) {
      const Point3 along = e.col(i - 1) + e.col(i);
      const Point3 b = normal(i).cross(along).normalized();
      side_.col(i) = b.allFinite() ? b : Point3(normal(i).unitOrthogonal());
    }
    for (Index i = 1; i + 1 < n; ++i) {
      const Point3 b = side_.col(i);
      const Point3 before = e.col(i - 1);
      const Point3 after = e.col(i);
      const Eigen::Map<const Eigen::Matrix3d> h(hessian_.col(i).data());
      bend_(i) = b.dot(h * b) / gradient_.col(i).norm();
      force_(i) = (before - after).dot(b);
      const double p = before.dot(b);
      const double q = after.dot(b);
      diagonal_(i) = (1 - p * p) / l(i - 1) + (1 - q * q) / l(i);
      curved_(i) = -bend_(i) * (before - after).dot(normal(i));
      if (i + 2 < n) {
        const Point3 next = side_.col(i + 1);
        beside_(i) = -(b.dot(next) - q * after.dot(next)) / l(i);
      }
      lower_(i) = -room_(i);
      upper_(i) = room_(i);
      for (Index m = 0; m < num_domain_; ++m) {
        const Point3 g = domain_gradient_.col(num_domain_ * i + m);
        const double up = g.dot(b);
        if (!(std::abs(up) > kAcross * g.norm())) continue;
        const double at = -domain_value_(m, i) / up;
        if (up > 0 && at > lower_(i)) {
          lower_(i) = std::min(at, room_(i));
          bound_[static_cast<std::size_t>(i)].first = static_cast<int>(m);
        } else if (up < 0 && at < upper_(i)) {
          upper_(i) = std::max(at, -room_(i));
          bound_[static_cast<std::size_t>(i)].second = static_cast<int>(m);
        }
      }
      if (lower_(i) > upper_(i)) lower_(i) = upper_(i) = (lower_(i) + upper_(i)) / 2;
    }
  }

  /// Minimises force . u + u . H u / 2 within the bounds, by the primal-dual active set method.
  void solve() {
    const Index n = x_.cols();
    for (Index i = 1; i + 1 < n; ++i) {  // bounds come and go from step to step
      auto& active = active_[static_cast<std::size_t>(i)];
      if (!std::isfinite(active < 0 ? lower_(i) : active > 0 ? upper_(i) : 0.0)) active = 0;
    }
    const bool convex = solve_free(true);
    for (Index round = 0; round < kMostActiveSets; ++round) {
      if (!solve_free(convex)) (void)solve_free(false);
      bool same = true;
      for (Index i = 1; i + 1 < n; ++i) {
        auto& active = active_[static_cast<std::size_t>(i)];
        const double pull =
            force_(i) + diagonal(i, convex) * move_(i) + beside_(i - 1) * move_(i - 1) + beside_(i) * move_(i + 1);
        std::int8_t now = active;
        if (active < 0 && pull < 0) now = 0;  // wants to go up
        if (active > 0 && pull > 0) now = 0;
        if (active == 0 && move_(i) < lower_(i)) now = -1;
        if (active == 0 && move_(i) > upper_(i)) now = 1;
        same = same && now == active;
        active = now;
      }
      if (same) break;
    }
    for (Index i = 1; i + 1 < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      move_(i) = std::clamp(move_(i), lower_(i), upper_(i));
      touching_[at] = active_[at] < 0 ? bound_[at].first : active_[at] > 0 ? bound_[at].second : -1;
    }
  }

  [[nodiscard]] double diagonal(Index i, bool curved) const { return diagonal_(i) + (curved ? curved_(i) : 0); }

  /// For the active set as it is, by elimination. False where the matrix is not positive definite.
  bool solve_free(bool curved) {
    const Index n = x_.cols();
    move_.setZero(n);
    pivot_.setOnes(n);
    right_.setZero(n);
    for (Index i = 1; i + 1 < n; ++i) {
      const auto active = active_[static_cast<std::size_t>(i)];
      if (active != 0) {
        pivot_(i) = 1;
        right_(i) = active < 0 ? lower_(i) : upper_(i);
        continue;
      }
      double pivot = diagonal(i, curved);
      double right = -force_(i);
      if (i > 1) {
        const double below = beside_(i - 1);
        const bool fixed = active_[static_cast<std::size_t>(i - 1)] != 0;
        right -= below * (fixed ? right_(i - 1) : right_(i - 1) / pivot_(i - 1));
        if (!fixed) pivot -= below * below / pivot_(i - 1);
      }
      if (!(pivot > 1e-8 * diagonal_(i))) return false;
      pivot_(i) = pivot;
      right_(i) = right;
    }
    for (Index i = n - 2; i > 0; --i) {
      const bool fixed = active_[static_cast<std::size_t>(i)] != 0;
      move_(i) = fixed ? right_(i) : (right_(i) - beside_(i) * move_(i + 1)) / pivot_(i);
    }
    return true;
  }

  const Surface& surface_;
  const Context& context_;
  std::unique_ptr<Evaluator> function_;
  std::unique_ptr<Evaluator> domain_;
  Index num_domain_;
  double gap_;
  double trust_ = 0;  // how far the node that moves most may go
  Vector room_;       // how far each may that has had to go back
  Points x_;
  Vector value_;
  Points gradient_;
  Points hessian_;
  Vector weight_;
  Points domain_value_;
  Points domain_gradient_;  // of component m at node i: column num_domain_ i + m
  Points side_;
  Vector bend_;  // kappa_b
  Vector diagonal_;
  Vector curved_;
  Vector beside_;  // between i and i + 1
  Vector force_;
  Vector lower_;
  Vector upper_;
  Vector move_;
  Vector pivot_;
  Vector right_;
  std::vector<std::pair<int, int>> bound_;  // the components that bound u from below and above; -1: trust
  std::vector<std::int8_t> active_;         // -1: at the lower bound, 1: at the upper one
  std::vector<int> touching_;
};

}  // namespace

BorderBand pull_taut(const Surface& surface, const Points& start, double gap, const Context& context) {
  return BandPuller(surface, gap, context).run(start);
}

}  // namespace taut::detail
