#include "help_format.hpp"

#include <cstddef>
#include <sstream>

namespace taut::app {
namespace {

/// A terminal's usual width; where descriptions begin; what is left for them.
constexpr std::size_t kColumns = 80;
constexpr std::size_t kIndent = 26;
constexpr std::size_t kSpan = kColumns - kIndent;

/// Words of a text in lines of at most `span` columns, each after the first led by `indent` spaces. A word that is
/// longer stands alone.
std::string wrapped(const std::string& text, std::size_t span, std::size_t indent) {
  std::istringstream words(text);
  std::string lines;
  std::size_t column = 0;
  for (std::string word; words >> word;) {
    if (column > 0 && column + 1 + word.size() > span) {
      lines += "\n" + std::string(indent, ' ');
      column = 0;
    }
    if (column > 0) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines;
}

std::string entry(const std::string& name, const std::string& description) {
  std::string text = "  " + name;
  if (text.size() + 2 > kIndent) {
    text += "\n" + std::string(kIndent, ' ');
  } else {
    text.resize(kIndent, ' ');
  }
  return text + wrapped(description, kSpan, kIndent) + "\n";
}

}  // namespace

std::string HelpFormat::make_description(const CLI::App* app) const {
  const std::string& description = app->get_description();
  return description.empty() ? "" : wrapped(description, kColumns, 0) + "\n";
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  return entry(command->get_display_name(true), command->get_description());
}

}  // namespace taut::app
