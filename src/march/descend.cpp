// The way from a point down a distance field to the nearest source: x' = -grad u, with |grad u| = 1, in steps of half a
// cell, each followed by a projection onto the surface. Gradients are read at x by the update that the march itself
// makes, so they exist at any point. Two-step Adams-Bashforth, started and restarted by Heun's method: second order, as
// the field. Where the field has no single gradient (beside an edge of the surface, on the cut locus) the way goes to
// the projected point of a cell further down instead; fields of other methods have no gradients and go so everywhere.
// The last piece is a straight line from the source. Fields between centres give the path on the grid that the paper
// shows.
#include "taut/march/march.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "march/centre_reader.hpp"
#include "march/dimensions.hpp"
#include "march/field_reader.hpp"
#include "march/march_over.hpp"
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
/// Gradients that turn by more than this (cosine) from step to step say little about the next.
constexpr double kSmooth = 0.95;
/// How near the surface the points are kept, in cells.
constexpr double kNearness = 1e-4;

/// One descent. Where the field is smooth it goes against the gradient in steps of half a cell; elsewhere (beside an
/// edge of the surface, on the cut locus) it steps from cell to cell. The distance falls with every step, so it ends.
template <int D, int K>
class Descent {
 public:
  Descent(const Surface& surface, const SurfaceCells& cells, const DistanceField& field, const CellMap* map)
      : cells_(cells),
        field_(field),
        evaluator_(surface.make_evaluator()),
        d_(surface.dim()),
        k_(surface.codim()),
        reader_(cells, field, map) {}

  /// From the target to the source, d x m; empty when there is no way down.
  [[nodiscard]] Points run(const VectorIn& target, const VectorIn& target_normals) {
    points_.assign(target.data(), target.data() + d_);
    x_ = target;
    normals_ = target_normals;
    // Every point's distance must be less than `below`, the distance before it: no way turns back on itself.
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

  /// One step of second order: along the gradient as it has turned since the last one (Adams and Bashforth), or, at
  /// first, where it turned much and where that leads nowhere, along the mean of the gradients at both ends (Heun).
  /// False when it does not lead down.
  [[nodiscard]] bool follow_gradient(double& below) {
    if (!reading_ || !(reading_->arrival.distance < below)) return false;
    const SmallVector<D> gradient = reading_->arrival.gradient;
    const bool smooth = follows_on_ && gradient.dot(last_gradient_) > kSmooth;
    // Only the direction counts: look_along() gives the step its length.
    bool taken = smooth && step_along(1.5 * gradient - 0.5 * last_gradient_, below);
    if (!taken) {
      const std::optional<Reading<D>> ahead = look_along(gradient);
      taken = ahead && step_along(gradient + ahead->arrival.gradient, below);
    }
    follows_on_ = taken;
    last_gradient_ = gradient;
    return taken;
  }

  /// What the field says a step down against a direction, `there_` with the normals `normals_there_`.
  [[nodiscard]] std::optional<Reading<D>> look_along(const SmallVector<D>& direction) {
    there_ = x_ - kStep * cells_.grid().size() / direction.norm() * direction;
    if (!settle(there_, normals_there_)) return std::nullopt;
    return reader_.read({there_.data(), normals_there_.data()});
  }

  /// Takes such a step if it leads down.
  [[nodiscard]] bool step_along(const SmallVector<D>& direction, double& below) {
    const double distance = reading_->arrival.distance;
    const std::optional<Reading<D>> next = look_along(direction);
    // On a smooth field a step lowers u by its own length, but for the turn of the gradient.
    if (!next || !(next->arrival.distance < distance - kLeastDescent * kStep * cells_.grid().size())) return false;
    std::swap(x_, there_);
    std::swap(normals_, normals_there_);
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
        // A step that leaves the surface by a cell has lost it: then the way goes over a cell's point.
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
    follows_on_ = false;
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
  Eigen::MatrixXd normals_;
  Vector there_;
  Eigen::MatrixXd normals_there_;
  std::optional<Reading<D>> reading_;
  bool is_read_ = false;  // reading_ is of x_ already
  SmallVector<D> last_gradient_;
  bool follows_on_ = false;  // the last step ran along the gradients, from one of last_gradient_
};

/// From cell to cell, by their centres.
Points descend_centres(const CellGrid& grid, const DistanceField& field, const VectorIn& target) {
  const Index d = target.size();
  std::vector<double> points(target.data(), target.data() + d);
  const auto append = [&](const VectorIn& x) { points.insert(points.end(), x.data(), x.data() + d); };
  CentreReader reader(grid, field);
  Index i = reader.last_cell(target).first;
  if (i == CellGrid::kNone) return Points(d, 0);
  Index source = reader.source_in(i);
  while (source < 0) {
    append(grid.centre(i));
    i = reader.next_cell(i);
    if (i == CellGrid::kNone) return Points(d, 0);
    source = reader.source_in(i);
  }
  append(field.sources.col(source));
  return Eigen::Map<const Points>(points.data(), d, static_cast<Index>(points.size()) / d);
}

}  // namespace

Points descend_over(const Surface& surface, const SurfaceCells& cells, const CellMap* map, const DistanceField& field,
                    const VectorIn& target) {
  if (target.size() != surface.dim() || !target.allFinite()) {
    throw InvalidArgument("descend: the target must be a finite point in dimension " + std::to_string(surface.dim()));
  }
  const Vector normals = normals_at(surface, target).col(0);
  // A singular target has no tangent plane to read the field in.
  if (!normals.allFinite()) return Points(surface.dim(), 0);
  // Both walk from the target; paths are told from the source.
  if (field.at_centres) return descend_centres(cells.grid(), field, target).rowwise().reverse();
  Points down;
  with_dimensions(surface.dim(), surface.codim(),
                  [&]<int D, int K>() { down = Descent<D, K>(surface, cells, field, map).run(target, normals); });
  return down.rowwise().reverse();
}

}  // namespace detail

Points descend(const Surface& surface, const SurfaceCells& cells, const DistanceField& field, const VectorIn& target) {
  return detail::descend_over(surface, cells, nullptr, field, target);
}

}  // namespace taut
