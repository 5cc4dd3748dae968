// A panel's series summed at one point, in SIMD lanes: two thirds of the time of a field with many targets went here.
//
// Rows are summed along first: row r of the series holds component r % 3 of the Chebyshev coefficient r / 3 across the
// rays. They go in groups of twelve, a multiple of three and of every number of lanes, so that each of twelve partial
// sums always holds the same component; their order does not depend on the lanes either.

#include "fan/panel_point.hpp"

#include <cstddef>

#include "fan/panel_basis.hpp"
#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fan/panel_point.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kGroup = 12;
constexpr std::size_t kRows = 3 * PanelBasis::kRays;

/// Adds the four partial sums of a component.
HWY_INLINE double fold(const double* sum) { return (sum[0] + sum[3]) + (sum[6] + sum[9]); }

/// `out`: x, d x / d alpha, d x / d beta, of the first terms across and along.
template <std::size_t kAcross, std::size_t kAlong>
HWY_INLINE void sum_terms(const double* HWY_RESTRICT series, double alpha, double beta, double* HWY_RESTRICT out) {
  static_assert(3 * kAcross % kGroup == 0);
  const hn::CappedTag<double, 4> d;
  using Vec = hn::Vec<decltype(d)>;
  constexpr std::size_t kMostVectors = kGroup / hn::MaxLanes(d);
  double tb[kAlong];
  double sb[kAlong];
  double ta[kAcross];
  double sa[kAcross];
  chebyshev_slopes(beta, kAlong, tb, sb);
  chebyshev_slopes(alpha, kAcross, ta, sa);
  double t[3 * kAcross];  // each three times, as the rows go
  double s[3 * kAcross];
  for (std::size_t m = 0; m < kAcross; ++m) {
    for (std::size_t c = 0; c < 3; ++c) {
      t[3 * m + c] = ta[m];
      s[3 * m + c] = sa[m];
    }
  }
  double x[kGroup];
  double across[kGroup];
  double along[kGroup];
  Vec sum_x[kMostVectors];
  Vec sum_across[kMostVectors];
  Vec sum_along[kMostVectors];
  for (std::size_t v = 0; v < kMostVectors; ++v) sum_x[v] = sum_across[v] = sum_along[v] = hn::Zero(d);
  for (std::size_t group = 0; group < 3 * kAcross / kGroup; ++group) {
    const double* HWY_RESTRICT rows = series + group * kGroup;
    Vec value[kMostVectors];
    Vec slope[kMostVectors];
    for (std::size_t v = 0; v < kMostVectors; ++v) {
      value[v] = hn::LoadU(d, rows + v * hn::MaxLanes(d));
      slope[v] = hn::Zero(d);
    }
    for (std::size_t n = 1; n < kAlong; ++n) {
      const Vec t_n = hn::Set(d, tb[n]);
      const Vec s_n = hn::Set(d, sb[n]);
      for (std::size_t v = 0; v < kMostVectors; ++v) {
        const Vec c = hn::LoadU(d, rows + n * kRows + v * hn::MaxLanes(d));
        value[v] = hn::Add(value[v], hn::Mul(t_n, c));
        slope[v] = hn::Add(slope[v], hn::Mul(s_n, c));
      }
    }
    for (std::size_t v = 0; v < kMostVectors; ++v) {
      const Vec t_m = hn::LoadU(d, t + group * kGroup + v * hn::MaxLanes(d));
      const Vec s_m = hn::LoadU(d, s + group * kGroup + v * hn::MaxLanes(d));
      sum_x[v] = hn::Add(sum_x[v], hn::Mul(t_m, value[v]));
      sum_across[v] = hn::Add(sum_across[v], hn::Mul(s_m, value[v]));
      sum_along[v] = hn::Add(sum_along[v], hn::Mul(t_m, slope[v]));
    }
  }
  for (std::size_t v = 0; v < kMostVectors; ++v) {
    hn::StoreU(sum_x[v], d, x + v * hn::MaxLanes(d));
    hn::StoreU(sum_across[v], d, across + v * hn::MaxLanes(d));
    hn::StoreU(sum_along[v], d, along + v * hn::MaxLanes(d));
  }
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = fold(x + c);
    out[3 + c] = fold(across + c);
    out[6 + c] = fold(along + c);
  }
}

void sum_all(const double* HWY_RESTRICT series, double alpha, double beta, double* HWY_RESTRICT out) {
  sum_terms<PanelBasis::kRays, PanelBasis::kSeries>(series, alpha, beta, out);
}

void sum_first(const double* HWY_RESTRICT series, double alpha, double beta, double* HWY_RESTRICT out) {
  sum_terms<kSketchAcross, kSketchAlong>(series, alpha, beta, out);
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {
namespace {

PanelPoint point_of(const double* out) {
  return {Eigen::Map<const Eigen::Vector3d>(out), Eigen::Map<const Eigen::Vector3d>(out + 3),
          Eigen::Map<const Eigen::Vector3d>(out + 6)};
}

}  // namespace

PanelPoint panel_point(const ExpPatch& patch, double alpha, double beta) {
  double out[9];
  TAUT_DISPATCH(sum_all)(patch.series.data(), alpha, beta, out);
  return point_of(out);
}

PanelPoint panel_sketch(const ExpPatch& patch, double alpha, double beta) {
  double out[9];
  TAUT_DISPATCH(sum_first)(patch.series.data(), alpha, beta, out);
  return point_of(out);
}

double sketch_error(const ExpPatch& patch) {
  double sum = 0;
  for (int n = 0; n < PanelBasis::kSeries; ++n) {
    for (int m = n < kSketchAlong ? kSketchAcross : 0; m < PanelBasis::kRays; ++m) {
      sum += patch.series.col(n).segment<3>(3 * m).norm();
    }
  }
  return sum;
}

}  // namespace taut::detail
#endif
