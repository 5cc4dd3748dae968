#pragma once

#include <vector>

#include "taut/core/types.hpp"
#include "taut/io/output_file.hpp"

namespace taut {

/// The beginning of a `.npy` file (NumPy's format 1.0) of 64-bit floats in C order; the numbers, little-endian, follow.
void write_npy_header(OutputFile& out, const std::vector<Index>& shape);

}  // namespace taut
