#pragma once

#include "io/input_file.hpp"

namespace taut::detail {

/// Unpacks the file's bytes, one gzip member after the other. Throws IoError for damaged data and in a build without
/// zlib, Cancelled, std::bad_alloc.
void gunzip(InputFile& file);

}  // namespace taut::detail
