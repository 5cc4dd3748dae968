#pragma once

#include <string>

#include "taut/view/scene.hpp"

namespace taut {

/// One self-contained page, in WebGL2, that opens from a file without a network: the surface to turn, zoom and move
/// with mouse, touch or keys, with the paths drawn over it. Numbers are embedded as float32 and uint32. Where there is
/// no WebGL2 or no JavaScript it shows a still picture instead. Deterministic: equal scenes give equal bytes. Throws
/// InvalidArgument for a scene that cannot be drawn (nothing in it, unequal dimensions, indices out of range,
/// coordinates that are not finite).
[[nodiscard]] std::string to_html(const Scene& scene);

/// Writes that page. The file appears whole or not at all. Throws IoError too.
void write_html(const std::string& path, const Scene& scene);

}  // namespace taut
