#include "taut/core/error.hpp"

#include <algorithm>

namespace taut {
namespace {

/// Restricted Damerau-Levenshtein distance, a change of case at half price so that `Sin` is nearest to `sin`.
double distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  // Rows of the table for the first i-2, i-1 and i letters of `a`.
  std::vector<double> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<double>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before.swap(last);
    last.swap(row);
    row[0] = static_cast<double>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const double change = a[i - 1] == b[j - 1] ? 0 : lower(a[i - 1]) == lower(b[j - 1]) ? 0.5 : 1;
      row[j] = std::min({row[j - 1] + 1, last[j] + 1, last[j - 1] + change});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& known) {
  double best = name.size() < 2 ? 0.5 : name.size() <= 4 ? 1 : 2;
  std::string_view nearest;
  for (const std::string_view candidate : known) {
    const double d = distance(name, candidate);
    if (d < best || (d == best && nearest.empty())) {
      best = d;
      nearest = candidate;
    }
  }
  return nearest;
}

}  // namespace taut
