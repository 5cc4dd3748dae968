#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "surface/describe.hpp"
#include "surface/height/height_function.hpp"
#include "surface/height/plane_spline.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/height_field.hpp"

// Samples that were not measured are filled with the mean of their neighbours, again and again from the rim inwards, so
// that the spline is tame there; the domain ends before them. Its border is where the spline of 1 (measured) and 0, not
// interpolated but with these as its coefficients, is 2/3: a smooth curve that parts the two.

namespace taut {
namespace {

using detail::describe;
using detail::PlaneSpline;

/// Room around the grid in the surface's box, in pixels: rounding must not cut it.
constexpr double kMargin = 0.01;

void require_valid(const HeightField& field, const HeightOptions& options) {
  if (field.columns < 4 || field.rows < 4) {
    throw InvalidArgument("the grid has " + std::to_string(field.columns) + " x " + std::to_string(field.rows) +
                          " heights; a smooth surface takes at least 4 along each axis");
  }
  if (static_cast<Index>(field.heights.size()) != field.columns * field.rows) {
    throw InvalidArgument("there are " + std::to_string(field.heights.size()) + " heights for a grid of " +
                          std::to_string(field.columns) + " x " + std::to_string(field.rows) + "; give one each");
  }
  const auto require = [](bool good, const char* what, double value) {
    if (!good) throw InvalidArgument(std::string(what) + ", not " + describe(value));
  };
  for (const double pixel : {field.pixel_x, field.pixel_y}) {
    require(std::isfinite(pixel) && pixel > 0, "a pixel must be wider than 0", pixel);
  }
  require(std::isfinite(field.x0) && std::isfinite(field.y0), "the origin must be finite", field.x0 + field.y0);
  require(std::isfinite(options.z_scale) && options.z_scale != 0, "the scale of heights must be finite and not 0",
          options.z_scale);
  for (const double height : field.heights) {
    if (std::isinf(height)) throw InvalidArgument("a height is infinite: NaN stands for what was not measured");
  }
}

/// Gives what is NaN the mean of its known neighbours, rim by rim, then relaxes it towards the mean of all.
void fill(std::vector<double>& heights, Index columns, Index rows) {
  constexpr int kSweeps = 8;
  std::vector<Index> missing;
  for (Index at = 0; at < columns * rows; ++at) {
    if (std::isnan(heights[static_cast<std::size_t>(at)])) missing.push_back(at);
  }
  const auto mean_around = [&](Index at) {
    const Index i = at % columns;
    const Index j = at / columns;
    double sum = 0;
    int count = 0;
    const auto add = [&](bool there, Index other) {
      if (!there || std::isnan(heights[static_cast<std::size_t>(other)])) return;
      sum += heights[static_cast<std::size_t>(other)];
      ++count;
    };
    add(i > 0, at - 1);
    add(i + 1 < columns, at + 1);
    add(j > 0, at - columns);
    add(j + 1 < rows, at + columns);
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
  };
  for (std::vector<Index> open = missing; !open.empty();) {
    std::vector<std::pair<Index, double>> known;
    std::vector<Index> rest;
    for (const Index at : open) {
      const double mean = mean_around(at);
      if (std::isnan(mean)) {
        rest.push_back(at);
      } else {
        known.emplace_back(at, mean);
      }
    }
    for (const auto& [at, mean] : known) heights[static_cast<std::size_t>(at)] = mean;
    open = std::move(rest);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Index at : missing) heights[static_cast<std::size_t>(at)] = mean_around(at);
  }
}

/// 1 where a height was measured, else 0, as coefficients: the outermost samples speak for those beyond them.
std::vector<double> measured_coefficients(const std::vector<double>& heights, Index columns, Index rows) {
  std::vector<double> coefficients;
  for (Index j = -1; j <= rows; ++j) {
    for (Index i = -1; i <= columns; ++i) {
      const Index at = std::clamp<Index>(i, 0, columns - 1) + columns * std::clamp<Index>(j, 0, rows - 1);
      coefficients.push_back(std::isnan(heights[static_cast<std::size_t>(at)]) ? 0 : 1);
    }
  }
  return coefficients;
}

}  // namespace

Surface height_surface(const HeightField& field, const HeightOptions& options, const Context& context) {
  require_valid(field, options);
  std::vector<double> heights = field.heights;
  Index missing = 0;
  for (double& height : heights) {
    if (options.no_data && height == *options.no_data) height = std::numeric_limits<double>::quiet_NaN();
    height *= options.z_scale;
    missing += std::isnan(height) ? 1 : 0;
  }
  const Index count = field.columns * field.rows;
  if (2 * missing > count) {
    throw InvalidArgument(std::to_string(missing) + " of " + std::to_string(count) +
                          " heights were not measured: cut the field to where most were");
  }
  std::shared_ptr<const PlaneSpline> measured;
  if (missing > 0) {
    measured = std::make_shared<const PlaneSpline>(field.columns, field.rows,
                                                   measured_coefficients(heights, field.columns, field.rows));
    fill(heights, field.columns, field.rows);
    context.tell(std::to_string(missing) + " of " + std::to_string(count) +
                 " heights were not measured: the surface ends before them");
  }
  const auto [least, most] = std::ranges::minmax(heights);
  const auto spline = std::make_shared<const PlaneSpline>(PlaneSpline::through(field.columns, field.rows, heights));
  const detail::PixelFrame frame{field.x0, field.y0, field.pixel_x, field.pixel_y};
  SurfaceExtras extras;
  extras.domain = std::make_shared<const detail::HeightDomain>(field.columns, field.rows, frame, std::move(measured));
  // Between samples the spline overshoots; the box is cut where it may not be any more.
  const PlaneSpline::Range range =
      spline->range(0, static_cast<double>(field.columns - 1), 0, static_cast<double>(field.rows - 1));
  const double room = 1e-3 * std::max({most - least, field.pixel_x, field.pixel_y});
  const Eigen::Vector3d margin(kMargin * field.pixel_x, kMargin * field.pixel_y, room);
  const Eigen::Vector3d lower(field.x0, field.y0, std::min(least, range.lower));
  const Eigen::Vector3d upper(field.x0 + static_cast<double>(field.columns - 1) * field.pixel_x,
                              field.y0 + static_cast<double>(field.rows - 1) * field.pixel_y,
                              std::max(most, range.upper));
  extras.box = Box{lower - margin, upper + margin};
  return Surface(std::make_shared<const detail::HeightFunction>(spline, frame), std::move(extras));
}

std::optional<double> height_at(const Surface& surface, double x, double y) {
  const auto* const function = dynamic_cast<const detail::HeightFunction*>(&surface.function());
  return function == nullptr ? std::nullopt : function->height(x, y);
}

}  // namespace taut
