#pragma once

#include <string>
#include <string_view>

#include "taut/core/context.hpp"

namespace taut::app {

struct TerminalOptions {
  int threads = 0;
  bool quiet = false;     ///< no notes, no progress
  bool progress = false;  ///< progress lines even where stderr is no terminal
};

/// A context whose notes and progress go to stderr (a bar that redraws itself on a terminal, else plain lines when
/// asked for) and that Ctrl-C cancels: the first one asks the job to stop, a second one ends the program at once.
[[nodiscard]] Context terminal_context(const TerminalOptions& options);

/// Wipes the progress bar, so that other output starts on a clean line.
void clear_progress();

/// A message of the library with its options as the command line spells them: "(option grid_name)" is (--grid-name).
[[nodiscard]] std::string in_flags(std::string_view message);

/// One line on stderr: "taut: MESSAGE". A formula error keeps its lines with the caret.
void print_error(std::string_view message);

}  // namespace taut::app
