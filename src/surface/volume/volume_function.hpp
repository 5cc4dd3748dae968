#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "surface/volume/spline_volume.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// A tricubic spline as a function R^3 -> R.
class VolumeFunction : public ImplicitFunction {
 public:
  explicit VolumeFunction(std::shared_ptr<const SplineVolume> spline) : spline_(std::move(spline)) {}
  [[nodiscard]] Index dim() const override { return 3; }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;
  [[nodiscard]] std::string_view kind() const override { return "volume"; }

 private:
  std::shared_ptr<const SplineVolume> spline_;
};

/// A face of the volume, where it ends.
struct VolumeFace {
  int axis = 0;
  bool upper = false;  ///< at the last voxels' centres; else at the first ones'
};

/// How far inside of some faces a point lies, in voxels: >= 0 in the volume. One component a face.
class VolumeDomain : public ImplicitFunction {
 public:
  VolumeDomain(std::shared_ptr<const SplineVolume> spline, const std::vector<VolumeFace>& faces);
  [[nodiscard]] Index dim() const override { return 3; }
  [[nodiscard]] Index codim() const override { return static_cast<Index>(offsets_.size()); }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;

 private:
  class Own;
  Eigen::Matrix3Xd gradients_;  // a face each
  Eigen::VectorXd offsets_;     // F_i = gradient_i (x - origin) + offset_i
  Eigen::Vector3d origin_;
};

}  // namespace taut::detail
