// Our own letters, drawn as lines and quarters of ellipses. Capitals and figures are 14 units high, small letters 10,
// descenders 4. M x y moves the pen, L x y draws a line, Q cx cy x y a quarter of an ellipse from the pen to (x, y)
// inside the corner (cx, cy).

#include "view/stroke_font.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace taut::detail {
namespace {

constexpr double kCapitals = 14;          // units
constexpr double kCapitalsOfSize = 0.72;  // of the font size
constexpr double kGap = 3.4;              // units between letters
constexpr int kPiecesOfArc = 8;

struct Glyph {
  double width;  // of its ink, units
  std::string_view path;
};

constexpr std::array<Glyph, 95> kGlyphs = {{
    {2.2, ""},                                                 // space
    {0, "M0 14L0 4.5M0 0.1L0 0"},                              // !
    {4, "M0 14L0 10M4 14L4 10"},                               // "
    {10, "M3 14L1.5 0M8.5 14L7 0M0 9.5L10 9.5M0 4.5L10 4.5"},  // #
    {9, "M8.5 10.5Q8.5 12.3 4.5 12.3Q0.5 12.3 0.5 9.7Q0.5 7 4.5 7Q9 7 9 4.2Q9 1.5 4.5 1.5Q0 1.5 0 3.5M4.5 15L4.5 -1"},
    {12, "M10 14L2 0M3 14Q6 14 6 11Q6 8 3 8Q0 8 0 11Q0 14 3 14M9 6Q12 6 12 3Q12 0 9 0Q6 0 6 3Q6 6 9 6"},  // %
    {11, "M11 0L2.6 9Q1.5 10.2 1.5 11.3Q1.5 14 4.2 14Q6.8 14 6.8 11.5Q6.8 9.5 4.5 8Q0 5.5 0 3.2Q0 0 4 0Q9 0 10 7"},
    {0, "M0 14L0 10"},                                                       // '
    {3.5, "M3.5 16Q0 12.5 0 6Q0 -0.5 3.5 -4"},                               // (
    {3.5, "M0 16Q3.5 12.5 3.5 6Q3.5 -0.5 0 -4"},                             // )
    {6, "M3 14L3 7M0 12.2L6 8.8M6 12.2L0 8.8"},                              // *
    {9, "M4.5 10.5L4.5 1.5M0 6L9 6"},                                        // +
    {0.8, "M0.8 0.6L0 -2.6"},                                                // ,
    {5, "M0 5.5L5 5.5"},                                                     // -
    {0, "M0 0.1L0 0"},                                                       // .
    {6, "M6 15L0 -1.5"},                                                     // /
    {8.4, "M4.2 14Q8.4 14 8.4 7Q8.4 0 4.2 0Q0 0 0 7Q0 14 4.2 14"},           // 0
    {8.4, "M1.4 11L5 14L5 0"},                                               // 1
    {8.4, "M0.3 10.2Q0.3 14 4.2 14Q8.1 14 8.1 10.2Q8.1 8 6.2 6L0 0L8.4 0"},  // 2
    {8.4, "M0.5 12Q1.6 14 4 14Q7.8 14 7.8 10.8Q7.8 7.6 4 7.6L3 7.6M4 7.6Q8.4 7.6 8.4 3.8Q8.4 0 4 0Q0.8 0 0 2.6"},
    {8.4, "M6.4 0L6.4 14L0 3.8L8.8 3.8"},                                                    // 4
    {8.4, "M7.6 14L1.2 14L0.7 7.4Q2 9 4.2 9Q8.4 9 8.4 4.5Q8.4 0 4.2 0Q1 0 0 2.4"},           // 5
    {8.4, "M6 14L1 6.8Q0 5.4 0 4.3Q0 0 4.2 0Q8.4 0 8.4 4.3Q8.4 8.6 4.2 8.6Q2.2 8.6 1 6.8"},  // 6
    {8.4, "M0 14L8.4 14L3 0"},                                                               // 7
    {8.4,
     "M4.2 7.6Q0.5 7.6 0.5 10.8Q0.5 14 4.2 14Q7.9 14 7.9 10.8Q7.9 7.6 4.2 7.6Q0 7.6 0 3.8Q0 0 4.2 0Q8.4 0 8.4 3.8"
     "Q8.4 7.6 4.2 7.6"},                                                                            // 8
    {8.4, "M2.4 0L7.4 7.2Q8.4 8.6 8.4 9.7Q8.4 14 4.2 14Q0 14 0 9.7Q0 5.4 4.2 5.4Q6.2 5.4 7.4 7.2"},  // 9
    {0, "M0 8L0 7.9M0 0.1L0 0"},                                                                     // :
    {0.8, "M0.8 8L0.8 7.9M0.8 0.6L0 -2.6"},                                                          // ;
    {8, "M8 11L0 6L8 1"},                                                                            // <
    {9, "M0 8L9 8M0 4L9 4"},                                                                         // =
    {8, "M0 11L8 6L0 1"},                                                                            // >
    {7.6, "M0 10.8Q0 14 3.8 14Q7.6 14 7.6 10.8Q7.6 8.8 5.6 7.2Q3.8 5.8 3.8 4.2M3.8 0.1L3.8 0"},      // ?
    {12,
     "M8.6 9.2L8.6 5Q8.6 3 10.3 3Q12 3 12 7Q12 13 6.2 13Q0 13 0 6Q0 -2 6.5 -2Q8.5 -2 10 -1.2"
     "M8.6 6.2Q8.6 9.2 6 9.2Q3.4 9.2 3.4 6.2Q3.4 3.2 6 3.2Q8.6 3.2 8.6 6.2"},                         // @
    {10, "M0 0L5 14L10 0M1.7 4.6L8.3 4.6"},                                                           // A
    {9, "M0 0L0 14L4.6 14Q8.2 14 8.2 10.8Q8.2 7.6 4.6 7.6L0 7.6M4.6 7.6Q9 7.6 9 3.8Q9 0 4.6 0L0 0"},  // B
    {9.6, "M9.6 11Q8.4 14 5.2 14Q0 14 0 7Q0 0 5.2 0Q8.4 0 9.6 3"},                                    // C
    {9.6, "M0 0L0 14L4 14Q9.6 14 9.6 7Q9.6 0 4 0L0 0"},                                               // D
    {8, "M8 14L0 14L0 0L8 0M0 7.4L7 7.4"},                                                            // E
    {7.6, "M7.6 14L0 14L0 0M0 7.4L6.6 7.4"},                                                          // F
    {9.8, "M9.6 11.4Q8.4 14 5.2 14Q0 14 0 7Q0 0 5.2 0Q9.8 0 9.8 4.6L9.8 6.4L5.6 6.4"},                // G
    {9.4, "M0 0L0 14M9.4 0L9.4 14M0 7.4L9.4 7.4"},                                                    // H
    {0, "M0 0L0 14"},                                                                                 // I
    {5.6, "M5.6 14L5.6 4Q5.6 0 2.6 0Q0.6 0 0 1.6"},                                                   // J
    {9, "M0 0L0 14M8.6 14L0 5.4M3.2 8.6L9 0"},                                                        // K
    {7.6, "M0 14L0 0L7.6 0"},                                                                         // L
    {11, "M0 0L0 14L5.5 4.5L11 14L11 0"},                                                             // M
    {9.4, "M0 0L0 14L9.4 0L9.4 14"},                                                                  // N
    {10.4, "M5.2 14Q10.4 14 10.4 7Q10.4 0 5.2 0Q0 0 0 7Q0 14 5.2 14"},                                // O
    {8.8, "M0 0L0 14L4.8 14Q8.8 14 8.8 10.4Q8.8 6.8 4.8 6.8L0 6.8"},                                  // P
    {10.4, "M5.2 14Q10.4 14 10.4 7Q10.4 0 5.2 0Q0 0 0 7Q0 14 5.2 14M6.6 3.6L10.4 -0.8"},              // Q
    {9, "M0 0L0 14L4.8 14Q8.8 14 8.8 10.4Q8.8 6.8 4.8 6.8L0 6.8M4.8 6.8L9 0"},                        // R
    {9, "M8.4 11.4Q7.6 14 4.4 14Q0.4 14 0.4 10.6Q0.4 7.4 4.5 7.2Q9 7 9 3.6Q9 0 4.5 0Q1 0 0 2.8"},     // S
    {9.4, "M0 14L9.4 14M4.7 14L4.7 0"},                                                               // T
    {9.4, "M0 14L0 4.6Q0 0 4.7 0Q9.4 0 9.4 4.6L9.4 14"},                                              // U
    {10, "M0 14L5 0L10 14"},                                                                          // V
    {14.4, "M0 14L3.5 0L7.2 13L10.9 0L14.4 14"},                                                      // W
    {9.4, "M0 14L9.4 0M9.4 14L0 0"},                                                                  // X
    {9.8, "M0 14L4.9 6.6L9.8 14M4.9 6.6L4.9 0"},                                                      // Y
    {9, "M0 14L9 14L0 0L9 0"},                                                                        // Z
    {3.4, "M3.4 16L0 16L0 -3L3.4 -3"},                                                                // [
    {6, "M0 15L6 -1.5"},                                                                              // backslash
    {3.4, "M0 16L3.4 16L3.4 -3L0 -3"},                                                                // ]
    {7.6, "M0 8.5L3.8 14L7.6 8.5"},                                                                   // ^
    {8, "M0 -2.5L8 -2.5"},                                                                            // _
    {2, "M0 14L2 11"},                                                                                // `
    {7.6, "M0.8 8Q1.6 10 4.2 10Q7.6 10 7.6 6.8L7.6 0M7.6 5.8L3.6 5.6Q0 5.4 0 2.8Q0 0 3.2 0Q6.2 0 7.6 2.4"},  // a
    {8, "M0 14L0 0M0 5Q0 10 4 10Q8 10 8 5Q8 0 4 0Q0 0 0 5"},                                                 // b
    {7.4, "M7.4 7.8Q6.4 10 4.1 10Q0 10 0 5Q0 0 4.1 0Q6.4 0 7.4 2.2"},                                        // c
    {8, "M8 14L8 0M8 5Q8 10 4 10Q0 10 0 5Q0 0 4 0Q8 0 8 5"},                                                 // d
    {8, "M0 5.4L8 5.4Q8 10 4.1 10Q0 10 0 5Q0 0 4.2 0Q6.8 0 7.7 2"},                                          // e
    {4.8, "M4.8 14Q2.2 14 2.2 11.4L2.2 0M0 10L4.6 10"},                                                      // f
    {8, "M8 10L8 -0.6Q8 -4 4.2 -4Q1.4 -4 0.4 -2.4M8 5Q8 10 4 10Q0 10 0 5Q0 0 4 0Q8 0 8 5"},                  // g
    {7.4, "M0 14L0 0M0 5.8Q0 10 3.9 10Q7.4 10 7.4 6.2L7.4 0"},                                               // h
    {0, "M0 10L0 0M0 13.9L0 13.8"},                                                                          // i
    {2.4, "M2.4 10L2.4 -1.6Q2.4 -4 0 -4M2.4 13.9L2.4 13.8"},                                                 // j
    {7.2, "M0 14L0 0M6.8 10L0 3.4M2.6 6L7.2 0"},                                                             // k
    {1.8, "M0 14L0 1.8Q0 0 1.8 0"},                                                                          // l
    {12, "M0 10L0 0M0 6Q0 10 3.2 10Q6 10 6 6.4L6 0M6 6Q6 10 9.2 10Q12 10 12 6.4L12 0"},                      // m
    {7.4, "M0 10L0 0M0 5.8Q0 10 3.9 10Q7.4 10 7.4 6.2L7.4 0"},                                               // n
    {8.2, "M4.1 10Q8.2 10 8.2 5Q8.2 0 4.1 0Q0 0 0 5Q0 10 4.1 10"},                                           // o
    {8, "M0 10L0 -4M0 5Q0 10 4 10Q8 10 8 5Q8 0 4 0Q0 0 0 5"},                                                // p
    {8, "M8 10L8 -4M8 5Q8 10 4 10Q0 10 0 5Q0 0 4 0Q8 0 8 5"},                                                // q
    {4.2, "M0 10L0 0M0 5.6Q0 10 4.2 9.8"},                                                                   // r
    {7.2, "M6.6 8.2Q6 10 3.5 10Q0.4 10 0.4 7.6Q0.4 5.3 3.6 5.2Q7.2 5 7.2 2.6Q7.2 0 3.6 0Q0.8 0 0 1.9"},      // s
    {5, "M2.2 13L2.2 2.4Q2.2 0 4.6 0L5 0M0 10L5 10"},                                                        // t
    {7.4, "M0 10L0 3.8Q0 0 3.5 0Q7.4 0 7.4 4.2M7.4 10L7.4 0"},                                               // u
    {7.8, "M0 10L3.9 0L7.8 10"},                                                                             // v
    {11.8, "M0 10L2.9 0L5.9 9.4L8.9 0L11.8 10"},                                                             // w
    {7.2, "M0 10L7.2 0M7.2 10L0 0"},                                                                         // x
    {8, "M0 10L4 0M8 10L4 0L2.8 -2.8Q2.2 -4 0.8 -4"},                                                        // y
    {7, "M0 10L7 10L0 0L7 0"},                                                                               // z
    {4, "M4 16Q2 16 2 14L2 8.6Q2 6.5 0 6.5Q2 6.5 2 4.4L2 -1Q2 -3 4 -3"},                                     // {
    {0, "M0 16L0 -3"},                                                                                       // |
    {4, "M0 16Q2 16 2 14L2 8.6Q2 6.5 4 6.5Q2 6.5 2 4.4L2 -1Q2 -3 0 -3"},                                     // }
    {9.2, "M0 5.2Q0 7.2 2.2 7.2Q3.4 7.2 4.6 6Q5.8 4.8 7 4.8Q9.2 4.8 9.2 6.8"},                               // ~
}};
constexpr Glyph kUnknown = {7, "M0 0L0 10L7 10L7 0L0 0"};

/// Reads a glyph's path.
class Pen {
 public:
  Pen(std::string_view path, const Eigen::Vector2d& origin, double scale, TextStrokes& text)
      : path_(path), origin_(origin), scale_(scale), text_(text) {}

  void draw() {
    while (!path_.empty()) {
      const char command = path_.front();
      path_.remove_prefix(1);
      if (command == 'M') {
        text_.lines.emplace_back();
        add(point());
      } else if (command == 'L') {
        add(point());
      } else {
        const Eigen::Vector2d corner = point();
        arc(corner, point());
      }
    }
  }

 private:
  double number() {
    while (path_.front() == ' ') path_.remove_prefix(1);
    double value = 0;
    const char* end = std::from_chars(path_.data(), path_.data() + path_.size(), value).ptr;
    path_.remove_prefix(static_cast<std::size_t>(end - path_.data()));
    return value;
  }
  Eigen::Vector2d point() {
    const double x = number();
    return {x, number()};
  }
  void add(const Eigen::Vector2d& at) {
    pen_ = at;
    text_.lines.back().emplace_back(origin_.x() + scale_ * at.x(), origin_.y() - scale_ * at.y());
  }
  void arc(const Eigen::Vector2d& corner, const Eigen::Vector2d& to) {
    const Eigen::Vector2d from = pen_;
    for (int k = 1; k <= kPiecesOfArc; ++k) {
      const double t = std::numbers::pi / 2 * k / kPiecesOfArc;
      add(corner + (1 - std::sin(t)) * (from - corner) + (1 - std::cos(t)) * (to - corner));
    }
  }

  std::string_view path_;
  Eigen::Vector2d origin_;
  double scale_;
  TextStrokes& text_;
  Eigen::Vector2d pen_ = Eigen::Vector2d::Zero();
};

}  // namespace

TextStrokes stroke_text(std::string_view utf8, double size) {
  const double scale = size * kCapitalsOfSize / kCapitals;
  TextStrokes text;
  for (const char c : utf8) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte & 0xC0U) == 0x80) continue;  // inside a character of several bytes
    const bool known = byte >= ' ' && byte < ' ' + kGlyphs.size();
    const Glyph& glyph = known ? kGlyphs[byte - std::size_t{' '}] : kUnknown;
    if (text.width > 0) text.width += scale * kGap;
    Pen(glyph.path, {text.width, 0}, scale, text).draw();
    text.width += scale * glyph.width;
  }
  return text;
}

}  // namespace taut::detail
