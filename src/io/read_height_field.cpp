#include "taut/io/read_surface.hpp"

#include <algorithm>

#include "io/height_readers.hpp"

namespace taut {
namespace detail {

HeightField parse_height_field(const InputFile& file) {
  const std::string extension = lower_extension(file.path);
  if (extension == ".pgm") return read_pgm(file);
  if (extension == ".png") return read_png_heights(file);
  if (extension == ".npy") return read_npy_heights(file);
  file.fail("heights are read from .pgm, .png and .npy; convert it");
}

void turn_rows(HeightField& field) {
  for (Index j = 0; j < field.rows / 2; ++j) {
    const auto row = field.heights.begin() + field.columns * j;
    std::swap_ranges(row, row + field.columns, field.heights.begin() + field.columns * (field.rows - 1 - j));
  }
}

}  // namespace detail

bool is_height_picture(const std::filesystem::path& path) {
  const std::string extension = detail::lower_extension(path);
  return extension == ".pgm" || extension == ".png";
}

HeightField read_height_field(const std::filesystem::path& path, const Context& context) {
  return detail::parse_height_field(detail::read_file(path, context));
}

}  // namespace taut
