#include <string>

#include "taut/io/output_file.hpp"
#include "taut/view/write_scene.hpp"
#include "view/canvas.hpp"
#include "view/encode_png.hpp"
#include "view/picture.hpp"

namespace taut {
namespace {

void put_on_white(detail::Image& image) {
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const int alpha = image.rgba[i + 3];
    for (std::size_t c = 0; c < 3; ++c) {
      image.rgba[i + c] = static_cast<std::uint8_t>(255 + (image.rgba[i + c] - 255) * alpha / 255);
    }
    image.rgba[i + 3] = 255;
  }
}

/// The scene with the text around it.
detail::Image lettered_image(const detail::Stage& stage, const PictureOptions& options) {
  detail::check_options(options);
  const detail::Lettering lettering = detail::letter(stage, options.width, options.height);
  detail::Camera camera(stage, detail::viewer_of(stage, options));
  camera.fit(stage, lettering.left, lettering.top, lettering.right, lettering.bottom);
  const double path_width = detail::path_width(options.width, options.height);
  Context context;
  context.threads = options.threads;
  detail::Image image = detail::render(
      stage, camera,
      {.width = options.width, .height = options.height, .isolines = options.isolines, .path_width = path_width},
      context);
  put_on_white(image);
  detail::draw_lettering(lettering, image);
  const double room = lettering.bar ? lettering.bar->x : options.width;
  for (const detail::Label& label : detail::point_labels(stage, camera, path_width, room)) {
    detail::draw_label(label, image);
  }
  return image;
}

}  // namespace

std::string to_png(const Scene& scene, const PictureOptions& options) {
  const detail::Stage stage = detail::make_stage(scene);
  return detail::encode_png(options.text ? lettered_image(stage, options) : detail::still_image(stage, options), false);
}

void write_png(const std::string& path, const Scene& scene, const PictureOptions& options) {
  write_text(path, to_png(scene, options));
}

}  // namespace taut
