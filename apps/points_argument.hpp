#pragma once

#include <stdexcept>
#include <string>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// What stands wrong on the command line: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "1,0,0", or "@17" for the 17th sample from 0; "1,0" over heights and where a formula is linear in its last variable,
/// as z = f(x, y) is. `option` names it in messages. Throws UsageError for text that is
/// no point, InvalidArgument for one that does not fit the surface.
[[nodiscard]] Vector parse_point(const std::string& text, const char* option, const Surface& surface);

/// "1,0,0" as numbers; `what` names it in messages.
[[nodiscard]] Vector parse_numbers(const std::string& text, const std::string& what,
                                   const char* remedy = "write numbers separated by commas, as in 1,0,0");

/// "lo,hi" for every axis, or "x0,x1,y0,y1,...".
[[nodiscard]] Box parse_box(const std::string& text, Index dim);

}  // namespace taut::app
