#pragma once

#include <string>
#include <vector>

#include "drawing.hpp"

namespace taut::paper {

struct Axis {
  std::string label;
  bool logarithmic = false;
};

struct Series {
  std::string name;
  std::vector<double> x = {};
  std::vector<double> y =
      {};  ///< as many as `x`; entries that are not finite, or not positive on a log axis, are left out
  Colour colour = kBlue;
  bool line = true;
  bool marks = true;
  double radius = 4;    ///< of the marks, pixels
  bool hollow = false;  ///< marks are rings
  double dash = 0;
};

/// Curves over two axes, with ticks and a legend.
struct Chart {
  std::string title;
  Axis x;
  Axis y;
  std::vector<Series> series = {};
  double width = 640;  ///< pixels
  double height = 420;
  bool legend_above = false;  ///< over the frame rather than in a corner of it
  bool equal_scales = false;  ///< one unit of x is as long as one of y: for maps
};

[[nodiscard]] Drawing draw(const Chart& chart);

/// Exponent and factor of y = factor x^exponent, least squares in the logarithms. At least two points, all positive.
struct PowerLaw {
  double factor = 0;
  double exponent = 0;
};
[[nodiscard]] PowerLaw fit_power_law(const std::vector<double>& x, const std::vector<double>& y);

}  // namespace taut::paper
