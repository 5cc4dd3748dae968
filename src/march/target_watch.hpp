#pragma once

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "march/field_reader.hpp"
#include "march/methods.hpp"

namespace taut::detail {

/// Says when a march has done what it was asked for. Keeps the distance at the target up to date while the front passes
/// it.
template <int D, int K>
class TargetWatch {
 public:
  TargetWatch(const MarchTask& task, const DistanceField& field) : radius_(task.options.radius) {
    if (!task.options.target) return;
    const Vector& x = *task.options.target;
    point_ = {x.data(), task.target_normals.data()};
    cell_.resize(static_cast<std::size_t>(x.size()));
    task.cells.grid().cell_of(x, cell_);
    reader_.emplace(task.cells, field);
  }

  /// To be called for every cell that was settled.
  void settled(std::span<const std::int32_t> cell) {
    if (!reader_) return;
    for (std::size_t a = 0; a < cell_.size(); ++a) {
      if (std::abs(cell[a] - cell_[a]) > 1) return;
    }
    distance_ = reader_->distance(point_);
  }
  /// Nothing that the front still holds can change the distance at the target, or lies within the radius.
  [[nodiscard]] bool is_final(double front_key) const { return front_key > distance_ || front_key > radius_; }
  /// NaN when there is no target, infinity when it was not reached.
  [[nodiscard]] double distance() const { return reader_ ? distance_ : std::numeric_limits<double>::quiet_NaN(); }

 private:
  SurfacePoint point_{};
  std::vector<std::int32_t> cell_;
  std::optional<FieldReader<D, K>> reader_;
  double distance_ = std::numeric_limits<double>::infinity();
  double radius_;
};

}  // namespace taut::detail
