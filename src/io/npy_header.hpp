#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/input_file.hpp"

namespace taut::detail {

/// What stands before the numbers of an .npy file.
struct NpyHeader {
  std::string descr;  ///< "<f8": byte order and type
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::size_t data_offset = 0;
};

/// Throws IoError for what is no NumPy array, or a structured one.
[[nodiscard]] NpyHeader parse_npy_header(const InputFile& file);

}  // namespace taut::detail
