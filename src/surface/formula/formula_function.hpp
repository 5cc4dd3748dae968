#pragma once

#include <memory>
#include <utility>

#include "surface/formula/program.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// A compiled formula as a function.
class FormulaFunction : public ImplicitFunction {
 public:
  explicit FormulaFunction(std::shared_ptr<const FormulaProgram> program) : program_(std::move(program)) {}
  [[nodiscard]] Index dim() const override { return program_->dim(); }
  [[nodiscard]] Index codim() const override { return program_->codim(); }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;
  [[nodiscard]] std::string_view kind() const override { return "formula"; }
  [[nodiscard]] const FormulaProgram& program() const { return *program_; }

 private:
  std::shared_ptr<const FormulaProgram> program_;
};

}  // namespace taut::detail
