#include "surface/normals/merged_sheets.hpp"

#include <cmath>
#include <memory>

#include "surface/describe.hpp"
#include "surface/normals/bridged_gap.hpp"
#include "surface/normals/layered_noise.hpp"
#include "surface/normals/sheet_split.hpp"

// Between the faces of a plate F is negative, between two solids positive, and in the middle about as far from 0 as the
// gap is wide: of a parabola that vanishes on both with slope 1, a quarter of the gap. Where F has not this sign there,
// the two sheets have become one, or F goes from one to the other. Sheets that face the same way have F change its sign
// once more between them, so that nothing nearer than the samples can be right. Half-way between two samples of one
// sheet, in the middle of the gap, F has to have that sign, too: else there is a tunnel from one face to the other, as
// random samples leave holes for.

namespace taut::detail {
namespace {

/// Of the parabola's depth: half as deep still tells two sheets.
constexpr double kLeastDepth = 0.25 * 0.4;
/// Cosine of two normals that face the same way.
constexpr double kSameWay = 0.5;
/// A few samples at a rim, or one whose opposite was not recognised, say nothing about the surface.
constexpr double kFew = 0.02;
/// Of all samples: a doubt concerns every path, wherever it goes, and must not come of a few places on a large scan.
/// Measured: random plates with tunnels 1.5 % and more; the wings of a feline 0.15 %, a raw range image 0.005 %.
constexpr double kFewOfAll = 0.01;

/// Where samples can be told apart one by one.
MergedSheets find_unparted(const Points& points, const Points& normals, const KdTree& tree,
                           const ImplicitFunction& function, const Context& context) {
  const SheetSplit split(points, tree, context);
  if (!split.any()) return {};
  const std::unique_ptr<Evaluator> evaluator = function.make_evaluator();
  const auto height = [&](Index i) { return normals.col(i).dot(points.col(split.opposite(i)) - points.col(i)); };
  const auto middle = [&](Index i) { return Vector(points.col(i) + 0.5 * height(i) * normals.col(i)); };
  const auto value = [&](const Vector& x) {
    double f = 0;
    evaluator->evaluate({.n = 1, .x = x.data(), .value = &f});
    return f;
  };
  MergedSheets merged;
  double gaps = 0;
  Index shallow = 0;
  for (Index i = 0; i < points.cols(); ++i) {
    if (!split.is_split(i)) continue;
    const double h = height(i);
    const auto depth = [&](const Vector& x) { return h < 0 ? -value(x) : value(x); };
    const Vector here = middle(i);
    bool bad = normals.col(i).dot(normals.col(split.opposite(i))) > kSameWay;
    if (!bad && depth(here) < kLeastDepth * std::abs(h)) ++shallow;
    for (const Index j : split.beside(i)) {
      if (bad) break;
      if (j < i || !split.is_split(j) || normals.col(i).dot(normals.col(j)) < kSameWay) continue;
      bad = depth(0.5 * (here + middle(j))) < 0;
    }
    if (!bad) continue;
    if (merged.count++ == 0) merged.at = i;
    gaps += std::abs(h);
  }
  if (static_cast<double>(shallow) > kFew * static_cast<double>(split.num_split())) merged.count += shallow;
  if (static_cast<double>(merged.count) <= kFewOfAll * static_cast<double>(points.cols())) return {};
  merged.gap = gaps / static_cast<double>(merged.count);
  return merged;
}

}  // namespace

MergedSheets find_merged_sheets(const Points& points, const Points& normals, const KdTree& tree,
                                const ImplicitFunction& function, bool of_mesh, const Context& context) {
  const MergedSheets unparted = find_unparted(points, normals, tree, function, context);
  if (unparted.count > 0 || of_mesh) return unparted;
  const MergedSheets bridged = find_bridged_gap(points, normals, tree, function, context);
  if (bridged.count > 0) return bridged;
  return find_layered_noise(points, normals, tree, context);
}

std::string doubt(const MergedSheets& merged, const Points& samples) {
  if (merged.count == 0 || merged.at >= samples.cols()) return {};
  return "the fitted surface may not be the sampled one: two sheets are nearer to each other (some " +
         describe(merged.gap) + ") than the samples on them, and the fit does not keep them apart, as at @" +
         std::to_string(merged.at) + " " + describe(samples.col(merged.at)) + " and " +
         std::to_string(merged.count - 1) + " more samples; denser samples help, and normals where the file has none";
}

}  // namespace taut::detail
