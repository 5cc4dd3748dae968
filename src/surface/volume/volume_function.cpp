// The tricubic spline in world coordinates: u = A (x - origin) in voxels, F(x) = sum_ijk c_ijk B(u_1 - i) B(u_2 - j)
// B(u_3 - k), grad F = A^T grad_u, Hess F = A^T Hess_u A.

#include "surface/volume/volume_function.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/volume/spline_basis.hpp"

namespace taut::detail {
namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();

class VolumeEvaluator : public Evaluator {
 public:
  explicit VolumeEvaluator(std::shared_ptr<const SplineVolume> spline)
      : Evaluator(3, 1), spline_(std::move(spline)), coefficients_(spline_->coefficients()) {}

  void evaluate(const PointBatch& batch) override {
    if (batch.hessian != nullptr) {
      evaluate_points<2>(batch);
    } else if (batch.jacobian != nullptr) {
      evaluate_points<1>(batch);
    } else {
      evaluate_points<0>(batch);
    }
  }

  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const VoxelBox box =
          spline_->voxel_box(Eigen::Vector3d::Map(batch.lower + 3 * j), Eigen::Vector3d::Map(batch.upper + 3 * j));
      const ValueRange range = spline_->bounds(box);
      batch.value_lower[j] = range.lower;
      batch.value_upper[j] = range.upper;
    }
    return true;
  }

 private:
  /// A point on one axis: its cell, and the weights of the four coefficients that matter there.
  struct Position {
    Index cell = 0;
    Eigen::Array4d weights;
    Eigen::Array4d slopes;
    Eigen::Array4d curvatures;
  };

  template <int Derivatives>
  [[nodiscard]] Position locate(double u, int axis) const {
    const Index num_cells = spline_->num_cells(axis);
    const double end = static_cast<double>(num_cells);
    const double clamped = std::clamp(u, -SplineVolume::kOverhang, end + SplineVolume::kOverhang);
    const double cell = std::clamp(std::floor(clamped), 0.0, end - 1);
    const double t = clamped - cell;
    Position position;
    position.cell = static_cast<Index>(cell);
    position.weights = spline_weights(t);
    // Beyond the overhang the function does not depend on u.
    const double moves = clamped == u ? 1 : 0;
    if constexpr (Derivatives > 0) position.slopes = moves * spline_slopes(t);
    if constexpr (Derivatives > 1) position.curvatures = moves * spline_curvatures(t);
    return position;
  }

  template <int Derivatives>
  void evaluate_points(const PointBatch& batch) {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Vector3d u = spline_->to_voxels() * (Eigen::Vector3d::Map(batch.x + 3 * j) - spline_->origin());
      if (u.hasNaN()) {
        set_nan(batch, j);
      } else {
        evaluate_point<Derivatives>(batch, j, u);
      }
    }
  }

  static void set_nan(const PointBatch& batch, Index j) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    if (batch.value != nullptr) batch.value[j] = kNaN;
    if (batch.jacobian != nullptr) std::fill_n(batch.jacobian + 3 * j, 3, kNaN);
    if (batch.hessian != nullptr) std::fill_n(batch.hessian + 9 * j, 9, kNaN);
  }

  /// Sums over k, then j, then i; below, v_jk stands for a derivative of order j along axis 2 and k along axis 3, with
  /// the four entries along axis 1 side by side.
  template <int Derivatives>
  void evaluate_point(const PointBatch& batch, Index point, const Eigen::Vector3d& u) {
    using Four = Eigen::Array4d;
    const Position p0 = locate<Derivatives>(u(0), 0);
    const Position p1 = locate<Derivatives>(u(1), 1);
    const Position p2 = locate<Derivatives>(u(2), 2);
    const float* corner = coefficients_.values.data() + coefficients_.at(p0.cell, p1.cell, p2.cell);
    const Index row = coefficients_.stride(1);
    const Index plane = coefficients_.stride(2);
    Four v00 = Four::Zero(), v01 = Four::Zero(), v02 = Four::Zero();
    Four v10 = Four::Zero(), v11 = Four::Zero(), v20 = Four::Zero();
    for (Index b = 0; b < 4; ++b) {
      Four value = Four::Zero(), slope = Four::Zero(), curvature = Four::Zero();
      for (Index c = 0; c < 4; ++c) {
        const Four entries = Eigen::Map<const Eigen::Array4f>(corner + b * row + c * plane).cast<double>();
        value += p2.weights(c) * entries;
        if constexpr (Derivatives > 0) slope += p2.slopes(c) * entries;
        if constexpr (Derivatives > 1) curvature += p2.curvatures(c) * entries;
      }
      v00 += p1.weights(b) * value;
      if constexpr (Derivatives > 0) {
        v10 += p1.slopes(b) * value;
        v01 += p1.weights(b) * slope;
      }
      if constexpr (Derivatives > 1) {
        v20 += p1.curvatures(b) * value;
        v11 += p1.slopes(b) * slope;
        v02 += p1.weights(b) * curvature;
      }
    }
    const auto dot = [](const Four& a, const Four& b) {
      return (a(0) * b(0) + a(1) * b(1)) + (a(2) * b(2) + a(3) * b(3));
    };
    if (batch.value != nullptr) batch.value[point] = dot(p0.weights, v00);
    const Eigen::Matrix3d& a = spline_->to_voxels();
    if constexpr (Derivatives > 0) {
      if (batch.jacobian != nullptr) {
        const Eigen::Vector3d gradient(dot(p0.slopes, v00), dot(p0.weights, v10), dot(p0.weights, v01));
        Eigen::Vector3d::Map(batch.jacobian + 3 * point) = a.transpose() * gradient;
      }
    }
    if constexpr (Derivatives > 1) {
      Eigen::Matrix3d h;
      h(0, 0) = dot(p0.curvatures, v00);
      h(1, 1) = dot(p0.weights, v20);
      h(2, 2) = dot(p0.weights, v02);
      h(0, 1) = h(1, 0) = dot(p0.slopes, v10);
      h(0, 2) = h(2, 0) = dot(p0.slopes, v01);
      h(1, 2) = h(2, 1) = dot(p0.weights, v11);
      const Eigen::Matrix3d world = batch.weight[point] * (a.transpose() * (h * a));
      Eigen::Map<Eigen::Matrix3d> out(batch.hessian + 9 * point);
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c <= r; ++c) out(r, c) = out(c, r) = world(r, c);  // exactly symmetric
      }
    }
  }

  std::shared_ptr<const SplineVolume> spline_;
  const Lattice& coefficients_;
};

}  // namespace

std::unique_ptr<Evaluator> VolumeFunction::make_evaluator() const { return std::make_unique<VolumeEvaluator>(spline_); }

class VolumeDomain::Own : public Evaluator {
 public:
  explicit Own(const VolumeDomain& domain)
      : Evaluator(3, domain.codim()),
        gradients_(domain.gradients_),
        offsets_(domain.offsets_),
        origin_(domain.origin_) {}

  void evaluate(const PointBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const Eigen::Vector3d x = Eigen::Vector3d::Map(batch.x + 3 * j) - origin_;
      for (Index i = 0; i < codim_; ++i) {
        if (batch.value != nullptr) batch.value[j * codim_ + i] = gradients_.col(i).dot(x) + offsets_(i);
        if (batch.jacobian != nullptr) {
          Eigen::Vector3d::Map(batch.jacobian + 3 * (j * codim_ + i)) = gradients_.col(i);
        }
      }
    }
    if (batch.hessian != nullptr) std::fill_n(batch.hessian, 9 * batch.n, 0.0);
  }

  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const auto lower = Eigen::Vector3d::Map(batch.lower + 3 * j);
      const auto upper = Eigen::Vector3d::Map(batch.upper + 3 * j);
      const Eigen::Vector3d middle = 0.5 * (lower + upper) - origin_;
      const Eigen::Vector3d largest = lower.cwiseAbs().cwiseMax(upper.cwiseAbs()) + origin_.cwiseAbs();
      const Eigen::Vector3d reach = 0.5 * (upper - lower) + 16 * kEps * largest;
      for (Index i = 0; i < codim_; ++i) {
        const double value = gradients_.col(i).dot(middle) + offsets_(i);
        const double half = gradients_.col(i).cwiseAbs().dot(reach) + 4 * kEps * std::abs(offsets_(i));
        batch.value_lower[j * codim_ + i] = value - half;
        batch.value_upper[j * codim_ + i] = value + half;
      }
    }
    return true;
  }

 private:
  Eigen::Matrix3Xd gradients_;
  Eigen::VectorXd offsets_;
  Eigen::Vector3d origin_;
};

VolumeDomain::VolumeDomain(std::shared_ptr<const SplineVolume> spline, const std::vector<VolumeFace>& faces)
    : gradients_(3, static_cast<Index>(faces.size())),
      offsets_(static_cast<Index>(faces.size())),
      origin_(spline->origin()) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto i = static_cast<Index>(f);
    const Eigen::Vector3d along = spline->to_voxels().row(faces[f].axis).transpose();
    gradients_.col(i) = faces[f].upper ? Eigen::Vector3d(-along) : along;
    offsets_(i) = faces[f].upper ? static_cast<double>(spline->num_cells(faces[f].axis)) : 0;
  }
}

std::unique_ptr<Evaluator> VolumeDomain::make_evaluator() const { return std::make_unique<Own>(*this); }

}  // namespace taut::detail
