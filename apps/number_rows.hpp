#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/io/read_points.hpp"

namespace taut::app {

/// Some lines of a batch file: the numbers they ask about, or what is wrong with them.
struct NumberRows {
  std::vector<std::size_t> lines;     ///< n: their numbers in the file, from 1
  std::vector<std::string> problems;  ///< n: empty where nothing is wrong
  Points values;                      ///< width x n, a line a column; NaN where there is a problem

  [[nodiscard]] Index size() const { return values.cols(); }
};

/// The next lines of a file, at most `most`, of `width` numbers each; `takes` says in messages what a line takes
/// ("a pair takes 6, p1,...,pd,q1,...,qd"). None at the end of the file.
[[nodiscard]] NumberRows read_number_rows(CsvRows& rows, Index width, Index most, const std::string& takes);

}  // namespace taut::app
