#pragma once

#include <memory>
#include <string>
#include <vector>

#include "study.hpp"
#include "taut/core/mesh.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/surface.hpp"

namespace taut::paper {

/// A body as the paper has them: known by points, made into an implicit surface by radial basis functions.
struct Model {
  std::string name;    ///< "Human hand"
  std::string origin;  ///< where its points come from, for the report: a file, or Taut's own formula
  bool is_real = false;
  PointCloud cloud;  ///< what was fitted
  std::shared_ptr<const RbfModel> fit;
  Surface surface;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d towards_viewer = Eigen::Vector3d::Zero();  ///< where it looks best from; zero = wherever
};

enum class ModelKind { hand, pot, sculpture, face };

/// The model, real where `study.data` has a file for it, else made by Taut. Made once a study.
[[nodiscard]] const Model& model(Study& study, ModelKind kind);

/// Points of Taut's own body with outward normals, spread over its surface: what a scanner would see of the formula.
[[nodiscard]] PointCloud sample_own_model(ModelKind kind, const Context& context = {});

/// The file of that name in `folder` or one of its folders; empty when there is none.
[[nodiscard]] std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name);

/// Vertices - edges + faces.
[[nodiscard]] Index euler_number(const TriangleMesh& mesh);

}  // namespace taut::paper
