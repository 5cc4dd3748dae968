#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace taut::app {

/// Help in at most 80 columns: an option's name and value, and what it does on the same line if both fit, else below
/// it.
class HelpFormat : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
};

/// Options that are added to a command while this lives stand in one group of its help.
class OptionGroup {
 public:
  OptionGroup(CLI::App& command, const std::string& name)
      : command_(command), before_(command.option_defaults()->get_group()) {
    command_.option_defaults()->group(name);
  }
  ~OptionGroup() { command_.option_defaults()->group(before_); }
  OptionGroup(const OptionGroup&) = delete;
  OptionGroup& operator=(const OptionGroup&) = delete;

 private:
  CLI::App& command_;
  std::string before_;
};

}  // namespace taut::app
