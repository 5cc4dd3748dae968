// A string of points under tension: every point goes to the middle of its neighbours, and from there to the nearest
// point of the surface, or, where that is forbidden, of the border that forbids it. With sum |x_{i+1} - x_i|^2 falling,
// it comes to rest evenly spaced on a shortest curve among those that stay inside. Every second point moves at a time,
// over-relaxed as Young's theory of the straight string says: omega = 2 / (1 + sin(pi / n)).
//
// A start through the middle of an obstacle is on a watershed: a little disorder makes it leave.
#include "strata/taut_string.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>

#include "core/random.hpp"
#include "curve/polyline.hpp"

namespace taut::detail {
namespace {

/// Sweeps for each part of the string, at most: over-relaxed, a straight string comes to rest in a few times n.
constexpr Index kSweepsPerPart = 12;
/// A sweep that moves no point by more than this share of a part is the last: contacts are read off to a part.
constexpr double kAtRest = 1e-4;
/// Points are put so far beside the start, in parts.
constexpr double kDisorder = 1e-3;

class StringPuller {
 public:
  StringPuller(BorderedSurface& surface, const Points& start, Index parts)
      : surface_(surface),
        x_(at_equal_parts(start, parts)),
        touching_(static_cast<std::size_t>(parts) + 1, BorderedSurface::kFree),
        part_(polyline_length(start) / static_cast<double>(parts)) {}

  TautString run(const Context& context) {
    disturb();
    const Index n = x_.cols() - 1;
    std::vector<Index> inner;
    for (Index i = 1; i < n; ++i) inner.push_back(i);
    (void)move(inner, 0);  // onto the surface, and inside
    const double omega = 2 / (1 + std::sin(std::numbers::pi / static_cast<double>(n)));
    for (Index sweep = 0; sweep < kSweepsPerPart * n; ++sweep) {
      context.check_cancelled();
      double largest = 0;
      for (const Index parity : {1, 2}) {
        std::vector<Index> half;
        for (Index i = parity; i < n; i += 2) half.push_back(i);
        largest = std::max(largest, move(half, omega));
      }
      if (largest <= kAtRest * part_) break;
    }
    return {std::move(x_), std::move(touching_)};
  }

 private:
  void disturb() {
    std::mt19937_64 random(1);
    for (Index i = 1; i + 1 < x_.cols(); ++i) x_.col(i) += kDisorder * part_ * random_direction(x_.rows(), random);
  }

  /// Moves points towards the middle of their neighbours by `omega` times that way. How far at most.
  double move(const std::vector<Index>& which, double omega) {
    const auto count = static_cast<Index>(which.size());
    Points to(x_.rows(), count);
    for (Index j = 0; j < count; ++j) {
      const Index i = which[static_cast<std::size_t>(j)];
      to.col(j) = x_.col(i) + omega * ((x_.col(i - 1) + x_.col(i + 1)) / 2 - x_.col(i));
    }
    const Points wanted = to;
    const Eigen::Array<bool, Eigen::Dynamic, 1> there = surface_.project(BorderedSurface::kFree, to);
    const Points room = surface_.room(to);
    std::vector<int> touches(which.size(), BorderedSurface::kFree);
    for (Index border = 0; border < surface_.num_borders(); ++border) {
      std::vector<Index> outside;
      for (Index j = 0; j < count; ++j) {
        Index worst = 0;
        if (there(j) && room.col(j).minCoeff(&worst) < 0 && worst == border) outside.push_back(j);
      }
      if (outside.empty()) continue;
      Points at(x_.rows(), static_cast<Index>(outside.size()));
      for (std::size_t j = 0; j < outside.size(); ++j) at.col(static_cast<Index>(j)) = wanted.col(outside[j]);
      const Eigen::Array<bool, Eigen::Dynamic, 1> pressed = surface_.project(static_cast<int>(border), at);
      for (std::size_t j = 0; j < outside.size(); ++j) {
        if (!pressed(static_cast<Index>(j))) continue;  // in the middle of an obstacle: stays there for now
        to.col(outside[j]) = at.col(static_cast<Index>(j));
        touches[static_cast<std::size_t>(outside[j])] = static_cast<int>(border);
      }
    }
    double largest = 0;
    for (Index j = 0; j < count; ++j) {
      const Index i = which[static_cast<std::size_t>(j)];
      if (!there(j)) continue;
      largest = std::max(largest, (to.col(j) - x_.col(i)).norm());
      x_.col(i) = to.col(j);
      touching_[static_cast<std::size_t>(i)] = touches[static_cast<std::size_t>(j)];
    }
    return largest;
  }

  BorderedSurface& surface_;
  Points x_;
  std::vector<int> touching_;
  double part_;
};

}  // namespace

TautString pull_string(BorderedSurface& surface, const Points& start, Index parts, const Context& context) {
  return StringPuller(surface, start, parts).run(context);
}

}  // namespace taut::detail
