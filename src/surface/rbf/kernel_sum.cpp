#include "surface/rbf/kernel_sum.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/rbf/kernel_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLanes = 8;
using Tag = hn::CappedTag<double, kLanes>;
using Vec = hn::Vec<Tag>;

/// 1 / sqrt(x) to about 2 ulp by the exponent-halving start and four Newton steps: half the time of a square root and
/// a division, and the same bits everywhere (the processors' own estimates differ). Large but finite at 0, NaN at NaN.
HWY_INLINE Vec reciprocal_sqrt(Vec x) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  const Vec half_x = hn::Mul(hn::Set(d, 0.5), x);
  const Vec three_halves = hn::Set(d, 1.5);
  Vec y =
      hn::BitCast(d, hn::Sub(hn::Set(du, std::uint64_t{0x5FE6EB50C7B537A9}), hn::ShiftRight<1>(hn::BitCast(du, x))));
  for (int step = 0; step < 4; ++step) {
    // x y first: at x = 0 the square of y would overflow.
    y = hn::Mul(y, hn::Sub(three_halves, hn::Mul(hn::Mul(half_x, y), y)));
  }
  return y;
}

HWY_INLINE Vec add_product(Vec sum, Vec a, Vec b) { return hn::Add(sum, hn::Mul(a, b)); }

/// Adds the eight partial sums in a fixed order.
HWY_INLINE double total(const double* p) { return ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7])); }

/// w phi, w a and w b of KernelSum without their constant factors (1, 3 or 5, and 3 or 15).
template <bool kQuintic>
HWY_INLINE void radial_parts(Vec w, Vec squared_r, Vec& phi, Vec& a, Vec& b) {
  const Vec inverse_r = reciprocal_sqrt(squared_r);
  const Vec weighted_r = hn::Mul(w, hn::Mul(squared_r, inverse_r));
  if constexpr (kQuintic) {
    a = hn::Mul(weighted_r, squared_r);
    b = weighted_r;
  } else {
    a = weighted_r;
    b = hn::Mul(w, inverse_r);
  }
  phi = hn::Mul(a, squared_r);
}

/// kOrder: 0 = value, 1 = and gradient, 2 = and Hessian. `sums`: 8 lanes each of phi, a, a u_i, b u_i u_j (j <= i).
template <int kDim, int kOrder, bool kQuintic>
HWY_NOINLINE void sum_fixed(const double* HWY_RESTRICT blocks, std::size_t num_blocks, const double* HWY_RESTRICT x,
                            double* HWY_RESTRICT sums) {
  const Tag d;
  constexpr int kPairs = kDim * (kDim + 1) / 2;
  constexpr std::size_t kStride = (kDim + 1) * kLanes;
  for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(d)) {
    Vec at[kDim];
    Vec sum_gradient[kDim];
    Vec sum_hessian[kPairs];
    for (int i = 0; i < kDim; ++i) at[i] = hn::Set(d, x[i]);
    for (int i = 0; i < kDim; ++i) sum_gradient[i] = hn::Zero(d);
    for (int i = 0; i < kPairs; ++i) sum_hessian[i] = hn::Zero(d);
    Vec sum_phi = hn::Zero(d);
    Vec sum_a = hn::Zero(d);
    for (std::size_t block = 0; block < num_blocks; ++block) {
      const double* HWY_RESTRICT p = blocks + block * kStride + lane;
      Vec u[kDim];
      Vec squared_r = hn::Zero(d);
      for (int i = 0; i < kDim; ++i) {
        u[i] = hn::Sub(at[i], hn::LoadU(d, p + static_cast<std::size_t>(i) * kLanes));
        squared_r = add_product(squared_r, u[i], u[i]);
      }
      Vec phi, a, b;
      radial_parts<kQuintic>(hn::LoadU(d, p + kDim * kLanes), squared_r, phi, a, b);
      sum_phi = hn::Add(sum_phi, phi);
      if constexpr (kOrder >= 1) {
        for (int i = 0; i < kDim; ++i) sum_gradient[i] = add_product(sum_gradient[i], a, u[i]);
      }
      if constexpr (kOrder >= 2) {
        sum_a = hn::Add(sum_a, a);
        for (int i = 0, pair = 0; i < kDim; ++i) {
          const Vec b_u = hn::Mul(b, u[i]);
          for (int j = 0; j <= i; ++j, ++pair) sum_hessian[pair] = add_product(sum_hessian[pair], b_u, u[j]);
        }
      }
    }
    hn::StoreU(sum_phi, d, sums + lane);
    hn::StoreU(sum_a, d, sums + kLanes + lane);
    for (std::size_t i = 0; i < kDim; ++i) hn::StoreU(sum_gradient[i], d, sums + (2 + i) * kLanes + lane);
    for (std::size_t i = 0; i < kPairs; ++i) hn::StoreU(sum_hessian[i], d, sums + (2 + kDim + i) * kLanes + lane);
  }
}

/// The same for any dimension, with the partial sums in memory. `u`: room for d vectors of eight lanes.
template <int kOrder, bool kQuintic>
HWY_NOINLINE void sum_any(const double* HWY_RESTRICT blocks, std::size_t num_blocks, std::size_t dim,
                          const double* HWY_RESTRICT x, double* HWY_RESTRICT sums, double* HWY_RESTRICT u) {
  const Tag d;
  const std::size_t stride = (dim + 1) * kLanes;
  const std::size_t used = 2 + (kOrder >= 1 ? dim : 0) + (kOrder >= 2 ? dim * (dim + 1) / 2 : 0);
  for (std::size_t i = 0; i < used * kLanes; ++i) sums[i] = 0;
  for (std::size_t lane = 0; lane < kLanes; lane += hn::Lanes(d)) {
    for (std::size_t block = 0; block < num_blocks; ++block) {
      const double* HWY_RESTRICT p = blocks + block * stride + lane;
      Vec squared_r = hn::Zero(d);
      for (std::size_t i = 0; i < dim; ++i) {
        const Vec u_i = hn::Sub(hn::Set(d, x[i]), hn::LoadU(d, p + i * kLanes));
        squared_r = add_product(squared_r, u_i, u_i);
        hn::StoreU(u_i, d, u + i * kLanes);
      }
      Vec phi, a, b;
      radial_parts<kQuintic>(hn::LoadU(d, p + dim * kLanes), squared_r, phi, a, b);
      double* HWY_RESTRICT sum = sums + lane;
      hn::StoreU(hn::Add(hn::LoadU(d, sum), phi), d, sum);
      if constexpr (kOrder >= 1) {
        sum = sums + 2 * kLanes + lane;
        for (std::size_t i = 0; i < dim; ++i, sum += kLanes) {
          hn::StoreU(add_product(hn::LoadU(d, sum), a, hn::LoadU(d, u + i * kLanes)), d, sum);
        }
      }
      if constexpr (kOrder >= 2) {
        double* HWY_RESTRICT sum_a = sums + kLanes + lane;
        hn::StoreU(hn::Add(hn::LoadU(d, sum_a), a), d, sum_a);
        for (std::size_t i = 0; i < dim; ++i) {
          const Vec b_u = hn::Mul(b, hn::LoadU(d, u + i * kLanes));
          for (std::size_t j = 0; j <= i; ++j, sum += kLanes) {
            hn::StoreU(add_product(hn::LoadU(d, sum), b_u, hn::LoadU(d, u + j * kLanes)), d, sum);
          }
        }
      }
    }
  }
}

template <int kOrder, bool kQuintic>
HWY_INLINE void sum(const double* blocks, std::size_t num_blocks, std::size_t dim, const double* x, double* sums,
                    double* u) {
  if (dim == 2) return sum_fixed<2, kOrder, kQuintic>(blocks, num_blocks, x, sums);
  if (dim == 3) return sum_fixed<3, kOrder, kQuintic>(blocks, num_blocks, x, sums);
  return sum_any<kOrder, kQuintic>(blocks, num_blocks, dim, x, sums, u);
}

void kernel_sum(bool quintic, int order, const double* blocks, std::size_t num_blocks, std::size_t dim, const double* x,
                double* value, double* gradient, double* hessian, double* scratch) {
  double* const sums = scratch;
  double* const u = scratch + (2 + dim + dim * (dim + 1) / 2) * kLanes;
  if (order == 0) {
    quintic ? sum<0, true>(blocks, num_blocks, dim, x, sums, u) : sum<0, false>(blocks, num_blocks, dim, x, sums, u);
  } else if (order == 1) {
    quintic ? sum<1, true>(blocks, num_blocks, dim, x, sums, u) : sum<1, false>(blocks, num_blocks, dim, x, sums, u);
  } else {
    quintic ? sum<2, true>(blocks, num_blocks, dim, x, sums, u) : sum<2, false>(blocks, num_blocks, dim, x, sums, u);
  }
  const double slope = quintic ? 5 : 3;
  const double bend = quintic ? 15 : 3;
  if (value != nullptr) *value = total(sums);
  if (gradient != nullptr) {
    for (std::size_t i = 0; i < dim; ++i) gradient[i] = slope * total(sums + (2 + i) * kLanes);
  }
  if (hessian != nullptr) {
    const double diagonal = slope * total(sums + kLanes);
    const double* pair = sums + (2 + dim) * kLanes;
    for (std::size_t i = 0; i < dim; ++i) {
      for (std::size_t j = 0; j <= i; ++j, pair += kLanes) {
        hessian[i * dim + j] = hessian[j * dim + i] = bend * total(pair);
      }
      hessian[i * dim + i] += diagonal;
    }
  }
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {

namespace {
constexpr Index kBlock = 8;
}

KernelSum::KernelSum(RbfKernel kernel, const Points& centres, const Vector& weights)
    : kernel_(kernel), dim_(centres.rows()), num_blocks_((centres.cols() + kBlock - 1) / kBlock) {
  blocks_.assign(static_cast<std::size_t>(num_blocks_ * (dim_ + 1) * kBlock), 0.0);
  for (Index i = 0; i < centres.cols(); ++i) {
    double* block = blocks_.data() + (i / kBlock) * (dim_ + 1) * kBlock + i % kBlock;
    for (Index axis = 0; axis < dim_; ++axis) block[axis * kBlock] = centres(axis, i);
    block[dim_ * kBlock] = weights(i);
  }
}

void KernelSum::operator()(const double* x, double* value, double* gradient, double* hessian) const {
  const Index needed = (2 + dim_ + dim_ * (dim_ + 1) / 2 + dim_) * kBlock;
  constexpr Index kOnStack = (2 + 10 + 55 + 10) * kBlock;
  alignas(64) std::array<double, static_cast<std::size_t>(kOnStack)> stack;
  std::vector<double> heap;
  double* scratch = stack.data();
  if (needed > kOnStack) {
    heap.resize(static_cast<std::size_t>(needed));
    scratch = heap.data();
  }
  const int order = hessian != nullptr ? 2 : gradient != nullptr ? 1 : 0;
  TAUT_DISPATCH(kernel_sum)
  (kernel_ == RbfKernel::quintic, order, blocks_.data(), static_cast<std::size_t>(num_blocks_),
   static_cast<std::size_t>(dim_), x, value, gradient, hessian, scratch);
}

}  // namespace taut::detail
#endif
