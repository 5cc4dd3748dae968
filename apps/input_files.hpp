#pragma once

#include <string>
#include <vector>

#include "taut/io/read_points.hpp"

namespace taut::app {

/// The file to open: "-" stands for standard input.
[[nodiscard]] std::string file_or_stdin(const std::string& name);

/// Lines of numbers from a file or standard input. Throws IoError.
[[nodiscard]] CsvRows open_rows(const std::string& name);

/// Throws UsageError when one of the results would be written over one of the inputs. Empty names count for nothing.
void refuse_to_overwrite(const std::vector<std::string>& inputs, const std::vector<std::string>& results);

}  // namespace taut::app
