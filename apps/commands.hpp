#pragma once

#include <CLI/App.hpp>
#include <functional>

#include "exit_code.hpp"
#include "taut/core/context.hpp"
#include "terminal.hpp"

namespace taut::app {

/// What a command does once its options are read.
using Run = std::function<ExitCode()>;

/// Options every command has.
struct CommonArguments {
  TerminalOptions terminal;
  void add_to(CLI::App& command);
};

// Each declares one command with its options and returns what runs it.
Run add_path_command(CLI::App& app);
Run add_field_command(CLI::App& app);
Run add_exp_command(CLI::App& app);
Run add_log_command(CLI::App& app);
Run add_transport_command(CLI::App& app);
Run add_matrix_command(CLI::App& app);
Run add_sample_command(CLI::App& app);
Run add_voronoi_command(CLI::App& app);
Run add_mean_command(CLI::App& app);
Run add_curve_command(CLI::App& app);
Run add_fit_command(CLI::App& app);
Run add_mesh_command(CLI::App& app);
Run add_info_command(CLI::App& app);
Run add_paper_command(CLI::App& app);

}  // namespace taut::app
