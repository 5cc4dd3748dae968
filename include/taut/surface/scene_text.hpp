#pragma once

#include <string_view>

#include "taut/surface/formula.hpp"

namespace taut {

/// Reads a scene, bodies defined one a line and put together on the last:
///     post = cylinder(0, 0, 1, 0.5, 2)    # what is behind # or // is a remark
///     smooth_union(box(0, 0, 0, 4, 2, 0.4), post, 0.2)
/// A definition is a name, = and an expression of what was defined before it; the last line is the surface, as in
/// `parse_surface`. A line goes on where a parenthesis is open. `options.parameters` stand in for definitions of the
/// same name, which must be numbers. Throws ParseError, which names the line, and InvalidArgument.
[[nodiscard]] Surface parse_scene(std::string_view text, const FormulaOptions& options = {});

}  // namespace taut
