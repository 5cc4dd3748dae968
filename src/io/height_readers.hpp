#pragma once

#include "io/input_file.hpp"
#include "taut/surface/height_field.hpp"

namespace taut::detail {

/// Reads what `read_height_field` promises from bytes already in memory; the path's extension decides the format.
[[nodiscard]] HeightField parse_height_field(const InputFile& file);

// One function a format. Each throws IoError on anything wrong.
[[nodiscard]] HeightField read_pgm(const InputFile& file);
[[nodiscard]] HeightField read_png_heights(const InputFile& file);
[[nodiscard]] HeightField read_npy_heights(const InputFile& file);

/// Rows of a picture come from the top; those of a field from y = 0 upwards.
void turn_rows(HeightField& field);

}  // namespace taut::detail
