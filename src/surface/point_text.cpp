#include "surface/point_text.hpp"

#include <fmt/format.h>

#include "taut/core/error.hpp"

namespace taut::detail {

std::string text_of(const VectorIn& x) {
  std::string text;
  for (Index i = 0; i < x.size(); ++i) text += fmt::format("{}{}", i > 0 ? "," : "", x(i));
  return text;
}

std::string text_of(const Box& box) {
  std::string text;
  for (Index a = 0; a < box.dim(); ++a) {
    text += fmt::format("{}[{:.4g}, {:.4g}]", a > 0 ? " x " : "", box.lower(a), box.upper(a));
  }
  return text;
}

void check_point(const Surface& surface, const VectorIn& x, const char* name) {
  if (x.size() != surface.dim()) {
    throw InvalidArgument(fmt::format("{} point {}: has {} coordinates, the surface lies in {} dimensions", name,
                                      text_of(x), x.size(), surface.dim()));
  }
  if (!x.allFinite()) throw InvalidArgument(fmt::format("{} point {}: coordinates must be finite", name, text_of(x)));
}

}  // namespace taut::detail
