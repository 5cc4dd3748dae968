#include "points_argument.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "taut/core/error.hpp"
#include "taut/surface/height_field.hpp"

namespace taut::app {
namespace {

double parse_number(std::string_view text, const std::string& what, const char* remedy) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) {
    throw UsageError(fmt::format("{}: '{}' is beyond the range of numbers", what, text));
  }
  if (error != std::errc() || end != text.data() + text.size()) {
    throw UsageError(fmt::format("{}: '{}' is no number; {}", what, text, remedy));
  }
  return value;
}

/// The one last coordinate with F(x1, ..., z) = 0 where F is linear in z, as for z = f(x, y); else none.
std::optional<double> solve_for_last(const Surface& surface, const Vector& others) {
  constexpr double kRounding = 1e-12;
  if (surface.kind() != "formula" || surface.codim() != 1 || others.size() + 1 != surface.dim()) return std::nullopt;
  Vector x(surface.dim());
  x << others, 0;
  const double value = surface.value(x)(0);
  const double slope = surface.jacobian(x)(others.size(), 0);
  if (!std::isfinite(value) || !std::isfinite(slope) || slope == 0) return std::nullopt;
  for (const double z : {1.0, -std::numbers::sqrt2, std::numbers::e}) {
    x(others.size()) = z;
    const double expected = value + slope * z;
    const double scale = std::abs(value) + std::abs(slope * z);
    if (!(std::abs(surface.value(x)(0) - expected) <= kRounding * scale)) return std::nullopt;
  }
  return -value / slope;
}

}  // namespace

Vector parse_numbers(const std::string& text, const std::string& what, const char* remedy) {
  std::vector<double> values;
  std::size_t begin = 0;
  while (true) {
    const std::size_t comma = text.find(',', begin);
    values.push_back(parse_number(std::string_view(text).substr(begin, comma - begin), what, remedy));
    if (comma == std::string::npos) break;
    begin = comma + 1;
  }
  return Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size()));
}

Vector parse_point(const std::string& text, const char* option, const Surface& surface) {
  if (text.starts_with('@')) {
    Index index = 0;
    const auto [end, error] = std::from_chars(text.data() + 1, text.data() + text.size(), index);
    if (error != std::errc() || end != text.data() + text.size() || index < 0) {
      throw UsageError(fmt::format("{} {}: write @ and the number of a sample, as in @17", option, text));
    }
    if (surface.samples() == nullptr) {
      throw InvalidArgument(fmt::format("{} {}: this surface has no samples; give coordinates", option, text));
    }
    if (index >= surface.samples()->size()) {
      throw InvalidArgument(
          fmt::format("{} {}: samples go from @0 to @{}", option, text, surface.samples()->size() - 1));
    }
    return surface.samples()->points.col(index);
  }
  Vector point = parse_numbers(text, option);
  if (point.size() == 2 && surface.kind() == "heights") {
    const std::optional<double> z = height_at(surface, point(0), point(1));
    if (!z) throw InvalidArgument(fmt::format("{} {}: lies outside of the height field", option, text));
    point = Eigen::Vector3d(point(0), point(1), *z);
  } else if (const std::optional<double> z = solve_for_last(surface, point)) {
    point.conservativeResize(surface.dim());
    point(surface.dim() - 1) = *z;
  }
  if (point.size() > surface.dim() && surface.kind() == "formula") {
    throw InvalidArgument(
        fmt::format("{} {}: has {} coordinates, but the formula uses only {} variables; --dim {} puts "
                    "it into {} dimensions",
                    option, text, point.size(), surface.dim(), point.size(), point.size()));
  }
  if (point.size() != surface.dim()) {
    throw InvalidArgument(fmt::format("{} {}: has {} coordinates, the surface lies in {} dimensions", option, text,
                                      point.size(), surface.dim()));
  }
  if (!point.allFinite()) throw InvalidArgument(fmt::format("{} {}: coordinates must be finite", option, text));
  return point;
}

Box parse_box(const std::string& text, Index dim) {
  const Vector values = parse_numbers(text, "--box");
  if (!values.allFinite()) throw UsageError("--box " + text + ": bounds must be finite");
  Box box;
  if (values.size() == 2) {
    box = {Vector::Constant(dim, values(0)), Vector::Constant(dim, values(1))};
  } else if (values.size() == 2 * dim) {
    box = {Eigen::Map<const Vector, 0, Eigen::InnerStride<2>>(values.data(), dim),
           Eigen::Map<const Vector, 0, Eigen::InnerStride<2>>(values.data() + 1, dim)};
  } else {
    throw UsageError(fmt::format("--box {}: give lo,hi or {} numbers, lo,hi of each axis in turn", text, 2 * dim));
  }
  if (!(box.lower.array() < box.upper.array()).all()) {
    throw UsageError("--box " + text + ": each lower bound must be below its upper bound");
  }
  return box;
}

}  // namespace taut::app
