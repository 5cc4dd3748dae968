#include "deliver_path.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "report.hpp"
#include "terminal.hpp"

namespace taut::app {

void DeliveryArguments::add_to(CLI::App& command) {
  command.add_flag("--json", json, "the result as one JSON object on stdout");
  files.add_to(command, OutputKind::path, "write");
}

ExitCode deliver_path(const DeliveryArguments& arguments, const PathOutput& output, const Context& context) {
  const PathResult& path = *output.paths.front();
  if (arguments.json) {
    std::cout << output.json.dump() << "\n";
  } else {
    std::cout << facts_text(output.facts);
  }
  if (path.points.cols() == 0) {
    print_error(path.message);
    return exit_code(path.status);
  }
  write_paths(arguments.files, output, context);
  if (path.status != Status::ok) print_error(fmt::format("{}: {}", to_string(path.status), path.message));
  return exit_code(path.status);
}

}  // namespace taut::app
