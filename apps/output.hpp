#pragma once

#include <CLI/App.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/mesh.hpp"
#include "taut/query/path.hpp"
#include "taut/surface/surface.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

/// What a file is to hold.
enum class OutputKind { path, mesh };

/// --out and --up: the files to write, and which axis points up in pictures.
struct FileArguments {
  std::vector<std::string> out;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  /// `what` is written, for --help. Returns --out.
  CLI::Option* add_to(CLI::App& command, OutputKind kind, const std::string& what);
  /// Throws UsageError when a file's extension cannot hold the kind, IoError when its folder is not there: said before
  /// any work is done.
  void check(OutputKind kind) const;
};

struct PathOutput {
  const Surface& surface;
  std::vector<const PathResult*> paths;
  nlohmann::ordered_json json;
  std::vector<SceneFact> facts;  ///< for people, shown beside pictures
  std::string title;
};

/// Writes the paths to each file, by extension.
void write_paths(const FileArguments& files, const PathOutput& output, const Context& context);

struct MeshOutput {
  const Surface& surface;
  const TriangleMesh& mesh;
  Points marks;  ///< 3 x m: points to show, such as the sources of a field
  std::vector<SceneFact> facts;
  std::string title;
};

/// Writes the mesh, with its vertex scalars where the format has room for them, to each file, by extension.
void write_mesh_files(const FileArguments& files, const MeshOutput& output);

}  // namespace taut::app
