// Reads a finished field at any points (d x n), a fault in one point staying its own: NaN where a point is not finite
// or singular, infinity where no reached cell lies around it.
#include "taut/march/march.hpp"

#include <limits>
#include <string>

#include "march/centre_reader.hpp"
#include "march/dimensions.hpp"
#include "march/field_reader.hpp"
#include "march/point_normals.hpp"
#include "taut/core/error.hpp"

namespace taut {

Vector distance_at(const Surface& surface, const SurfaceCells& cells, const DistanceField& field, const PointsIn& x) {
  if (x.rows() != field.sources.rows()) {
    throw InvalidArgument("distance_at: points of dimension " + std::to_string(x.rows()) +
                          " on a surface in dimension " + std::to_string(field.sources.rows()));
  }
  const Points normals = detail::normals_at(surface, x);
  Vector result(x.cols());
  const auto readable = [&](Index j) { return x.col(j).allFinite() && normals.col(j).allFinite(); };
  if (field.at_centres) {
    detail::CentreReader reader(cells.grid(), field);
    for (Index j = 0; j < x.cols(); ++j) {
      result(j) = readable(j) ? reader.distance(x.col(j)) : std::numeric_limits<double>::quiet_NaN();
    }
    return result;
  }
  detail::with_dimensions(surface.dim(), surface.codim(), [&]<int D, int K>() {
    detail::FieldReader<D, K> reader(cells, field);
    for (Index j = 0; j < x.cols(); ++j) {
      result(j) = readable(j) ? reader.distance({x.col(j).data(), normals.col(j).data()})
                              : std::numeric_limits<double>::quiet_NaN();
    }
  });
  return result;
}

}  // namespace taut
