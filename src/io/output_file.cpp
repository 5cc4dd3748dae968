#include "taut/io/output_file.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <random>
#include <system_error>
#include <utility>

#include "taut/core/error.hpp"

namespace taut {
namespace {

constexpr std::size_t kBufferSize = std::size_t{1} << 20;

std::filesystem::path temporary_name(const std::filesystem::path& folder) {
  static std::atomic<unsigned> counter = 0;
  std::random_device random;
  return folder / (".taut-" + std::to_string(random()) + "-" + std::to_string(counter++) + ".tmp");
}

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path) : name_(path.string()), target_(path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (name_.empty()) throw IoError("''", "the name of the output file is empty; give one");
  if (fs::is_symlink(path, ignored)) target_ = fs::weakly_canonical(path, ignored);
  if (fs::is_directory(target_, ignored)) throw IoError(name_, "is a folder; name a file to write");
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    throw IoError(name_, "the folder '" + folder.string() + "' does not exist; create it first");
  }
  errno = 0;
  const bool exists = fs::exists(target_, ignored);
  if (exists && !fs::is_regular_file(target_, ignored)) {
    file_ = std::fopen(target_.string().c_str(), "wb");
    if (file_ == nullptr) fail("cannot be written", errno);
    return;
  }
  if (exists) {  // replacing it would quietly override a write protection
    std::FILE* probe = std::fopen(target_.string().c_str(), "r+b");
    if (probe == nullptr) fail("cannot be replaced", errno);
    std::fclose(probe);
  }
  temporary_ = temporary_name(folder);
  file_ = std::fopen(temporary_.string().c_str(), "wbx");
  if (file_ == nullptr) {
    const int error = errno;
    temporary_.clear();
    fail("cannot be written", error);
  }
  if (exists) fs::permissions(temporary_, fs::status(target_, ignored).permissions(), ignored);
}

OutputFile::~OutputFile() {
  if (file_ != nullptr) std::fclose(file_);
  std::error_code ignored;
  if (!temporary_.empty()) std::filesystem::remove(temporary_, ignored);
}

void OutputFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBufferSize) flush();
}

void OutputFile::write_number(double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  write({digits.data(), static_cast<std::size_t>(end - digits.data())});
}

void OutputFile::write_number(std::ptrdiff_t value) {
  std::array<char, 24> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  write({digits.data(), static_cast<std::size_t>(end - digits.data())});
}

void OutputFile::flush() {
  const std::size_t written = std::fwrite(buffer_.data(), 1, buffer_.size(), file_);
  if (written != buffer_.size()) fail("cannot be written to the end", errno);
  buffer_.clear();
}

void OutputFile::commit() {
  flush();
  if (std::fclose(std::exchange(file_, nullptr)) != 0) fail("cannot be written to the end", errno);
  if (temporary_.empty()) return;
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail("cannot be put in place", error.value());
  temporary_.clear();
}

void OutputFile::fail(const std::string& what, int error) const {
  const std::string reason = std::generic_category().message(error);
  const bool is_full = error == ENOSPC || error == EDQUOT;
  const bool is_forbidden = error == EACCES || error == EPERM || error == EROFS;
  throw IoError(name_, what + " (" + reason + "); " +
                           (is_full        ? "make room on the disk"
                            : is_forbidden ? "change the permissions or write elsewhere"
                                           : "check the name and the disk"));
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  file.commit();
}

std::string shortest(double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  return {digits.data(), end};
}

}  // namespace taut
