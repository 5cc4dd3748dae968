#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/temp_folder.hpp"
#include "taut/io/read_point_cloud.hpp"

namespace taut::test {

/// Reads `bytes` as if they stood in a file of this name. Notes are appended to `notes`, if given.
inline PointCloud read_as(std::string_view name, std::string_view bytes, std::vector<std::string>* notes = nullptr,
                          std::optional<Index> dim = {}) {
  const TempFolder folder;
  Context context;
  if (notes != nullptr) context.note = [notes](std::string_view note) { notes->emplace_back(note); };
  return read_point_cloud(folder.write(name, bytes), context, dim);
}

/// The message of the IoError that reading `bytes` under this name throws, without the folder; empty if none is thrown.
inline std::string error_of(std::string_view name, std::string_view bytes) {
  const TempFolder folder;
  try {
    static_cast<void>(read_point_cloud(folder.write(name, bytes)));
  } catch (const IoError& error) {
    const std::string message = error.what();
    const std::string prefix = folder.path().string() + "/";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
  }
  return {};
}

/// The bytes of a number, least significant first, or last.
template <class T>
std::string raw(T value, bool big_endian = false) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big)) bytes.assign(bytes.rbegin(), bytes.rend());
  return bytes;
}

/// The bytes that two hexadecimal digits each stand for: small binary files in a test's text.
inline std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  }
  return bytes;
}

}  // namespace taut::test
