#include "view/encode_png.hpp"

#include <png.h>

#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// The image over white, three channels.
std::vector<std::uint8_t> over_white(const Image& image) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.rgba.size() / 4 * 3);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const int alpha = image.rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      rgb.push_back(static_cast<std::uint8_t>(255 + (image.rgba[i + c] - 255) * alpha / 255));
    }
  }
  return rgb;
}

}  // namespace

std::string encode_png(const Image& image, bool keep_alpha) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = keep_alpha ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  const std::vector<std::uint8_t> opaque = keep_alpha ? std::vector<std::uint8_t>() : over_white(image);
  const std::uint8_t* pixels = keep_alpha ? image.rgba.data() : opaque.data();
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);  // by libpng's own bound: one pass over the picture is enough
  std::string png(size, '\0');
  if (png_image_write_to_memory(&header, png.data(), &size, 0, pixels, 0, nullptr) == 0) {
    throw OutOfMemory(std::string("a picture cannot be compressed: ") + header.message);
  }
  png.resize(size);
  return png;
}

}  // namespace taut::detail
