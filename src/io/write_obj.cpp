#include "io/geometry.hpp"

namespace taut::detail {

void write_obj(OutputFile& out, const Geometry& geometry) {
  out.write("# written by Taut\n");
  for (Index j = 0; j < geometry.size(); ++j) {
    out.write("v ");
    write_numbers(out, 3, " ", [&](Index i) { return geometry.at(i, j); });
    out.write("\n");
  }
  for (Index j = 0; geometry.has_normals() && j < geometry.size(); ++j) {
    out.write("vn ");
    write_numbers(out, 3, " ", [&](Index i) { return geometry.normal_at(i, j); });
    out.write("\n");
  }
  for (Index f = 0; f < geometry.faces.cols(); ++f) {
    out.write("f");
    for (Index i = 0; i < 3; ++i) {
      const std::ptrdiff_t corner = geometry.faces(i, f) + std::ptrdiff_t{1};
      out.write(" ");
      out.write_number(corner);
      if (!geometry.has_normals()) continue;
      out.write("//");
      out.write_number(corner);
    }
    out.write("\n");
  }
  for (Index l = 0; l < geometry.num_lines(); ++l) {
    const Index first = geometry.line_starts[static_cast<std::size_t>(l)];
    const Index end = geometry.line_starts[static_cast<std::size_t>(l) + 1];
    if (first == end) continue;
    out.write(end - first == 1 ? "p" : "l");
    for (Index j = first; j < end; ++j) {
      out.write(" ");
      out.write_number(j + 1);
    }
    out.write("\n");
  }
}

}  // namespace taut::detail
