#pragma once

#include <CLI/App.hpp>

#include "exit_code.hpp"
#include "output.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"

namespace taut::app {

/// Where a single path goes.
struct DeliveryArguments {
  FileArguments files;
  bool json = false;  ///< one JSON object on stdout instead of lines for people
  void add_to(CLI::App& command);
};

/// Prints the path (the only one of `output`), writes its files, says on stderr what was wrong with it, and knows the
/// exit code.
[[nodiscard]] ExitCode deliver_path(const DeliveryArguments& arguments, const PathOutput& output,
                                    const Context& context);

}  // namespace taut::app
