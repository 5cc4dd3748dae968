#include "surface/height/plane_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "surface/volume/prefilter.hpp"
#include "surface/volume/spline_basis.hpp"

// Bounds. A B-spline lies between the least and the greatest of the coefficients that matter, which is off by the
// slope over three pixels. Over boxes of at most two pieces a side the coefficients are turned into those of
// Bernstein's basis on the very box (polar forms: the control value (r, s, t) of a cubic is its blossom there), which
// are off by the curvature over the box only. Larger boxes ask a pyramid of blocks.

namespace taut::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEps = std::numeric_limits<double>::epsilon();
/// Rounding of a sum of 16 products of weights (which sum to 1) and coefficients, in units of eps times the largest.
constexpr double kRounding = 64;
/// Beyond the samples a basis function may be negative, all together by this part of the coefficients' range.
constexpr double kBeyond = 2e-4;

/// Monomial coefficients of the four B-splines on a piece.
constexpr double kBasis[4][4] = {{1.0 / 6, -3.0 / 6, 3.0 / 6, -1.0 / 6},
                                 {4.0 / 6, 0, -6.0 / 6, 3.0 / 6},
                                 {1.0 / 6, 3.0 / 6, 3.0 / 6, -3.0 / 6},
                                 {0, 0, 0, 1.0 / 6}};

/// Row b: the weights of the four B-spline coefficients in Bernstein coefficient b on [t0, t1].
Eigen::Matrix4d bernstein_weights(double t0, double t1) {
  Eigen::Matrix4d weights;
  for (int b = 0; b < 4; ++b) {
    const double r = b > 0 ? t1 : t0;
    const double s = b > 1 ? t1 : t0;
    const double t = b > 2 ? t1 : t0;
    for (int k = 0; k < 4; ++k) {
      weights(b, k) = kBasis[k][0] + kBasis[k][1] * (r + s + t) / 3 + kBasis[k][2] * (r * s + s * t + t * r) / 3 +
                      kBasis[k][3] * r * s * t;
    }
  }
  return weights;
}

void include(PlaneSpline::Range& range, double lower, double upper) {
  range.lower = std::min(range.lower, lower);
  range.upper = std::max(range.upper, upper);
}

Index piece_of(double u, Index samples) {
  return static_cast<Index>(std::clamp(std::floor(u), 0.0, static_cast<double>(samples - 2)));
}

}  // namespace

PlaneSpline::PlaneSpline(Index columns, Index rows, std::vector<double> coefficients)
    : columns_(columns), rows_(rows), coefficients_(std::move(coefficients)) {
  for (const double c : coefficients_) largest_ = std::max(largest_, std::abs(c));
  Index width = columns + 2;
  Index height = rows + 2;
  const auto below = [&](Index i, Index j) -> Range {
    if (levels_.empty()) return {coefficient(i, j), coefficient(i, j)};
    return levels_.back().blocks[static_cast<std::size_t>(i + levels_.back().columns * j)];
  };
  while (width > 2 || height > 2) {
    Level level{(width + 1) / 2, (height + 1) / 2, {}};
    level.blocks.resize(static_cast<std::size_t>(level.columns * level.rows), {kInfinity, -kInfinity});
    for (Index j = 0; j < height; ++j) {
      for (Index i = 0; i < width; ++i) {
        const Range part = below(i, j);
        include(level.blocks[static_cast<std::size_t>(i / 2 + level.columns * (j / 2))], part.lower, part.upper);
      }
    }
    width = level.columns;
    height = level.rows;
    levels_.push_back(std::move(level));
  }
}

PlaneSpline PlaneSpline::through(Index columns, Index rows, const std::vector<double>& values) {
  const Index width = columns + 2;
  std::vector<double> c(static_cast<std::size_t>(width * (rows + 2)), 0.0);
  for (Index j = 0; j < rows; ++j) {
    std::copy_n(values.begin() + columns * j, columns, c.begin() + width * (j + 1) + 1);
  }
  // Lines side by side, as interpolate_lines takes them.
  const auto filter = [&](Index n, Index num_lines, Index step, Index across) {
    std::vector<double> lines(static_cast<std::size_t>((n + 2) * kBundle));
    for (Index begin = 0; begin < num_lines; begin += kBundle) {
      const Index count = std::min(kBundle, num_lines - begin);
      std::fill(lines.begin(), lines.end(), 0.0);
      for (Index i = 0; i < n + 2; ++i) {
        for (Index w = 0; w < count; ++w) {
          lines[static_cast<std::size_t>(i * kBundle + w)] =
              c[static_cast<std::size_t>(i * step + (begin + w) * across)];
        }
      }
      interpolate_lines(lines.data(), n);
      for (Index i = 0; i < n + 2; ++i) {
        for (Index w = 0; w < count; ++w) {
          c[static_cast<std::size_t>(i * step + (begin + w) * across)] =
              lines[static_cast<std::size_t>(i * kBundle + w)];
        }
      }
    }
  };
  filter(columns, rows + 2, 1, width);
  filter(rows, width, width, 1);
  return {columns, rows, std::move(c)};
}

auto PlaneSpline::at(double u, double v) const -> Jet {
  if (!(std::abs(u) < kInfinity && std::abs(v) < kInfinity)) {
    const double nan = u + v - (u + v);
    return {nan, nan, nan, nan, nan, nan};
  }
  const Index i = piece_of(u, columns_);
  const Index j = piece_of(v, rows_);
  const double s = u - static_cast<double>(i);
  const double t = v - static_cast<double>(j);
  const Eigen::Array4d w = spline_weights(s);
  const Eigen::Array4d w1 = spline_slopes(s);
  const Eigen::Array4d w2 = spline_curvatures(s);
  const Eigen::Array4d y = spline_weights(t);
  const Eigen::Array4d y1 = spline_slopes(t);
  const Eigen::Array4d y2 = spline_curvatures(t);
  Jet jet;
  for (int b = 0; b < 4; ++b) {
    const Eigen::Map<const Eigen::Array4d> row(coefficients_.data() + i + (columns_ + 2) * (j + b));
    const auto dot = [&](const Eigen::Array4d& a) {
      return (a(0) * row(0) + a(1) * row(1)) + (a(2) * row(2) + a(3) * row(3));
    };
    const double value = dot(w);
    const double slope = dot(w1);
    jet.value += y(b) * value;
    jet.u += y(b) * slope;
    jet.v += y1(b) * value;
    jet.uu += y(b) * dot(w2);
    jet.uv += y1(b) * slope;
    jet.vv += y2(b) * value;
  }
  return jet;
}

auto PlaneSpline::piece_range(Index i, Index j, const std::array<double, 4>& part) const -> Range {
  Eigen::Matrix4d c;
  for (Index b = 0; b < 4; ++b) {
    for (Index a = 0; a < 4; ++a) c(a, b) = coefficient(i + a, j + b);
  }
  const Eigen::Matrix4d bernstein =
      bernstein_weights(part[0], part[1]) * c * bernstein_weights(part[2], part[3]).transpose();
  return {bernstein.minCoeff(), bernstein.maxCoeff()};
}

auto PlaneSpline::coefficient_range(Index i0, Index i1, Index j0, Index j1) const -> Range {
  constexpr Index kMostBlocks = 4;  // a side
  int level = 0;
  const auto blocks = [&](Index first, Index last) { return (last >> level) - (first >> level) + 1; };
  while (level < static_cast<int>(levels_.size()) && (blocks(i0, i1) > kMostBlocks || blocks(j0, j1) > kMostBlocks)) {
    ++level;
  }
  Range range{kInfinity, -kInfinity};
  for (Index j = j0 >> level; j <= j1 >> level; ++j) {
    for (Index i = i0 >> level; i <= i1 >> level; ++i) {
      if (level == 0) {
        include(range, coefficient(i, j), coefficient(i, j));
      } else {
        const Level& coarse = levels_[static_cast<std::size_t>(level - 1)];
        const Range& block = coarse.blocks[static_cast<std::size_t>(i + coarse.columns * j)];
        include(range, block.lower, block.upper);
      }
    }
  }
  return range;
}

auto PlaneSpline::range(double u0, double u1, double v0, double v1) const -> Range {
  const auto last_u = static_cast<double>(columns_ - 1);
  const auto last_v = static_cast<double>(rows_ - 1);
  const bool inside = u0 >= -kOverhang && u1 <= last_u + kOverhang && v0 >= -kOverhang && v1 <= last_v + kOverhang;
  if (!inside) return {-kInfinity, kInfinity};
  const Index i0 = piece_of(u0, columns_);
  const Index i1 = piece_of(u1, columns_);
  const Index j0 = piece_of(v0, rows_);
  const Index j1 = piece_of(v1, rows_);
  Range range{kInfinity, -kInfinity};
  if (i1 - i0 <= 1 && j1 - j0 <= 1) {
    for (Index j = j0; j <= j1; ++j) {
      for (Index i = i0; i <= i1; ++i) {
        const auto left = static_cast<double>(i);
        const auto low = static_cast<double>(j);
        // Between two pieces the box is cut; beyond the samples the outermost pieces go on.
        const Range part = piece_range(
            i, j, {i == i0 ? u0 - left : 0, i == i1 ? u1 - left : 1, j == j0 ? v0 - low : 0, j == j1 ? v1 - low : 1});
        include(range, part.lower, part.upper);
      }
    }
  } else {
    range = coefficient_range(i0, i1 + 3, j0, j1 + 3);
    const double beyond = kBeyond * (range.upper - range.lower);
    range.lower -= beyond;
    range.upper += beyond;
  }
  const double rounding = kRounding * kEps * largest_;
  return {range.lower - rounding, range.upper + rounding};
}

}  // namespace taut::detail
