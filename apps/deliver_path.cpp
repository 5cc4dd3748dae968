#include "deliver_path.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>

#include "help_format.hpp"
#include "ignored_faces.hpp"
#include "report.hpp"
#include "terminal.hpp"
#include "timer.hpp"

namespace taut::app {

void DeliveryArguments::add_to(CLI::App& command) {
  const OptionGroup group(command, "Output");
  command.add_flag("--json", json, "the result as one JSON object on stdout");
  files.add_to(command, OutputKind::path, "write");
}

ExitCode deliver_path(const DeliveryArguments& arguments, const PathOutput& output, const Context& context) {
  const PathResult& path = *output.sources.front().paths.front();
  const bool found = path.points.cols() > 0;
  nlohmann::ordered_json json = output.json;
  std::vector<SceneFact> facts = output.facts;
  // Pictures come first, so that their time is in the result; the result comes out even where they cannot be written.
  std::exception_ptr trouble;
  if (found) {
    const Timer timer;
    try {
      write_paths(arguments.files, output, context);
    } catch (...) {
      trouble = std::current_exception();
    }
    clear_progress();
    if (arguments.files.has_picture()) add_picture_seconds(timer.seconds(), json, facts);
  }
  if (arguments.json) {
    std::cout << json.dump() << "\n";
  } else {
    std::cout << facts_text(facts);
  }
  if (!found) {
    print_error(path.message);
    return exit_code(path.status);
  }
  tell_of_ignored_faces(output.surface, path.length, context);
  if (trouble) std::rethrow_exception(trouble);
  write_json_files(arguments.files, json);
  if (path.status != Status::ok) print_error(fmt::format("{}: {}", to_string(path.status), path.message));
  return exit_code(path.status);
}

}  // namespace taut::app
