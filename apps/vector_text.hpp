#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::app {

// Vectors as JSON, as lines for people and as columns of a table.

[[nodiscard]] inline nlohmann::ordered_json number_json(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

/// [x, y, ...]; null where a number is not finite.
[[nodiscard]] inline nlohmann::ordered_json vector_json(const VectorIn& x) {
  if (!x.allFinite()) return nullptr;
  return std::vector<double>(x.data(), x.data() + x.size());
}

/// "1,0,0.5", shortened after ten coordinates.
[[nodiscard]] inline std::string vector_text(const VectorIn& x) {
  constexpr Index kShown = 10;
  std::string text;
  for (Index i = 0; i < std::min(x.size(), kShown); ++i) text += fmt::format("{}{:.15g}", i > 0 ? "," : "", x(i));
  return x.size() > kShown ? text + fmt::format(",... ({} coordinates)", x.size()) : text;
}

/// "1,0,0.5," with all digits: the beginning of a line.
[[nodiscard]] inline std::string vector_columns(const VectorIn& x) {
  std::string text;
  for (const double c : x) text += fmt::format("{},", c);
  return text;
}

/// "v1,v2,v3,"
[[nodiscard]] inline std::string column_names(const std::string& name, Index d) {
  std::string text;
  for (Index i = 1; i <= d; ++i) text += fmt::format("{}{},", name, i);
  return text;
}

}  // namespace taut::app
