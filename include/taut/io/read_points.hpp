#pragma once

#include <filesystem>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut {

/// Reads a list of points, d x n in the file's order (what `taut path --start` and `--samples` take): every format of
/// `read_point_cloud`, of which only the points are used; any other extension (`.txt`, `.dat`, none) is read like
/// `.csv`. In `.csv`, `.xyz`, `.pts` and plain text a line is a point: `dim` numbers, or columns named x y z ... in a
/// header.
///
/// `dim` > 0 is the dimension the points must have. Throws IoError as `read_point_cloud` does, and when the dimension
/// is another one.
[[nodiscard]] Points read_points(const std::filesystem::path& path, Index dim, const Context& context = {});

}  // namespace taut
