#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/input_file.hpp"

namespace taut::detail {

/// The entries "KEY : VALUE" of a text header. Keys are compared in lower case and without blanks.
class HeaderFields {
 public:
  /// `file` must outlive this.
  explicit HeaderFields(const InputFile& file) : file_(file) {}

  /// Adds the line (number `line`, from 1) when it has the separator; the first entry of a key counts.
  void add(std::string_view line_text, std::string_view separator, std::size_t line);

  /// The value without surrounding blanks; null when there is none. `other` is another name of the same key.
  [[nodiscard]] const std::string* find(std::string_view key, std::string_view other = {}) const;
  /// Throws IoError where the key is missing.
  [[nodiscard]] const std::string& at(std::string_view key) const;

  /// The numbers in a value, separated by blanks, commas or parentheses; empty when the key is missing. Words that are
  /// no numbers ("none") are an IoError.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::string_view other = {}) const;
  /// Exactly `count` finite numbers, or none when the key is missing.
  [[nodiscard]] std::vector<double> numbers(std::string_view key, std::size_t count, std::string_view other = {}) const;
  /// Exactly `count` whole numbers; throws where the key is missing.
  [[nodiscard]] std::vector<std::int64_t> integers(std::string_view key, std::size_t count) const;
  [[nodiscard]] std::int64_t integer(std::string_view key) const { return integers(key, 1).front(); }

  /// Throws the IoError for a bad value of this key.
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;

 private:
  struct Entry {
    std::string key;
    std::string value;
    std::size_t line = 0;
  };
  [[nodiscard]] const Entry* entry(std::string_view key) const;

  const InputFile& file_;
  std::vector<Entry> entries_;
};

}  // namespace taut::detail
