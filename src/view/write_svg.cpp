#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "taut/io/output_file.hpp"
#include "taut/view/write_picture.hpp"
#include "view/encode.hpp"
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

constexpr double kMargin = 28;
constexpr double kTitleSize = 22;
constexpr double kTextSize = 14;
constexpr double kLine = 21;
constexpr double kBarRoom = 96;  // for the colour bar
constexpr std::size_t kMostLegendLines = 8;

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

/// One line a path; many paths are summed up in one.
struct LegendLine {
  Colour colour;
  std::string text;
};

std::vector<LegendLine> legend_of(const Stage& stage) {
  std::vector<LegendLine> lines;
  if (stage.paths.empty()) return lines;
  if (stage.paths.size() > kMostLegendLines) {
    const auto shorter = [](const auto& a, const auto& b) { return a.length < b.length; };
    const auto [low, high] = std::minmax_element(stage.paths.begin(), stage.paths.end(), shorter);
    lines.push_back({stage.paths.front().colour, std::to_string(stage.paths.size()) + " paths, lengths " +
                                                     format_number(low->length, 6) + " to " +
                                                     format_number(high->length, 6)});
    return lines;
  }
  for (const detail::StagePath& path : stage.paths) {
    lines.push_back(
        {path.colour, (path.label.empty() ? "path" : path.label) + ", length " + format_number(path.length, 10)});
  }
  return lines;
}

class SvgWriter {
 public:
  SvgWriter(const Scene& scene, const Stage& stage, const PictureOptions& options)
      : scene_(scene), stage_(stage), options_(options), camera_(stage, detail::view_direction(stage, options)) {
    legend_ = legend_of(stage);
    const double top =
        kMargin + (scene.title.empty() ? 0 : kTitleSize + 10) + kLine * static_cast<double>(legend_.size());
    bottom_ = options.height - kMargin - kLine * static_cast<double>(stage.caption.size());
    right_ = options.width - kMargin - (stage.scalar_name.empty() ? 0 : kBarRoom);
    // A small picture gives its room to the scene: text may then lie over it.
    top_ = std::min(top, 0.3 * options.height);
    camera_.fit(stage, kMargin, top_ + 6, std::max(right_, 0.6 * options.width),
                std::max(bottom_ - 6, 0.6 * options.height));
    width_ = detail::path_width(options.width, options.height) * 0.85;
  }

  std::string write() {
    open();
    surface();
    lines();
    paths();
    points();
    if (!stage_.scalar_name.empty()) colour_bar();
    text();
    svg_ += "</svg>\n";
    return std::move(svg_);
  }

 private:
  void open() {
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"" +
           std::to_string(options_.width) + "\" height=\"" + std::to_string(options_.height) + "\" viewBox=\"0 0 " +
           std::to_string(options_.width) + " " + std::to_string(options_.height) +
           "\" font-family=\"system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif\">\n";
    svg_ += "<title>" + escape_xml(scene_.title.empty() ? "Taut" : scene_.title) + "</title>\n";
    svg_ += "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  }

  void surface() {
    if (stage_.meshes.empty()) return;
    Context context;
    context.threads = options_.threads;
    Stage only_meshes = stage_;
    only_meshes.lines.clear();
    const detail::Image image = detail::render(
        only_meshes, camera_, {.width = options_.width, .height = options_.height, .paths = false}, context);
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
      for (const auto& segment : lines.segments.colwise()) {
        for (Index i = 0; i < 2; ++i) {
          const detail::Seen p = camera_.see(lines.positions.col(segment(i)).cast<double>());
          data.append(i == 0 ? "M" : "L");
          append_pixel(data, p.x, p.y);
        }
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
        const std::string colour = css_colour(stage_.paths[i].colour);
        for (const PathRun& run : runs[i]) {
          if (run.hidden != hidden) continue;
          const std::string data = polyline(run.pixels);
          if (hidden) {
            stroke(data, colour, 0.55 * width_,
                   " stroke-opacity=\"0.6\" stroke-dasharray=\"" + pixels(0.9 * width_) + " " + pixels(1.5 * width_) +
                       "\"");
          } else {
            stroke(data, "#ffffff", width_ + 2.5, " stroke-opacity=\"0.75\"");
            stroke(data, colour, width_, "");
          }
        }
      }
    }
  }

  void points() {
    const double radius = std::max(4.0, 1.1 * width_);
    for (const detail::StagePoint& point : stage_.points) {
      const Eigen::Vector3d x = point.position.cast<double>();
      const detail::Seen seen = camera_.see(x);
      const Eigen::Vector3d lifted = x + detail::kPathLift * stage_.radius * camera_.towards_viewer(x);
      const bool hidden = depth_.hides({seen.x, seen.y, camera_.see(lifted).nearness});
      svg_ += "<circle" + attribute("cx", seen.x) + attribute("cy", seen.y) + attribute("r", radius) + " fill=\"" +
              (hidden ? "none" : css_colour(point.colour)) + "\" stroke=\"" +
              (hidden ? css_colour(point.colour) : "#ffffff") + "\" stroke-width=\"2\"" +
              (hidden ? " stroke-opacity=\"0.7\"" : "") + "/>\n";
      if (point.label.empty()) continue;
      constexpr double kLabelRoom = 110;
      const bool room_right = seen.x < options_.width - kLabelRoom;
      const bool to_left = seen.x > kLabelRoom && (!room_right || seen.x < 0.5 * options_.width);
      svg_ += "<text" + attribute("x", seen.x + (to_left ? -1 : 1) * (radius + 6)) + attribute("y", seen.y - radius) +
              attribute("font-size", kTextSize + 1) + " font-weight=\"600\" fill=\"#1b2733\" text-anchor=\"" +
              (to_left ? "end" : "start") +
              "\" stroke=\"#ffffff\" stroke-width=\"4\" stroke-linejoin=\"round\" paint-order=\"stroke\">" +
              escape_xml(point.label) + "</text>\n";
    }
  }

  void colour_bar() {
    const double height = 0.6 * (bottom_ - top_);
    const double x = options_.width - kMargin - kBarRoom + 24;
    const double y = top_ + 0.2 * (bottom_ - top_);
    constexpr double kBarWidth = 16;
    svg_ += "<defs><linearGradient id=\"scale\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">";
    for (std::size_t i = 0; i < detail::kViridis.size(); ++i) {
      svg_ +=
          "<stop offset=\"" + std::to_string(10 * i) + "%\" stop-color=\"" + css_colour(detail::kViridis[i]) + "\"/>";
    }
    svg_ += "</linearGradient></defs>\n<rect" + attribute("x", x) + attribute("y", y) + attribute("width", kBarWidth) +
            attribute("height", height) + " fill=\"url(#scale)\" rx=\"2\"/>\n";
    label(x, y - 10, stage_.scalar_name, kTextSize, "#1b2733", "600");
    const double range = stage_.scalar_max - stage_.scalar_min;
    const double step = detail::nice_step(range, 5);
    for (double k = std::ceil(stage_.scalar_min / step - 1e-6); k * step <= stage_.scalar_max + 1e-6 * range; ++k) {
      const double at = y + height * (1 - (k * step - stage_.scalar_min) / range);
      svg_ += "<path d=\"M" + pixels(x + kBarWidth) + "," + pixels(at) + "h5\" stroke=\"#5b6b7c\"/>\n";
      label(x + kBarWidth + 9, at + 4.5, format_number(k * step, 6), kTextSize - 1, "#3a4856", "400");
    }
  }

  void label(double x, double y, const std::string& words, double size, const char* colour, const char* weight) {
    svg_ += "<text" + attribute("x", x) + attribute("y", y) + attribute("font-size", size) + " fill=\"" + colour +
            "\" font-weight=\"" + weight + "\">" + escape_xml(words) + "</text>\n";
  }

  void text() {
    double y = kMargin;
    if (!scene_.title.empty()) {
      y += kTitleSize - 6;
      label(kMargin, y, scene_.title, kTitleSize, "#1b2733", "650");
      y += 10;
    }
    for (const LegendLine& line : legend_) {
      y += kLine;
      std::string swatch = "M";
      append_pixel(swatch, kMargin + 2, y - 5);
      stroke(swatch.append("h22"), css_colour(line.colour), 4, "");
      label(kMargin + 34, y, line.text, kTextSize, "#3a4856", "400");
    }
    y = options_.height - kMargin - kLine * static_cast<double>(stage_.caption.size());
    for (const std::string& line : stage_.caption) {
      y += kLine;
      label(kMargin, y, line, kTextSize - 1, "#5b6b7c", "400");
    }
  }

  const Scene& scene_;
  const Stage& stage_;
  const PictureOptions& options_;
  Camera camera_;
  DepthImage depth_;
  std::vector<LegendLine> legend_;
  std::string svg_;
  double top_ = 0;
  double bottom_ = 0;
  double right_ = 0;
  double width_ = 0;
};

}  // namespace

std::string to_svg(const Scene& scene, const PictureOptions& options) {
  detail::check_options(options);
  const Stage stage = detail::make_stage(scene);
  return SvgWriter(scene, stage, options).write();
}

void write_svg(const std::string& path, const Scene& scene, const PictureOptions& options) {
  write_text(path, to_svg(scene, options));
}

}  // namespace taut
