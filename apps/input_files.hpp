#pragma once

#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/io/read_points.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// The file to open: "-" stands for standard input.
[[nodiscard]] std::string file_or_stdin(const std::string& name);

/// Lines of numbers from a file or standard input; @17 stands for a sample of the surface, which must outlive them.
/// Throws IoError.
[[nodiscard]] CsvRows open_rows(const std::string& name, const Surface& surface);

/// The points of a file or of standard input; a line @17 stands for a sample of the surface. Throws IoError.
[[nodiscard]] Points read_point_list(const std::string& name, const Surface& surface, const Context& context);

/// Throws UsageError when one of the results would be written over one of the inputs. Empty names count for nothing.
void refuse_to_overwrite(const std::vector<std::string>& inputs, const std::vector<std::string>& results);

}  // namespace taut::app
