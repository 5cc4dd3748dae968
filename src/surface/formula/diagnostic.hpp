#pragma once

#include <string>
#include <string_view>

#include "taut/core/error.hpp"

namespace taut::detail {

/// `text` in quotes, cut when it is long.
[[nodiscard]] std::string quoted(std::string_view text);

/// A ParseError that says `reason` in one line, then shows `text` (a window of it when it is long) with a caret under
/// byte `column`. Columns are counted in characters, so UTF-8 in the text does not move the caret.
[[nodiscard]] ParseError parse_error(std::string_view text, std::size_t column, const std::string& reason);

}  // namespace taut::detail
