#include "taut/io/read_surface.hpp"

#include "io/input_file.hpp"
#include "taut/surface/formula.hpp"

namespace taut {

Surface read_scene(const std::filesystem::path& path, const FormulaOptions& options, const Context& context) {
  detail::InputFile file = detail::read_file(path, context);
  detail::normalise_text(file);
  try {
    return parse_scene(file.bytes, options);
  } catch (const ParseError& error) {
    file.fail(error.what());
  }
}

}  // namespace taut
