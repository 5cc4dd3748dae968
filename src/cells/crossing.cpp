#include "taut/cells/crossing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace taut {
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

}  // namespace

CrossingTest::CrossingTest(const Surface& surface, Vector origin, double size)
    : surface_(surface), origin_(std::move(origin)), size_(size), function_(surface.make_evaluator()) {
  const Index d = surface_.dim();
  has_bounds_ = probe_bounds(*function_, d, surface_.codim());
  Index m = surface_.codim();
  if (surface_.domain() != nullptr) {
    domain_ = surface_.domain()->make_evaluator();
    domain_has_bounds_ = probe_bounds(*domain_, d, surface_.domain()->codim());
    m = std::max(m, surface_.domain()->codim());
  }
  for (auto* a : {&lower_, &upper_, &centre_}) a->resize(idx(d * kBlock));
  for (auto* a : {&value_lower_, &value_upper_}) a->resize(idx(m * kBlock));
  if (!has_bounds_ || (domain_ && !domain_has_bounds_)) jacobian_.resize(idx(d * m * kBlock));
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
  for (Index begin = 0; begin < n; begin += kBlock) {
    const Index count = std::min(kBlock, n - begin);
    const std::int32_t* cell = cells.data() + begin * d;
    for (Index j = 0; j < count; ++j) {
      for (Index a = 0; a < d; ++a) {
        // Exact products of integers, so that these are the faces of CellGrid to the last bit.
        const double c = scale * cell[j * d + a];
        lower_[idx(j * d + a)] = origin_(a) + size_ * c;
        upper_[idx(j * d + a)] = origin_(a) + size_ * (c + scale);
      }
    }
    test_block(count, may_cross.data() + begin);
  }
}

void CrossingTest::test_block(Index n, std::uint8_t* may_cross) {
  std::fill(may_cross, may_cross + n, std::uint8_t{1});
  if (surface_.box()) test_box(n, may_cross);
  if (has_bounds_) {
    test_bounds(n, may_cross);
  } else {
    test_taylor(n, may_cross);
  }
  if (domain_) test_domain(n, may_cross);
}

void CrossingTest::test_box(Index n, std::uint8_t* may_cross) const {
  const Index d = surface_.dim();
  const Box& box = *surface_.box();
  for (Index j = 0; j < n; ++j) {
    for (Index a = 0; a < d; ++a) {
      if (lower_[idx(j * d + a)] > box.upper(a) || upper_[idx(j * d + a)] < box.lower(a)) may_cross[j] = 0;
    }
  }
}

void CrossingTest::test_bounds(Index n, std::uint8_t* may_cross) {
  const Index k = surface_.codim();
  function_->bounds({.n = n,
                     .lower = lower_.data(),
                     .upper = upper_.data(),
                     .value_lower = value_lower_.data(),
                     .value_upper = value_upper_.data()});
  for (Index j = 0; j < n; ++j) {
    // Bounds that are both NaN: F has no value in the whole cell.
    for (Index i = 0; i < k; ++i) {
      const double lower = value_lower_[idx(j * k + i)];
      const double upper = value_upper_[idx(j * k + i)];
      if (lower > 0 || upper < 0 || (std::isnan(lower) && std::isnan(upper))) may_cross[j] = 0;
    }
  }
}

void CrossingTest::test_taylor(Index n, std::uint8_t* may_cross) {
  const Index d = surface_.dim();
  const Index k = surface_.codim();
  // Only what the box left is worth an evaluation.
  kept_.clear();
  for (Index j = 0; j < n; ++j) {
    if (may_cross[j] == 0) continue;
    const Index slot = static_cast<Index>(kept_.size());
    for (Index a = 0; a < d; ++a) {
      centre_[idx(slot * d + a)] = 0.5 * (lower_[idx(j * d + a)] + upper_[idx(j * d + a)]);
    }
    kept_.push_back(j);
  }
  const Index m = static_cast<Index>(kept_.size());
  if (m == 0) return;
  for (Index i = 0; i < k; ++i) {
    for (Index slot = 0; slot < m; ++slot) {
      for (Index l = 0; l < k; ++l) weight_[idx(slot * k + l)] = l == i ? 1 : 0;
    }
    function_->evaluate({.n = m,
                         .x = centre_.data(),
                         .value = value_lower_.data(),
                         .jacobian = jacobian_.data(),
                         .weight = weight_.data(),
                         .hessian = hessian_.data()});
    for (Index slot = 0; slot < m; ++slot) {
      const Index j = kept_[idx(slot)];
      double reach = 0;
      for (Index a = 0; a < d; ++a) {
        const double half = 0.5 * (upper_[idx(j * d + a)] - lower_[idx(j * d + a)]);
        const double slope = std::abs(jacobian_[idx((slot * k + i) * d + a)]);
        reach += slope * (half + kRounding * (half + std::abs(centre_[idx(slot * d + a)])));
        for (Index b = 0; b < d; ++b) {
          reach += 0.5 * kTaylorSafety * half * half * std::abs(hessian_[idx((slot * d + a) * d + b)]);
        }
      }
      const double value = value_lower_[idx(slot * k + i)];
      if (std::isnan(value) || std::abs(value) > reach) may_cross[j] = 0;
    }
  }
}

void CrossingTest::test_domain(Index n, std::uint8_t* may_cross) {
  const Index d = surface_.dim();
  const Index m = surface_.domain()->codim();
  kept_.clear();
  for (Index j = 0; j < n; ++j) {
    if (may_cross[j] == 0) continue;
    const Index slot = static_cast<Index>(kept_.size());
    for (Index a = 0; a < d; ++a) {  // slot <= j: packing in place
      lower_[idx(slot * d + a)] = lower_[idx(j * d + a)];
      upper_[idx(slot * d + a)] = upper_[idx(j * d + a)];
      centre_[idx(slot * d + a)] = 0.5 * (lower_[idx(j * d + a)] + upper_[idx(j * d + a)]);
    }
    kept_.push_back(j);
  }
  const Index count = static_cast<Index>(kept_.size());
  if (count == 0) return;
  if (domain_has_bounds_) {
    domain_->bounds({.n = count,
                     .lower = lower_.data(),
                     .upper = upper_.data(),
                     .value_lower = value_lower_.data(),
                     .value_upper = value_upper_.data()});
  } else {
    domain_->evaluate({.n = count, .x = centre_.data(), .value = value_upper_.data(), .jacobian = jacobian_.data()});
    for (Index slot = 0; slot < count; ++slot) {
      for (Index i = 0; i < m; ++i) {
        double reach = 0;
        for (Index a = 0; a < d; ++a) {
          const double half = 0.5 * (upper_[idx(slot * d + a)] - lower_[idx(slot * d + a)]);
          reach += half * std::abs(jacobian_[idx((slot * m + i) * d + a)]);
        }
        value_upper_[idx(slot * m + i)] += kDomainSafety * reach;
      }
    }
  }
  for (Index slot = 0; slot < count; ++slot) {
    for (Index i = 0; i < m; ++i) {
      const double upper = value_upper_[idx(slot * m + i)];
      if (upper < 0 || std::isnan(upper)) may_cross[kept_[idx(slot)]] = 0;
    }
  }
}

}  // namespace taut
