#include "view/canvas.hpp"

#include <algorithm>
#include <cmath>

#include "view/shading.hpp"
#include "view/stroke_font.hpp"

namespace taut::detail {
namespace {

// Widths of the pen, in font sizes.
constexpr double kRegular = 0.082;
constexpr double kBold = 0.125;
constexpr double kHalo = 2.2;  // pixels round a letter

/// How much of each pixel of a part of the image something covers, 0..1.
class Coverage {
 public:
  Coverage(const Image& image, double x0, double y0, double x1, double y1)
      : x0_(std::clamp(static_cast<int>(std::floor(x0)), 0, image.width)),
        y0_(std::clamp(static_cast<int>(std::floor(y0)), 0, image.height)),
        x1_(std::clamp(static_cast<int>(std::ceil(x1)), 0, image.width)),
        y1_(std::clamp(static_cast<int>(std::ceil(y1)), 0, image.height)) {
    covered_.assign(static_cast<std::size_t>(x1_ - x0_) * static_cast<std::size_t>(y1_ - y0_), 0);
  }

  /// A straight stroke of a round pen.
  void stroke(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width) {
    const double reach = 0.5 * width + 1;
    const Eigen::Vector2d along = b - a;
    const double squared = along.squaredNorm();
    const int first_y = std::max(y0_, static_cast<int>(std::floor(std::min(a.y(), b.y()) - reach)));
    const int last_y = std::min(y1_ - 1, static_cast<int>(std::ceil(std::max(a.y(), b.y()) + reach)));
    const int first_x = std::max(x0_, static_cast<int>(std::floor(std::min(a.x(), b.x()) - reach)));
    const int last_x = std::min(x1_ - 1, static_cast<int>(std::ceil(std::max(a.x(), b.x()) + reach)));
    for (int y = first_y; y <= last_y; ++y) {
      for (int x = first_x; x <= last_x; ++x) {
        const Eigen::Vector2d p = Eigen::Vector2d(x + 0.5, y + 0.5) - a;
        const double t = squared > 0 ? std::clamp(p.dot(along) / squared, 0.0, 1.0) : 0;
        cover(x, y, 0.5 * width + 0.5 - (p - t * along).norm());
      }
    }
  }

  /// An upright rectangle.
  void rectangle(double left, double top, double right, double bottom) {
    const auto part = [](double low, double high, int k) {
      return std::min<double>(high, k + 1) - std::max<double>(low, k);
    };
    for (int y = y0_; y < y1_; ++y) {
      for (int x = x0_; x < x1_; ++x) {
        cover(x, y, std::max(0.0, part(left, right, x)) * std::max(0.0, part(top, bottom, y)));
      }
    }
  }

  void paint(const Colour& colour, double opacity, Image& image) const {
    for (int y = y0_; y < y1_; ++y) {
      for (int x = x0_; x < x1_; ++x) {
        const double alpha = opacity * covered_[index(x, y)];
        if (alpha <= 0) continue;
        std::uint8_t* pixel = image.pixel(x, y);
        const std::array<float, 3> ink = {colour.red, colour.green, colour.blue};
        for (std::size_t c = 0; c < 3; ++c) {
          pixel[c] =
              static_cast<std::uint8_t>((1 - alpha) * pixel[c] + alpha * 255 * static_cast<double>(ink[c]) + 0.5);
        }
      }
    }
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - y0_) * static_cast<std::size_t>(x1_ - x0_) + static_cast<std::size_t>(x - x0_);
  }
  void cover(int x, int y, double part) {
    double& covered = covered_[index(x, y)];
    covered = std::max(covered, std::clamp(part, 0.0, 1.0));
  }

  int x0_, y0_, x1_, y1_;
  std::vector<double> covered_;
};

void draw_mark(const Mark& mark, Image& image) {
  constexpr double kWidth = 4;
  Coverage area(image, mark.x - kWidth, mark.y - 8, mark.x + kMarkWidth + kWidth, mark.y + 8);
  const auto line = [&](double from, double to) {
    area.stroke({mark.x + from, mark.y}, {mark.x + to, mark.y}, kWidth);
  };
  switch (mark.kind) {
    case LegendMark::line: line(0, kMarkWidth); break;
    case LegendMark::dashes:
      line(0, 4);
      line(10, 14);
      line(20, kMarkWidth);
      break;
    case LegendMark::square: area.rectangle(mark.x + 4, mark.y - 7, mark.x + 18, mark.y + 7); break;
  }
  area.paint(mark.colour, mark.kind == LegendMark::square ? 0.55 : 1, image);
}

void draw_bar(const ColourBar& bar, Image& image) {
  const int rows = static_cast<int>(std::lround(bar.height));
  for (int row = 0; row < rows; ++row) {
    Coverage area(image, bar.x, bar.y + row, bar.x + bar.width, bar.y + row + 1);
    area.rectangle(bar.x, bar.y + row, bar.x + bar.width, bar.y + row + 1);
    area.paint(viridis(1 - (static_cast<float>(row) + 0.5F) / static_cast<float>(rows)), 1, image);
  }
  for (const double y : bar.ticks) {
    Coverage area(image, bar.x + bar.width, y - 2, bar.x + bar.width + 8, y + 2);
    area.rectangle(bar.x + bar.width, y - 0.5, bar.x + bar.width + 5, y + 0.5);
    area.paint(Colour::hex(0x5B6B7C), 1, image);
  }
}

}  // namespace

void draw_label(const Label& label, Image& image) {
  const TextStrokes text = stroke_text(label.words, label.size);
  const double width = label.size * (label.bold ? kBold : kRegular);
  const Eigen::Vector2d origin(label.anchor == Anchor::end ? label.x - text.width : label.x, label.y);
  const double reach = label.size + kHalo;
  const auto paint = [&](double pen, const Colour& colour, double opacity) {
    Coverage area(image, origin.x() - reach, origin.y() - 1.5 * reach, origin.x() + text.width + reach,
                  origin.y() + reach);
    for (const std::vector<Eigen::Vector2d>& line : text.lines) {
      for (std::size_t i = 1; i < line.size(); ++i) area.stroke(origin + line[i - 1], origin + line[i], pen);
    }
    area.paint(colour, opacity, image);
  };
  if (label.halo) paint(width + 2 * kHalo, Colour::hex(0xFFFFFF), 0.9);
  paint(width, label.colour, 1);
}

void draw_lettering(const Lettering& lettering, Image& image) {
  for (const Mark& mark : lettering.marks) draw_mark(mark, image);
  if (lettering.bar) draw_bar(*lettering.bar, image);
  for (const Label& label : lettering.labels) draw_label(label, image);
}

}  // namespace taut::detail
