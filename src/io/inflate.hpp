#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "io/input_file.hpp"

namespace taut::detail {

/// Unpacks gzip or zlib data (the first bytes tell) up to `most` bytes: fewer come back where there are no more, or
/// where the data are cut short. Memory: no more than the packed bytes can hold, whatever `most` is. Throws IoError for
/// damaged data, and where Taut was built without zlib.
[[nodiscard]] std::string inflate(const InputFile& file, std::string_view packed, std::size_t most);

/// The same for bare deflated data, as ZIP archives hold them. Throws, too, where they are not `size` bytes.
[[nodiscard]] std::string inflate_raw(const InputFile& file, std::string_view packed, std::size_t size);

/// Unpacks all of a gzip file in place. Throws IoError for data that are damaged, cut short, or no gzip data.
void gunzip(InputFile& file);

}  // namespace taut::detail
