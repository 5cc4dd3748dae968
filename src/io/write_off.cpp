#include "io/geometry.hpp"

namespace taut::detail {

void write_off(OutputFile& out, const Geometry& geometry) {
  out.write(geometry.has_normals() ? "NOFF\n" : "OFF\n");
  out.write_number(geometry.size());
  out.write(" ");
  out.write_number(geometry.faces.cols());
  out.write(" 0\n");
  for (Index j = 0; j < geometry.size(); ++j) {
    write_numbers(out, geometry.has_normals() ? 6 : 3, " ",
                  [&](Index i) { return i < 3 ? geometry.at(i, j) : geometry.normal_at(i - 3, j); });
    out.write("\n");
  }
  for (Index f = 0; f < geometry.faces.cols(); ++f) {
    out.write("3 ");
    write_numbers(out, 3, " ", [&](Index i) -> std::ptrdiff_t { return geometry.faces(i, f); });
    out.write("\n");
  }
}

}  // namespace taut::detail
