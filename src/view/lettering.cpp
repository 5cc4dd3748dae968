#include "view/lettering.hpp"

#include <algorithm>
#include <cmath>

namespace taut::detail {
namespace {

// Pixels.
constexpr double kMargin = 28;
constexpr double kTitleSize = 22;
constexpr double kTextSize = 14;
constexpr double kLine = 21;
constexpr double kBarRoom = 110;  // for the colour bar and its numbers
/// Text this long is cut, in letters a pixel of the picture's width: capitals are wider than small letters.
constexpr double kLettersPerPixel = 0.125;

constexpr Colour kInk = Colour::hex(0x1B2733);
constexpr Colour kSoftInk = Colour::hex(0x3A4856);
constexpr Colour kFaintInk = Colour::hex(0x5B6B7C);

/// At most so much of a text, at the end of a character.
std::string shortened(const std::string& text, double room, double size) {
  auto most = static_cast<std::size_t>(std::max(8.0, room * kLettersPerPixel * kTextSize / size));
  if (text.size() <= most) return text;
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0U) == 0x80) --most;
  return text.substr(0, most) + "...";
}

void add_colour_bar(const Stage& stage, int width, Lettering& lettering) {
  ColourBar bar;
  // On whole pixels, so that its edges are sharp.
  bar.x = std::round(width - kMargin - kBarRoom + 24);
  bar.height = std::round(0.6 * (lettering.bottom - lettering.top));
  bar.y = std::round(lettering.top + 0.2 * (lettering.bottom - lettering.top));
  lettering.labels.push_back({bar.x, bar.y - 12, stage.scalar_name, kTextSize, kInk, true});
  const double range = stage.scalar_max - stage.scalar_min;
  const double step = nice_step(range, 5);
  for (double k = std::ceil(stage.scalar_min / step - 1e-6); k * step <= stage.scalar_max + 1e-6 * range; ++k) {
    const double at = bar.y + bar.height * (1 - (k * step - stage.scalar_min) / range);
    bar.ticks.push_back(at);
    lettering.labels.push_back({bar.x + bar.width + 9, at + 4.5, format_number(k * step, 6), kTextSize - 1, kSoftInk});
  }
  lettering.bar = std::move(bar);
}

}  // namespace

Lettering letter(const Stage& stage, int width, int height) {
  Lettering lettering;
  const double room = width - 2 * kMargin;
  double y = kMargin;
  if (!stage.title.empty()) {
    y += kTitleSize - 6;
    lettering.labels.push_back({kMargin, y, shortened(stage.title, room, kTitleSize), kTitleSize, kInk, true});
    y += 10;
  }
  for (const LegendLine& line : make_legend(stage)) {
    y += kLine;
    lettering.marks.push_back({kMargin + 2, y - 5, line.mark, line.colour});
    lettering.labels.push_back({kMargin + 2 + kMarkWidth + 10, y,
                                shortened(line.text + ", " + line.value, room - kMarkWidth, kTextSize), kTextSize,
                                kSoftInk});
  }
  double foot = height - kMargin - kLine * static_cast<double>(stage.caption.size());
  // A small picture gives its room to the scene: text may then lie over it.
  lettering.left = kMargin;
  lettering.top = std::min(y, 0.3 * height) + 6;
  lettering.bottom = std::max(foot - 6, 0.6 * height);
  lettering.right = std::max(width - kMargin - (stage.scalar_name.empty() ? 0 : kBarRoom), 0.6 * width);
  if (!stage.scalar_name.empty()) add_colour_bar(stage, width, lettering);
  for (const std::string& line : stage.caption) {
    foot += kLine;
    lettering.labels.push_back({kMargin, foot, shortened(line, room, kTextSize - 1), kTextSize - 1, kFaintInk});
  }
  return lettering;
}

std::vector<Label> point_labels(const Stage& stage, const Camera& camera, double point_radius, double width) {
  constexpr double kSamePlace = 3;
  constexpr double kLabelRoom = 110;
  std::vector<Label> labels;
  std::vector<Eigen::Vector2d> places;
  for (const StagePoint& point : stage.points) {
    if (point.label.empty()) continue;
    const Seen seen = camera.see(point.position.cast<double>());
    const Eigen::Vector2d place(seen.x, seen.y);
    const auto same =
        std::ranges::find_if(places, [&](const Eigen::Vector2d& other) { return (other - place).norm() < kSamePlace; });
    if (same != places.end()) {
      std::string& words = labels[static_cast<std::size_t>(same - places.begin())].words;
      if (words != point.label) words += ", " + point.label;
      continue;
    }
    const bool room_right = seen.x < width - kLabelRoom;
    const bool to_left = seen.x > kLabelRoom && (!room_right || seen.x < 0.5 * width);
    const double radius = point_radius * point.size;
    places.push_back(place);
    labels.push_back({seen.x + (to_left ? -1 : 1) * (radius + 6), seen.y - radius, point.label, kTextSize + 1, kInk,
                      true, true, to_left ? Anchor::end : Anchor::start});
  }
  return labels;
}

}  // namespace taut::detail
