#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "taut/view/scene.hpp"

namespace taut::paper {

inline constexpr Colour kInk = Colour::hex(0x1b2733);
inline constexpr Colour kGrey = Colour::hex(0x8593a0);
inline constexpr Colour kRed = Colour::hex(0xc8322d);
inline constexpr Colour kBlue = Colour::hex(0x1f5fbf);
inline constexpr Colour kGreen = Colour::hex(0x3d9950);
inline constexpr Colour kAmber = Colour::hex(0xc98a12);
inline constexpr Colour kViolet = Colour::hex(0x7a4fa3);
inline constexpr Colour kTeal = Colour::hex(0x198a8a);

/// A line through points, or an area.
struct Stroke {
  Points points;  ///< 2 x n, pixels, y downwards
  Colour colour = kInk;
  double width = 1.5;  ///< pixels; 0 = no line
  bool closed = false;
  std::optional<Colour> fill = std::nullopt;
  double fill_opacity = 1;
  double dash = 0;     ///< pixels of a dash and of the gap after it; 0 = a whole line
  bool arrow = false;  ///< a head at the last point
};

struct Disc {
  Eigen::Vector2d centre;
  double radius = 4;
  Colour colour = kInk;
  bool hollow = false;
};

enum class TextAnchor { start, middle, end };

/// A line of text, its base line at `at`. `p^{i-1}` is raised, `k_{g}` is lowered, as in TeX.
struct TextLine {
  Eigen::Vector2d at;
  std::string text;
  double size = 14;
  TextAnchor anchor = TextAnchor::start;
  Colour colour = kInk;
  bool bold = false;
  bool italic = false;
  bool upwards = false;  ///< reads from below
};

/// A drawing by hand: what stands later lies above.
struct Drawing {
  double width = 800;  ///< pixels
  double height = 500;
  std::string title;  ///< for readers who cannot see it
  std::vector<std::variant<Stroke, Disc, TextLine>> shapes = {};

  void add(Stroke stroke) { shapes.emplace_back(std::move(stroke)); }
  void add(Disc disc) { shapes.emplace_back(disc); }
  void add(TextLine label) { shapes.emplace_back(std::move(label)); }
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, Colour colour = kInk, double line_width = 1.5,
            double dash = 0);
  void arrow(const Eigen::Vector2d& a, const Eigen::Vector2d& b, Colour colour = kInk, double line_width = 2);
};

/// A piece of a label: raised (1), lowered (-1) or on the line (0).
struct TextRun {
  std::string text;
  int shift = 0;
};
[[nodiscard]] std::vector<TextRun> text_runs(const std::string& text);
/// The triangle at the end of an arrow: 2 x 3, its point first; 2 x 0 for a line without length.
[[nodiscard]] Points arrow_head(const Points& points, double line_width);

inline constexpr double kShiftedSize = 0.72;  ///< size of raised and lowered text, by that of the line

[[nodiscard]] std::string to_svg(const Drawing& drawing);
/// The same as a PNG file's bytes, `scale` pixels a pixel. Empty where the program was built without Cairo.
[[nodiscard]] std::string to_png(const Drawing& drawing, double scale = 2);

}  // namespace taut::paper
