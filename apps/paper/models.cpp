#include "models.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "model_formulas.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/formula.hpp"

namespace taut::paper {
namespace {

/// How a model is made and how it is looked at.
struct Recipe {
  ModelKind kind;
  std::string name;
  std::string (*formula)();
  double sampling;  ///< cell size of the display mesh whose vertices are the samples of Taut's own body
  Eigen::Vector3d towards_viewer;
  struct File {
    std::string name;
    Eigen::Vector3d up, towards_viewer;
  };
  std::vector<File> files;  ///< real models in the order they are preferred
};

const Recipe& recipe_of(ModelKind kind) {
  using Eigen::Vector3d;
  const Vector3d y = Vector3d::UnitY();
  const Vector3d z = Vector3d::UnitZ();
  static const std::vector<Recipe> recipes = {
      {ModelKind::hand, "Human hand", hand_formula, 0.06, {-0.35, -1, 0.25}, {{"hand_gel.obj", y, {0.2, 0.4, 1}}}},
      {ModelKind::pot,
       "Watering pot",
       pot_formula,
       0.075,
       {0.25, -1, 0.35},
       {{"eight_genus2.off", z, {0.3, -1, 0.6}}, {"kitten.xyz", y, {0.3, 0.3, 1}}}},
      {ModelKind::sculpture,
       "Sculpture",
       sculpture_formula,
       0.075,
       {0.45, -1, 0.25},
       {{"feline_genus2.obj", -z, {-1, 0.5, -0.3}}}},
      {ModelKind::face,
       "Human face",
       face_formula,
       0.045,
       {-0.35, -1, 0.1},
       {{"face_libigl.ply", y, {0.25, 0.1, 1}}, {"sven_fused.ply", y, {0.25, 0.1, 1}}}}};
  return *std::ranges::find(recipes, kind, &Recipe::kind);
}

/// A body's surface as its formula has it.
Surface own_surface(ModelKind kind) {
  FormulaOptions options;
  if (kind == ModelKind::face) {
    options.domain = {face_domain()};
    options.box = Box{Eigen::Vector3d(-0.8, -1.7, -1.2), Eigen::Vector3d(0.8, 0, 1.2)};
  }
  return parse_surface(recipe_of(kind).formula(), options);
}

}  // namespace

std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name) {
  if (folder.empty()) return {};
  std::vector<std::filesystem::path> found;
  constexpr auto kSkip = std::filesystem::directory_options::skip_permission_denied;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder, kSkip)) {
    if (entry.path().filename() == name) found.push_back(entry.path());
  }
  return found.empty() ? std::filesystem::path() : *std::ranges::min_element(found);
}

PointCloud sample_own_model(ModelKind kind, const Context& context) {
  const SurfaceMesh mesh = display_mesh(own_surface(kind), {.cell = recipe_of(kind).sampling}, context);
  PointCloud cloud{.points = mesh.vertices, .normals = mesh.normals, .faces = mesh.faces};
  return cloud;
}

const Model& model(Study& study, ModelKind kind) {
  const Recipe& recipe = recipe_of(kind);
  std::shared_ptr<const Model>& kept = study.models[recipe.name];
  if (kept != nullptr) return *kept;

  PointCloud cloud;
  std::string origin;
  bool is_real = false;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d towards_viewer = recipe.towards_viewer;
  for (const Recipe::File& file : recipe.files) {
    const std::filesystem::path path = find_file(study.data, file.name);
    if (path.empty()) continue;
    cloud = read_point_cloud(path, study.context);
    origin = file.name;
    is_real = true;
    up = file.up;
    towards_viewer = file.towards_viewer;
    break;
  }
  if (!is_real) {
    cloud = sample_own_model(kind, study.context);
    origin = "Taut's own formula";
  }
  RbfOptions options;
  if (!is_real) options.smoothing = 0;  // the samples lie on the formula exactly
  auto fit = std::make_shared<const RbfModel>(fit_rbf(cloud, options, study.context));
  kept = std::make_shared<const Model>(Model{.name = recipe.name,
                                             .origin = std::move(origin),
                                             .is_real = is_real,
                                             .cloud = std::move(cloud),
                                             .fit = fit,
                                             .surface = make_surface(fit),
                                             .up = up,
                                             .towards_viewer = towards_viewer});
  return *kept;
}

Index euler_number(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  std::set<int> vertices;
  for (const auto& face : mesh.faces.colwise()) {
    for (int i = 0; i < 3; ++i) {
      vertices.insert(face(i));
      edges.insert(std::minmax(face(i), face((i + 1) % 3)));
    }
  }
  return static_cast<Index>(vertices.size()) - static_cast<Index>(edges.size()) + mesh.faces.cols();
}

}  // namespace taut::paper
