// taut mesh: the surface as triangles, for pictures and for other programs.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>

#include "cell_arguments.hpp"
#include "commands.hpp"
#include "input_files.hpp"
#include "load_surface.hpp"
#include "output.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/query/surface_mesh.hpp"

namespace taut::app {
namespace {

struct MeshArguments {
  CommonArguments common;
  SurfaceArguments surface;
  DisplayMeshOptions options;
  FileArguments files;
};

ExitCode run(const MeshArguments& arguments) {
  refuse_to_overwrite({arguments.surface.surface}, arguments.files.out);
  arguments.files.check(OutputKind::mesh);
  const Context context = terminal_context(arguments.common.terminal);
  const Surface surface = load_surface(arguments.surface, context);
  DisplayMeshOptions options = arguments.options;
  options.seeds = read_seeds(arguments.surface, surface, options.grid, context);
  const auto& files = arguments.files.out;
  options.part_faces = std::ranges::all_of(
      files, [](const std::string& file) { return FileArguments{.out = {file}, .view = {}}.has_picture(); });
  const SurfaceMesh mesh = display_mesh(surface, options, context);
  clear_progress();
  const std::vector<SceneFact> facts = {{"vertices", grouped(mesh.vertices.cols())},
                                        {"triangles", grouped(mesh.faces.cols())}};
  write_mesh_files(arguments.files, {.surface = surface,
                                     .mesh = mesh,
                                     .edges = mesh.edges,
                                     .marks = {},
                                     .facts = facts,
                                     .title = picture_title(arguments.surface.surface)});
  std::cout << facts_text(facts);
  return kDone;
}

}  // namespace

Run add_mesh_command(CLI::App& app) {
  auto arguments = std::make_shared<MeshArguments>();
  CLI::App& command = *app.add_subcommand("mesh", "triangles on the surface, every vertex exact");
  arguments->surface.add_to(command);
  add_cell_options(command, arguments->options.cell, arguments->options.grid);
  command
      .add_option("--component", arguments->options.component,
                  "one connected piece alone: 1 the largest, 2 the next (default: all)")
      ->check(CLI::Range(1, 1'000'000));
  arguments->files.add_to(command, OutputKind::mesh, "write")->required();
  arguments->common.add_to(command);
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
