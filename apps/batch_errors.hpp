#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

namespace taut::app {

/// What goes wrong with the lines of a batch, on stderr: the first few in full, then a count.
class BatchErrors {
 public:
  /// `file`: what messages call the batch.
  explicit BatchErrors(std::string file) : file_(std::move(file)) {}
  BatchErrors(const BatchErrors&) = delete;
  BatchErrors& operator=(const BatchErrors&) = delete;
  /// Says how many were not told.
  ~BatchErrors();

  /// `number`: the line's, from 1. `noun`: what is counted where it is no line.
  void tell(std::size_t number, std::string_view problem, std::string_view noun = "line");
  [[nodiscard]] bool any() const { return count_ > 0; }

 private:
  std::string file_;
  std::size_t count_ = 0;
};

}  // namespace taut::app
