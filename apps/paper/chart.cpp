#include "chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::paper {
namespace {

constexpr double kLeft = 76;  // pixels around the frame
constexpr double kRight = 20;
constexpr double kTopMargin = 44;
constexpr double kLegendRow = 26;
constexpr double kBottom = 56;
constexpr double kText = 13;

/// 1, 2 or 5 times a power of ten: a step that divides `range` into about `wanted` parts.
double tick_step(double range, int wanted) {
  const double rough = range / wanted;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (rough <= factor * power) return factor * power;
  }
  return 10 * power;
}

/// One axis: where its values stand between 0 and 1, and its ticks.
class Scale {
 public:
  Scale(const Axis& axis, double least, double most) : logarithmic_(axis.logarithmic) {
    lower_ = coordinate(least);
    upper_ = coordinate(most);
    if (!(upper_ > lower_)) {
      lower_ -= 0.5;
      upper_ += 0.5;
    }
    const double margin = 0.05 * (upper_ - lower_);
    lower_ -= margin;
    upper_ += margin;
  }

  [[nodiscard]] bool shows(double value) const { return std::isfinite(value) && (!logarithmic_ || value > 0); }
  [[nodiscard]] double place(double value) const { return (coordinate(value) - lower_) / (upper_ - lower_); }
  [[nodiscard]] double range() const { return upper_ - lower_; }
  void widen(double range) {
    const double more = 0.5 * (range - (upper_ - lower_));
    lower_ -= more;
    upper_ += more;
  }

  struct Tick {
    double place;
    std::string text;  // empty: a minor one
  };
  [[nodiscard]] std::vector<Tick> ticks() const { return logarithmic_ ? decades() : steps(); }

 private:
  [[nodiscard]] double coordinate(double value) const { return logarithmic_ ? std::log10(value) : value; }

  [[nodiscard]] std::vector<Tick> steps() const {
    std::vector<Tick> ticks;
    const double step = tick_step(upper_ - lower_, 6);
    for (double k = std::ceil(lower_ / step); k * step <= upper_; ++k) {
      ticks.push_back({(k * step - lower_) / (upper_ - lower_), fmt::format("{:.6g}", k * step + 0.0)});
    }
    return ticks;
  }

  [[nodiscard]] std::vector<Tick> decades() const {
    std::vector<Tick> ticks;
    const double decades_shown = upper_ - lower_;
    const int every = std::max(1, static_cast<int>(decades_shown / 7));
    for (int k = static_cast<int>(std::floor(lower_)); k <= upper_; ++k) {
      for (int digit = 1; digit < 10; ++digit) {
        const double at = (k + std::log10(digit) - lower_) / decades_shown;
        if (at < 0 || at > 1) continue;
        const bool named = digit == 1 ? k % every == 0 : decades_shown < 2 && (digit == 2 || digit == 5);
        if (!named && decades_shown > 8) continue;
        ticks.push_back({at, named ? tick_text(k, digit) : ""});
      }
    }
    return ticks;
  }

  static std::string tick_text(int k, int digit) {
    if (k >= -2 && k <= 3) return fmt::format("{:.6g}", digit * std::pow(10, k));
    return (digit == 1 ? "10^{" : fmt::format("{}·10^{{", digit)) + std::to_string(k) + "}";
  }

  bool logarithmic_;
  double lower_;
  double upper_;
};

Scale scale_of(const Axis& axis, const std::vector<Series>& series, std::vector<double> Series::*values) {
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const Series& one : series) {
    for (const double value : one.*values) {
      if (!std::isfinite(value) || (axis.logarithmic && value <= 0)) continue;
      least = std::min(least, value);
      most = std::max(most, value);
    }
  }
  if (least > most) least = most = 1;
  return {axis, least, most};
}

class ChartPainter {
 public:
  explicit ChartPainter(const Chart& chart)
      : chart_(chart),
        x_(scale_of(chart.x, chart.series, &Series::x)),
        y_(scale_of(chart.y, chart.series, &Series::y)) {
    top_ = kTopMargin + (chart.legend_above ? kLegendRow : 0);
    drawing_.width = chart.width;
    drawing_.height = chart.height;
    drawing_.title = chart.title;
    if (!chart.equal_scales) return;
    const double wanted = (right() - kLeft) / (bottom() - top_);  // of x's range to y's
    if (x_.range() < wanted * y_.range()) {
      x_.widen(wanted * y_.range());
    } else {
      y_.widen(x_.range() / wanted);
    }
  }

  Drawing draw() {
    frame();
    for (const Series& series : chart_.series) curve(series);
    if (chart_.legend_above) {
      legend_rows();
    } else if (!legend_in_a_corner()) {
      // The curves leave no corner free: once more, lower, with the legend above.
      drawing_.shapes.clear();
      top_ += kLegendRow * num_legend_rows();
      frame();
      for (const Series& series : chart_.series) curve(series);
      legend_rows();
    }
    return std::move(drawing_);
  }

 private:
  [[nodiscard]] double right() const { return chart_.width - kRight; }
  [[nodiscard]] double bottom() const { return chart_.height - kBottom; }
  [[nodiscard]] Eigen::Vector2d at(double x, double y) const {
    return {kLeft + x * (right() - kLeft), bottom() - y * (bottom() - top_)};
  }

  void frame() {
    constexpr Colour kGridLine = Colour::hex(0xe6eaee);
    for (const Scale::Tick& tick : x_.ticks()) {
      if (!tick.text.empty()) drawing_.line(at(tick.place, 0), at(tick.place, 1), kGridLine, 1);
      drawing_.line(at(tick.place, 0), at(tick.place, 0) + Eigen::Vector2d(0, tick.text.empty() ? 3 : 5), kGrey, 1);
      drawing_.add(TextLine{.at = at(tick.place, 0) + Eigen::Vector2d(0, 20),
                            .text = tick.text,
                            .size = kText,
                            .anchor = TextAnchor::middle});
    }
    for (const Scale::Tick& tick : y_.ticks()) {
      if (!tick.text.empty()) drawing_.line(at(0, tick.place), at(1, tick.place), kGridLine, 1);
      drawing_.line(at(0, tick.place), at(0, tick.place) - Eigen::Vector2d(tick.text.empty() ? 3 : 5, 0), kGrey, 1);
      drawing_.add(TextLine{.at = at(0, tick.place) + Eigen::Vector2d(-9, 4.5),
                            .text = tick.text,
                            .size = kText,
                            .anchor = TextAnchor::end});
    }
    Points corners(2, 4);
    corners << at(0, 0), at(1, 0), at(1, 1), at(0, 1);
    drawing_.add(Stroke{.points = corners, .colour = kGrey, .width = 1, .closed = true});
    drawing_.add(TextLine{.at = {kLeft, 24}, .text = chart_.title, .size = 15, .bold = true});
    drawing_.add(TextLine{.at = {0.5 * (kLeft + right()), chart_.height - 14},
                          .text = chart_.x.label,
                          .size = kText + 1,
                          .anchor = TextAnchor::middle});
    drawing_.add(TextLine{.at = {18, 0.5 * (top_ + bottom())},
                          .text = chart_.y.label,
                          .size = kText + 1,
                          .anchor = TextAnchor::middle,
                          .upwards = true});
  }

  void curve(const Series& series) {
    std::vector<Eigen::Vector2d> places;
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (!x_.shows(series.x[i]) || !y_.shows(series.y[i])) continue;
      places.push_back(at(x_.place(series.x[i]), y_.place(series.y[i])));
    }
    if (series.line && places.size() > 1) {
      Points points(2, static_cast<Index>(places.size()));
      for (std::size_t i = 0; i < places.size(); ++i) points.col(static_cast<Index>(i)) = places[i];
      drawing_.add(Stroke{.points = points, .colour = series.colour, .width = 2.2, .dash = series.dash});
    }
    if (!series.marks) return;
    for (const Eigen::Vector2d& place : places) {
      drawing_.add(Disc{.centre = place, .radius = series.radius, .colour = series.colour, .hollow = series.hollow});
    }
  }

  /// Calls entry(series, place) for each name, in rows over the frame from `y` down.
  template <class Entry>
  void for_each_in_rows(double y, const Entry& entry) const {
    double x = kLeft;
    for (const Series& series : chart_.series) {
      if (series.name.empty()) continue;
      const double width = 30 + 6.8 * static_cast<double>(series.name.size());
      if (x > kLeft && x + width > right()) {
        x = kLeft;
        y += kLegendRow;
      }
      entry(series, Eigen::Vector2d(x, y));
      x += width + 22;
    }
  }

  [[nodiscard]] int num_legend_rows() const {
    int rows = 0;
    for_each_in_rows(0, [&rows](const Series&, const Eigen::Vector2d& place) {
      rows = 1 + static_cast<int>(std::lround(place.y() / kLegendRow));
    });
    return rows;
  }

  void legend_rows() {
    for_each_in_rows(top_ - 14 - kLegendRow * (num_legend_rows() - 1), [this](const Series& series, const auto& place) {
      mark(series, place - Eigen::Vector2d(0, 4.5));
      drawing_.add(TextLine{.at = place + Eigen::Vector2d(30, 0), .text = series.name, .size = kText - 0.5});
    });
  }

  /// 22 pixels from `left` to the right.
  void mark(const Series& series, const Eigen::Vector2d& left) {
    if (series.line) drawing_.line(left, left + Eigen::Vector2d(22, 0), series.colour, 2.2, series.dash);
    if (!series.marks) return;
    drawing_.add(Disc{.centre = left + Eigen::Vector2d(11, 0),
                      .radius = series.radius,
                      .colour = series.colour,
                      .hollow = series.hollow});
  }

  /// False: it would cover curves in every corner.
  bool legend_in_a_corner() {
    std::size_t longest = 0;
    double lines = 0;
    for (const Series& series : chart_.series) {
      if (series.name.empty()) continue;
      longest = std::max(longest, series.name.size());
      ++lines;
    }
    if (lines == 0) return true;
    const double width = 46 + 7.0 * static_cast<double>(longest);
    const double height = 10 + 20 * lines;
    Eigen::Vector2d best = at(0, 1);
    double fewest = std::numeric_limits<double>::infinity();
    for (const auto& [x, y] : {std::pair{0, 1}, {1, 1}, {0, 0}, {1, 0}}) {
      const Eigen::Vector2d corner = at(x, y);
      const Eigen::Vector2d start(corner.x() + (x == 0 ? 10 : -10 - width), corner.y() + (y == 1 ? 8 : -8 - height));
      const double covered = num_covered(start, width, height);
      if (covered < fewest) {
        fewest = covered;
        best = start;
      }
    }
    if (fewest > 0) return false;
    Points box(2, 4);
    box << best, best + Eigen::Vector2d(width, 0), best + Eigen::Vector2d(width, height),
        best + Eigen::Vector2d(0, height);
    drawing_.add(Stroke{.points = box,
                        .colour = Colour::hex(0xd5dbe1),
                        .width = 1,
                        .closed = true,
                        .fill = Colour::hex(0xffffff),
                        .fill_opacity = 0.9});
    double y = best.y() + 19;
    for (const Series& series : chart_.series) {
      if (series.name.empty()) continue;
      mark(series, {best.x() + 10, y - 4});
      drawing_.add(TextLine{.at = {best.x() + 40, y}, .text = series.name, .size = kText - 0.5});
      y += 20;
    }
    return true;
  }

  [[nodiscard]] double num_covered(const Eigen::Vector2d& start, double width, double height) const {
    double covered = 0;
    const auto inside = [&](const Eigen::Vector2d& p) {
      return p.x() > start.x() - 6 && p.x() < start.x() + width + 6 && p.y() > start.y() - 6 &&
             p.y() < start.y() + height + 6;
    };
    for (const auto& shape : drawing_.shapes) {
      if (const auto* disc = std::get_if<Disc>(&shape)) covered += inside(disc->centre) ? 1 : 0;
      const auto* stroke = std::get_if<Stroke>(&shape);
      if (stroke == nullptr || stroke->width < 2) continue;
      for (Index i = 0; i + 1 < stroke->points.cols(); ++i) {
        constexpr int kProbes = 12;  // along each segment
        for (int k = 0; k <= kProbes; ++k) {
          const double part = static_cast<double>(k) / kProbes;
          covered += inside((1 - part) * stroke->points.col(i) + part * stroke->points.col(i + 1)) ? 0.2 : 0;
        }
      }
    }
    return covered;
  }

  const Chart& chart_;
  Scale x_;
  Scale y_;
  double top_ = 0;  // of the frame
  Drawing drawing_;
};

}  // namespace

Drawing draw(const Chart& chart) { return ChartPainter(chart).draw(); }

PowerLaw fit_power_law(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const double n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double lx = std::log(x[i]);
    const double ly = std::log(y[i]);
    sx += lx;
    sy += ly;
    sxx += lx * lx;
    sxy += lx * ly;
  }
  PowerLaw law;
  law.exponent = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  law.factor = std::exp((sy - law.exponent * sx) / n);
  return law;
}

}  // namespace taut::paper
