// taut fit: a point cloud becomes a surface file that the other commands read at once.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "checks.hpp"
#include "commands.hpp"
#include "load_surface.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/io/read_surface.hpp"

namespace taut::app {
namespace {

struct FitArguments {
  CommonArguments common;
  std::string cloud;
  std::optional<Index> dim;
  FitOptions options;
  std::string out;
};

std::vector<SceneFact> kind_facts(const RbfModel& model) {
  const RbfReport& report = model.report;
  std::vector<SceneFact> facts = {
      {"kind", fmt::format("dense: one system of {} centres", grouped(model.centres.cols()))},
      {"samples", fmt::format("{}, {} of them fitted {:.3g} apart", grouped(model.samples.size()),
                              grouped(report.num_fitted), report.spacing)},
      {"noise", fmt::format("{:.2e}, smoothing length {:.3g}", report.noise, report.smoothing)}};
  if (report.num_fitted < report.num_samples) {
    facts.push_back({"left out", fmt::format("samples lie {:.2e} (rms), {:.2e} (most) off the surface",
                                             report.left_out_rms, report.left_out_max)});
  }
  facts.push_back({"ends", model.support_radius > 0 ? fmt::format("{:.3g} from the samples", model.support_radius)
                                                    : std::string("nowhere: the surface is closed")});
  return facts;
}

std::vector<SceneFact> kind_facts(const LocalFitModel& model) {
  const LocalFitReport& report = model.report;
  return {
      {"kind",
       fmt::format("local: {} patches of some {} samples", grouped(model.radii.size()), report.samples_per_patch)},
      {"samples", fmt::format("{}, {:.3g} apart", grouped(model.samples.size()), report.spacing)},
      {"noise", fmt::format("{:.2e}", report.noise)},
      {"ends", fmt::format("{:.3g} to {:.3g} from the samples", model.support.minCoeff(), model.support.maxCoeff())}};
}

ExitCode run(const FitArguments& arguments) {
  if (!arguments.out.ends_with(".taut")) {
    throw UsageError("--out " + arguments.out + ": a model file ends in .taut");
  }
  const Context context = terminal_context(arguments.common.terminal);
  const FitModel model = fit_file(arguments.cloud, arguments.options, context, arguments.dim);
  write_model(arguments.out, model);
  clear_progress();
  std::visit(
      [](const auto& kind) {
        std::vector<SceneFact> facts = kind_facts(kind);
        facts.push_back(
            {"residual", fmt::format("the surface stands {:.2e} (rms) off the samples, {:.2e} (most) at @{}",
                                     kind.report.residual_rms, kind.report.residual_max, kind.report.residual_at)});
        std::cout << facts_text(facts);
      },
      model);
  return kDone;
}

}  // namespace

Run add_fit_command(CLI::App& app) {
  auto arguments = std::make_shared<FitArguments>();
  CLI::App& command = *app.add_subcommand("fit", "fit a surface to a point cloud and keep it in a file");
  command
      .add_option("CLOUD", arguments->cloud,
                  fmt::format("points or a mesh: {}, or one of them as .gz", fmt::join(point_cloud_extensions(), " ")))
      ->required();
  command.add_option("-o,--out", arguments->out, "the model, a .taut file")->required();
  command.add_option("--dim", arguments->dim, "how many columns of a table without a header are coordinates")
      ->check(whole_number(2, 65535));
  add_fit_options(command, arguments->options);
  arguments->common.add_to(command);
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
