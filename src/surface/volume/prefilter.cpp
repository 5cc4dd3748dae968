// Interpolation by cubic B-splines, one axis after the other.
//
// On a line of values f_0 .. f_{n-1} the spline sum_i c_i B(x - i), i = -1 .. n, has to satisfy
//     (c_{i-1} + 4 c_i + c_{i+1}) / 6 = f_i.                                    (1)
// Two conditions are open. Not-a-knot ends (the first two pieces are one cubic, the last two as well; de Boor 1978)
// keep the fourth order up to the border, where mirrored ends would force a zero slope. The fourth difference of c then
// vanishes at 1, which with (1) for i = 0, 1, 2 leaves
//     c_1 = (8 f_1 - f_0 - f_2) / 6,                                            (2)
// likewise c_{n-2}, and between these (1) is a tridiagonal system. Elimination on it is the pair of recursive filters
// of Unser, Aldroubi and Eden 1991 with exact starts: its factors tend to their pole z = sqrt(3) - 2 within some 15
// entries. Then (1) gives c_0 and c_{-1} outwards.

#include "surface/volume/prefilter.hpp"

namespace taut::detail {
namespace {

/// The factors of the elimination: c_i = (g_i - c_{i+1}) * factor_i, where g_i = 6 f_i - factor_{i-1} g_{i-1}.
std::vector<double> elimination_factors(Index n) {
  std::vector<double> factors(static_cast<std::size_t>(n));
  double factor = 0;
  for (double& entry : factors) {
    factor = 1 / (4 - factor);
    entry = factor;
  }
  return factors;
}

/// The lines' values stand in entries 1 .. n of n + 2. Below, c(i) is entry i of a line, from -1 to n.
void interpolate(double* lines, Index n, const std::vector<double>& factors) {
  const auto c = [&](Index i) { return lines + (i + 1) * kBundle; };
  double first[kBundle];
  double last[kBundle];
  for (Index w = 0; w < kBundle; ++w) {
    first[w] = (8 * c(1)[w] - c(0)[w] - c(2)[w]) / 6;  // (2)
    last[w] = (8 * c(n - 2)[w] - c(n - 1)[w] - c(n - 3)[w]) / 6;
  }
  for (Index w = 0; w < kBundle; ++w) {
    // What the ends will need once their neighbours are overwritten: 6 f.
    c(-1)[w] = 6 * c(0)[w];
    c(n)[w] = 6 * c(n - 1)[w];
    c(0)[w] = 6 * c(1)[w];
    c(n - 1)[w] = 6 * c(n - 2)[w];
    c(1)[w] = first[w];
  }
  for (Index i = 2; i <= n - 3; ++i) {
    const double factor = i == 2 ? 1 : factors[static_cast<std::size_t>(i - 3)];
    for (Index w = 0; w < kBundle; ++w) c(i)[w] = 6 * c(i)[w] - factor * c(i - 1)[w];
  }
  for (Index w = 0; w < kBundle; ++w) c(n - 2)[w] = last[w];
  for (Index i = n - 3; i >= 2; --i) {
    const double factor = factors[static_cast<std::size_t>(i - 2)];
    for (Index w = 0; w < kBundle; ++w) c(i)[w] = factor * (c(i)[w] - c(i + 1)[w]);
  }
  for (Index w = 0; w < kBundle; ++w) {
    c(0)[w] -= 4 * c(1)[w] + c(2)[w];
    c(n - 1)[w] -= 4 * c(n - 2)[w] + c(n - 3)[w];
    c(-1)[w] -= 4 * c(0)[w] + c(1)[w];
    c(n)[w] -= 4 * c(n - 1)[w] + c(n - 2)[w];
  }
}

}  // namespace

void interpolate_lines(double* lines, Index n) { interpolate(lines, n, elimination_factors(n)); }

void prefilter(Lattice& lattice, const Context& context) {
  for (int axis = 0; axis < 3; ++axis) {
    const Index n = lattice.size[static_cast<std::size_t>(axis)] - 2;
    const std::vector<double> factors = elimination_factors(n);
    filter_lines(lattice, axis, context, [&](double* lines, Index) { interpolate(lines, n, factors); });
  }
}

}  // namespace taut::detail
