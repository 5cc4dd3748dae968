// The taut program: reads the command line, runs one command, maps what went wrong to an exit code and one line.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "checks.hpp"
#include "command_line_errors.hpp"
#include "commands.hpp"
#include "examples.hpp"
#include "help_format.hpp"
#include "points_argument.hpp"
#include "taut/core/context.hpp"
#include "taut/core/error.hpp"

namespace taut::app {
namespace {

constexpr const char* kDescription =
    "Taut pulls a string taut over a surface F(x) = 0: exact geodesics on surfaces given by a formula "
    "or by a point cloud.";
constexpr const char* kFooter =
    "Examples:\n"
    "  taut path 'x^2+y^2+4z^2=1' --from 1,0,0 --to 0,0,0.5\n"
    "  taut path scan.ply --from @120 --to @2411 --out page.html\n"
    "  taut field 'x^4+y^4+z^4=1' --from 1,0,0 --out field.ply\n"
    "  taut exp 'x^2+y^2+4z^2=1' --from 1,0,0 --dir 0,1,1 --length 2\n"
    "Exit codes: 0 done, 1 some lines of a batch failed, 2 wrong usage, 3 bad input,\n"
    "4 no path, 5 not converged, 70 internal error, 130 interrupted.\n"
    "'taut COMMAND --help' tells more.";

/// "--from -1,0,0" and a formula such as "-x^2+1" start like options; make them unmistakable.
std::vector<std::string> shield_negatives(int argc, char** argv) {
  std::vector<std::string> arguments;
  const auto negative = [](const std::string& text) {
    return text.size() > 1 && text[0] == '-' &&
           (std::isdigit(static_cast<unsigned char>(text[1])) != 0 || text[1] == '.');
  };
  const auto short_option = [](const std::string& text) { return text == "-h" || text == "-o" || text == "-q"; };
  for (int i = 1; i < argc; ++i) {
    std::string text = argv[i];
    if (negative(text) && !arguments.empty() && arguments.back().starts_with("--") &&
        arguments.back().find('=') == std::string::npos) {
      arguments.back() += "=" + text;
    } else if (i == 2 && text.size() > 1 && text[0] == '-' && text[1] != '-' && !short_option(text)) {
      arguments.push_back(" " + text);
    } else {
      arguments.push_back(std::move(text));
    }
  }
  return arguments;
}

ExitCode fail(ExitCode code, const std::string& message) {
  print_error(message);
  return code;
}

ExitCode guarded(const Run& run) {
  try {
    const ExitCode code = run();
    clear_progress();
    if (!std::cout.flush()) return fail(kBadInput, "stdout cannot be written to the end; make room or write elsewhere");
    return code;
  } catch (const UsageError& e) {
    return fail(kWrongUsage, e.what());
  } catch (const Cancelled&) {
    return fail(kInterrupted, "interrupted");
  } catch (const Error& e) {
    return fail(kBadInput, e.what());
  } catch (const std::bad_alloc&) {
    return fail(kBadInput, "out of memory: try larger cells (--cell) or fewer samples");
  } catch (const std::exception& e) {
    return fail(kInternalError, std::string("internal error, please report it with the command line: ") + e.what());
  }
}

/// "help" and "help path" as the options they stand for.
void translate_help(std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front() != "help") return;
  arguments.erase(arguments.begin());
  if (arguments.size() > 1) arguments.resize(1);
  arguments.emplace_back("--help");
}

int run_program(int argc, char** argv) {
  CLI::App app{kDescription, "taut"};
  app.footer(kFooter);
  app.formatter(std::make_shared<HelpFormat>());
  app.set_version_flag("-V,--version", "taut " TAUT_VERSION);
  app.require_subcommand(1);
  app.fallthrough(false);

  std::vector<std::pair<CLI::App*, Run>> commands;
  for (const auto add : {add_path_command, add_field_command, add_exp_command, add_log_command, add_transport_command,
                         add_matrix_command, add_sample_command, add_voronoi_command, add_mean_command,
                         add_curve_command, add_fit_command, add_mesh_command, add_info_command, add_paper_command}) {
    Run run = add(app);
    commands.emplace_back(app.get_subcommands(nullptr).back(), std::move(run));
    commands.back().first->footer(examples_of(commands.back().first->get_name()));
  }

  std::vector<std::string> arguments = shield_negatives(argc, argv);
  translate_help(arguments);
  if (const std::string problem = explain_command(app, arguments); !problem.empty()) {
    return fail(kWrongUsage, problem + " (see taut --help)");
  }
  std::reverse(arguments.begin(), arguments.end());  // the order CLI11 wants
  try {
    app.parse(std::move(arguments));
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();  // of the command that was chosen, if one was
    return kDone;
  } catch (const CLI::Success& e) {
    std::cout << e.what() << "\n";
    return kDone;
  } catch (const CLI::ParseError& e) {
    const auto chosen = app.get_subcommands();
    const std::string help = chosen.empty() ? "taut --help" : "taut " + chosen.front()->get_name() + " --help";
    return fail(kWrongUsage, fmt::format("{} (see {})", explain(e, chosen.empty() ? app : *chosen.front()), help));
  }
  for (const auto& [command, run] : commands) {
    if (command->parsed()) return guarded(run);
  }
  return kWrongUsage;
}

}  // namespace

void CommonArguments::add_to(CLI::App& command) {
  const OptionGroup group(command, "How it runs");
  command.add_option("--threads", terminal.threads, "threads; 0 = all cores (never changes a result)")
      ->check(whole_number(0, 4096));
  command.add_flag("-q,--quiet", terminal.quiet, "no notes and no progress on stderr");
  command.add_flag("--progress", terminal.progress, "progress lines even when stderr is no terminal");
}

}  // namespace taut::app

int main(int argc, char** argv) {
  const std::jthread starting = taut::start_threads();
  return taut::app::run_program(argc, argv);
}
