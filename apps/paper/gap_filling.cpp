// Equation (5), min |F(p)| subject to (p - p') . AB = 0, is solved as two equations F(p) = 0 and (p - p') . AB = 0 by
// the projection onto a surface of codimension 2.

#include "gap_filling.hpp"

#include <algorithm>
#include <memory>

#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut::paper {
namespace {

/// F and the plane through `origin` across `axis`: two equations.
class CutByPlane final : public ImplicitFunction {
 public:
  CutByPlane(const Surface& surface, Vector origin, Vector axis)
      : surface_(surface), origin_(std::move(origin)), axis_(std::move(axis)) {}

  [[nodiscard]] Index dim() const override { return surface_.dim(); }
  [[nodiscard]] Index codim() const override { return 2; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override { return std::make_unique<Cut>(*this); }

 private:
  class Cut final : public Evaluator {
   public:
    explicit Cut(const CutByPlane& function)
        : Evaluator(function.dim(), 2), function_(function), inner_(function.surface_.make_evaluator()) {}

    void evaluate(const PointBatch& batch) override {
      for (Index j = 0; j < batch.n; ++j) {
        const double* x = batch.x + j * dim_;
        double value = 0;
        Vector gradient(dim_);
        Eigen::MatrixXd hessian(dim_, dim_);
        PointBatch one{.n = 1, .x = x, .value = &value, .jacobian = gradient.data()};
        if (batch.hessian != nullptr) {
          one.weight = batch.weight + 2 * j;
          one.hessian = hessian.data();
        }
        inner_->evaluate(one);
        const Eigen::Map<const Vector> place(x, dim_);
        if (batch.value != nullptr) {
          batch.value[2 * j] = value;
          batch.value[2 * j + 1] = function_.axis_.dot(place - function_.origin_);
        }
        if (batch.jacobian != nullptr) {
          Eigen::Map<Points>(batch.jacobian + 2 * j * dim_, dim_, 2) << gradient, function_.axis_;
        }
        if (batch.hessian != nullptr) Eigen::Map<Points>(batch.hessian + j * dim_ * dim_, dim_, dim_) = hessian;
      }
    }

   private:
    const CutByPlane& function_;
    std::unique_ptr<Evaluator> inner_;
  };

  Surface surface_;
  Vector origin_;
  Vector axis_;
};

Vector new_node(const Surface& surface, const Vector& a, const Vector& b, NodeProjection projection) {
  const Vector middle = 0.5 * (a + b);
  try {
    if (projection == NodeProjection::ordinary) return project_to_surface(surface, middle).point;
    const Surface cut(std::make_shared<const CutByPlane>(surface, middle, (b - a).normalized()));
    return project_to_surface(cut, middle).point;
  } catch (const SingularPoint&) {
    return middle;
  }
}

}  // namespace

GapFilling fill_gap(const Surface& surface, const VectorIn& a, const VectorIn& b, Index num_nodes,
                    NodeProjection projection) {
  std::vector<Vector> nodes = {a, b};
  GapFilling filling;
  const auto interval = [&nodes](std::size_t i) { return (nodes[i + 1] - nodes[i]).norm(); };
  for (Index count = 0; count <= num_nodes; ++count) {
    std::size_t widest = 0;
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) widest = interval(i) > interval(widest) ? i : widest;
    filling.longest.push_back(interval(widest));
    if (count == num_nodes) break;
    nodes.insert(nodes.begin() + static_cast<std::ptrdiff_t>(widest) + 1,
                 new_node(surface, nodes[widest], nodes[widest + 1], projection));
  }
  filling.nodes.resize(surface.dim(), static_cast<Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) filling.nodes.col(static_cast<Index>(i)) = nodes[i];
  return filling;
}

}  // namespace taut::paper
