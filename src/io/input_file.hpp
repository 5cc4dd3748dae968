#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "taut/core/context.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {

/// A file's bytes with the name that errors and notes carry.
struct InputFile {
  std::string path;
  std::string bytes;
  Context context;

  [[noreturn]] void fail(const std::string& problem) const { throw IoError(path, problem); }
  [[noreturn]] void fail_at_byte(std::size_t offset, const std::string& problem) const {
    fail("byte " + std::to_string(offset) + ": " + problem);
  }
  [[noreturn]] void fail_at_line(std::size_t line, const std::string& problem) const {
    fail("line " + std::to_string(line) + ": " + problem);
  }
  void note(const std::string& message) const { context.tell(path + ": " + message); }
};

/// Reads a whole file. Throws IoError when it is missing, a directory, unreadable or empty.
[[nodiscard]] InputFile read_file(const std::filesystem::path& path, const Context& context);

/// Throws the IoError for a file that could not be opened.
[[noreturn]] void fail_to_open(const std::string& path, int error);

/// Makes text of the bytes: drops a UTF-8 byte order mark, turns lone carriage returns into line ends. Throws IoError
/// for UTF-16 and for anything that holds a zero byte.
void normalise_text(InputFile& file);

/// What the first bytes say the file is ("a PLY file", "a PNG image"); empty when they say nothing.
[[nodiscard]] std::string_view recognise(std::string_view bytes);

/// `text` in quotes for a message: cut to some 40 characters, unprintable bytes escaped.
[[nodiscard]] std::string quote(std::string_view text);

/// "1 point", "2 points", "3 vertices", "4 entries"
[[nodiscard]] std::string counted(std::size_t n, std::string_view noun);

/// The extension in lower case with its dot: ".ply".
[[nodiscard]] std::string lower_extension(const std::filesystem::path& path);
[[nodiscard]] std::string lower(std::string_view text);

}  // namespace taut::detail
