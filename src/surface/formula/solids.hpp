#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "surface/formula/expression.hpp"

namespace taut::detail {

/// A function of constructive solid geometry. Bodies are expressions, negative inside.
struct SolidFunction {
  std::string_view name;
  std::string_view parameters;  ///< as people read it: "x, y, z, r"
  std::size_t min_arguments;
  std::size_t max_arguments;
  std::uint32_t positive;  ///< bit i: argument i must be > 0; kLast: the last one must
  NodeId (*make)(Graph& graph, std::span<const NodeId> arguments);

  static constexpr std::uint32_t kLast = 1U << 31;
  [[nodiscard]] bool must_be_positive(std::size_t argument, std::size_t count) const {
    return (argument < 31 && (positive >> argument & 1U) != 0) || ((positive & kLast) != 0 && argument + 1 == count);
  }
};

/// Primitives, unions and the like, smooth ones, and transforms; docs/formula.md has what each means.
[[nodiscard]] std::span<const SolidFunction> solid_functions();

/// The one of this name, or null.
[[nodiscard]] const SolidFunction* find_solid_function(std::string_view name);

}  // namespace taut::detail
