#pragma once

#include <string>
#include <vector>

namespace taut::detail {

/// How the values of a volume are distributed, for people who have to choose a level.
struct ValueStatistics {
  float least = 0;
  float largest = 0;
  std::vector<double> quantiles;  ///< at 5, 25, 50, 75 and 95 %, to 1/1000 of the range
  /// 0 for values from -a to a; else the level that parts them into two classes of least variance (Otsu 1979).
  double guess = 0;

  /// "values run from 0 to 255, half of them within 3 and 80 (5 % below 0, 5 % above 133); a first try: 61"
  [[nodiscard]] std::string text() const;
};

/// `values` has at least one entry, all finite.
[[nodiscard]] ValueStatistics value_statistics(const std::vector<float>& values);

/// The different values when there are no more than `most`, ascending; empty when there are more.
[[nodiscard]] std::vector<float> few_values(const std::vector<float>& values, std::size_t most);

}  // namespace taut::detail
