#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/error.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut {

/// A table of which nobody says what its columns mean: more than three, no header, and no dimension given.
class UnnamedColumns : public IoError {
 public:
  using IoError::IoError;
};

/// Extensions `read_point_cloud` knows, lower case with their dot: ".ply", ".obj", ...
[[nodiscard]] const std::vector<std::string>& point_cloud_extensions();

/// Reads points, and normals and faces where the file has them. The extension decides the format, in either case:
/// `.ply` (ascii, binary of both byte orders), `.obj`, `.off`, `.stl` (corners welded), `.xyz`, `.pts`, `.asc`, `.txt`,
/// `.pwn`, `.pcd` (ascii, binary, compressed), `.csv`, `.tsv` and `.npy` (any dimension d; the others are d = 3), and
/// each of them compressed by gzip (`.ply.gz`). Polygons are cut into triangle fans. docs/files.md says what each
/// format may hold.
///
/// `dim` says how many columns of a table without a header are coordinates; of any file, which dimension its points
/// must have. A `.csv` or `.tsv` of more than three columns needs it, or a header.
///
/// The result has at least one point, finite coordinates, and faces whose indices are in range. Normals come as the
/// file has them, of any length; one that is not finite becomes zero (unknown). What is left out on purpose (rows of
/// NaN in an organised `.pcd`, columns that are no coordinates, points such as 0,0,0 or -9999 that stand for a missing
/// value far from all others) is told to `context.note`, and so is which columns were taken, where they are not x y z.
///
/// Throws IoError, which names the file, the line (or byte), what is wrong and what to do: a missing, empty, cut or
/// otherwise damaged file, counts that do not fit its size (nothing is allocated on a header's word alone), a
/// coordinate that is NaN, infinite or too large, an index out of range, an unknown extension. Throws Cancelled.
///
/// Numbers are read independently of the locale. Memory is bounded by a multiple of the file's size.
[[nodiscard]] PointCloud read_point_cloud(const std::filesystem::path& path, const Context& context = {},
                                          std::optional<Index> dim = {});

}  // namespace taut
