#include <string>

#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"
#include "taut/view/write_picture.hpp"
#include "view/encode.hpp"
#include "view/picture.hpp"

namespace taut {

std::string to_png(const Scene& scene, const PictureOptions& options) {
  const detail::Stage stage = detail::make_stage(scene);
  return detail::encode_png(detail::still_image(stage, options), false);
}

void write_png(const std::string& path, const Scene& scene, const PictureOptions& options) {
  write_text(path, to_png(scene, options));
}

}  // namespace taut
