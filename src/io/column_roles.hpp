#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace taut::detail {

/// Which columns of a table are coordinates and which are normals.
struct ColumnRoles {
  std::vector<std::size_t> coordinates;  ///< empty where the header does not name them
  std::vector<std::size_t> normals;      ///< as many as coordinates, or none
  std::vector<std::size_t> others;
  bool some_named = false;  ///< at least one name is one of a coordinate or a normal
  bool angles = false;      ///< no coordinates, but latitudes and longitudes
};

/// Reads the roles from column names, in any order and case, with or without units in brackets:
///   x y z w, x1 x2 ..., x0 x1 ...; Points_0 Points_1 ... and other prefixes of viewers and solvers; easting northing
///   elevation; nx ny nz, normal_x ..., n1 n2 ..., Normals_0 ... for normals.
[[nodiscard]] ColumnRoles roles_from_header(const std::vector<std::string_view>& names);

/// Does this look like a line of column names? It does when not every field is a number (nan and inf included) and none
/// begins like one.
[[nodiscard]] bool is_header(const std::vector<std::string_view>& fields);

/// "column 'a'", "columns 'a', 'b'" of the named columns; a long list is cut.
[[nodiscard]] std::string list_columns(const std::vector<std::string_view>& names,
                                       const std::vector<std::size_t>& columns);

}  // namespace taut::detail
