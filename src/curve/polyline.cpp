// Plain geometry of polylines (d x m): lengths, points at arc lengths, how far they stray from their chords, and meshes
// that equidistribute a density (de Boor's rule). All by one pass along the nodes; nothing is known of a surface here.
#include "curve/polyline.hpp"

#include <algorithm>
#include <cstddef>

namespace taut::detail {

double polyline_length(const PointsIn& nodes) {
  double length = 0;
  for (Index j = 1; j < nodes.cols(); ++j) length += (nodes.col(j) - nodes.col(j - 1)).norm();
  return length;
}

Points without_repeats(const PointsIn& nodes) {
  Points result(nodes.rows(), nodes.cols());
  Index count = 0;
  for (Index j = 0; j < nodes.cols(); ++j) {
    if (count > 0 && (nodes.col(j) - result.col(count - 1)).squaredNorm() == 0) continue;
    result.col(count++) = nodes.col(j);
  }
  return result.leftCols(count);
}

Points at_arc_lengths(const PointsIn& nodes, const std::vector<double>& arcs) {
  const Index last = nodes.cols() - 1;
  Points result(nodes.rows(), static_cast<Index>(arcs.size()));
  Index segment = 0;
  double before = 0;
  double length = last > 0 ? (nodes.col(1) - nodes.col(0)).norm() : 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    while (segment + 1 < last && arcs[i] > before + length) {
      before += length;
      ++segment;
      length = (nodes.col(segment + 1) - nodes.col(segment)).norm();
    }
    // Clamped: sums of lengths and the arcs asked for differ by rounding.
    const double fraction = length > 0 ? std::clamp((arcs[i] - before) / length, 0.0, 1.0) : 0;
    const Index next = std::min(segment + 1, last);
    result.col(static_cast<Index>(i)) = nodes.col(segment) + fraction * (nodes.col(next) - nodes.col(segment));
  }
  // The ends bit for bit, as fixed ends of what is built on it.
  result.leftCols<1>() = nodes.col(0);
  result.rightCols<1>() = nodes.col(last);
  return result;
}

// Parts of the polyline's own length: its corners are in general not among the points.
Points at_equal_parts(const PointsIn& nodes, Index count) {
  const double length = polyline_length(nodes);
  std::vector<double> arcs;
  for (Index i = 0; i <= count; ++i) arcs.push_back(length * static_cast<double>(i) / static_cast<double>(count));
  return at_arc_lengths(nodes, arcs);
}

std::vector<double> straying(const PointsIn& nodes, const std::vector<double>& arcs) {
  const Points ends = at_arc_lengths(nodes, arcs);
  std::vector<double> result(arcs.size() - 1, 0.0);
  std::vector<int> inside(result.size(), 0);
  double arc = 0;
  std::size_t i = 0;
  for (Index j = 1; j + 1 < nodes.cols(); ++j) {
    arc += (nodes.col(j) - nodes.col(j - 1)).norm();
    while (i + 1 < result.size() && arc > arcs[i + 1]) ++i;
    const auto e = static_cast<Index>(i);
    const Vector chord = ends.col(e + 1) - ends.col(e);
    const Vector offset = nodes.col(j) - ends.col(e);
    const double squared = chord.squaredNorm();
    const double along = squared > 0 ? std::clamp(offset.dot(chord) / squared, 0.0, 1.0) : 0;
    result[i] = std::max(result[i], (offset - along * chord).norm() / (arcs[i + 1] - arcs[i]));
    ++inside[i];
  }
  for (i = 0; i < result.size(); ++i) {
    // Three nodes or fewer may be a zigzag of cells, not a bend.
    if (inside[i] < 4) result[i] = 0;
  }
  return result;
}

std::vector<double> equidistribute(const std::vector<double>& lengths, const std::vector<double>& density,
                                   Index count) {
  double whole = 0;
  double mass = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    whole += lengths[i];
    mass += lengths[i] * density[i];
  }
  // Where the density vanishes (a flat piece) intervals still end somewhere.
  const double floor = mass > 0 ? 0.25 * mass / whole : 1;
  double total = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) total += lengths[i] * (density[i] + floor);

  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(count));
  std::size_t i = 0;
  double arc = 0;     // where interval i starts
  double before = 0;  // mass left of it
  double previous = 0;
  for (Index cut = 1; cut < count; ++cut) {
    const double wanted = total * static_cast<double>(cut) / static_cast<double>(count);
    while (i + 1 < lengths.size() && before + lengths[i] * (density[i] + floor) < wanted) {
      before += lengths[i] * (density[i] + floor);
      arc += lengths[i++];
    }
    const double here = arc + (wanted - before) / (density[i] + floor);
    result.push_back(here - previous);
    previous = here;
  }
  result.push_back(whole - previous);
  return result;
}

}  // namespace taut::detail
