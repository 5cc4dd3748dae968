#include "view/picture.hpp"

#include <algorithm>
#include <string>

#include "taut/core/error.hpp"

namespace taut::detail {

void check_options(const PictureOptions& options) {
  constexpr int kSmallest = 16;
  constexpr int kLargest = 16384;
  for (const int size : {options.width, options.height}) {
    if (size < kSmallest || size > kLargest) {
      throw InvalidArgument("a picture's sides must lie between " + std::to_string(kSmallest) + " and " +
                            std::to_string(kLargest) + " pixels, not " + std::to_string(size));
    }
  }
  if (!options.towards_viewer.allFinite()) throw InvalidArgument("the direction to look from is not finite");
}

Eigen::Vector3d viewer_of(const Stage& stage, const PictureOptions& options) {
  if (stage.flat) return Eigen::Vector3d::UnitZ();
  if (!options.towards_viewer.isZero()) return options.towards_viewer;
  return stage.towards_viewer.isZero() ? choose_view(stage) : stage.towards_viewer;
}

double path_width(int width, int height) { return std::max(2.0, 0.0085 * std::min(width, height)); }

Image still_image(const Stage& stage, const PictureOptions& options) {
  check_options(options);
  Camera camera(stage, viewer_of(stage, options));
  const double margin = 0.04 * std::min(options.width, options.height);
  camera.fit(stage, margin, margin, options.width - margin, options.height - margin);
  Context context;
  context.threads = options.threads;
  return render(stage, camera,
                {.width = options.width,
                 .height = options.height,
                 .isolines = options.isolines,
                 .path_width = path_width(options.width, options.height)},
                context);
}

}  // namespace taut::detail
