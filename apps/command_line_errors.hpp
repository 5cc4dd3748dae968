#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace taut::app {

/// What is wrong with the command's name in the words of the command line; empty when nothing is.
[[nodiscard]] std::string explain_command(const CLI::App& app, const std::vector<std::string>& arguments);

/// What stands wrong on the command line, in one sentence that says what to write: CLI11's own words are for
/// programmers. `command` is the one chosen, or the program where none was.
[[nodiscard]] std::string explain(const CLI::ParseError& error, const CLI::App& command);

}  // namespace taut::app
