// Drawings as pixels, by Cairo, which also draws their text.

#include "drawing.hpp"

#ifdef TAUT_HAVE_CAIRO

#include <cairo.h>

#include <memory>
#include <numbers>

namespace taut::paper {
namespace {

class CairoShapes {
 public:
  explicit CairoShapes(cairo_t* cairo) : cairo_(cairo) {
    cairo_set_line_cap(cairo, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  }

  void operator()(const Stroke& stroke) {
    trace(stroke.points, stroke.closed);
    if (stroke.fill) {
      use(*stroke.fill, stroke.fill_opacity);
      cairo_fill_preserve(cairo_);
    }
    if (stroke.width > 0) {
      use(stroke.colour);
      cairo_set_line_width(cairo_, stroke.width);
      cairo_set_dash(cairo_, &stroke.dash, stroke.dash > 0 ? 1 : 0, 0);
      cairo_stroke_preserve(cairo_);
    }
    cairo_new_path(cairo_);
    if (!stroke.arrow) return;
    use(stroke.colour);
    trace(arrow_head(stroke.points, stroke.width), true);
    cairo_fill(cairo_);
  }

  void operator()(const Disc& disc) {
    cairo_arc(cairo_, disc.centre.x(), disc.centre.y(), disc.radius, 0, 2 * std::numbers::pi);
    use(disc.hollow ? Colour::hex(0xffffff) : disc.colour);
    cairo_fill_preserve(cairo_);
    use(disc.hollow ? disc.colour : Colour::hex(0xffffff));
    cairo_set_line_width(cairo_, disc.hollow ? 1.8 : 1.2);
    cairo_set_dash(cairo_, nullptr, 0, 0);
    cairo_stroke(cairo_);
  }

  void operator()(const TextLine& label) {
    cairo_select_font_face(cairo_, "sans-serif", label.italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                           label.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    const std::vector<TextRun> runs = text_runs(label.text);
    double width = 0;
    for (const TextRun& run : runs) {
      cairo_text_extents_t extents;
      size_for(run, label);
      cairo_text_extents(cairo_, run.text.c_str(), &extents);
      width += extents.x_advance;
    }
    cairo_save(cairo_);
    cairo_translate(cairo_, label.at.x(), label.at.y());
    if (label.upwards) cairo_rotate(cairo_, -std::numbers::pi / 2);
    const double part = label.anchor == TextAnchor::start ? 0 : label.anchor == TextAnchor::middle ? 0.5 : 1;
    use(label.colour);
    double x = -part * width;
    for (const TextRun& run : runs) {
      size_for(run, label);
      cairo_move_to(cairo_, x, -0.32 * run.shift * label.size);
      cairo_show_text(cairo_, run.text.c_str());
      double y = 0;
      cairo_get_current_point(cairo_, &x, &y);
    }
    cairo_new_path(cairo_);
    cairo_restore(cairo_);
  }

 private:
  void use(const Colour& colour, double opacity = 1) {
    cairo_set_source_rgba(cairo_, static_cast<double>(colour.red), static_cast<double>(colour.green),
                          static_cast<double>(colour.blue), opacity);
  }
  void trace(const Points& points, bool closed) {
    cairo_new_path(cairo_);
    for (const auto& point : points.colwise()) cairo_line_to(cairo_, point(0), point(1));
    if (closed) cairo_close_path(cairo_);
  }
  void size_for(const TextRun& run, const TextLine& label) {
    cairo_set_font_size(cairo_, run.shift == 0 ? label.size : kShiftedSize * label.size);
  }

  cairo_t* cairo_;
};

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

std::string to_png(const Drawing& drawing, double scale) {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> image(
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(scale * drawing.width),
                                 static_cast<int>(scale * drawing.height)),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> cairo(cairo_create(image.get()), cairo_destroy);
  cairo_scale(cairo.get(), scale, scale);
  cairo_set_source_rgb(cairo.get(), 1, 1, 1);
  cairo_paint(cairo.get());
  CairoShapes shapes(cairo.get());
  for (const auto& shape : drawing.shapes) std::visit(shapes, shape);
  std::string bytes;
  cairo_surface_write_to_png_stream(image.get(), append, &bytes);
  return bytes;
}

}  // namespace taut::paper

#else

namespace taut::paper {
std::string to_png(const Drawing& /*drawing*/, double /*scale*/) { return {}; }
}  // namespace taut::paper

#endif
