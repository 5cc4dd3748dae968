#pragma once

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "march/centre_reader.hpp"
#include "march/methods.hpp"

namespace taut::detail {

/// As TargetWatch, for a march between cell centres.
class CentreWatch {
 public:
  CentreWatch(const MarchTask& task, const DistanceField& field)
      : target_(task.options.target), radius_(task.options.radius) {
    if (!target_) return;
    cell_.resize(static_cast<std::size_t>(target_->size()));
    task.cells.grid().cell_of(*target_, cell_);
    reader_.emplace(task.cells.grid(), field);
  }

  /// To be called for every cell that was settled.
  void settled(std::span<const std::int32_t> cell) {
    if (!reader_) return;
    for (std::size_t a = 0; a < cell_.size(); ++a) {
      // Only cells of the block around the target are read there.
      if (std::abs(cell[a] - cell_[a]) > 1) return;
    }
    distance_ = reader_->distance(*target_);
  }
  /// Nothing that the front still holds can change the distance at the target, or lies within the radius.
  [[nodiscard]] bool is_final(double front_key) const { return front_key > distance_ || front_key > radius_; }
  /// NaN when there is no target, infinity when it was not reached.
  [[nodiscard]] double distance() const { return reader_ ? distance_ : std::numeric_limits<double>::quiet_NaN(); }

 private:
  std::optional<Vector> target_;
  std::vector<std::int32_t> cell_;
  std::optional<CentreReader> reader_;
  double distance_ = std::numeric_limits<double>::infinity();
  double radius_;
};

}  // namespace taut::detail
