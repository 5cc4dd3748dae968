#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "taut/core/types.hpp"

namespace taut {

/// A file that appears complete or not at all: bytes go to a temporary file in the same folder, which `commit` moves
/// into place. Without `commit` (an exception on the way) the temporary file is removed and an older file of that name
/// stays as it was. Devices and pipes (/dev/stdout) are written directly.
class OutputFile {
 public:
  /// Throws IoError when the folder does not exist or cannot be written to, or when `path` is a folder.
  explicit OutputFile(const std::filesystem::path& path);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Throws IoError when the disk is full or fails.
  void write(std::string_view bytes);
  /// Shortest decimal that reads back as the same double; "nan", "inf".
  void write_number(double value);
  void write_number(std::ptrdiff_t value);
  /// Writes everything out and moves the file into place. Nothing may be written afterwards.
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const std::string& what, int error) const;

  std::string name_;                 // as the caller gave it, for messages
  std::filesystem::path target_;     // symbolic links resolved
  std::filesystem::path temporary_;  // empty when the target is written directly
  std::FILE* file_ = nullptr;
  std::string buffer_;
};

/// Writes `text` to `path`, whole or not at all.
void write_text(const std::filesystem::path& path, std::string_view text);

/// Shortest decimal that reads back as the same double; "nan", "inf", "-inf".
[[nodiscard]] std::string shortest(double value);

/// The beginning of a `.npy` file (NumPy's format 1.0) of 64-bit floats in C order; the numbers, little-endian, follow.
void write_npy_header(OutputFile& out, const std::vector<Index>& shape);

}  // namespace taut
