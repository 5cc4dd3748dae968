#include "deliver_path.hpp"

#include <fmt/format.h>

#include <iostream>

#include "output.hpp"
#include "report.hpp"
#include "terminal.hpp"

namespace taut::app {

ExitCode deliver_path(const PathDelivery& delivery, const Surface& surface, const PathResult& path,
                      const nlohmann::ordered_json& json, const std::vector<SceneFact>& facts, const Context& context) {
  if (delivery.json) {
    std::cout << json.dump() << "\n";
  } else {
    std::cout << facts_text(facts);
  }
  if (path.points.cols() == 0) {
    print_error(path.message);
    return exit_code(path.status);
  }
  write_paths(
      delivery.out,
      {.surface = surface, .paths = {&path}, .json = json, .facts = facts, .title = delivery.title, .up = delivery.up},
      context);
  if (path.status != Status::ok) print_error(fmt::format("{}: {}", to_string(path.status), path.message));
  return exit_code(path.status);
}

}  // namespace taut::app
