#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace taut {

/// The request itself is wrong: base of everything the library throws. Mathematical outcomes (no path, not converged)
/// are no exceptions but a `Status` in the result. Every message names what, its value and what to do.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An argument breaks its rule: a wrong shape, a NaN, an option out of range.
class InvalidArgument : public Error {
 public:
  using Error::Error;
};

/// A formula that cannot be read. `what()` holds the message, the line and a caret under `column()`.
class ParseError : public Error {
 public:
  ParseError(const std::string& message, std::size_t column) : Error(message), column_(column) {}
  /// Byte offset into the formula, from 0.
  [[nodiscard]] std::size_t column() const { return column_; }

 private:
  std::size_t column_;
};

/// A file that cannot be read or written.
class IoError : public Error {
 public:
  IoError(const std::string& path, const std::string& problem) : Error(path + ": " + problem), path_(path) {}
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// The Jacobian loses rank where a normal is needed (the apex of a cone, the node of a cubic).
class SingularPoint : public Error {
 public:
  using Error::Error;
};

/// There is nothing to work on: no cell of the box holds a piece of the surface.
class EmptySurface : public Error {
 public:
  using Error::Error;
};

/// The job would need more memory than it may take. Thrown before the machine swaps.
class OutOfMemory : public Error {
 public:
  using Error::Error;
};

/// `Context::cancel` was raised.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

/// Which of the known names is meant by `name`, which is none of them: the one with the fewest letters to insert, drop,
/// change or swap with their neighbour (letter case counts half). Empty where the nearest is too far to be meant: more
/// than one step for up to four letters, two for longer names. The first of several that are as near.
[[nodiscard]] std::string_view nearest_name(std::string_view name, const std::vector<std::string_view>& known);

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
