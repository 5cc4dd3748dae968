#pragma once

#include <memory>

#include "taut/surface/surface.hpp"

namespace taut::detail {

/// An evaluator that counts the points it is asked about: work that is the same on every machine.
class CountingEvaluator final : public Evaluator {
 public:
  explicit CountingEvaluator(const Surface& surface)
      : Evaluator(surface.dim(), surface.codim()), evaluator_(surface.make_evaluator()) {}

  void evaluate(const PointBatch& batch) override {
    num_evaluated_ += batch.n;
    evaluator_->evaluate(batch);
  }
  [[nodiscard]] Index num_evaluated() const { return num_evaluated_; }

 private:
  std::unique_ptr<Evaluator> evaluator_;
  Index num_evaluated_ = 0;
};

}  // namespace taut::detail
