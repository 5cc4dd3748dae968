#pragma once

#include "taut/view/write_picture.hpp"
#include "view/raster.hpp"

namespace taut::detail {

/// Throws InvalidArgument for a size or a direction that cannot be.
void check_options(const PictureOptions& options);

/// The direction asked for, or the chosen one.
Eigen::Vector3d view_direction(const Stage& stage, const PictureOptions& options);

/// Width of a path on a picture of this size, pixels.
double path_width(int width, int height);

/// The whole scene as an image with a transparent background, fitted to the size.
Image still_image(const Stage& stage, const PictureOptions& options);

}  // namespace taut::detail
