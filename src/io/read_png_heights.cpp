// Grey PNG pictures as heights, by libpng's plain interface: its simple one would apply the picture's gamma.

#include <png.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>
#include <vector>

#include "io/height_readers.hpp"

namespace taut::detail {
namespace {

struct PngSource {
  const char* next;
  std::size_t left;
};

struct PngFailure {
  std::string message;
};

void read_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto* const source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "the file is cut short");
  std::memcpy(out, source->next, count);
  source->next += count;
  source->left -= count;
}

// libpng is C and unwinds nothing of its own: an exception may pass where it is built with unwind tables, as on Debian.
[[noreturn]] void fail(png_structp, png_const_charp message) { throw PngFailure{message}; }
void ignore(png_structp, png_const_charp) {}

struct PngReader {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, ignore);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  PngReader() = default;
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

HeightField read(const InputFile& file) {
  PngReader reader;
  if (reader.png == nullptr || reader.info == nullptr) file.fail("libpng cannot be started");
  PngSource source{file.bytes.data(), file.bytes.size()};
  png_set_read_fn(reader.png, &source, read_bytes);
  png_read_info(reader.png, reader.info);
  const png_byte colour = png_get_color_type(reader.png, reader.info);
  if (colour != PNG_COLOR_TYPE_GRAY) {
    file.fail("is a picture in colours or with transparency; heights are grey: save it as grey, with 16 bits");
  }
  const int depth = png_get_bit_depth(reader.png, reader.info);
  if (depth < 8) png_set_packing(reader.png);  // one value a byte, as it is
  (void)png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  HeightField field;
  field.columns = static_cast<Index>(png_get_image_width(reader.png, reader.info));
  field.rows = static_cast<Index>(png_get_image_height(reader.png, reader.info));
  const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
  // A picture that is all one colour shrinks a thousandfold.
  constexpr std::size_t kMostInflation = 1100;
  const auto rows = static_cast<std::size_t>(field.rows);
  if (row_bytes > kMostInflation * file.bytes.size() / rows) {
    file.fail("the picture is larger than the file can hold; it is damaged");
  }
  std::vector<png_byte> pixels(row_bytes * rows);
  std::vector<png_bytep> row_pointers(rows);
  for (std::size_t j = 0; j < rows; ++j) row_pointers[j] = pixels.data() + row_bytes * j;
  png_read_image(reader.png, row_pointers.data());
  field.heights.resize(static_cast<std::size_t>(field.columns * field.rows));
  const std::size_t width = depth == 16 ? 2 : 1;
  for (std::size_t j = 0; j < rows; ++j) {
    const png_byte* p = row_pointers[j];
    for (Index i = 0; i < field.columns; ++i, p += width) {
      field.heights[j * static_cast<std::size_t>(field.columns) + static_cast<std::size_t>(i)] =
          width == 1 ? p[0] : 256.0 * p[0] + p[1];
    }
  }
  turn_rows(field);
  return field;
}

}  // namespace

HeightField read_png_heights(const InputFile& file) {
  try {
    return read(file);
  } catch (const PngFailure& failure) {
    file.fail("is no whole PNG picture: " + failure.message);
  }
}

}  // namespace taut::detail
