#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "taut/core/error.hpp"

namespace taut {

/// A formula that uses a name without a meaning: no variable, no constant, no function, no parameter with a value.
class UnknownName : public ParseError {
 public:
  UnknownName(const std::string& message, std::size_t column, std::string name)
      : ParseError(message, column), name_(std::move(name)) {}
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace taut
