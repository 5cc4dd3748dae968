#pragma once

#include "load_surface.hpp"
#include "taut/surface/formula.hpp"

namespace taut::app {

/// --dim, --vars, --set and --domain for the formula `text`, which must use every parameter; where it is empty, that is
/// not checked. Throws UsageError.
[[nodiscard]] FormulaOptions formula_options(const SurfaceArguments& arguments, const std::string& text = "");

/// Does a text file hold a formula where points are expected? Tables of numbers have no '='.
[[nodiscard]] bool holds_formula(const std::string& file);

/// The surface of a formula on the command line, or of one in a file that `@NAME` names. Its errors say which option
/// helps. Throws UsageError, ParseError, InvalidArgument, IoError.
[[nodiscard]] Surface read_formula(const SurfaceArguments& arguments);

}  // namespace taut::app
