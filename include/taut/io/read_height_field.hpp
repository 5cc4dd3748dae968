#pragma once

#include <filesystem>

#include "taut/core/context.hpp"
#include "taut/surface/height_field.hpp"

namespace taut {

/// Does the extension name a picture that `read_height_field` reads: `.pgm` or `.png`?
[[nodiscard]] bool is_height_picture(const std::filesystem::path& path);

/// Reads heights from a grey picture (`.pgm`, plain or raw, of 8 or 16 bits; `.png` of up to 16 bits) or from an `.npy`
/// array of two dimensions. Values come as they are in the file, with no gamma, one pixel = 1 unit.
///  - A picture: column i stands at x = i, the lowest row at y = 0, as it is seen.
///  - An array: entry [j, i] stands at x = i, y = j, as it is indexed.
/// Throws IoError for what cannot be read (colours, three dimensions, a cut file), naming the file; Cancelled.
[[nodiscard]] HeightField read_height_field(const std::filesystem::path& path, const Context& context = {});

}  // namespace taut
