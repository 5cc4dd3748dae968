// AutoCAD DXF, the R12 dialect that every program reads: a POLYLINE in space for each curve, a POINT for a curve of
// one.

#include "io/geometry.hpp"

namespace taut::detail {
namespace {

/// Pairs of a group code and a value, a line each.
void write_place(OutputFile& out, const Geometry& geometry, Index j) {
  for (Index i = 0; i < 3; ++i) {
    out.write(i == 0 ? "10\n" : i == 1 ? "20\n" : "30\n");
    out.write_number(geometry.at(i, j));
    out.write("\n");
  }
}

}  // namespace

void write_dxf(OutputFile& out, const Geometry& geometry) {
  constexpr std::string_view kLayer = "8\ntaut\n";
  out.write("0\nSECTION\n2\nENTITIES\n");
  for (Index l = 0; l < geometry.num_lines(); ++l) {
    const Index first = geometry.line_starts[static_cast<std::size_t>(l)];
    const Index end = geometry.line_starts[static_cast<std::size_t>(l) + 1];
    if (first == end) continue;
    if (end - first == 1) {
      out.write("0\nPOINT\n");
      out.write(kLayer);
      write_place(out, geometry, first);
      continue;
    }
    // 66: vertices follow; 70: 8 = in space; the polyline's own place is a dummy.
    out.write("0\nPOLYLINE\n");
    out.write(kLayer);
    out.write("66\n1\n70\n8\n10\n0.0\n20\n0.0\n30\n0.0\n");
    for (Index j = first; j < end; ++j) {
      out.write("0\nVERTEX\n");
      out.write(kLayer);
      write_place(out, geometry, j);
      out.write("70\n32\n");  // a vertex of a polyline in space
    }
    out.write("0\nSEQEND\n");
    out.write(kLayer);
  }
  out.write("0\nENDSEC\n0\nEOF\n");
}

}  // namespace taut::detail
