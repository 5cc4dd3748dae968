#include "output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <optional>

#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/view/write_html.hpp"
#include "taut/view/write_picture.hpp"

namespace taut::app {
namespace {

constexpr std::array kPathOutputs = {".json", ".csv", ".npy", ".ply", ".obj", ".vtp", ".html", ".svg", ".png"};
constexpr std::array kMeshOutputs = {".ply", ".obj", ".off", ".stl", ".vtp", ".html", ".svg", ".png"};
/// Cells drawn around a path: more than these only hide the surface.
constexpr Index kMostCellsDrawn = 50000;

std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension;
}

void write_picture(const std::string& file, const std::string& extension, const Scene& scene) {
  if (extension == ".html") write_html(file, scene);
  if (extension == ".svg") write_svg(file, scene);
  if (extension == ".png") write_png(file, scene);
}

bool is_picture(const std::string& extension) {
  return extension == ".html" || extension == ".svg" || extension == ".png";
}

/// ".json .csv ...": the extensions that can hold this kind.
std::string known_outputs(OutputKind kind) {
  return kind == OutputKind::path ? fmt::format("{}", fmt::join(kPathOutputs, " "))
                                  : fmt::format("{}", fmt::join(kMeshOutputs, " "));
}

/// The surface, the cells that were walked and the paths. A surface that cannot be meshed is left out.
Scene path_scene(const PathOutput& output, const Eigen::Vector3d& up, const Context& context) {
  Scene scene;
  scene.title = output.title;
  scene.facts = output.facts;
  scene.up = up;
  const bool single = output.paths.size() == 1;
  for (const PathResult* path : output.paths) {
    scene.paths.push_back({.points = path->points, .label = "geodesic", .length = path->length});
    if (single) {
      scene.points.push_back({.position = path->from, .label = "from"});
      scene.points.push_back({.position = path->to, .label = "to"});
    }
  }
  if (!single && !output.paths.empty())
    scene.points.push_back({.position = output.paths.front()->from, .label = "from"});
  if (output.surface.dim() == 3 && output.surface.codim() == 1) {
    SurfaceMesh mesh = display_mesh(output.surface, {}, context);
    scene.meshes.push_back({.mesh = std::move(mesh)});
  }
  const double cell = output.paths.empty() ? 0 : output.paths.front()->cell;
  if (output.surface.dim() <= 3 && cell > 0 && output.paths.front()->num_cells <= kMostCellsDrawn) {
    Points centres = display_cells(output.surface, {.cell = cell}, context);
    if (centres.cols() <= kMostCellsDrawn) scene.cells = {.centres = std::move(centres), .size = cell};
  }
  return scene;
}

}  // namespace

CLI::Option* FileArguments::add_to(CLI::App& command, OutputKind kind, const std::string& what) {
  command
      .add_option_function<std::string>(
          "--up", [this](const std::string& axis) { up = Eigen::Vector3d::Unit(axis[0] - 'x'); },
          "axis that points up in pictures: x, y or z (default z)")
      ->check(CLI::IsMember({"x", "y", "z"}));
  return command
      .add_option("--out", out, fmt::format("{} to FILE, by extension (repeatable): {}", what, known_outputs(kind)))
      ->allow_extra_args(false);
}

void FileArguments::check(OutputKind kind) const {
  for (const std::string& file : out) {
    const std::string extension = extension_of(file);
    const bool known = kind == OutputKind::path ? std::ranges::count(kPathOutputs, extension) > 0
                                                : std::ranges::count(kMeshOutputs, extension) > 0;
    if (!known) throw UsageError(fmt::format("--out {}: write one of {}", file, known_outputs(kind)));
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) {
      throw IoError(file, "its folder does not exist; create it first");
    }
    if (std::filesystem::is_directory(file, ignored)) throw IoError(file, "is a folder; name a file");
  }
}

void write_paths(const FileArguments& files, const PathOutput& output, const Context& context) {
  std::optional<Scene> scene;
  for (const std::string& file : files.out) {
    const std::string extension = extension_of(file);
    if (is_picture(extension)) {
      if (!scene) scene = path_scene(output, files.up, context);
      write_picture(file, extension, *scene);
      continue;
    }
    if (extension == ".json") {
      write_text(file, output.json.dump(1) + "\n");
      continue;
    }
    Polylines lines;
    for (const PathResult* path : output.paths) lines.lines.push_back(path->points);
    write_polylines(file, lines);
  }
}

void write_mesh_files(const FileArguments& files, const MeshOutput& output) {
  std::optional<Scene> scene;
  for (const std::string& file : files.out) {
    const std::string extension = extension_of(file);
    if (!is_picture(extension)) {
      write_mesh(file, output.mesh);
      continue;
    }
    if (!scene) {
      scene.emplace();
      scene->title = output.title;
      scene->facts = output.facts;
      scene->up = files.up;
      const std::string coloured_by = output.mesh.scalars.empty() ? "" : output.mesh.scalars.front().name;
      scene->meshes.push_back({.mesh = output.mesh, .coloured_by = coloured_by});
      for (Index j = 0; j < output.marks.cols(); ++j) {
        scene->points.push_back({.position = output.marks.col(j), .label = "source"});
      }
    }
    write_picture(file, extension, *scene);
  }
}

}  // namespace taut::app
