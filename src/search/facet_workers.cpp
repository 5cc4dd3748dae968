#include "search/facet_workers.hpp"

#include <utility>

#include "core/stopwatch.hpp"

namespace taut::detail {

void FacetWorkers::expect(const PointsIn& near) {
  if (near.cols() > 0) asked_ = {near.rowwise().minCoeff(), near.rowwise().maxCoeff()};
  ready_ = false;
}

/// A graph made for all that is asked about now is shared; which thread looks for which pair changes nothing.
std::unique_ptr<FacetSearch> FacetWorkers::worker(const SurfaceExtent& extent) {
  const std::scoped_lock lock(turn_);
  if (!first_) first_ = std::make_unique<FacetSearch>(surface_, options_, context_);
  if (!first_->is_ready()) return nullptr;
  if (!ready_) {
    if (first_->prepare(extent, asked_)) idle_.clear();
    ready_ = true;
  }
  if (idle_.empty()) return first_->clone();
  std::unique_ptr<FacetSearch> worker = std::move(idle_.back());
  idle_.pop_back();
  return worker;
}

std::optional<PathResult> FacetWorkers::find(const Vector& p, const Vector& q, const SurfaceExtent& extent) {
  const Stopwatch watch;
  std::unique_ptr<FacetSearch> one = worker(extent);
  if (!one) return std::nullopt;
  const double prepared = watch.seconds();
  PathResult found = one->find(p, q, extent);
  found.seconds.cells += prepared;
  const std::scoped_lock lock(turn_);
  idle_.push_back(std::move(one));
  return found;
}

}  // namespace taut::detail
