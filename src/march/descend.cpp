#include "taut/march/descend.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "march/dimensions.hpp"
#include "march/field_reader.hpp"
#include "march/point_normals.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace detail {
namespace {

/// Length of a step, in cells.
constexpr double kStep = 0.5;
/// A step that lowers the distance by less than this part of its length is not taken: the field is not smooth there.
constexpr double kLeastDescent = 0.3;
/// How near the surface the points are kept, in cells.
constexpr double kNearness = 1e-4;

/// One descent. Where the field is smooth it goes against the gradient in steps of half a cell; elsewhere (beside an
/// edge of the surface, on the cut locus) it steps from cell to cell. The distance falls with every step, so it ends.
template <int D, int K>
class Descent {
 public:
  Descent(const Surface& surface, const SurfaceCells& cells, const DistanceField& field)
      : cells_(cells),
        field_(field),
        evaluator_(surface.make_evaluator()),
        d_(surface.dim()),
        k_(surface.codim()),
        reader_(cells, field) {}

  /// From the target to the source, d x m; empty when there is no way down.
  [[nodiscard]] Points run(const VectorIn& target, const VectorIn& target_normals) {
    points_.assign(target.data(), target.data() + d_);
    x_ = target;
    normals_ = target_normals;
    double below = std::numeric_limits<double>::infinity();
    while (!at_source()) {
      if (field_.method == MarchMethod::convergent && follow_gradient(below)) continue;
      if (!step_to_cell(below)) return Points(d_, 0);
    }
    return Eigen::Map<const Points>(points_.data(), d_, static_cast<Index>(points_.size()) / d_);
  }

 private:
  [[nodiscard]] SurfacePoint here() const { return {x_.data(), normals_.data()}; }

  void append(const VectorIn& x) { points_.insert(points_.end(), x.data(), x.data() + d_); }

  /// When the way leads straight from a source, goes there and ends.
  [[nodiscard]] bool at_source() {
    Index source = -1;
    if (field_.method == MarchMethod::convergent) {
      if (!is_read_) reading_ = reader_.read(here());
      is_read_ = false;
      if (reading_) source = reading_->direct_source;
    } else {
      source = reader_.source_nearby(here());
    }
    if (source >= 0) append(field_.sources.col(source));
    return source >= 0;
  }

  /// One step along the mean of the gradients at both its ends, second order. False when it does not lead down.
  [[nodiscard]] bool follow_gradient(double& below) {
    if (!reading_ || !(reading_->arrival.distance < below)) return false;
    const double distance = reading_->arrival.distance;
    const double step = kStep * cells_.grid().size();
    const SmallVector<D> gradient = reading_->arrival.gradient;
    Eigen::MatrixXd normals;
    Vector y = x_ - step * gradient;
    if (!settle(y, normals)) return false;
    auto next = reader_.read({y.data(), normals.data()});
    if (!next) return false;
    const SmallVector<D> mean = gradient + next->arrival.gradient;
    y = x_ - step * mean / mean.norm();
    if (!settle(y, normals)) return false;
    next = reader_.read({y.data(), normals.data()});
    if (!next || !(next->arrival.distance < distance - kLeastDescent * step)) return false;
    x_ = y;
    normals_ = normals;
    below = distance;
    append(x_);
    reading_ = next;
    is_read_ = true;
    return true;
  }

  [[nodiscard]] bool settle(Vector& y, Eigen::MatrixXd& normals) {
    const double h = cells_.grid().size();
    Eigen::MatrixXd point = y;
    const auto converged = project_to_surface(
        *evaluator_, d_, k_, point, {.tolerance = kNearness * h, .max_steps = 5, .max_distance = h}, &normals);
    y = point;
    return converged(0);
  }

  [[nodiscard]] bool step_to_cell(double& below) {
    const Index i = reader_.step_down(here(), below).first;
    if (i < 0) return false;
    below = field_.distance(i);
    x_ = cells_.point(i);
    normals_ = Eigen::Map<const Vector>(cells_.normals(i).data(), d_ * k_);
    append(x_);
    return true;
  }

  const SurfaceCells& cells_;
  const DistanceField& field_;
  std::unique_ptr<Evaluator> evaluator_;
  Index d_;
  Index k_;
  FieldReader<D, K> reader_;
  std::vector<double> points_;
  Vector x_;
  Vector normals_;
  std::optional<Reading<D>> reading_;
  bool is_read_ = false;  // reading_ is of x_ already
};

}  // namespace
}  // namespace detail

Points descend(const Surface& surface, const SurfaceCells& cells, const DistanceField& field, const VectorIn& target) {
  if (target.size() != surface.dim() || !target.allFinite()) {
    throw InvalidArgument("descend: the target must be a finite point in dimension " + std::to_string(surface.dim()));
  }
  const Vector normals = detail::normals_at(surface, target).col(0);
  if (!normals.allFinite()) return Points(surface.dim(), 0);
  Points down;
  detail::with_dimensions(surface.dim(), surface.codim(), [&]<int D, int K>() {
    down = detail::Descent<D, K>(surface, cells, field).run(target, normals);
  });
  return down.rowwise().reverse();
}

}  // namespace taut
