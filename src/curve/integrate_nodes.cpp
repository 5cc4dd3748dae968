// The products of a step's integration matrices, in SIMD lanes: two thirds of what a ray takes besides its surface went
// there. A place is a lane, so that every instruction set adds the same numbers in the same order.

#include "curve/integrate_nodes.hpp"

#include <cstddef>

#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "curve/integrate_nodes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void integrate(const double* HWY_RESTRICT once, const double* HWY_RESTRICT twice, const double* HWY_RESTRICT at,
               std::size_t dim, double h, const double* HWY_RESTRICT x, const double* HWY_RESTRICT v,
               const double* HWY_RESTRICT a, double* HWY_RESTRICT velocity, double* HWY_RESTRICT position) {
  constexpr std::size_t kPlaces = GaussCollocation::kStages;
  const hn::CappedTag<double, kPlaces> d;
  const auto step = hn::Set(d, h);
  const auto square = hn::Set(d, h * h);
  for (std::size_t c = 0; c < dim; ++c) {
    const double* HWY_RESTRICT row = a + c * kPlaces;
    for (std::size_t i = 0; i < kPlaces; i += hn::Lanes(d)) {
      auto first = hn::Mul(hn::LoadU(d, once + i), hn::Set(d, row[0]));
      auto second = hn::Mul(hn::LoadU(d, twice + i), hn::Set(d, row[0]));
      for (std::size_t j = 1; j < kPlaces; ++j) {
        const auto a_j = hn::Set(d, row[j]);
        first = hn::Add(first, hn::Mul(hn::LoadU(d, once + j * kPlaces + i), a_j));
        second = hn::Add(second, hn::Mul(hn::LoadU(d, twice + j * kPlaces + i), a_j));
      }
      const auto straight = hn::Mul(hn::LoadU(d, at + i), hn::Set(d, h * v[c]));
      hn::StoreU(hn::Add(hn::Mul(step, first), hn::Set(d, v[c])), d, velocity + c * kPlaces + i);
      hn::StoreU(hn::Add(hn::Add(hn::Mul(square, second), straight), hn::Set(d, x[c])), d, position + c * kPlaces + i);
    }
  }
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {

void integrate_nodes(const NodeWeights& weights, Index dim, double h, const double* x, const double* v, const double* a,
                     double* velocity, double* position) {
  TAUT_DISPATCH(integrate)
  (weights.once.data(), weights.twice.data(), weights.at.data(), static_cast<std::size_t>(dim), h, x, v, a, velocity,
   position);
}

}  // namespace taut::detail
#endif
