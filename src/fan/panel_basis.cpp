// Tables of the panels of a geodesic fan (Gauss collocation along the rays, Chebyshev polynomials across them).
// Everything is a linear map of nodal values; each is built from closed forms in long double and rounded once.

#include "fan/panel_basis.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace taut::detail {
namespace {

using Real = long double;
constexpr int kS = PanelBasis::kStages;
constexpr int kN = PanelBasis::kRays;
constexpr int kC = PanelBasis::kSeries;
constexpr Real kPi = std::numbers::pi_v<Real>;
template <int N>
using Reals = std::array<Real, static_cast<std::size_t>(N)>;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <int N, class T>
std::array<T, static_cast<std::size_t>(N)> legendre(T xi) {
  std::array<T, static_cast<std::size_t>(N)> p{};
  p[0] = 1;
  p[1] = xi;
  for (int n = 2; n < N; ++n) {
    p[at(n)] =
        (static_cast<T>(2 * n - 1) * xi * p[at(n - 1)] - static_cast<T>(n - 1) * p[at(n - 2)]) / static_cast<T>(n);
  }
  return p;
}

template <std::size_t N>
Real series_at(const std::array<Real, N>& series, Real xi) {
  const auto p = legendre<static_cast<int>(N)>(xi);
  Real sum = 0;
  for (std::size_t n = 0; n < N; ++n) sum += series[n] * p[n];
  return sum;
}

/// The integral from -1, in xi: int P_n = (P_{n+1} - P_{n-1}) / (2 n + 1).
template <std::size_t N>
std::array<Real, N + 1> integrated(const std::array<Real, N>& series) {
  std::array<Real, N + 1> result{};
  result[0] += series[0];
  result[1] += series[0];
  for (std::size_t n = 1; n < N; ++n) {
    const Real part = series[n] / (2 * static_cast<Real>(n) + 1);
    result[n + 1] += part;
    result[n - 1] -= part;
  }
  return result;
}

Real legendre_slope(Real xi) {  // of P_kS, |xi| < 1
  const auto p = legendre<kS + 1>(xi);
  return kS * (p[kS - 1] - xi * p[kS]) / (1 - xi * xi);
}

void build_along(PanelBasis& t) {
  Reals<kS> xi{};
  Reals<kS> weight{};
  for (int i = 0; i < kS; ++i) {
    Real x = -std::cos(kPi * (static_cast<Real>(i) + 0.75L) / (kS + 0.5L));
    for (int step = 0; step < 20; ++step) x -= legendre<kS + 1>(x)[kS] / legendre_slope(x);
    xi[at(i)] = x;
    weight[at(i)] = 2 / ((1 - x * x) * legendre_slope(x) * legendre_slope(x));
  }
  for (int j = 0; j < kS; ++j) {
    Reals<kS> series{};  // of the polynomial that is 1 at node j and 0 at the others
    const auto p = legendre<kS>(xi[at(j)]);
    for (int n = 0; n < kS; ++n) {
      series[at(n)] = (2 * static_cast<Real>(n) + 1) / 2 * weight[at(j)] * p[at(n)];
      t.to_legendre(j, n) = static_cast<double>(series[at(n)]);
    }
    const auto first = integrated(series);
    const auto second = integrated(first);
    t.node(j) = static_cast<double>((xi[at(j)] + 1) / 2);
    for (int i = 0; i < kS; ++i) {
      t.once(j, i) = static_cast<double>(series_at(first, xi[at(i)]) / 2);
      t.twice(j, i) = static_cast<double>(series_at(second, xi[at(i)]) / 4);
    }
    t.end_once(j) = static_cast<double>(series_at(first, Real(1)) / 2);
    t.end_twice(j) = static_cast<double>(series_at(second, Real(1)) / 4);
    for (int n = 0; n < kC; ++n) {
      Real sum = 0;
      for (int g = 0; g < kC; ++g) {
        const Real angle = kPi * (static_cast<Real>(g) + 0.5L) / kC;
        sum += series_at(second, std::cos(angle)) / 4 * std::cos(n * angle);
      }
      t.twice_series(j, n) = static_cast<double>(sum * (n == 0 ? 1 : 2) / kC);
    }
  }
}

void build_across(PanelBasis& t) {
  Reals<kN> angle{};
  for (int i = 0; i < kN; ++i) angle[at(i)] = kPi * (static_cast<Real>(kN - 1 - i) + 0.5L) / kN;
  std::array<Reals<kN>, static_cast<std::size_t>(kN)> series{};  // series[n][i]
  for (int n = 0; n < kN; ++n) {
    for (int i = 0; i < kN; ++i) {
      series[at(n)][at(i)] = std::cos(n * angle[at(i)]) * (n == 0 ? 1 : 2) / kN;
      t.ray_series(n, i) = static_cast<double>(series[at(n)][at(i)]);
    }
  }
  for (int i = 0; i < kN; ++i) {
    t.ray(i) = static_cast<double>(std::cos(angle[at(i)]));
    for (int j = 0; j < kN; ++j) {
      Real slope = 0;
      Real lower = 0;
      Real upper = 0;
      for (int n = 0; n < kN; ++n) {
        const Real weight = series[at(n)][at(j)];
        slope += weight * n * std::sin(n * angle[at(i)]) / std::sin(angle[at(i)]);
        lower += weight * std::cos(n * std::acos((std::cos(angle[at(i)]) - 1) / 2));
        upper += weight * std::cos(n * std::acos((std::cos(angle[at(i)]) + 1) / 2));
      }
      t.ray_slope(i, j) = static_cast<double>(slope);
      t.half[0](i, j) = static_cast<double>(lower);
      t.half[1](i, j) = static_cast<double>(upper);
    }
  }
}

}  // namespace

const PanelBasis& PanelBasis::tables() {
  static const PanelBasis tables = [] {
    PanelBasis t;
    build_along(t);
    build_across(t);
    return t;
  }();
  return tables;
}

void legendre_at(double tau, double* value) {
  const auto p = legendre<kS>(2 * tau - 1);
  for (int n = 0; n < kS; ++n) value[n] = p[at(n)];
}

}  // namespace taut::detail
