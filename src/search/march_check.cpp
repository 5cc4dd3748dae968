// How wrong are distances marched on coarser cells? Those on finer ones stand for the truth: from two sources, far
// apart in the order of the cells, to up to 1,000 cells each. A cell that only one of both fields reaches counts as
// infinitely wrong.
#include "search/march_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "taut/march/march.hpp"

namespace taut::detail {
namespace {

constexpr Index kSources = 2;
constexpr Index kMostSamples = 1000;  // cells at which distances from one source are compared
/// Distances of fewer cells say more about the cells than about ways.
constexpr double kFewCells = 6;

}  // namespace

MarchCheck::MarchCheck(const Surface& surface, SurfaceCells& finer, const Context& context)
    : surface_(surface), context_(context), finer_(finer), fields_(static_cast<std::size_t>(kSources)) {
  std::vector<Index> valid;
  for (Index i = 0; i < finer.num_cells(); ++i) {
    if (finer.valid(i)) valid.push_back(i);
  }
  const auto n = static_cast<Index>(valid.size());
  parallel_for(context, 0, n > 0 ? kSources : 0, 1, [&](Index first, Index last) {
    for (Index s = first; s < last; ++s) {
      const Index source = valid[static_cast<std::size_t>((2 * s + 1) * n / (2 * kSources))];
      fields_[static_cast<std::size_t>(s)] = march(surface, finer, finer.point(source), {}, context);
    }
  });
}

double MarchCheck::quantile(SurfaceCells& coarser, double part) const {
  const Index stride = 1 + coarser.num_valid() / kMostSamples;
  std::vector<Index> samples;
  for (Index i = 0, count = 0; i < coarser.num_cells(); ++i) {
    if (coarser.valid(i) && count++ % stride == 0) samples.push_back(i);
  }
  Points points(coarser.dim(), static_cast<Index>(samples.size()));
  for (std::size_t j = 0; j < samples.size(); ++j) points.col(static_cast<Index>(j)) = coarser.point(samples[j]);
  std::vector<double> errors;
  for (const DistanceField& fine : fields_) {
    const Vector truth = distance_at(surface_, finer_, fine, points);
    const Index cell = coarser.cell_at(fine.sources.col(0));
    if (cell == CellGrid::kNone || !coarser.valid(cell)) return std::numeric_limits<double>::infinity();
    const DistanceField coarse = march(surface_, coarser, fine.sources, {}, context_);
    for (std::size_t j = 0; j < samples.size(); ++j) {
      const double there = truth(static_cast<Index>(j));
      const double here = coarse.distance(samples[j]);
      const double shorter = std::min(here, there);
      if (!(shorter > kFewCells * coarser.grid().size()) || std::isinf(shorter)) continue;
      errors.push_back(std::abs(here / there - 1));
    }
  }
  if (errors.empty()) return 0;
  const auto at = errors.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(errors.size() - 1));
  std::nth_element(errors.begin(), at, errors.end());
  return *at;
}

}  // namespace taut::detail
