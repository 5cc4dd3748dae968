#pragma once

#include "taut/view/write_scene.hpp"
#include "view/image.hpp"
#include "view/raster.hpp"

namespace taut::detail {

/// Throws InvalidArgument for a size or a direction that cannot be.
void check_options(const PictureOptions& options);

/// From where to look: as the options or the scene say, else as chosen.
Eigen::Vector3d viewer_of(const Stage& stage, const PictureOptions& options);

/// Usual width of a path on a picture of this size, pixels.
double path_width(int width, int height);

/// The whole scene without text as an image with a transparent background, fitted to the size.
Image still_image(const Stage& stage, const PictureOptions& options);

}  // namespace taut::detail
