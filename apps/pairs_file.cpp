#include "pairs_file.hpp"

#include <fmt/format.h>
#include <stdlib.h>  // mkstemp
#include <unistd.h>

#include <cstdint>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include "taut/core/error.hpp"

namespace taut::app {

PairsFile::PairsFile(std::string name, const Context& context) : name_(std::move(name)), path_(name_) {
  if (name_ == "-") {
    name_ = "standard input";
    path_ = "/dev/stdin";
  }
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && !std::filesystem::is_regular_file(path_, ignored) &&
      !std::filesystem::is_directory(path_, ignored)) {
    keep_pipe(context);
    return;
  }
  const auto size = std::filesystem::file_size(path_, ignored);
  const auto time = std::filesystem::last_write_time(path_, ignored).time_since_epoch().count();
  version_ = fmt::format("{} bytes, {}", size, time);
}

CsvRows PairsFile::rows(const Surface& surface) const {
  CsvRows rows(path_, name_);
  if (surface.samples() != nullptr) rows.set_samples(surface.samples()->points);
  return rows;
}

void PairsFile::Remover::operator()(std::filesystem::path* file) const {
  std::error_code ignored;
  std::filesystem::remove(*file, ignored);
  delete file;
}

void PairsFile::keep_pipe(const Context& context) {
  std::ifstream pipe(path_, std::ios::binary);
  std::error_code missing;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(missing);
  if (missing)
    throw IoError("TMPDIR", "is no folder, the pairs from a pipe cannot be kept there; set it to one with room");
  std::string kept = (folder / "taut-pairs-XXXXXX").string();
  const int file = mkstemp(kept.data());
  if (file < 0) throw IoError(kept, "cannot be made to keep the pairs from a pipe; set TMPDIR to a folder with room");
  close(file);
  temporary_.reset(new std::filesystem::path(kept));
  path_ = kept;
  std::ofstream copy(path_, std::ios::binary);
  std::vector<char> chunk(std::size_t{1} << 16);
  std::uint64_t hash = 14695981039346656037U;  // FNV-1a
  std::uint64_t size = 0;
  while (pipe && copy) {
    pipe.read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    context.check_cancelled();
    const auto got = static_cast<std::size_t>(pipe.gcount());
    for (std::size_t i = 0; i < got; ++i) hash = (hash ^ static_cast<unsigned char>(chunk[i])) * 1099511628211U;
    size += got;
    copy.write(chunk.data(), static_cast<std::streamsize>(got));
  }
  if (!copy.flush())
    throw IoError(path_.string(), "the pairs from a pipe cannot be kept there; set TMPDIR to a folder with room");
  version_ = fmt::format("{} bytes, {:016x}", size, hash);
}

}  // namespace taut::app
