#include "output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "help_format.hpp"
#include "load_surface.hpp"
#include "path_lines.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/output_file.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/view/write_scene.hpp"

namespace taut::app {
namespace {

constexpr const char* kJson = ".json";
constexpr std::array kPathOutputs = {kJson,  ".csv", ".npy",  ".ply", ".obj", ".vtp",
                                     ".glb", ".dxf", ".html", ".svg", ".png"};
constexpr std::array kMeshOutputs = {".ply", ".obj", ".off", ".stl", ".vtp", ".glb", ".html", ".svg", ".png"};
/// Ends of so many paths are marked by dots; of more they only clutter the picture.
constexpr std::size_t kMostEndsMarked = 200;
constexpr double kDotSize = 0.55;
constexpr Colour kMarchedColour = Colour::hex(0xD7301F);    // the paper's figures: red on the cells,
constexpr Colour kCorrectedColour = Colour::hex(0x1F5FBF);  // blue on the surface
constexpr std::size_t kLongestTitle = 120;

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

/// Polylines as thin lines.
SceneLines scene_lines(const Polylines& lines, std::string name) {
  SceneLines result{.vertices = Points(3, lines.num_points()), .segments = {}, .name = std::move(name)};
  result.segments.resize(2, lines.num_points() - static_cast<Index>(lines.lines.size()));
  Index vertex = 0;
  Index segment = 0;
  for (const Points& line : lines.lines) {
    result.vertices.middleCols(vertex, line.cols()) = line;
    for (Index i = 0; i + 1 < line.cols(); ++i) {
      result.segments.col(segment++) << static_cast<int>(vertex + i), static_cast<int>(vertex + i + 1);
    }
    vertex += line.cols();
  }
  return result;
}

void add_edges(Scene& scene, const Polylines& edges) {
  if (!edges.lines.empty()) scene.lines.push_back(scene_lines(edges, "edges"));
}

/// Builds what a picture of paths shows.
class PathScene {
 public:
  PathScene(const PathOutput& output, const FileArguments& files) : output_(output) {
    scene_.title = output.title;
    scene_.facts = output.facts;
    scene_.up = files.up;
    scene_.towards_viewer = files.towards_viewer();
    for (const SourcePaths& source : output.sources) num_paths_ += source.paths.size();
  }

  Scene build(const Context& context) {
    add_surface(context);
    for (std::size_t s = 0; s < output_.sources.size(); ++s) {
      for (const PathResult* path : output_.sources[s].paths) add_path(*path, s);
    }
    add_ends();
    if (output_.show.cells && !add_cells()) context.tell("no cells are shown: the paths were found without any");
    scene_.points.insert(scene_.points.end(), output_.marks.begin(), output_.marks.end());
    return std::move(scene_);
  }

 private:
  /// A surface that cannot be meshed is left out.
  void add_surface(const Context& context) {
    if (output_.show.field) {
      if (output_.surface.dim() != 3 || output_.surface.codim() != 1) {
        throw InvalidArgument("--field colours surfaces in 3 dimensions with one equation");
      }
      FieldResult field = marched_field(output_.surface, source_points(), output_.field, context);
      add_edges(scene_, field.mesh.edges);
      const std::string distance = field.mesh.scalars.front().name;
      scene_.meshes.push_back({.mesh = std::move(field.mesh), .coloured_by = distance});
    } else if (output_.surface.dim() == 3 && output_.surface.codim() == 1) {
      SurfaceMesh mesh = display_mesh(output_.surface, {.exact = false, .near = ends(), .part_faces = true}, context);
      add_edges(scene_, mesh.edges);
      scene_.meshes.push_back({.mesh = std::move(mesh)});
    } else if (output_.surface.dim() == 2 && output_.surface.codim() == 1) {
      const CurveMesh curve = display_curve(output_.surface, {.exact = false, .near = ends()}, context);
      scene_.lines.push_back({.vertices = curve.vertices, .segments = curve.segments, .name = "F = 0"});
    }
  }

  void add_path(const PathResult& path, std::size_t source) {
    const bool failed = path.status != Status::ok;
    const bool marched = output_.show.marched && path.grid_path.cols() > 1 && path.corrected;
    const bool single = num_paths_ == 1;
    if (marched) {
      scene_.paths.push_back({.points = path.grid_path,
                              .label = single ? "marched path" : "marched paths",
                              .colour = single ? kMarchedColour : Colour::hex(0x5B6B7C),
                              .width = single ? 0.8 : 0.5});
    }
    ScenePath drawn{
        .points = path.points, .label = output_.sources[source].name, .length = path.length, .failed = failed};
    if (!failed && marched && single) {
      drawn.label = "corrected path";
      drawn.colour = kCorrectedColour;
    } else if (failed) {
      drawn.label = std::string(to_string(path.status));
      std::ranges::replace(drawn.label, '_', ' ');
    } else if (!single) {
      drawn.colour = path_colour(source);
    }
    scene_.paths.push_back(std::move(drawn));
    if (!single) return;
    for (std::size_t i = 1; i < path.candidates.size() && (output_.all_ways || path.tied); ++i) {
      const PathCandidate& other = path.candidates[i];
      if (other.points.cols() < 2) continue;
      scene_.paths.push_back(
          {.points = other.points, .label = "another way", .colour = path_colour(i), .length = other.length});
    }
  }

  void add_ends() {
    if (num_paths_ == 1) {
      const PathResult& path = *only_path();
      const bool closed = path.from.size() == path.to.size() && path.from == path.to;
      scene_.points.push_back({.position = path.from, .label = closed ? "start" : "from"});
      if (!closed) scene_.points.push_back({.position = path.to, .label = output_.end_name});
      return;
    }
    for (std::size_t s = 0; s < output_.sources.size(); ++s) {
      const SourcePaths& source = output_.sources[s];
      if (source.paths.empty()) continue;
      scene_.points.push_back({.position = source.paths.front()->from, .size = 1.6});
      if (num_paths_ > kMostEndsMarked) continue;
      for (const PathResult* path : source.paths) {
        if (path->to.size() > 0)
          scene_.points.push_back({.position = path->to, .colour = path_colour(s), .size = kDotSize});
      }
    }
  }

  [[nodiscard]] Points source_points() const {
    Points points(output_.surface.dim(), 0);
    for (const SourcePaths& source : output_.sources) {
      if (source.paths.empty()) continue;
      points.conservativeResize(Eigen::NoChange, points.cols() + 1);
      points.rightCols(1) = source.paths.front()->from;
    }
    return points;
  }

  [[nodiscard]] const PathResult* only_path() const {
    for (const SourcePaths& source : output_.sources) {
      if (!source.paths.empty()) return source.paths.front();
    }
    return nullptr;
  }

  /// Those that a march has come to, of all paths that were found on cells of the first one's size. False: there are
  /// none.
  bool add_cells() {
    SceneCells cells{.centres = {}, .label = "cells walked"};
    std::set<std::vector<double>> centres;
    for (const SourcePaths& source : output_.sources) {
      for (const PathResult* path : source.paths) {
        if (cells.size == 0) cells.size = path->cell;
        if (path->cell != cells.size) continue;
        for (const auto& centre : path->walked_cells.colwise()) centres.emplace(centre.begin(), centre.end());
      }
    }
    if (centres.empty()) return false;
    cells.centres.resize(output_.surface.dim(), static_cast<Index>(centres.size()));
    Index j = 0;
    for (const std::vector<double>& centre : centres) {
      cells.centres.col(j++) = Eigen::Map<const Vector>(centre.data(), static_cast<Index>(centre.size()));
    }
    scene_.cells = std::move(cells);
    return true;
  }

  /// Of all paths.
  [[nodiscard]] Points ends() const {
    Points points(output_.surface.dim(), 0);
    for (const SourcePaths& source : output_.sources) {
      for (const PathResult* path : source.paths) {
        points.conservativeResize(Eigen::NoChange, points.cols() + 2);
        points.rightCols(2) << path->from, path->to;
      }
    }
    return points;
  }

  const PathOutput& output_;
  Scene scene_;
  std::size_t num_paths_ = 0;
};

}  // namespace

CLI::Option* FileArguments::add_to(CLI::App& command, OutputKind kind, const std::string& what) {
  const OptionGroup group(command, "Output");
  command
      .add_option_function<std::string>(
          "--up",
          [this](const std::string& axis) {
            up = Eigen::Vector3d::Unit(axis.back() - 'x') * (axis.size() > 1 ? -1 : 1);
          },
          "axis that points up in pictures: x, y, z, -x, -y or -z (default z)")
      ->check(CLI::IsMember({"x", "y", "z", "-x", "-y", "-z"}));
  command.add_option("--view", view,
                     "AZIMUTH,ELEVATION in degrees to look from in pictures (default: chosen): 0,0 is from +x, 90,0 "
                     "from +y, 0,90 from above");
  return command
      .add_option("-o,--out", out, fmt::format("{} to FILE, by extension (repeatable): {}", what, known_outputs(kind)))
      ->allow_extra_args(false);
}

void FileArguments::check(OutputKind kind) const {
  for (const std::string& file : out) {
    const std::string extension = extension_of(file);
    const bool known = kind == OutputKind::path ? std::ranges::count(kPathOutputs, extension) > 0
                                                : std::ranges::count(kMeshOutputs, extension) > 0;
    if (!known) throw UsageError(fmt::format("--out {}: write one of {}", file, known_outputs(kind)));
    // Two files in one word: nobody wants the second as part of the first one's name.
    const std::string first = file.substr(0, file.find(','));
    if (first.size() < file.size() && !std::filesystem::path(first).extension().empty()) {
      throw UsageError(fmt::format("--out {}: one file a time; repeat it: --out {} --out {}", file, first,
                                   file.substr(first.size() + 1)));
    }
    const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
    std::error_code ignored;
    if (!std::filesystem::is_directory(folder, ignored)) {
      throw IoError(file, "its folder does not exist; create it first");
    }
    if (std::filesystem::is_directory(file, ignored)) throw IoError(file, "is a folder; name a file");
  }
  (void)towards_viewer();
  if (!view.empty() && !has_picture()) {
    throw UsageError("--view is for pictures: give --out FILE.html, .svg or .png, too");
  }
}

bool FileArguments::has_picture() const {
  return std::ranges::any_of(out, [](const std::string& file) { return is_picture(extension_of(file)); });
}

Eigen::Vector3d FileArguments::towards_viewer() const {
  if (view.empty()) return Eigen::Vector3d::Zero();
  const Vector angles = parse_numbers(view, "--view");
  if (angles.size() != 2 || !angles.allFinite() || std::abs(angles(1)) > 90) {
    throw UsageError(fmt::format(
        "--view {}: give azimuth,elevation in degrees, the elevation from -90 to 90, as in --view -60,24", view));
  }
  return view_direction(angles(0), angles(1), up);
}

void PathShow::add_to(CLI::App& command) {
  const OptionGroup group(command, "Output");
  command
      .add_option_function<std::vector<std::string>>(
          "--show",
          [this](const std::vector<std::string>& what) {
            cells = std::ranges::count(what, "cells") > 0;
            marched = std::ranges::count(what, "marched") > 0;
          },
          "in pictures, too: cells (those that were walked), marched (the path on them before its correction)")
      ->delimiter(',')
      ->check(CLI::IsMember({"cells", "marched"}));
  command.add_flag("--field", field, "in pictures colour the surface by the marched distance from --from");
}

void PathShow::check(const FileArguments& files) const {
  if (!(cells || marched || field) || files.has_picture()) return;
  throw UsageError(
      fmt::format("{} is for pictures: give --out FILE.html, .svg or .png, too", field ? "--field" : "--show"));
}

void write_paths(const FileArguments& files, const PathOutput& output, const Context& context) {
  std::optional<Scene> scene;
  for (const std::string& file : files.out) {
    const std::string extension = extension_of(file);
    if (is_picture(extension)) {
      if (!scene) scene = PathScene(output, files).build(context);
      write_picture(file, extension, *scene);
    } else if (extension != kJson) {
      std::vector<const PathResult*> paths;
      for (const SourcePaths& source : output.sources) {
        paths.insert(paths.end(), source.paths.begin(), source.paths.end());
      }
      const PathLines drawn = path_lines(output.surface, paths, output.evenly_spaced);
      write_polylines(file, drawn.lines, drawn.normals);
    }
  }
}

void write_json_files(const FileArguments& files, const nlohmann::ordered_json& json) {
  for (const std::string& file : files.out) {
    if (extension_of(file) == kJson) write_text(file, json.dump(1) + "\n");
  }
}

FieldOptions field_options(const PathOptions& options) {
  return {.march = options.march, .grid = options.grid, .cell = options.cell};
}

std::string picture_title(const std::string& surface) {
  const std::string name = surface.starts_with('@') ? surface.substr(1) : surface;  // @FILE holds a formula
  std::string title =
      name == surface && !names_a_file(surface) ? surface : std::filesystem::path(name).filename().string();
  if (title.size() > kLongestTitle) title = title.substr(0, kLongestTitle) + "...";
  return title;
}

void write_mesh_files(const FileArguments& files, const MeshOutput& output) {
  constexpr Index kMostLabels = 12;  // more than so many marks are shown without words
  std::optional<Scene> scene;
  for (const std::string& file : files.out) {
    const std::string extension = extension_of(file);
    if (!is_picture(extension)) {
      if (output.isolines) {
        write_polylines(file, *output.isolines);
      } else {
        write_mesh(file, output.mesh);
      }
      continue;
    }
    if (!scene) {
      scene.emplace();
      scene->title = output.title;
      scene->facts = output.facts;
      scene->up = files.up;
      scene->towards_viewer = files.towards_viewer();
      const std::string coloured_by = output.mesh.scalars.empty() ? "" : output.mesh.scalars.front().name;
      scene->meshes.push_back({.mesh = output.mesh, .coloured_by = coloured_by});
      if (output.isolines) scene->lines.push_back(scene_lines(*output.isolines, "isolines"));
      add_edges(*scene, output.edges);
      for (const Points& curve : output.curves) scene->paths.push_back({.points = curve, .label = {}});
      const bool few = output.marks.cols() <= kMostLabels;
      for (Index j = 0; j < output.marks.cols(); ++j) {
        scene->points.push_back({.position = output.marks.col(j), .label = few ? output.mark_name : ""});
      }
    }
    write_picture(file, extension, *scene);
  }
}

}  // namespace taut::app
