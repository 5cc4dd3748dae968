#include <Eigen/Geometry>
#include <string>

#include "io/geometry.hpp"

namespace taut::detail {

void write_stl(OutputFile& out, const Geometry& geometry) {
  std::string header = "written by Taut";  // must not begin with "solid", which marks the text form
  header.resize(80, ' ');
  out.write(header);
  write_raw(out, static_cast<std::int32_t>(geometry.faces.cols()));
  for (Index f = 0; f < geometry.faces.cols(); ++f) {
    Eigen::Matrix3d corner;
    for (Index i = 0; i < 3; ++i) {
      const Index j = geometry.faces(i, f);
      corner.col(i) << geometry.at(0, j), geometry.at(1, j), geometry.at(2, j);
    }
    const Eigen::Vector3d normal =
        (corner.col(1) - corner.col(0)).cross(corner.col(2) - corner.col(0)).stableNormalized();
    for (Index i = 0; i < 3; ++i) write_raw(out, static_cast<float>(normal(i)));
    for (Index c = 0; c < 3; ++c) {
      for (Index i = 0; i < 3; ++i) write_raw(out, static_cast<float>(corner(i, c)));
    }
    out.write(std::string_view("\0\0", 2));
  }
}

}  // namespace taut::detail
