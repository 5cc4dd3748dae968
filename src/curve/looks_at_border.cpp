// A gap between two points is looked at as a box around both: where the bounds of every component g of the domain are
// >= 0 over it, the curve stays inside there; where one's are < 0, it is outside. Next to a contact with the border no
// box tells, be it as small as it may. There g is read at the quarters of the gap: where it follows the parabola
// through its ends and its middle, and that stays above zero, the curve stays inside. Other gaps get these three
// points, and all four parts are looked at by their quarters.
#include "curve/looks_at_border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

/// The box reaches so far beyond both points, of their distance: an arc between them that turns by up to 2 radians is
/// inside.
constexpr double kSagitta = 0.25;
/// 64 gaps or more are quartered so often, ...
constexpr int kQuarterings = 7;
/// ... until there are so many points: of a curve that runs beside the border.
constexpr Index kMostPoints = 4000;
/// g follows the parabola where it is off by less than this part of itself; what is outside by less than this part of
/// the curve's length is rounding.
constexpr double kFollows = 0.25;
constexpr double kRounding = 1e-10;

/// Does a component stay above -tiny on a gap, by its values at the ends and the quarters.
bool stays_above(const std::array<double, 5>& g, double tiny) {
  const double slope = g[4] - g[0];
  const double bend = 2 * (g[4] - 2 * g[2] + g[0]);
  for (const int i : {1, 3}) {
    const double t = i / 4.0 - 0.5;
    const double parabola = g[2] + t * (slope + t * bend);
    if (!(std::abs(g[static_cast<std::size_t>(i)] - parabola) <= kFollows * g[static_cast<std::size_t>(i)] + tiny)) {
      return false;
    }
  }
  if (std::min({g[0], g[2], g[4]}) < -tiny) return false;
  const double lowest = bend > 0 ? -slope / (2 * bend) : 1;  // from the middle, in gaps
  return std::abs(lowest) >= 0.5 || g[2] - slope * slope / (4 * bend) >= -tiny;
}

class BorderLooks {
 public:
  BorderLooks(const Surface& surface, Evaluator& function, const Points& curve)
      : surface_(surface),
        function_(function),
        domain_(surface.domain()->make_evaluator()),
        count_(surface.domain()->codim()),
        x_(curve),
        open_(static_cast<std::size_t>(curve.cols()) - 1, true) {}

  Points run() {
    if (!look_at_boxes()) return std::move(x_);
    for (int quartering = 0; quartering < kQuarterings && look_at_quarters(); ++quartering) {
    }
    return std::move(x_);
  }

 private:
  /// False: there are no bounds.
  bool look_at_boxes() {
    const Index n = x_.cols() - 1;
    const auto before = x_.leftCols(n);
    const auto after = x_.rightCols(n);
    const Eigen::RowVectorXd reach = kSagitta * (after - before).colwise().norm();
    const Points lower = before.cwiseMin(after).rowwise() - reach;
    const Points upper = before.cwiseMax(after).rowwise() + reach;
    Points least(count_, n);
    Points most(count_, n);
    if (!domain_->bounds({.n = n,
                          .lower = lower.data(),
                          .upper = upper.data(),
                          .value_lower = least.data(),
                          .value_upper = most.data()})) {
      return false;
    }
    for (Index i = 0; i < n; ++i) {
      const bool inside = (least.col(i).array() >= 0).all();
      const bool outside = (most.col(i).array() < 0).any();
      open_[static_cast<std::size_t>(i)] = !inside && !outside;
    }
    return true;
  }

  /// False: no gap is open any more, or there are too many.
  bool look_at_quarters() {
    std::vector<Index> gaps;
    for (Index i = 0; i + 1 < x_.cols(); ++i) {
      if (open_[static_cast<std::size_t>(i)]) gaps.push_back(i);
    }
    const auto n = static_cast<Index>(gaps.size());
    if (n == 0 || x_.cols() + 3 * n > kMostPoints) return false;
    // Five points a gap, its ends among them.
    Points at(x_.rows(), 5 * n);
    for (Index j = 0; j < n; ++j) {
      const Index i = gaps[static_cast<std::size_t>(j)];
      for (Index part = 0; part < 5; ++part) {
        const double t = static_cast<double>(part) / 4;
        at.col(5 * j + part) = (1 - t) * x_.col(i) + t * x_.col(i + 1);
      }
    }
    (void)project_to_surface(function_, surface_.dim(), surface_.codim(), at);
    Points value(count_, 5 * n);
    Points jacobian(x_.rows() * count_, 5 * n);
    domain_->evaluate({.n = 5 * n, .x = at.data(), .value = value.data(), .jacobian = jacobian.data()});
    double length = 0;
    for (Index i = 0; i + 1 < x_.cols(); ++i) length += (x_.col(i + 1) - x_.col(i)).norm();
    const auto is_inside = [&](Index j) {
      for (Index c = 0; c < count_; ++c) {
        const double gradient = jacobian.col(5 * j + 2).segment(c * x_.rows(), x_.rows()).norm();
        std::array<double, 5> g{};
        for (Index part = 0; part < 5; ++part) g[static_cast<std::size_t>(part)] = value(c, 5 * j + part);
        if (!stays_above(g, kRounding * length * gradient)) return false;
      }
      return true;
    };
    Points finer(x_.rows(), x_.cols() + 3 * n);
    std::vector<bool> open;
    Index to = 0;
    for (Index i = 0, j = 0; i < x_.cols(); ++i) {
      finer.col(to++) = x_.col(i);
      if (i + 1 == x_.cols()) break;
      const bool looked = open_[static_cast<std::size_t>(i)];
      if (looked && !is_inside(j)) {
        finer.middleCols(to, 3) = at.middleCols(5 * j + 1, 3);
        to += 3;
        open.insert(open.end(), 4, true);
      } else {
        open.push_back(false);
      }
      if (looked) ++j;
    }
    x_ = finer.leftCols(to);
    open_ = std::move(open);
    return true;
  }

  const Surface& surface_;
  Evaluator& function_;
  std::unique_ptr<Evaluator> domain_;
  Index count_;
  Points x_;
  std::vector<bool> open_;  // one a gap: not known to be inside or outside
};

}  // namespace

Points looks_at_border(const Surface& surface, Evaluator& function, const Points& curve) {
  return BorderLooks(surface, function, curve).run();
}

}  // namespace taut::detail
