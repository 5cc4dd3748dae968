#include "number_rows.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

namespace taut::app {

NumberRows read_number_rows(CsvRows& rows, Index width, Index most, const std::string& takes) {
  NumberRows found;
  std::vector<double> numbers;
  for (CsvRow row; static_cast<Index>(found.lines.size()) < most && rows.next(row);) {
    std::string problem = row.problem;
    if (problem.empty() && static_cast<Index>(row.values.size()) != width) {
      problem = fmt::format("{} numbers; {}", row.values.size(), takes);
    }
    if (!problem.empty()) {
      row.values.assign(static_cast<std::size_t>(width), std::numeric_limits<double>::quiet_NaN());
    }
    numbers.insert(numbers.end(), row.values.begin(), row.values.end());
    found.lines.push_back(row.line);
    found.problems.push_back(std::move(problem));
  }
  found.values = Eigen::Map<const Points>(numbers.data(), width, static_cast<Index>(found.lines.size()));
  return found;
}

}  // namespace taut::app
