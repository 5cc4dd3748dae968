// taut path --start and --closed: geodesics in the homotopy class of a polyline.

#include "path_class.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "input_files.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/projection.hpp"

namespace taut::app {
namespace {

/// --from and --to may be given all the same: they must be the polyline's ends, up to rounded coordinates.
constexpr double kSameEnd = 1e-6;

std::string text_of(const Vector& x) { return fmt::format("{}", fmt::join(x.begin(), x.end(), ",")); }

void check_end(const std::string& text, const char* option, const Vector& end, double extent, const Surface& surface) {
  if (text.empty()) return;
  const Vector given = parse_point(text, option, surface);
  const Vector x = project_to_surface(surface, given).point;
  const Vector y = project_to_surface(surface, end).point;
  if ((x - y).norm() <= kSameEnd * extent) return;
  throw InvalidArgument(fmt::format("{} {}: the polyline's end there is {}, {:.3g} away; leave {} out", option, text,
                                    text_of(end), (x - y).norm(), option));
}

/// Runs `solve`, with the file before what it finds wrong with its points.
template <class Solve>
auto naming(const std::string& file, const Solve& solve) {
  try {
    return solve();
  } catch (const InvalidArgument& error) {
    throw InvalidArgument(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace

PathResult shorten_polyline(const PolylineRequest& request, const Surface& surface, const PathOptions& options,
                            const Context& context) {
  const Points polyline = read_point_list(request.file, surface, context);
  const double extent = (polyline.rowwise().maxCoeff() - polyline.rowwise().minCoeff()).maxCoeff();
  check_end(request.from, "--from", polyline.col(0), extent, surface);
  check_end(request.to, "--to", polyline.rightCols(1), extent, surface);
  return naming(request.file, [&] { return path_in_class(surface, polyline, options, context); });
}

ClosedGeodesic close_polyline(const std::string& file, const Surface& surface, const PathOptions& options,
                              const Context& context) {
  const Points polyline = read_point_list(file, surface, context);
  return naming(file, [&] { return closed_geodesic(surface, polyline, options, context); });
}

void add_closed(const ClosedGeodesic& loop, nlohmann::ordered_json& json) {
  const bool known = loop.status == Status::ok && !loop.is_point;
  json["closed"] = {{"is_point", loop.is_point},
                    {"kink", known ? nlohmann::ordered_json(loop.kink) : nullptr},
                    {"neutral", known ? nlohmann::ordered_json(loop.neutral) : nullptr}};
}

void add_closed(const ClosedGeodesic& loop, std::vector<SceneFact>& facts) {
  if (loop.status != Status::ok || loop.is_point) return;
  facts.push_back({"closed", fmt::format("kink {:.1e}{}", loop.kink,
                                         loop.neutral > 0 ? fmt::format(", {} neutral", loop.neutral) : "")});
}

}  // namespace taut::app
