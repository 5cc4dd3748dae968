// The one test of Algorithms I and II, in blocks of kBlock cells. Each part drops cells of the block that the surface
// cannot cross, cheapest first: the box; interval bounds of F over the cell; the mean value theorem with bounds of the
// Jacobian, or, where F has no bounds, its Taylor polynomial of second order; the domain. What is left may be crossed.
#include "cells/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace taut::detail {
namespace {

constexpr Index kBlock = 256;
// Allowance for third derivatives in the second-order term.
constexpr double kTaylorSafety = 2;
constexpr double kDomainSafety = 2;
// A surface that just touches a face must not be lost to the rounding of F, some units of |grad F| |x| eps.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

std::size_t idx(Index i) { return static_cast<std::size_t>(i); }

bool probe_bounds(Evaluator& evaluator, Index d, Index k) {
  const Vector x = Vector::Zero(d);
  Vector lower(k);
  Vector upper(k);
  return evaluator.bounds(
      {.n = 1, .lower = x.data(), .upper = x.data(), .value_lower = lower.data(), .value_upper = upper.data()});
}

bool probe_slopes(Evaluator& evaluator, Index d, Index k) {
  const Vector x = Vector::Zero(d);
  Vector lower(d * k);
  Vector upper(d * k);
  return evaluator.jacobian_bounds(
      {.n = 1, .lower = x.data(), .upper = x.data(), .jacobian_lower = lower.data(), .jacobian_upper = upper.data()});
}

}  // namespace

CrossingTest::CrossingTest(const Surface& surface, Vector origin, double size)
    : surface_(surface), origin_(std::move(origin)), size_(size), function_(surface.make_evaluator()) {
  const Index d = surface_.dim();
  has_bounds_ = probe_bounds(*function_, d, surface_.codim());
  has_slopes_ = has_bounds_ && probe_slopes(*function_, d, surface_.codim());
  Index m = surface_.codim();
  if (surface_.domain() != nullptr) {
    domain_ = surface_.domain()->make_evaluator();
    domain_has_bounds_ = probe_bounds(*domain_, d, surface_.domain()->codim());
    m = std::max(m, surface_.domain()->codim());
  }
  for (auto* a : {&lower_, &upper_, &centre_}) a->resize(idx(d * kBlock));
  for (auto* a : {&value_lower_, &value_upper_}) a->resize(idx(m * kBlock));
  if (!has_bounds_ || has_slopes_ || (domain_ && !domain_has_bounds_)) jacobian_.resize(idx(d * m * kBlock));
  if (has_slopes_) jacobian_upper_.resize(jacobian_.size());
  if (!has_bounds_) {
    weight_.resize(idx(m * kBlock));
    hessian_.resize(idx(d * d * kBlock));
  }
  kept_.reserve(idx(kBlock));
}

void CrossingTest::test(std::span<const std::int32_t> cells, int level, std::span<std::uint8_t> may_cross) {
  const Index d = surface_.dim();
  const Index n = static_cast<Index>(may_cross.size());
  const double scale = std::ldexp(1.0, level);
  num_tested_ += n;
  std::fill(may_cross.begin(), may_cross.end(), std::uint8_t{0});
  for (Index begin = 0; begin < n; begin += kBlock) {
    const Index count = std::min(kBlock, n - begin);
    const std::int32_t* cell = cells.data() + begin * d;
    kept_.clear();
    for (Index j = 0; j < count; ++j) {
      kept_.push_back(begin + j);
      for (Index a = 0; a < d; ++a) {
        // Exact products of integers, so that these are the faces of CellGrid to the last bit.
        const double c = scale * cell[j * d + a];
        lower_[idx(j * d + a)] = origin_(a) + size_ * c;
        upper_[idx(j * d + a)] = origin_(a) + size_ * (c + scale);
      }
    }
    if (surface_.box()) test_box();
    if (has_bounds_) {
      test_bounds();
      if (has_slopes_) test_slopes();
    } else {
      test_taylor();
    }
    if (domain_) test_domain();
    for (const Index j : kept_) may_cross[idx(j)] = 1;
  }
}

template <class Keep>
void CrossingTest::retain(const Keep& keep) {
  const Index d = surface_.dim();
  std::size_t count = 0;
  for (std::size_t slot = 0; slot < kept_.size(); ++slot) {
    if (!keep(static_cast<Index>(slot))) continue;
    if (count != slot) {
      kept_[count] = kept_[slot];
      const auto from = static_cast<std::ptrdiff_t>(slot) * d;
      const auto to = static_cast<std::ptrdiff_t>(count) * d;
      std::copy_n(lower_.begin() + from, d, lower_.begin() + to);
      std::copy_n(upper_.begin() + from, d, upper_.begin() + to);
    }
    ++count;
  }
  kept_.resize(count);
}

void CrossingTest::find_centres() {
  const std::size_t count = kept_.size() * idx(surface_.dim());
  for (std::size_t i = 0; i < count; ++i) centre_[i] = 0.5 * (lower_[i] + upper_[i]);
}

void CrossingTest::test_box() {
  const Index d = surface_.dim();
  const Box& box = *surface_.box();
  retain([&](Index slot) {
    for (Index a = 0; a < d; ++a) {
      if (lower_[idx(slot * d + a)] > box.upper(a) || upper_[idx(slot * d + a)] < box.lower(a)) return false;
    }
    return true;
  });
}

void CrossingTest::test_bounds() {
  const Index k = surface_.codim();
  function_->bounds({.n = static_cast<Index>(kept_.size()),
                     .lower = lower_.data(),
                     .upper = upper_.data(),
                     .value_lower = value_lower_.data(),
                     .value_upper = value_upper_.data()});
  retain([&](Index slot) {
    // Bounds that are both NaN: F has no value in the whole cell.
    for (Index i = slot * k; i < (slot + 1) * k; ++i) {
      const double lower = value_lower_[idx(i)];
      const double upper = value_upper_[idx(i)];
      // For several equations one of them off 0 is enough.
      if (lower > 0 || upper < 0 || (std::isnan(lower) && std::isnan(upper))) return false;
    }
    return true;
  });
}

void CrossingTest::test_slopes() {
  const Index d = surface_.dim();
  const Index k = surface_.codim();
  const Index n = static_cast<Index>(kept_.size());
  if (n == 0) return;
  find_centres();
  function_->bounds({.n = n,
                     .lower = centre_.data(),
                     .upper = centre_.data(),
                     .value_lower = value_lower_.data(),
                     .value_upper = value_upper_.data()});
  function_->jacobian_bounds({.n = n,
                              .lower = lower_.data(),
                              .upper = upper_.data(),
                              .jacobian_lower = jacobian_.data(),
                              .jacobian_upper = jacobian_upper_.data()});
  // Rounding of the distances, of their products with the slopes, of the sum.
  const double above = 1 + 2 * static_cast<double>(d + 4) * std::numeric_limits<double>::epsilon();
  retain([&](Index slot) {
    for (Index i = slot * k; i < (slot + 1) * k; ++i) {
      // Not 0: products of tiny numbers may have been rounded to 0.
      double reach = std::numeric_limits<double>::min();
      for (Index a = 0; a < d; ++a) {
        const std::size_t at = idx(slot * d + a);
        const double half = std::max(upper_[at] - centre_[at], centre_[at] - lower_[at]);
        const std::size_t entry = idx(i * d + a);
        reach += half * std::max(-jacobian_[entry], jacobian_upper_[entry]);
      }
      // Neither is true where a slope is not bounded or F has no value at the centre.
      if (value_lower_[idx(i)] > above * reach || -value_upper_[idx(i)] > above * reach) return false;
    }
    return true;
  });
}

void CrossingTest::test_taylor() {
  const Index d = surface_.dim();
  const Index k = surface_.codim();
  for (Index i = 0; i < k; ++i) {
    const Index n = static_cast<Index>(kept_.size());
    if (n == 0) return;
    find_centres();
    for (Index slot = 0; slot < n; ++slot) {
      for (Index l = 0; l < k; ++l) weight_[idx(slot * k + l)] = l == i ? 1 : 0;
    }
    function_->evaluate({.n = n,
                         .x = centre_.data(),
                         .value = value_lower_.data(),
                         .jacobian = jacobian_.data(),
                         .weight = weight_.data(),
                         .hessian = hessian_.data()});
    retain([&](Index slot) {
      double reach = 0;
      for (Index a = 0; a < d; ++a) {
        const double half = 0.5 * (upper_[idx(slot * d + a)] - lower_[idx(slot * d + a)]);
        const double slope = std::abs(jacobian_[idx((slot * k + i) * d + a)]);
        // A surface that only touches a face is kept, though F there is rounding.
        reach += slope * (half + kRounding * (half + std::abs(centre_[idx(slot * d + a)])));
        for (Index b = 0; b < d; ++b) {
          reach += 0.5 * kTaylorSafety * half * half * std::abs(hessian_[idx((slot * d + a) * d + b)]);
        }
      }
      const double value = value_lower_[idx(slot * k + i)];
      // A reach of NaN (no derivatives) keeps the cell.
      return !std::isnan(value) && !(std::abs(value) > reach);
    });
  }
}

void CrossingTest::test_domain() {
  const Index d = surface_.dim();
  const Index m = surface_.domain()->codim();
  const Index n = static_cast<Index>(kept_.size());
  if (n == 0) return;
  if (domain_has_bounds_) {
    domain_->bounds({.n = n,
                     .lower = lower_.data(),
                     .upper = upper_.data(),
                     .value_lower = value_lower_.data(),
                     .value_upper = value_upper_.data()});
  } else {
    find_centres();
    domain_->evaluate({.n = n, .x = centre_.data(), .value = value_upper_.data(), .jacobian = jacobian_.data()});
    for (Index slot = 0; slot < n; ++slot) {
      for (Index i = 0; i < m; ++i) {
        double reach = 0;
        for (Index a = 0; a < d; ++a) {
          const double half = 0.5 * (upper_[idx(slot * d + a)] - lower_[idx(slot * d + a)]);
          reach += half * std::abs(jacobian_[idx((slot * m + i) * d + a)]);
        }
        // An upper bound of the domain over the cell, to first order.
        value_upper_[idx(slot * m + i)] += kDomainSafety * reach;
      }
    }
  }
  retain([&](Index slot) {
    for (Index i = slot * m; i < (slot + 1) * m; ++i) {
      // Negative in the whole cell: outside.
      if (value_upper_[idx(i)] < 0 || std::isnan(value_upper_[idx(i)])) return false;
    }
    return true;
  });
}

}  // namespace taut::detail
