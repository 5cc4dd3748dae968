#pragma once

#include <string>
#include <string_view>

#include "taut/view/scene.hpp"

namespace taut::detail {

std::string base64(std::string_view bytes);

/// Text that is no UTF-8, and control characters, replaced by U+FFFD.
std::string clean_utf8(std::string_view text);

/// Text for XML and HTML: clean UTF-8 with & < > " ' replaced.
std::string escape_xml(std::string_view text);

/// "#rrggbb"
std::string css_colour(const Colour& colour);

}  // namespace taut::detail
