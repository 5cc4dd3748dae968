#pragma once

#include <cstddef>
#include <filesystem>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut {

/// One line of a table of numbers.
struct CsvRow {
  std::size_t line = 0;        ///< its number in the file, from 1
  std::vector<double> values;  ///< finite, unless `problem` says otherwise
  std::string problem;  ///< what is wrong with the line ("column 2: 'abc' is not a number; ..."); empty if nothing is
};

/// Reads a table line by line, as large as it may be: what batch commands walk over. Columns are separated by commas,
/// semicolons or blanks (the first line decides); blank lines and `#` comments are skipped, and so is a first line of
/// column names. A bad line does not end the walk: it comes with its `problem`, so that the answer can stand in its
/// place. Memory is one line's, and a line longer than 16 MiB is refused.
class CsvRows {
 public:
  /// Throws IoError when the file cannot be opened, is empty or is no text. "-" is not special: pass `std::cin` for it.
  /// Messages call it `name`, or by its path.
  explicit CsvRows(const std::filesystem::path& path, std::string name = {});
  /// Reads from `in`, which must outlive this; `name` stands for it in messages.
  CsvRows(std::istream& in, std::string name);
  CsvRows(CsvRows&&) noexcept;
  CsvRows& operator=(CsvRows&&) noexcept;
  ~CsvRows();

  /// From now on a field such as @17 stands for the d coordinates of column 17 (from 0) of `samples`, d x n, which must
  /// outlive this. Without samples such a field is the line's `problem`.
  void set_samples(const Points& samples);

  /// Reads the next line with numbers into `row`; false at the end. Throws IoError when reading fails.
  [[nodiscard]] bool next(CsvRow& row);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Reads a list of points, d x n in the file's order (what `taut path --start` and `--samples` take): every format of
/// `read_point_cloud`, of which only the points are used; any other extension (`.txt`, `.dat`, none) is read like
/// `.csv`. In `.csv`, `.xyz`, `.pts` and plain text a line is a point: `dim` numbers, or columns named x y z ... in a
/// header.
///
/// In `.csv`, `.tsv`, `.txt` and other plain text a line @17 stands for column 17 (from 0) of `samples`, if given.
///
/// `dim` > 0 is the dimension the points must have. Throws IoError as `read_point_cloud` does, and when the dimension
/// is another one.
[[nodiscard]] Points read_points(const std::filesystem::path& path, Index dim, const Context& context = {},
                                 const Points* samples = nullptr);

}  // namespace taut
