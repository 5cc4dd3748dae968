#pragma once

#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// A curve x(t) in R^d, 0 <= t <= T: polynomials of one degree p on elements in a row, continuous, each given by its
/// values at p + 1 Gauss-Lobatto-Legendre nodes; neighbours share the node between them. A value.
class SpectralCurve {
 public:
  SpectralCurve() = default;
  /// `lengths`: parameter length of each of m elements, > 0. `nodes`: d x (m degree + 1). Throws InvalidArgument when
  /// the shapes do not fit or degree is not in 1..16.
  SpectralCurve(int degree, std::vector<double> lengths, Points nodes);

  [[nodiscard]] Index dim() const { return nodes_.rows(); }
  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] Index num_elements() const { return static_cast<Index>(lengths_.size()); }
  [[nodiscard]] const Points& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<double>& lengths() const { return lengths_; }
  /// T. A corrected geodesic has constant speed close to 1: t is arc length from the start.
  [[nodiscard]] double period() const { return breaks_.empty() ? 0 : breaks_.back(); }

  [[nodiscard]] Vector point(double t) const;     ///< x(t); t is clamped to [0, T]
  [[nodiscard]] Vector velocity(double t) const;  ///< x'(t)
  /// x(t) at each of n parameters, d x n.
  [[nodiscard]] Points sample(const VectorIn& t) const;

 private:
  struct Place {
    Index element;
    double local;  // -1 .. 1
  };
  [[nodiscard]] Place locate(double t) const;

  int degree_ = 0;
  std::vector<double> lengths_;
  std::vector<double> breaks_;  // m + 1, from 0
  Points nodes_;
};

/// Arc length from the first point to each point of a smooth curve that is given by points close together (d x m),
/// model units. Each chord counts as the circular arc that its neighbours say, so the error falls with the fourth power
/// of the spacing; where the curve turns by more than 0.3 rad from one chord to the next it is taken for a corner.
[[nodiscard]] Vector arc_lengths(const PointsIn& curve);

/// n points (n >= 2) at equal arc lengths along the curve (d x m), the first and the last its ends; each is projected
/// onto the surface. Throws InvalidArgument for n < 2 and for a curve of less than two points.
[[nodiscard]] Points evenly_spaced(const Surface& surface, const PointsIn& curve, Index n);

}  // namespace taut
