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

/// ".json .csv ...": the extensions that can hold this kind.
[[nodiscard]] std::string known_outputs(OutputKind kind);

/// Throws UsageError when a file's extension cannot hold this kind: said before any work is done.
void check_outputs(const std::vector<std::string>& files, OutputKind kind);

/// --up: which axis points up in pictures.
struct PictureArguments {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  void add_to(CLI::App& command);
};

struct PathOutput {
  const Surface& surface;
  std::vector<const PathResult*> paths;
  nlohmann::ordered_json json;
  std::vector<SceneFact> facts;  ///< for people, shown beside pictures
  std::string title;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// Writes the paths to each file, by extension.
void write_paths(const std::vector<std::string>& files, const PathOutput& output, const Context& context);

struct MeshOutput {
  const Surface& surface;
  const TriangleMesh& mesh;
  Points marks;  ///< 3 x m: points to show, such as the sources of a field
  std::vector<SceneFact> facts;
  std::string title;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
};

/// Writes the mesh, with its vertex scalars where the format has room for them, to each file, by extension.
void write_mesh_files(const std::vector<std::string>& files, const MeshOutput& output);

}  // namespace taut::app
