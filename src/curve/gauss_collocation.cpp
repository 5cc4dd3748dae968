#include "curve/gauss_collocation.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace taut::detail {
namespace {

using Real = long double;
constexpr int kS = GaussCollocation::kStages;
constexpr int kC = GaussCollocation::kChecks;
constexpr int kFine = kS + 4;  // Gauss points that integrate products of the tables' polynomials exactly

template <std::size_t N>
using Reals = std::array<Real, N>;

/// P_0 .. P_{N - 1} at xi, |xi| <= 1 or not.
template <class Number, std::size_t N>
std::array<Number, N> legendre_at(Number xi) {
  std::array<Number, N> p{};
  p[0] = 1;
  p[1] = xi;
  for (std::size_t n = 2; n < N; ++n) {
    const auto m = static_cast<Number>(n);
    p[n] = ((2 * m - 1) * xi * p[n - 1] - (m - 1) * p[n - 2]) / m;
  }
  return p;
}

/// int_{-1}^xi of the Legendre series c, as a series one longer.
template <class Number, std::size_t N>
std::array<Number, N + 1> integrated(const std::array<Number, N>& c) {
  std::array<Number, N + 1> sum{};
  for (std::size_t n = 0; n < N; ++n) {
    if (n == 0) {
      sum[0] += c[0];
      sum[1] += c[0];
      continue;
    }
    const Number share = c[n] / static_cast<Number>(2 * n + 1);
    sum[n + 1] += share;
    sum[n - 1] -= share;
  }
  return sum;
}

template <class Number, std::size_t N>
Number series_at(const std::array<Number, N>& c, Number xi) {
  const auto p = legendre_at<Number, N>(xi);
  Number sum = 0;
  for (std::size_t n = 0; n < N; ++n) sum += c[n] * p[n];
  return sum;
}

template <std::size_t N>
Real legendre_slope(Real xi) {  // P_N'(xi), |xi| < 1
  const auto p = legendre_at<Real, N + 1>(xi);
  return static_cast<Real>(N) * (p[N - 1] - xi * p[N]) / (1 - xi * xi);
}

/// The N Gauss points of [-1, 1] and their weights.
template <std::size_t N>
void gauss(Reals<N>& node, Reals<N>& weight) {
  for (std::size_t i = 0; i < N; ++i) {
    Real x = -std::cos(std::numbers::pi_v<Real> * (static_cast<Real>(i) + 0.75L) / (static_cast<Real>(N) + 0.5L));
    for (int step = 0; step < 20; ++step) x -= legendre_at<Real, N + 1>(x)[N] / legendre_slope<N>(x);
    const Real slope = legendre_slope<N>(x);
    node[i] = x;
    weight[i] = 2 / ((1 - x * x) * slope * slope);
  }
}

/// The kChecks Lobatto points: -1, 1 and the zeros of P_kStages'.
Reals<kC> lobatto() {
  Reals<kC> node{};
  node.front() = -1;
  node.back() = 1;
  for (std::size_t i = 1; i + 1 < kC; ++i) {
    Real x = -std::cos(std::numbers::pi_v<Real> * static_cast<Real>(i) / kS);
    for (int step = 0; step < 20; ++step) {  // (1 - x^2) P'' = 2 x P' - n (n + 1) P
      const Real slope = legendre_slope<kS>(x);
      const Real second = (2 * x * slope - kS * (kS + 1) * legendre_at<Real, kS + 1>(x)[kS]) / (1 - x * x);
      x -= slope / second;
    }
    node[i] = x;
  }
  return node;
}

GaussCollocation build() {
  GaussCollocation t;
  Reals<kS> xi{};
  Reals<kS> weight{};
  gauss<kS>(xi, weight);
  const Reals<kC> check = lobatto();
  for (std::size_t j = 0; j < kS; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    // The Legendre series of the polynomial that is 1 at node j and 0 at the others.
    Reals<kS> series{};
    const auto p = legendre_at<Real, kS>(xi[j]);
    for (std::size_t n = 0; n < kS; ++n) {
      series[n] = (2 * static_cast<Real>(n) + 1) / 2 * weight[j] * p[n];
      t.to_legendre(row, static_cast<Eigen::Index>(n)) = static_cast<double>(series[n]);
    }
    const auto first = integrated(series);
    const auto second = integrated(first);
    t.node(row) = static_cast<double>((xi[j] + 1) / 2);
    for (std::size_t i = 0; i < kS; ++i) {
      const auto column = static_cast<Eigen::Index>(i);
      t.once(row, column) = static_cast<double>(series_at(first, xi[i]) / 2);
      t.twice(row, column) = static_cast<double>(series_at(second, xi[i]) / 4);
    }
    for (std::size_t g = 0; g < kC; ++g) {
      const auto column = static_cast<Eigen::Index>(g);
      t.check_value(row, column) = static_cast<double>(series_at(series, check[g]));
      t.check_once(row, column) = static_cast<double>(series_at(first, check[g]) / 2);
      t.check_twice(row, column) = static_cast<double>(series_at(second, check[g]) / 4);
    }
    t.end_once(row) = static_cast<double>(series_at(first, Real(1)) / 2);
    t.end_twice(row) = static_cast<double>(series_at(second, Real(1)) / 4);
  }

  Reals<kFine> fine{};
  Reals<kFine> fine_weight{};
  gauss<kFine>(fine, fine_weight);
  for (std::size_t g = 0; g < kC; ++g) {
    const auto column = static_cast<Eigen::Index>(g);
    t.check(column) = static_cast<double>((check[g] + 1) / 2);
    Reals<3> moment{};
    for (std::size_t f = 0; f < kFine; ++f) {  // the polynomial that is 1 at check g, 0 at other checks and all nodes
      Real product = 1;
      for (std::size_t j = 0; j < kS; ++j) product *= (fine[f] - xi[j]) / (check[g] - xi[j]);
      for (std::size_t i = 0; i < kC; ++i) {
        if (i != g) product *= (fine[f] - check[i]) / (check[g] - check[i]);
      }
      const auto p = legendre_at<Real, 3>(fine[f]);
      for (std::size_t m = 0; m < 3; ++m) moment[m] += fine_weight[f] / 2 * product * p[m];
    }
    for (std::size_t m = 0; m < 3; ++m)
      t.defect_moment(static_cast<Eigen::Index>(m), column) = static_cast<double>(moment[m]);
  }
  return t;
}

}  // namespace

void GaussCollocation::legendre(double tau, Eigen::Ref<Eigen::Matrix<double, kStages, 1>> values) {
  const auto p = legendre_at<double, kS>(2 * tau - 1);
  for (std::size_t n = 0; n < kS; ++n) values(static_cast<Eigen::Index>(n)) = p[n];
}

void GaussCollocation::legendre_integrals(double tau, Eigen::Ref<Eigen::Matrix<double, kStages, 1>> first,
                                          Eigen::Ref<Eigen::Matrix<double, kStages, 1>> second) {
  for (std::size_t n = 0; n < kS; ++n) {
    std::array<double, kS> unit{};
    unit[n] = 1;
    const auto once = integrated(unit);
    first(static_cast<Eigen::Index>(n)) = series_at(once, 2 * tau - 1) / 2;
    second(static_cast<Eigen::Index>(n)) = series_at(integrated(once), 2 * tau - 1) / 4;
  }
}

const GaussCollocation& GaussCollocation::tables() {
  static const GaussCollocation tables = build();
  return tables;
}

}  // namespace taut::detail
