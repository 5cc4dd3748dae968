#pragma once

#include "view/image.hpp"
#include "view/lettering.hpp"

namespace taut::detail {

/// Draws lettering onto an image, over what is there: smooth edges, no fonts needed.
void draw_lettering(const Lettering& lettering, Image& image);
void draw_label(const Label& label, Image& image);

}  // namespace taut::detail
