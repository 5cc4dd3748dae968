#include <algorithm>
#include <cmath>
#include <string>

#include "taut/io/output_file.hpp"
#include "taut/view/write_scene.hpp"
#include "view/encode.hpp"
#include "view/encode_png.hpp"
#include "view/lettering.hpp"
#include "view/path_runs.hpp"
#include "view/picture.hpp"
#include "view/shading.hpp"

namespace taut {
namespace {

using detail::Camera;
using detail::css_colour;
using detail::DepthImage;
using detail::escape_xml;
using detail::format_number;
using detail::PathRun;
using detail::Stage;

std::string pixels(double value) {
  return format_number(std::round(value * 10) / 10 + 0.0, 7);  // + 0.0: no "-0"
}

/// `name="value"` with a space before it.
std::string attribute(const char* name, double value) {
  std::string text = " ";
  text.append(name).append("=\"").append(pixels(value)).append("\"");
  return text;
}

void append_pixel(std::string& data, double x, double y) { data.append(pixels(x)).append(",").append(pixels(y)); }

class SvgWriter {
 public:
  SvgWriter(const Stage& stage, const PictureOptions& options)
      : stage_(stage),
        options_(options),
        lettering_(options.text ? detail::letter(stage, options.width, options.height) : scene_alone(options)),
        camera_(stage, detail::viewer_of(stage, options)),
        width_(0.85 * detail::path_width(options.width, options.height)),
        point_radius_(std::max(4.0, 1.1 * width_)) {
    camera_.fit(stage, lettering_.left, lettering_.top, lettering_.right, lettering_.bottom);
  }

  std::string write() {
    open();
    surface();
    lines();
    paths();
    points();
    if (lettering_.bar) colour_bar(*lettering_.bar);
    for (const detail::Mark& mark : lettering_.marks) draw(mark);
    for (const detail::Label& label : lettering_.labels) draw(label);
    if (options_.text) {
      const double room = lettering_.bar ? lettering_.bar->x : options_.width;
      for (const detail::Label& label : detail::point_labels(stage_, camera_, point_radius_, room)) {
        draw(label);
      }
    }
    svg_ += "</svg>\n";
    return std::move(svg_);
  }

 private:
  static detail::Lettering scene_alone(const PictureOptions& options) {
    const double margin = 0.04 * std::min(options.width, options.height);
    detail::Lettering none;
    none.left = none.top = margin;
    none.right = options.width - margin;
    none.bottom = options.height - margin;
    return none;
  }

  void open() {
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"" +
           std::to_string(options_.width) + "\" height=\"" + std::to_string(options_.height) + "\" viewBox=\"0 0 " +
           std::to_string(options_.width) + " " + std::to_string(options_.height) +
           "\" font-family=\"system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif\">\n";
    svg_ += "<title>" + escape_xml(stage_.title.empty() ? "Taut" : stage_.title) + "</title>\n";
    svg_ += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  }

  /// Meshes and cells as an image.
  void surface() {
    const bool cells = stage_.cells_shown && stage_.cell_centres.cols() > 0;
    if (stage_.meshes.empty() && !cells) return;
    Context context;
    context.threads = options_.threads;
    Stage without_lines = stage_;
    without_lines.lines.clear();
    const detail::Image image = detail::render(
        without_lines, camera_,
        {.width = options_.width, .height = options_.height, .paths = false, .isolines = options_.isolines}, context);
    const std::string data = detail::base64(detail::encode_png(image, true));
    svg_ += "<image width=\"" + std::to_string(options_.width) + "\" height=\"" + std::to_string(options_.height) +
            "\" xlink:href=\"data:image/png;base64," + data + "\"/>\n";
    depth_ = detail::render_depth(stage_, camera_, options_.width, options_.height);
  }

  void stroke(const std::string& data, const std::string& colour, double width, const std::string& more) {
    svg_ += "<path d=\"" + data + "\" fill=\"none\" stroke=\"" + colour + "\"" + attribute("stroke-width", width) +
            " stroke-linecap=\"round\" stroke-linejoin=\"round\"" + more + "/>\n";
  }

  static std::string polyline(const std::vector<Eigen::Vector2d>& points) {
    std::string data;
    for (std::size_t i = 0; i < points.size(); ++i) {
      data.append(i == 0 ? "M" : i == 1 ? "L" : " ");
      append_pixel(data, points[i].x(), points[i].y());
    }
    return data;
  }

  void lines() {
    for (const detail::StageLines& lines : stage_.lines) {
      std::string data;
      // Segments that go on from one to the next are one polyline, of which what lies behind a mesh is left out.
      for (Index first = 0; first < lines.segments.cols();) {
        Index last = first;
        while (last + 1 < lines.segments.cols() && lines.segments(0, last + 1) == lines.segments(1, last)) ++last;
        Eigen::Matrix3Xf chain(3, last - first + 2);
        chain.col(0) = lines.positions.col(lines.segments(0, first));
        for (Index i = first; i <= last; ++i) chain.col(i - first + 1) = lines.positions.col(lines.segments(1, i));
        for (const PathRun& run : detail::cut_path(chain, camera_, depth_, detail::kPathLift * stage_.radius)) {
          if (!run.hidden) data += polyline(run.pixels);
        }
        first = last + 1;
      }
      if (!data.empty()) stroke(data, css_colour(lines.colour), stage_.flat ? 2 : 1, "");
    }
  }

  void paths() {
    std::vector<std::vector<PathRun>> runs;
    for (const detail::StagePath& path : stage_.paths) {
      runs.push_back(detail::cut_path(path.positions, camera_, depth_, detail::kPathLift * stage_.radius));
    }
    for (const bool hidden : {true, false}) {
      for (std::size_t i = 0; i < runs.size(); ++i) {
        const detail::StagePath& path = stage_.paths[i];
        const std::string colour = css_colour(path.colour);
        const double width = width_ * path.width;
        for (const PathRun& run : runs[i]) {
          if (run.hidden != hidden) continue;
          const std::string data = polyline(run.pixels);
          if (hidden) {
            stroke(data, colour, 0.55 * width, " stroke-opacity=\"0.6\"" + dashes(0.9 * width, 1.5 * width));
          } else {
            stroke(data, "#ffffff", width + 2.5 * std::min(path.width, 1.0), " stroke-opacity=\"0.75\"");
            stroke(data, colour, width, path.failed ? dashes(2 * width, 2.2 * width) : "");
          }
        }
      }
    }
  }

  static std::string dashes(double dash, double gap) {
    return " stroke-dasharray=\"" + pixels(dash) + " " + pixels(gap) + "\"";
  }

  void points() {
    for (const detail::StagePoint& point : stage_.points) {
      const Eigen::Vector3d x = point.position.cast<double>();
      const detail::Seen seen = camera_.see(x);
      const Eigen::Vector3d lifted = x + detail::kPathLift * stage_.radius * camera_.towards_viewer(x);
      const bool hidden = depth_.hides({seen.x, seen.y, camera_.see(lifted).nearness});
      const std::string colour = css_colour(point.colour);
      svg_ += "<circle" + attribute("cx", seen.x) + attribute("cy", seen.y) +
              attribute("r", point_radius_ * point.size) + " fill=\"" + (hidden ? "none" : colour) + "\" stroke=\"" +
              (hidden ? colour : "#ffffff") + "\"" + attribute("stroke-width", std::max(1.0, 2 * point.size)) +
              (hidden ? " stroke-opacity=\"0.7\"" : "") + "/>\n";
    }
  }

  void colour_bar(const detail::ColourBar& bar) {
    svg_ += "<defs><linearGradient id=\"scale\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">";
    for (std::size_t i = 0; i < detail::kViridis.size(); ++i) {
      svg_ +=
          "<stop offset=\"" + std::to_string(10 * i) + "%\" stop-color=\"" + css_colour(detail::kViridis[i]) + "\"/>";
    }
    svg_ += "</linearGradient></defs>\n<rect" + attribute("x", bar.x) + attribute("y", bar.y) +
            attribute("width", bar.width) + attribute("height", bar.height) + " fill=\"url(#scale)\" rx=\"2\"/>\n";
    for (const double y : bar.ticks) {
      svg_ += "<path d=\"M" + pixels(bar.x + bar.width) + "," + pixels(y) + "h5\" stroke=\"#5b6b7c\"/>\n";
    }
  }

  void draw(const detail::Mark& mark) {
    const std::string colour = css_colour(mark.colour);
    if (mark.kind == detail::LegendMark::square) {
      svg_ += "<rect" + attribute("x", mark.x + 4) + attribute("y", mark.y - 7) +
              " width=\"14\" height=\"14\" fill=\"" + colour + "\" fill-opacity=\"0.55\"/>\n";
      return;
    }
    std::string data = "M";
    append_pixel(data, mark.x, mark.y);
    stroke(data.append("h").append(pixels(detail::kMarkWidth)), colour, 4,
           mark.kind == detail::LegendMark::dashes ? dashes(4, 6) : "");
  }

  void draw(const detail::Label& label) {
    svg_ +=
        "<text" + attribute("x", label.x) + attribute("y", label.y) + attribute("font-size", label.size) + " fill=\"" +
        css_colour(label.colour) + "\" font-weight=\"" + (label.bold ? "600" : "400") + "\"" +
        (label.anchor == detail::Anchor::end ? " text-anchor=\"end\"" : "") +
        (label.halo ? " stroke=\"#ffffff\" stroke-width=\"4\" stroke-linejoin=\"round\" paint-order=\"stroke\"" : "") +
        ">" + escape_xml(label.words) + "</text>\n";
  }

  const Stage& stage_;
  const PictureOptions& options_;
  detail::Lettering lettering_;
  Camera camera_;
  DepthImage depth_;
  std::string svg_;
  double width_;         // of a usual path, pixels
  double point_radius_;  // of a usual point, pixels
};

}  // namespace

std::string to_svg(const Scene& scene, const PictureOptions& options) {
  detail::check_options(options);
  const Stage stage = detail::make_stage(scene);
  return SvgWriter(stage, options).write();
}

void write_svg(const std::string& path, const Scene& scene, const PictureOptions& options) {
  write_text(path, to_svg(scene, options));
}

}  // namespace taut
