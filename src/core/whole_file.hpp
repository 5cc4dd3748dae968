#pragma once

#include <string>
#include <string_view>

namespace taut::detail {

/// Writes `bytes` to the file `path`, which appears whole or not at all: into a temporary file beside it, then renamed
/// over it. What is no regular file (/dev/stdout, a pipe) is written directly. Throws IoError with the system's reason.
void write_whole_file(const std::string& path, std::string_view bytes);

}  // namespace taut::detail
