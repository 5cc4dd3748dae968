// Reduced length and geodesic scales of a ray: x'' = II(x', x') and j'' + K j = 0 by Gauss collocation with fixed
// steps, halved until nothing changes.
//
// Notation: e the unit vector of the surface across the ray, v = x', |v| = 1, and a = II(v, v) of ray_field.hpp;
// K = <II(e, e), a> - |II(v, e)|^2 (Gauss' equation).

#include "taut/curve/exponential_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/linear_algebra.hpp"
#include "curve/gauss_collocation.hpp"
#include "curve/ray_field.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::GaussCollocation;
using Field = detail::RayField<Eigen::Dynamic>;
using Row = GaussCollocation::Row;
using Transfer = Eigen::Matrix2d;  // (j, j') at the start of a stretch -> at its end
constexpr int kStages = GaussCollocation::kStages;

/// A ray and its fields, step by step.
class FieldRay {
 public:
  FieldRay(const Surface& surface, const VectorIn& x, const VectorIn& v) : field_(surface, kStages), x_(x), v_(v) {}

  Transfer transfer = Transfer::Identity();

  /// False where the step is too long, or F cannot be followed.
  bool step(double h) {
    const GaussCollocation& t = GaussCollocation::tables();
    const Index d = x_.size();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(d, kStages);
    Eigen::MatrixXd x;
    Eigen::MatrixXd v;
    constexpr int kMostVisits = 40;
    double last = std::numeric_limits<double>::infinity();
    for (int visit = 0;; ++visit) {
      v = h * a * t.once;
      v.colwise() += v_;
      x = h * h * a * t.twice + h * v_ * t.node;
      x.colwise() += x_;
      if (field_.evaluate(kStages, x.data(), v.data()) != Field::Outcome::regular) return false;
      const double change = h * h * (field_.acceleration.leftCols(kStages) - a).cwiseAbs().maxCoeff();
      a = field_.acceleration.leftCols(kStages);
      if (change <= 1e-16 * h || (visit > 2 && change >= last && change < 1e-13 * h)) break;
      if (visit + 1 == kMostVisits || !(change < 10 * h)) return false;
      last = change;
    }
    follow_fields(pull_at_nodes(x, v), h);
    x_ += h * v_ + h * h * a * t.end_twice.transpose();
    v_ += h * a * t.end_once.transpose();
    return settle();
  }

 private:
  /// K at the nodes.
  [[nodiscard]] Row pull_at_nodes(const Eigen::MatrixXd& x, const Eigen::MatrixXd& v) {
    const Index d = x.rows();
    const Index k = field_.codim();
    Eigen::MatrixXd across(d, kStages);
    for (Index i = 0; i < kStages; ++i) {
      Eigen::MatrixXd known(d, k + 1);
      known << field_.normals(i), v.col(i).normalized();
      across.col(i) = detail::orthogonal_complement(known);
    }
    Eigen::MatrixXd bent(d, kStages);
    field_.bend_along(kStages, x.data(), 1, across.data(), bent.data());
    Row pull;
    Eigen::MatrixXd y;
    for (Index i = 0; i < kStages; ++i) {
      field_.bend(i, across.col(i), y);
      pull(i) = across.col(i).dot(bent.col(i)) - y.squaredNorm();
    }
    return pull;
  }

  void follow_fields(const Row& pull, double h) {
    const GaussCollocation& t = GaussCollocation::tables();
    Transfer of_step;
    for (int start = 0; start < 2; ++start) {
      const double value = start == 0 ? 1 : 0;
      const double slope = start == 0 ? 0 : 1;
      const Row straight = Row::Constant(value) + h * slope * t.node;
      Row j = straight;
      constexpr int kMostVisits = 100;
      for (int visit = 0; visit < kMostVisits; ++visit) {
        const Row next = straight - (h * h) * (pull.cwiseProduct(j) * t.twice);
        const double change = (next - j).cwiseAbs().maxCoeff();
        j = next;
        if (!(change > 1e-17 * std::max(1.0, h))) break;
      }
      const Row force = -pull.cwiseProduct(j);
      of_step(0, start) = value + h * slope + h * h * force.dot(t.end_twice);
      of_step(1, start) = slope + h * force.dot(t.end_once);
    }
    transfer = (of_step * transfer).eval();
  }

  /// Back onto the surface and into its tangent space.
  bool settle() {
    if (field_.evaluate(1, x_.data(), v_.data()) != Field::Outcome::regular) return false;
    const auto q = field_.normals(0);
    x_ -= q * field_.value.col(0);
    v_ -= q * (q.transpose() * v_);
    v_.normalize();
    return x_.allFinite() && v_.allFinite();
  }

  Field field_;
  Vector x_, v_;
};

}  // namespace

GeodesicScales geodesic_scales(const Surface& surface, const VectorIn& from, const VectorIn& direction, double length) {
  if (surface.dim() - surface.codim() != 2) throw InvalidArgument("geodesic scales are for surfaces of two dimensions");
  if (from.size() != surface.dim() || direction.size() != surface.dim() || !(length >= 0)) {
    throw InvalidArgument("geodesic scales need a start, a direction and a length >= 0");
  }
  GeodesicScales result;
  if (length == 0) return result;
  constexpr int kMostSteps = 1 << 13;
  constexpr double kEnough = 1e-13;  // with order 16, halving a step that leaves this leaves nothing
  bool known = false;
  double last = std::numeric_limits<double>::infinity();
  Transfer whole;
  for (int steps = 4; steps <= kMostSteps; steps *= 2) {
    FieldRay ray(surface, from, direction);
    bool followed = true;
    for (int i = 0; i < steps && followed; ++i) followed = ray.step(length / steps);
    if (!followed) continue;
    const double size = std::max(1.0, ray.transfer.cwiseAbs().maxCoeff());
    double change = std::numeric_limits<double>::infinity();
    if (known) {
      Transfer off = ray.transfer - whole;
      off(0, 1) /= length;
      off(1, 0) *= length;
      change = off.cwiseAbs().maxCoeff() / size;
    }
    whole = ray.transfer;
    known = true;
    result.error = change * size + 4e-15 * size;
    if (change <= kEnough || (change < 1e-9 && change > 0.5 * last)) break;  // or rounding, grown along the way
    last = change;
  }
  if (!known || !whole.allFinite()) {
    result.status = Status::rank_deficient;
    return result;
  }
  result.m12 = whole(0, 1);
  result.M12 = whole(0, 0);
  result.M21 = whole(1, 1);
  return result;
}

}  // namespace taut
