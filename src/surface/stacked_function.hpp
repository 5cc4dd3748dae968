#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/implicit_function.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// A surface's F and some components g of its domain, as one function R^d -> R^(k + m): its zero set is the border
/// where those vanish. With none it is F itself, without the domain.
class StackedFunction final : public ImplicitFunction {
 public:
  /// `components`: of the domain, each once.
  StackedFunction(Surface surface, std::vector<Index> components)
      : surface_(std::move(surface)), components_(std::move(components)) {}

  [[nodiscard]] Index dim() const override { return surface_.dim(); }
  [[nodiscard]] Index codim() const override { return surface_.codim() + static_cast<Index>(components_.size()); }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;
  [[nodiscard]] std::string_view kind() const override { return surface_.kind(); }

 private:
  Surface surface_;
  std::vector<Index> components_;
};

}  // namespace taut::detail
