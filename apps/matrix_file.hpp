#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::app {

/// How a matrix is laid out in its file.
enum class MatrixLayout {
  square,     ///< n x n, both triangles
  condensed,  ///< the upper triangle without the diagonal, row after row: what SciPy's squareform takes
  full,       ///< n x m
  sparse,     ///< row, column, distance: an entry a line
};

/// The rows of a matrix, kept as they come, so that one that was stopped goes on where it was: they go to FILE.partial,
/// under a first line that says what was asked for, and become FILE (.npy or .csv) when all are there.
class MatrixFile {
 public:
  /// `request`: one line that stands for the whole command; rows of an earlier run are kept if theirs was the same.
  /// Throws IoError.
  MatrixFile(std::filesystem::path file, std::string_view request, MatrixLayout layout, Index rows, Index columns);
  MatrixFile(const MatrixFile&) = delete;
  MatrixFile& operator=(const MatrixFile&) = delete;
  ~MatrixFile();

  [[nodiscard]] Index num_done() const { return num_done_; }  ///< rows that are there
  /// The next row. Of `square` and `condensed` what is right of the diagonal, of `full` all; `column` is for `sparse`.
  void add(const std::vector<Index>& column, const std::vector<double>& distance);
  /// What was added is on its way to the disk when it returns. Throws IoError.
  void flush();
  /// All rows are there: makes the file. Throws IoError.
  void finish();

  [[nodiscard]] Index num_entries() const { return num_entries_; }  ///< known after `finish`, both triangles once
  [[nodiscard]] Index num_unknown() const { return num_unknown_; }  ///< of those NaN
  [[nodiscard]] Index num_apart() const { return num_apart_; }      ///< of those infinite

 private:
  [[nodiscard]] Index dense_length(Index row) const;
  void read_earlier(std::string_view header);
  [[noreturn]] void fail(const std::string& what) const;
  void count(double distance);
  void write_dense();
  void write_sparse();

  std::filesystem::path file_, partial_;
  MatrixLayout layout_;
  Index rows_, columns_;
  std::FILE* out_ = nullptr;
  std::size_t header_size_ = 0;
  Index num_done_ = 0;
  Index num_entries_ = 0, num_unknown_ = 0, num_apart_ = 0;
};

}  // namespace taut::app
