#pragma once

#include <string>

#include "view/image.hpp"

namespace taut::detail {

/// A PNG file's bytes, 8 bits a channel, by libpng: with alpha when `keep_alpha`, else over white.
std::string encode_png(const Image& image, bool keep_alpha);

}  // namespace taut::detail
