#include "input_files.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "points_argument.hpp"
#include "taut/io/read_points.hpp"

namespace taut::app {

std::string file_or_stdin(const std::string& name) { return name == "-" ? "/dev/stdin" : name; }

CsvRows open_rows(const std::string& name, const Surface& surface) {
  CsvRows rows = name == "-" ? CsvRows(file_or_stdin(name), "standard input") : CsvRows(name);
  if (surface.samples() != nullptr) rows.set_samples(surface.samples()->points);
  return rows;
}

Points read_point_list(const std::string& name, const Surface& surface, const Context& context) {
  const Points* samples = surface.samples() != nullptr ? &surface.samples()->points : nullptr;
  return read_points(file_or_stdin(name), surface.dim(), context, samples);
}

void refuse_to_overwrite(const std::vector<std::string>& inputs, const std::vector<std::string>& results) {
  for (const std::string& result : results) {
    for (const std::string& input : inputs) {
      std::error_code ignored;
      if (input.empty() || !std::filesystem::is_regular_file(input, ignored) ||
          !std::filesystem::equivalent(input, result, ignored)) {
        continue;
      }
      throw UsageError(fmt::format("--out {}: is read as input; write to another file", result));
    }
  }
}

}  // namespace taut::app
