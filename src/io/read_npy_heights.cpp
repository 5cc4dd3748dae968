// NumPy's .npy as heights: entry [j, i] of the array stands in row j, column i.

#include "io/height_readers.hpp"
#include "io/npy_header.hpp"
#include "io/readers.hpp"

namespace taut::detail {

HeightField read_npy_heights(const InputFile& file) {
  const NpyHeader header = parse_npy_header(file);
  if (header.shape.size() != 2) {
    file.fail("the array has " + counted(header.shape.size(), "dimension") + "; heights have shape (rows, columns)");
  }
  // An array of points has the same bytes: a point a row.
  const PointCloud rows = read_npy(file);
  HeightField field;
  field.columns = rows.dim();
  field.rows = rows.size();
  field.heights.assign(rows.points.data(), rows.points.data() + rows.points.size());
  return field;
}

}  // namespace taut::detail
