#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "taut/core/context.hpp"
#include "taut/io/read_points.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// The table of a batch, which is read twice: a file, or what comes through a pipe ("-" is stdin), kept in a temporary
/// file meanwhile.
class PairsFile {
 public:
  /// Reads a pipe to its end. Throws IoError when the temporary file cannot be written, and Cancelled.
  PairsFile(std::string name, const Context& context);

  /// What messages call it.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// From its first line; @17 stands for a sample of the surface, which must outlive them. Throws IoError.
  [[nodiscard]] CsvRows rows(const Surface& surface) const;
  /// Changes when the content does: size and time of a file, size and hash of what came through a pipe.
  [[nodiscard]] const std::string& version() const { return version_; }

 private:
  /// Removes the file in the end.
  struct Remover {
    void operator()(std::filesystem::path* file) const;
  };

  void keep_pipe(const Context& context);

  std::string name_;
  std::filesystem::path path_;
  std::string version_;
  std::unique_ptr<std::filesystem::path, Remover> temporary_;  // null where the file is the user's own
};

}  // namespace taut::app
