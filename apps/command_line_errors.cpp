#include "command_line_errors.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>

#include "taut/core/error.hpp"

namespace taut::app {
namespace {

/// ", did you mean --from?", or nothing. `dashes` stand before the name.
std::string suggestion(std::string_view name, const std::vector<std::string>& known, std::string_view dashes = "") {
  const std::vector<std::string_view> views(known.begin(), known.end());
  std::string_view nearest = nearest_name(name, views);
  constexpr std::size_t kShortest = 3;  // of what one name may have in front of the other, as in --output
  for (const std::string_view each : views) {
    const bool begins =
        name.size() >= kShortest && each.size() >= kShortest && (each.starts_with(name) || name.starts_with(each));
    if (nearest.empty() && begins) nearest = each;
  }
  return nearest.empty() ? "" : fmt::format(", did you mean {}{}?", dashes, nearest);
}

/// The long names of a command's options, without dashes.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    const std::vector<std::string>& long_names = option->get_lnames();
    names.insert(names.end(), long_names.begin(), long_names.end());
  }
  return names;
}

std::string explain_option(const std::string& written, const CLI::App& command) {
  const std::string option = written.substr(0, written.find('='));
  const std::string name = option.substr(std::min(option.find_first_not_of('-'), option.size()));
  return fmt::format("there is no option {}{}", option, suggestion(name, option_names(command), "--"));
}

std::string explain_word(const std::string& word) {
  const bool number = word.find_first_of("0123456789") != std::string::npos &&
                      word.find_first_not_of("+-.,0123456789eE") == std::string::npos;
  return number ? fmt::format("'{}' stands alone; a point is one word with commas and no blanks, as in 1,0,0", word)
                : fmt::format("'{}' is not expected here; put a formula or a name with blanks into quotes", word);
}

}  // namespace

std::string explain_command(const CLI::App& app, const std::vector<std::string>& arguments) {
  if (!arguments.empty() && arguments.front().starts_with("-")) return "";
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (!arguments.empty() && std::ranges::count(names, arguments.front()) > 0) return "";
  const std::string meant = arguments.empty() ? "" : suggestion(arguments.front(), names);
  if (!meant.empty()) return fmt::format("there is no command '{}'{}", arguments.front(), meant);
  const std::string problem =
      arguments.empty() ? "give a command" : fmt::format("there is no command '{}'", arguments.front());
  return fmt::format("{}; the commands are {}", problem, fmt::join(names, ", "));
}

std::string explain(const CLI::ParseError& error, const CLI::App& command) {
  const std::vector<std::string> extras = command.remaining();
  // CLI11 may complain of something else first that only follows from a mistyped option.
  for (const std::string& extra : extras) {
    if (extra.starts_with("-")) return explain_option(extra, command);
  }
  if (!extras.empty()) return explain_word(extras.front());
  const std::string text = error.what();
  const std::string name = text.substr(0, text.find_first_of(": "));
  const CLI::Option* option = command.get_option_no_throw(name);
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) return fmt::format("give {}", name);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr && option != nullptr) {
    if (option->get_expected_max() == 0) return fmt::format("{} takes no value", name);
    return option->results().size() > 1 ? fmt::format("{} is given more than once", name)
                                        : fmt::format("{} needs a value behind it", name);
  }
  return text;
}

}  // namespace taut::app
