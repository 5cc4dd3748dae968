// taut paper: the figures, the table and the appendices of the paper Taut grew out of, measured.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "paper/parts.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"

namespace taut::app {
namespace {

struct PaperArguments {
  CommonArguments common;
  std::vector<std::string> parts = {"all"};
  std::string out;
  std::string data;
};

std::string part_names() {
  std::string names;
  for (const paper::Part& part : paper::parts()) names += part.name + ", ";
  return names + "all";
}

/// Those asked for, in the report's order.
std::vector<const paper::Part*> chosen_parts(const std::vector<std::string>& names) {
  const auto& all = paper::parts();
  for (const std::string& name : names) {
    if (name != "all" && std::ranges::find(all, name, &paper::Part::name) == all.end()) {
      throw UsageError(fmt::format("there is no part '{}'; the parts are {}", name, part_names()));
    }
  }
  std::vector<const paper::Part*> chosen;
  for (const paper::Part& part : all) {
    const bool wanted = std::ranges::count(names, "all") > 0 || std::ranges::count(names, part.name) > 0;
    if (wanted) chosen.push_back(&part);
  }
  return chosen;
}

/// Runs one part; what goes wrong in it is told in its section, and the others go on.
void run_part(const paper::Part& part, paper::Study& study, paper::Report& report) {
  try {
    part.run(study, report);
  } catch (const Cancelled&) {
    report.section(part.headings.front())
        .failed("Interrupted: this part is not complete, and those after it are missing.");
    throw;
  } catch (const std::exception& error) {
    print_error(fmt::format("{}: {}", part.name, error.what()));
    report.section(part.headings.front()).failed(paper::escape_markup(error.what()));
  }
}

std::string preface(const PaperArguments& arguments, double seconds, double processor_seconds) {
  return fmt::format(
      "<p>This page was written by <code>taut paper</code> (Taut {}). It goes through the paper <i>Geodesic "
      "computation "
      "on implicit surfaces</i> figure by figure, and puts what was measured beside what the paper states, in our own "
      "words. Nothing on it was typed in: every number comes from this run, which took {:.0f} s ({:.0f} s of processor "
      "time). {} Times are processor time, of all threads together. Each table and each figure lies beside this page "
      "as a file.</p>",
      TAUT_VERSION, seconds, processor_seconds,
      arguments.data.empty()
          ? "All models are made by Taut itself; <code>--data DIR</code> uses real scans where it finds them."
          : "Models are real ones where <code>" + paper::escape_markup(arguments.data) + "</code> has them.");
}

ExitCode run(const PaperArguments& arguments) {
  const std::vector<const paper::Part*> chosen = chosen_parts(arguments.parts);
  if (!arguments.data.empty() && !std::filesystem::is_directory(arguments.data)) {
    throw IoError(arguments.data, "is no folder; --data names one with models in it");
  }
  const std::filesystem::path folder = arguments.out;
  paper::prepare_report_folder(folder);

  paper::Study study{.context = terminal_context(arguments.common.terminal), .data = arguments.data};
  study.context.note = nullptr;  // the report says what was fitted to what
  paper::Report report;
  const paper::WallClock wall;
  const paper::ProcessorClock processor;
  const auto write = [&] { report.write(folder, preface(arguments, wall.seconds(), processor.seconds())); };
  std::size_t count = 0;
  try {
    for (const paper::Part* part : chosen) {
      clear_progress();
      if (!arguments.common.terminal.quiet) {
        fmt::print(stderr, "taut: {} ({} of {})\n", part->headings.front(), ++count, chosen.size());
      }
      run_part(*part, study, report);
    }
  } catch (const Cancelled&) {
    write();  // what is there by now
    throw;
  }
  write();
  clear_progress();
  std::cout << facts_text(
      {{"report", (folder / "report.html").string()}, {"took", fmt::format("{:.1f} s", wall.seconds())}});
  return report.has_failed() ? kSomeLinesFailed : kDone;
}

}  // namespace

Run add_paper_command(CLI::App& app) {
  auto arguments = std::make_shared<PaperArguments>();
  CLI::App& command = *app.add_subcommand("paper", "the figures and tables of Taut's paper, measured: a report");
  command.add_option("PART", arguments->parts, "what to measure: " + part_names())->capture_default_str();
  command.add_option("-o,--out", arguments->out, "folder for report.html, figures/ and data/; made if it is not there")
      ->required();
  command.add_option("--data", arguments->data,
                     "folder with real models: hand_gel.obj, eight_genus2.off or kitten.xyz, feline_genus2.obj, "
                     "face_libigl.ply or sven_fused.ply, looked for in its folders, too (default: Taut makes its own)");
  arguments->common.add_to(command);
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
