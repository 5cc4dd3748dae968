// The arrays of a field over cells that may still be coming. They grow by at least half of their size, so that growing
// costs O(N) in all; memory is checked against the limit before each time. Between reports a march looks whether it has
// been cancelled.
#include "march/growing_field.hpp"

#include <algorithm>

#include "cells/memory_guard.hpp"

namespace taut::detail {

GrowingField::GrowingField(const MarchTask& task, DistanceField& field, Growth growth)
    : task_(task),
      field_(field),
      growth_(growth),
      gradients_(field.method == MarchMethod::convergent),
      memory_limit_(memory_limit(task.context)) {
  field_.gradient.resize(field_.sources.rows(), 0);
  grow();
}

Index GrowingField::pop() {
  const Index i = front_.pop();
  if (growth_ == Growth::faces) {
    task_.cells.expand_faces(i);
  } else {
    task_.cells.expand(i);
  }
  grow();
  return i;
}

void GrowingField::settle(Index i, double distance, Index source) {
  field_.distance(i) = distance;
  field_.nearest_source[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(source);
  constexpr Index kCellsPerReport = 4096;  // a few milliseconds
  if (++field_.num_reached % kCellsPerReport != 0) return;
  task_.context.check_cancelled();
  const double share = static_cast<double>(field_.num_reached) / static_cast<double>(task_.cells.num_cells());
  task_.context.report("march", task_.cells.is_lazy() ? -1.0 : share);
}

void GrowingField::grow() {
  const Index n = task_.cells.num_cells();
  const Index old = field_.distance.size();
  if (n <= old) return;
  const Index d = field_.sources.rows();
  const Index size = std::max(n, old + old / 2);
  constexpr std::size_t kBytesPerCell = 32;  // distance, source, place and entry in the front
  const std::size_t bytes_per_cell = kBytesPerCell + (gradients_ ? 8 * static_cast<std::size_t>(d) : 0);
  check_memory(task_.cells.bytes() + bytes_per_cell * static_cast<std::size_t>(size), memory_limit_, n,
               task_.cells.grid().size());
  field_.distance.conservativeResize(size);
  field_.distance.tail(size - old).setConstant(kUnknown);
  if (gradients_) {
    field_.gradient.conservativeResize(d, size);
    field_.gradient.rightCols(size - old).setZero();
  }
  field_.nearest_source.resize(static_cast<std::size_t>(size), -1);
  front_.resize(size);
}

void GrowingField::finish(double target_distance) {
  const Index n = task_.cells.num_cells();
  field_.distance.conservativeResize(n);
  if (gradients_) field_.gradient.conservativeResize(field_.gradient.rows(), n);
  field_.nearest_source.resize(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    // What still waits in the front has a source but no distance.
    if (!settled(i)) field_.nearest_source[static_cast<std::size_t>(i)] = -1;
  }
  field_.target_distance = target_distance;
  task_.context.report("march", 1.0);
}

}  // namespace taut::detail
