#pragma once

#include <array>
#include <cstddef>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Where the entries of a symmetric matrix and of a symmetric third-order tensor in D variables stand when each is kept
/// once: row by row with i <= j (<= k).
template <int D>
struct SymmetricLayout {
  static constexpr std::size_t kDim = D;
  static constexpr std::size_t kPairs = kDim * (kDim + 1) / 2;
  static constexpr std::size_t kTriples = kDim * (kDim + 1) * (kDim + 2) / 6;

  std::array<std::array<std::size_t, kDim>, kDim> pair{};
  std::array<std::array<std::array<std::size_t, kDim>, kDim>, kDim> triple{};

  static constexpr SymmetricLayout make() {
    SymmetricLayout layout;
    std::size_t pairs = 0;
    std::size_t triples = 0;
    for (std::size_t i = 0; i < kDim; ++i) {
      for (std::size_t j = i; j < kDim; ++j) {
        layout.pair[i][j] = layout.pair[j][i] = pairs++;
        for (std::size_t k = j; k < kDim; ++k) {
          for (const auto& [a, b, c] : {std::array{i, j, k}, std::array{i, k, j}, std::array{j, i, k},
                                        std::array{j, k, i}, std::array{k, i, j}, std::array{k, j, i}}) {
            layout.triple[a][b][c] = triples;
          }
          ++triples;
        }
      }
    }
    return layout;
  }
};

/// A polynomial of degree three in D variables, p(u) = c + g.u + H(u, u) / 2 + T(u, u, u) / 6, kept as c, g, H, T: all
/// its derivatives come of sums of the same products. Loops have constant lengths; the compiler unrolls them.
template <int D>
struct Cubic {
  static constexpr std::size_t kDim = D;
  static constexpr SymmetricLayout<D> kLayout = SymmetricLayout<D>::make();
  static constexpr std::size_t kPairs = SymmetricLayout<D>::kPairs;
  static constexpr std::size_t kLinear = 1;
  static constexpr std::size_t kQuadratic = kLinear + kDim;
  static constexpr std::size_t kCubic = kQuadratic + kPairs;
  static constexpr std::size_t kSize = kCubic + SymmetricLayout<D>::kTriples;

  std::array<double, kSize> coefficient{};

  /// T(u, ., .) at entry (i, j).
  [[nodiscard]] double third(std::size_t i, std::size_t j, const std::array<double, kDim>& u) const {
    double sum = 0;
    for (std::size_t k = 0; k < kDim; ++k) sum += coefficient[kCubic + kLayout.triple[i][j][k]] * u[k];
    return sum;
  }

  [[nodiscard]] double value(const std::array<double, kDim>& u) const {
    double sum = 0;
    for (std::size_t i = 0; i < kDim; ++i) {
      double row = 0;
      for (std::size_t j = 0; j < kDim; ++j) {
        row += (coefficient[kQuadratic + kLayout.pair[i][j]] + third(i, j, u) * (1.0 / 3)) * u[j];
      }
      sum += u[i] * (coefficient[kLinear + i] + 0.5 * row);
    }
    return coefficient[0] + sum;
  }

  /// Gradient and Hessian (packed, kPairs entries).
  void derivatives(const std::array<double, kDim>& u, std::array<double, kDim>& gradient,
                   std::array<double, kPairs>& hessian) const {
    for (std::size_t i = 0; i < kDim; ++i) {
      double row = 0;
      for (std::size_t j = 0; j < kDim; ++j) {
        const std::size_t ij = kLayout.pair[i][j];
        const double along = third(i, j, u);
        row += (coefficient[kQuadratic + ij] + 0.5 * along) * u[j];
        if (j >= i) hessian[ij] = coefficient[kQuadratic + ij] + along;
      }
      gradient[i] = coefficient[kLinear + i] + row;
    }
  }

  /// The largest |p(v) - p(u) - grad p(u).(v - u)| for |v_a - u_a| <= half_a: sums of absolute values, exact Taylor
  /// terms.
  [[nodiscard]] double curvature_reach(const std::array<double, kDim>& u, const std::array<double, kDim>& half) const {
    double second = 0;
    double third_order = 0;
    for (std::size_t i = 0; i < kDim; ++i) {
      for (std::size_t j = 0; j < kDim; ++j) {
        const double h = coefficient[kQuadratic + kLayout.pair[i][j]] + third(i, j, u);
        second += (h < 0 ? -h : h) * half[i] * half[j];
        for (std::size_t k = 0; k < kDim; ++k) {
          const double t = coefficient[kCubic + kLayout.triple[i][j][k]];
          third_order += (t < 0 ? -t : t) * half[i] * half[j] * half[k];
        }
      }
    }
    return second / 2 + third_order / 6;
  }

  /// What multiplies each coefficient in p(u) (the first kSize numbers of `out`) and in its derivatives by u_1 .. u_D
  /// (kSize numbers each).
  static void basis(const std::array<double, kDim>& u, double* out) {
    for (std::size_t e = 0; e < (kDim + 1) * kSize; ++e) out[e] = 0;
    const auto slope = [&](std::size_t axis, std::size_t at) -> double& { return out[(1 + axis) * kSize + at]; };
    out[0] = 1;
    for (std::size_t i = 0; i < kDim; ++i) {
      out[kLinear + i] = u[i];
      slope(i, kLinear + i) = 1;
      for (std::size_t j = i; j < kDim; ++j) {
        const double half = i == j ? 0.5 : 1;
        const std::size_t ij = kQuadratic + kLayout.pair[i][j];
        out[ij] = half * u[i] * u[j];
        slope(i, ij) += half * u[j];
        slope(j, ij) += half * u[i];
        for (std::size_t k = j; k < kDim; ++k) {
          const double part = i == j && j == k ? 1.0 / 6 : i == j || j == k ? 0.5 : 1;
          const std::size_t ijk = kCubic + kLayout.triple[i][j][k];
          out[ijk] = part * u[i] * u[j] * u[k];
          slope(i, ijk) += part * u[j] * u[k];
          slope(j, ijk) += part * u[i] * u[k];
          slope(k, ijk) += part * u[i] * u[j];
        }
      }
    }
  }
};

/// A cubic that speaks for a ball: f(x) = radius p((x - centre) / radius).
template <int D>
struct Patch {
  std::array<double, D> centre{};
  double radius = 0;
  Cubic<D> cubic;
};

}  // namespace taut::detail
