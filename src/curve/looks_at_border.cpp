// A gap between two points is looked at as a box around both. Where the bounds of every component g of the domain are
// >= 0 over it, the curve stays inside there; where one's are < 0, it is outside. Other gaps get the point half-way,
// and both halves are looked at, as long as there are some. Next to a contact that is a few gaps of every size.
#include "curve/looks_at_border.hpp"

#include <cstddef>
#include <memory>
#include <vector>

#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

/// The box reaches so far beyond both points, of their distance: an arc between them that turns by up to 2 radians is
/// inside.
constexpr double kSagitta = 0.25;
/// 64 gaps or more are halved so often, ...
constexpr int kHalvings = 14;
/// ... until there are so many points: of a curve that runs beside the border.
constexpr Index kMostPoints = 4000;

/// Which of these gaps neither stay inside nor are outside for certain. False: there are no bounds.
bool undecided(Evaluator& domain, Index count, const Points& x, std::vector<bool>& open) {
  const Index d = x.rows();
  std::vector<Index> gaps;
  for (Index i = 0; i + 1 < x.cols(); ++i) {
    if (open[static_cast<std::size_t>(i)]) gaps.push_back(i);
  }
  const auto n = static_cast<Index>(gaps.size());
  Points lower(d, n);
  Points upper(d, n);
  for (Index j = 0; j < n; ++j) {
    const Index i = gaps[static_cast<std::size_t>(j)];
    const double reach = kSagitta * (x.col(i + 1) - x.col(i)).norm();
    lower.col(j) = x.col(i).cwiseMin(x.col(i + 1)).array() - reach;
    upper.col(j) = x.col(i).cwiseMax(x.col(i + 1)).array() + reach;
  }
  Points least(count, n);
  Points most(count, n);
  if (!domain.bounds({.n = n,
                      .lower = lower.data(),
                      .upper = upper.data(),
                      .value_lower = least.data(),
                      .value_upper = most.data()})) {
    return false;
  }
  for (Index j = 0; j < n; ++j) {
    const bool inside = (least.col(j).array() >= 0).all();
    const bool outside = (most.col(j).array() < 0).any();
    open[static_cast<std::size_t>(gaps[static_cast<std::size_t>(j)])] = !inside && !outside;
  }
  return true;
}

}  // namespace

Points looks_at_border(const Surface& surface, Evaluator& function, const Points& curve) {
  const std::unique_ptr<Evaluator> domain = surface.domain()->make_evaluator();
  Points x = curve;
  std::vector<bool> open(static_cast<std::size_t>(x.cols()) - 1, true);
  for (int halving = 0; halving < kHalvings; ++halving) {
    if (!undecided(*domain, surface.domain()->codim(), x, open)) return curve;
    Index count = 0;
    for (const bool one : open) count += one ? 1 : 0;
    if (count == 0 || x.cols() + count > kMostPoints) break;
    Points middles(x.rows(), count);
    Index at = 0;
    for (Index i = 0; i + 1 < x.cols(); ++i) {
      if (open[static_cast<std::size_t>(i)]) middles.col(at++) = (x.col(i) + x.col(i + 1)) / 2;
    }
    (void)project_to_surface(function, surface.dim(), surface.codim(), middles);
    Points finer(x.rows(), x.cols() + count);
    std::vector<bool> open_finer;
    Index to = 0;
    at = 0;
    for (Index i = 0; i < x.cols(); ++i) {
      finer.col(to++) = x.col(i);
      if (i + 1 == x.cols()) break;
      const bool halved = open[static_cast<std::size_t>(i)];
      open_finer.push_back(halved);
      if (!halved) continue;
      finer.col(to++) = middles.col(at++);
      open_finer.push_back(true);
    }
    x = std::move(finer);
    open = std::move(open_finer);
  }
  return x;
}

}  // namespace taut::detail
