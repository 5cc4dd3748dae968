#include "surface/volume/value_statistics.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "surface/describe.hpp"

namespace taut::detail {
namespace {

constexpr std::size_t kBins = 1024;
constexpr std::array kShares = {0.05, 0.25, 0.5, 0.75, 0.95};

using Histogram = std::array<std::size_t, kBins>;

/// The first bin at which a share of all values lies in it or below.
std::size_t quantile_bin(const Histogram& histogram, double share, std::size_t total) {
  std::size_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins) {
    below += histogram[bin];
    if (static_cast<double>(below) >= share * static_cast<double>(total)) break;
    ++bin;
  }
  return bin;
}

/// The last bin of the lower class: the middle one of those that serve as well.
std::size_t otsu_bin(const Histogram& histogram, std::size_t total) {
  double sum = 0;
  for (std::size_t b = 0; b < kBins; ++b) sum += static_cast<double>(b * histogram[b]);
  double weight = 0;
  double weighted = 0;
  double best = -1;
  std::size_t first = 0;
  std::size_t last = 0;
  for (std::size_t b = 0; b + 1 < kBins; ++b) {
    weight += static_cast<double>(histogram[b]);
    weighted += static_cast<double>(b * histogram[b]);
    const double other = static_cast<double>(total) - weight;
    if (weight == 0 || other == 0) continue;
    const double difference = weighted / weight - (sum - weighted) / other;
    const double between = weight * other * difference * difference;
    if (between > best) {
      best = between;
      first = b;
    }
    if (between == best) last = b;
  }
  return (first + last) / 2;
}

}  // namespace

ValueStatistics value_statistics(const std::vector<float>& values) {
  const auto [least, largest] = std::ranges::minmax(values);
  ValueStatistics statistics{.least = least, .largest = largest, .quantiles = {}, .guess = least};
  const double width = (static_cast<double>(largest) - static_cast<double>(least)) / static_cast<double>(kBins);
  if (width == 0) {
    statistics.quantiles.assign(kShares.size(), least);
    return statistics;
  }
  Histogram histogram = {};
  for (const float value : values) {
    const double bin = (static_cast<double>(value) - static_cast<double>(least)) / width;
    ++histogram[std::min(static_cast<std::size_t>(bin), kBins - 1)];
  }
  const auto middle = [&](std::size_t bin) { return least + (static_cast<double>(bin) + 0.5) * width; };
  for (const double share : kShares) {
    statistics.quantiles.push_back(middle(quantile_bin(histogram, share, values.size())));
  }
  // Of a level set whose values are cut off at some distance from it, the level is known.
  const bool symmetric = least == -largest;
  statistics.guess = symmetric ? 0 : least + static_cast<double>(otsu_bin(histogram, values.size()) + 1) * width;
  return statistics;
}

std::string ValueStatistics::text() const {
  const auto rounded = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return std::string(text);
  };
  return "values run from " + describe(static_cast<double>(least)) + " to " + describe(static_cast<double>(largest)) +
         ", half of them within " + rounded(quantiles[1]) + " and " + rounded(quantiles[3]) + " (5 % below " +
         rounded(quantiles[0]) + ", 5 % above " + rounded(quantiles[4]) + "); a first try: " + rounded(guess);
}

std::vector<float> few_values(const std::vector<float>& values, std::size_t most) {
  std::vector<float> found;
  float previous = 0;
  for (const float value : values) {
    if (!found.empty() && value == previous) continue;
    previous = value;
    const auto place = std::ranges::lower_bound(found, value);
    if (place != found.end() && *place == value) continue;
    if (found.size() == most) return {};
    found.insert(place, value);
  }
  return found;
}

}  // namespace taut::detail
