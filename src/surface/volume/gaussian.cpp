#include "surface/volume/gaussian.hpp"

#include <cmath>

namespace taut::detail {
namespace {

/// The kernel is cut off after so many standard deviations, where it has fallen to 3e-4.
constexpr double kReach = 4;

/// The weights of the entries 0, 1, 2, ... away, which with their mirror images sum to 1.
std::vector<double> gaussian_weights(double sigma) {
  std::vector<double> weights(static_cast<std::size_t>(std::ceil(kReach * sigma)) + 1);
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double t = static_cast<double>(i) / sigma;
    weights[i] = std::exp(-0.5 * t * t);
    sum += i == 0 ? weights[i] : 2 * weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

void smooth_gaussian(Lattice& lattice, double sigma, const Context& context) {
  const std::vector<double> weights = gaussian_weights(sigma);
  const auto reach = static_cast<Index>(weights.size()) - 1;
  const auto filter = [&](double* line, Index n) {
    const std::vector<double> source(line, line + n * kBundle);
    const auto entry = [&](Index i) { return source.data() + std::clamp<Index>(i, 0, n - 1) * kBundle; };
    for (Index i = 0; i < n; ++i) {
      for (Index w = 0; w < kBundle; ++w) line[i * kBundle + w] = weights[0] * entry(i)[w];
      for (Index r = 1; r <= reach; ++r) {
        const double weight = weights[static_cast<std::size_t>(r)];
        const double* before = entry(i - r);
        const double* after = entry(i + r);
        for (Index w = 0; w < kBundle; ++w) line[i * kBundle + w] += weight * (before[w] + after[w]);
      }
    }
  };
  for (int axis = 0; axis < 3; ++axis) filter_lines(lattice, axis, context, filter);
}

}  // namespace taut::detail
