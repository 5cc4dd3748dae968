// A user's polyline or loop, checked and made a strand: projected onto the surface, and cut until its segments are no
// longer than half a cell and a 48th of the whole. A polyline that jumps so far that its class is in doubt is refused.
#include "homotopy/class_setting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "curve/polyline.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

constexpr double kMostCellsOff = 10;
constexpr double kFewestSegments = 48;

}  // namespace

void check_polyline(const Surface& surface, const PointsIn& polyline, bool closed) {
  if (polyline.rows() != surface.dim()) {
    throw InvalidArgument(fmt::format("the polyline has {} coordinates a point, the surface lies in {} dimensions",
                                      polyline.rows(), surface.dim()));
  }
  const Index fewest = closed ? 3 : 2;
  if (polyline.cols() < fewest) {
    throw InvalidArgument(fmt::format("the {} has {} point{}; it takes at least {}", closed ? "loop" : "polyline",
                                      polyline.cols(), polyline.cols() == 1 ? "" : "s", fewest));
  }
  for (Index j = 0; j < polyline.cols(); ++j) {
    if (!polyline.col(j).allFinite()) {
      throw InvalidArgument(fmt::format("point {} of the polyline: coordinates must be finite", j + 1));
    }
  }
}

ClassSetting class_setting(const Surface& surface, const StrandMaker& maker, const PointsIn& polyline, bool closed,
                           double cell) {
  ClassSetting setting;
  setting.cell = cell;
  const double length = polyline_length(polyline) + (closed ? (polyline.col(0) - polyline.rightCols(1)).norm() : 0);
  setting.gap = std::min(setting.cell / 2, length / kFewestSegments);
  if (!(setting.gap > 1e-12 * polyline.cwiseAbs().maxCoeff())) setting.gap = setting.cell / 2;  // a point, many times
  setting.strand = maker.make(polyline, closed, setting.gap, kMostCellsOff * setting.cell);
  const auto inside = surface.inside_domain(setting.strand.points, setting.cell);
  for (Index j = 0; j < inside.size(); ++j) {
    if (!inside(j)) {
      throw InvalidArgument(
          fmt::format("the polyline leaves the surface's domain at {}", text_of(setting.strand.points.col(j))));
    }
  }
  return setting;
}

}  // namespace taut::detail
