#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/mesh.hpp"
#include "taut/query/field.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

/// What a file is to hold.
enum class OutputKind { path, mesh };

/// --out, --up and --view: the files to write, and from where pictures look.
struct FileArguments {
  std::vector<std::string> out;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::string view;  ///< azimuth,elevation; empty = chosen
  /// `what` is written, for --help. Returns --out.
  CLI::Option* add_to(CLI::App& command, OutputKind kind, const std::string& what);
  /// Throws UsageError when a file's extension cannot hold the kind or the view is none, IoError when a file's folder
  /// is not there: said before any work is done.
  void check(OutputKind kind) const;
  [[nodiscard]] bool has_picture() const;
  [[nodiscard]] Eigen::Vector3d towards_viewer() const;  ///< zero = to be chosen
};

/// --show and --field: what pictures of paths show beside them.
struct PathShow {
  bool cells = false;    ///< the cells that were walked
  bool marched = false;  ///< the polylines on the cells that the paths were corrected from
  bool field = false;    ///< the surface coloured by the distance from the nearest source
  void add_to(CLI::App& command);
  /// Throws UsageError where there is no picture to show it in.
  void check(const FileArguments& files) const;
};

/// Paths that begin in one point and share a colour.
struct SourcePaths {
  std::string name;  ///< for the legend
  std::vector<const PathResult*> paths;
};

struct PathOutput {
  const Surface& surface;
  std::vector<SourcePaths> sources;
  nlohmann::ordered_json json;
  std::vector<SceneFact> facts;  ///< for people, shown beside pictures
  std::string title;
  PathShow show = {};
  FieldOptions field = {};             ///< how distances are marched for `show.field`
  bool all_ways = false;               ///< show every other candidate of a single path, not only one as short
  std::string end_name = "to";         ///< what a single path's end is called
  std::vector<ScenePoint> marks = {};  ///< more points to show
  Index evenly_spaced = 0;             ///< in files of points: so many points a path at equal arc lengths; 0 = its own
};

/// A field marched as the paths were.
[[nodiscard]] FieldOptions field_options(const PathOptions& options);

/// Writes the paths to each file but .json ones, by extension. Several sources one after the other.
void write_paths(const FileArguments& files, const PathOutput& output, const Context& context);

/// Writes the JSON to each .json file.
void write_json_files(const FileArguments& files, const nlohmann::ordered_json& json);

/// What a picture of this surface is called: a file's name, or the formula.
[[nodiscard]] std::string picture_title(const std::string& surface);

struct MeshOutput {
  const Surface& surface;
  const TriangleMesh& mesh;
  std::optional<Polylines> isolines = {};  ///< drawn on the mesh in pictures; other files hold them instead of it
  Polylines edges = {};                    ///< sharp edges and borders, drawn as thin lines
  Points marks;                            ///< 3 x m: points to show, such as the sources of a field
  std::string mark_name = "source";
  std::vector<Points> curves = {};  ///< each 3 x n: drawn thick in pictures, as paths are
  std::vector<SceneFact> facts;
  std::string title;
};

/// Writes the mesh, with its vertex scalars where the format has room for them, or its isolines, to each file, by
/// extension.
void write_mesh_files(const FileArguments& files, const MeshOutput& output);

}  // namespace taut::app
