#include "core/whole_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path) {
  throw IoError(path, "cannot be written: " + std::generic_category().message(errno));
}

struct Closer {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Closer>;

bool write_and_close(File file, std::string_view bytes) {
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  return std::fclose(file.release()) == 0 && written;
}

/// A new file that nobody else has, beside `path`.
File open_beside(const std::string& path, std::string& name) {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    name = path + ".part" + std::to_string(attempt);
    if (std::FILE* file = std::fopen(name.c_str(), "wbx")) return File(file);
    if (errno != EEXIST) break;
  }
  fail(path);
}

}  // namespace

void write_whole_file(const std::string& path, std::string_view bytes) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw IoError(path, "cannot be written: it is a directory");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    File file(std::fopen(path.c_str(), "wb"));
    if (!file || !write_and_close(std::move(file), bytes)) fail(path);
    return;
  }
  // Through a symbolic link the file it names is replaced, not the link.
  const std::string target =
      fs::is_symlink(fs::symlink_status(path, ignored)) ? fs::weakly_canonical(path, ignored).string() : path;
  std::string part;
  File file = open_beside(target, part);
  bool done = write_and_close(std::move(file), bytes);
  done = done && std::rename(part.c_str(), target.c_str()) == 0;
  if (done) return;
  const int reason = errno;
  std::remove(part.c_str());
  errno = reason;
  fail(path);
}

}  // namespace taut::detail
