#include "drawing.hpp"

#include <fmt/format.h>

#include <cmath>

#include "table.hpp"

namespace taut::paper {
namespace {

std::string css(const Colour& colour) {
  const auto byte = [](float channel) { return static_cast<int>(std::lround(channel * 255)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour.red), byte(colour.green), byte(colour.blue));
}

std::string path_data(const Points& points, bool closed) {
  std::string data;
  for (Index i = 0; i < points.cols(); ++i) {
    data += fmt::format("{}{:.1f},{:.1f}", i == 0 ? "M" : i == 1 ? "L" : " ", points(0, i), points(1, i));
  }
  return closed ? data + "Z" : data;
}

class SvgShapes {
 public:
  std::string text;

  void operator()(const Stroke& stroke) {
    text += "<path d=\"" + path_data(stroke.points, stroke.closed) + "\"";
    if (stroke.fill) {
      text += fmt::format(" fill=\"{}\" fill-opacity=\"{:.3g}\"", css(*stroke.fill), stroke.fill_opacity);
    } else {
      text += " fill=\"none\"";
    }
    if (stroke.width > 0) {
      text += fmt::format(" stroke=\"{}\" stroke-width=\"{:.3g}\" stroke-linejoin=\"round\" stroke-linecap=\"round\"",
                          css(stroke.colour), stroke.width);
    }
    if (stroke.dash > 0) text += fmt::format(" stroke-dasharray=\"{:.3g}\"", stroke.dash);
    text += "/>\n";
    if (stroke.arrow) {
      text += fmt::format("<path d=\"{}\" fill=\"{}\"/>\n", path_data(arrow_head(stroke.points, stroke.width), true),
                          css(stroke.colour));
    }
  }

  void operator()(const Disc& disc) {
    text += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.3g}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"{}\"/>\n",
        disc.centre.x(), disc.centre.y(), disc.radius, disc.hollow ? "#ffffff" : css(disc.colour),
        disc.hollow ? css(disc.colour) : "#ffffff", disc.hollow ? 1.8 : 1.2);
  }

  void operator()(const TextLine& label) {
    const char* anchor = label.anchor == TextAnchor::start ? "start"
                         : label.anchor == TextAnchor::end ? "end"
                                                           : "middle";
    text += fmt::format("<text x=\"{0:.1f}\" y=\"{1:.1f}\" font-size=\"{2:.3g}\" fill=\"{3}\" text-anchor=\"{4}\"",
                        label.at.x(), label.at.y(), label.size, css(label.colour), anchor);
    if (label.bold) text += " font-weight=\"600\"";
    if (label.italic) text += " font-style=\"italic\"";
    if (label.upwards) text += fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", label.at.x(), label.at.y());
    text += ">";
    // A shift holds for what follows, so each run first takes back that of the one before.
    double raised = 0;
    for (const TextRun& run : text_runs(label.text)) {
      const double wanted = 0.32 * run.shift * label.size;
      text += fmt::format("<tspan dy=\"{:.2f}\" font-size=\"{:.3g}\">{}</tspan>", raised - wanted,
                          run.shift == 0 ? label.size : kShiftedSize * label.size, escape_markup(run.text));
      raised = wanted;
    }
    text += "</text>\n";
  }
};

}  // namespace

void Drawing::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, Colour colour, double line_width, double dash) {
  Points points(2, 2);
  points << a, b;
  add(Stroke{.points = points, .colour = colour, .width = line_width, .dash = dash});
}

void Drawing::arrow(const Eigen::Vector2d& a, const Eigen::Vector2d& b, Colour colour, double line_width) {
  Points points(2, 2);
  points << a, b;
  add(Stroke{.points = points, .colour = colour, .width = line_width, .arrow = true});
}

std::vector<TextRun> text_runs(const std::string& text) {
  std::vector<TextRun> runs;
  std::string plain;
  const auto flush = [&] {
    if (!plain.empty()) runs.push_back({std::move(plain), 0});
    plain.clear();
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool shifted = (text[i] == '^' || text[i] == '_') && i + 1 < text.size() && text[i + 1] == '{';
    const std::size_t end = shifted ? text.find('}', i) : std::string::npos;
    if (end == std::string::npos) {
      plain += text[i];
      continue;
    }
    flush();
    runs.push_back({text.substr(i + 2, end - i - 2), text[i] == '^' ? 1 : -1});
    i = end;
  }
  flush();
  return runs;
}

Points arrow_head(const Points& points, double line_width) {
  const Index n = points.cols();
  if (n < 2) return Points(2, 0);
  const Eigen::Vector2d tip = points.col(n - 1);
  const Eigen::Vector2d along = tip - points.col(n - 2);
  if (along.norm() == 0) return Points(2, 0);
  const Eigen::Vector2d unit = along.normalized();
  const Eigen::Vector2d across(-unit.y(), unit.x());
  const double length = 6 + 3.2 * line_width;
  Points head(2, 3);
  // The point stands a little beyond the line's round end.
  head << tip + line_width * unit, tip - length * unit + 0.38 * length * across,
      tip - length * unit - 0.38 * length * across;
  return head;
}

std::string to_svg(const Drawing& drawing) {
  SvgShapes shapes;
  for (const auto& shape : drawing.shapes) std::visit(shapes, shape);
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
             "{1:.0f}\" font-family=\"system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', Arial, sans-serif\" "
             "role=\"img\">\n<title>{2}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
             drawing.width, drawing.height, escape_markup(drawing.title)) +
         shapes.text + "</svg>\n";
}

}  // namespace taut::paper
