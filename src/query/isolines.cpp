// Lines of equal distance: traced on a mesh by linear interpolation along its edges, then every node moved along the
// gradient of the exact distance until it has its level. Lines keep the higher values on one side.
#include "taut/query/distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "query/chains.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

void add_level(const TriangleMesh& mesh, const Vector& values, double level, Polylines& lines,
               std::vector<double>& levels_of) {
  std::unordered_map<std::uint64_t, Index> number;
  std::vector<std::array<Eigen::Index, 2>> edges;
  const auto crossing = [&](Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    // One number an edge, whichever face asks.
    const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
    const auto [place, fresh] = number.try_emplace(key, static_cast<Index>(edges.size()));
    if (fresh) edges.push_back({low, high});
    return place->second;
  };
  detail::Chains chains;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    // Round a face that the level cuts the value falls below it across one edge and rises above it across another.
    Index falls = -1;
    Index rises = -1;
    bool finite = true;
    for (int c = 0; c < 3; ++c) {
      const Index a = mesh.faces(c, f);
      const Index b = mesh.faces((c + 1) % 3, f);
      finite = finite && std::isfinite(values(a));
      // A vertex at the level counts as above it: a face is cut across two edges or none.
      if (values(a) >= level && values(b) < level) falls = crossing(a, b);
      if (values(a) < level && values(b) >= level) rises = crossing(a, b);
    }
    if (finite && falls >= 0 && rises >= 0) chains.join(rises, falls);
  }
  for (const std::vector<Index>& line : chains.lines()) {
    Points points(3, static_cast<Index>(line.size()));
    for (Index i = 0; i < points.cols(); ++i) {
      const auto [a, b] = edges[static_cast<std::size_t>(line[static_cast<std::size_t>(i)])];
      // Never 0 / 0: the ends lie on different sides of the level.
      const double share = (level - values(a)) / (values(b) - values(a));
      points.col(i) = mesh.vertices.col(a) + share * (mesh.vertices.col(b) - mesh.vertices.col(a));
    }
    lines.lines.push_back(std::move(points));
    levels_of.insert(levels_of.end(), line.size(), level);
  }
}

}  // namespace

Polylines trace_isolines(const TriangleMesh& mesh, const Vector& values, const std::vector<double>& levels) {
  if (values.size() != mesh.vertices.cols()) throw InvalidArgument("isolines need one value a vertex");
  Polylines lines;
  std::vector<double> levels_of;
  for (const double level : levels) add_level(mesh, values, level, lines, levels_of);
  lines.scalars.push_back({"level", Eigen::Map<const Vector>(levels_of.data(), static_cast<Index>(levels_of.size()))});
  return lines;
}

Polylines distance_isolines(DistanceSolver& solver, const TriangleMesh& mesh, const Vector& values,
                            const std::vector<double>& levels, Index* num_moved) {
  Polylines lines = trace_isolines(mesh, values, levels);
  const Vector& level = lines.scalars.front().values;
  const Index n = level.size();
  Points x(3, n);
  for (Index begin = 0; const Points& line : lines.lines) {
    x.middleCols(begin, line.cols()) = line;
    begin += line.cols();
  }
  const std::unique_ptr<Evaluator> evaluator = solver.surface().make_evaluator();
  const auto on_surface = [&](Points& points) { return project_to_surface(*evaluator, 3, 1, points); };
  (void)on_surface(x);
  // One step along a unit gradient leaves the square of what was missing; a mesh misses by less than its edges.
  constexpr int kMostSteps = 4;
  std::vector<std::uint8_t> there(static_cast<std::size_t>(n), 0);
  Points moved = x;
  for (int step = 0; step <= kMostSteps; ++step) {
    const Distances u = solver.at(moved);
    for (Index j = 0; j < n; ++j) {
      const double missing = level(j) - u.distance(j);
      // As far as the distance there is known.
      const double enough = std::max(u.error(j), 1e-12 * level(j));
      there[static_cast<std::size_t>(j)] = std::abs(missing) <= enough ? 1 : 0;
      if (step < kMostSteps && std::isfinite(missing) && u.arrival.col(j).allFinite()) {
        moved.col(j) += missing * u.arrival.col(j);
      }
    }
    if (step < kMostSteps) (void)on_surface(moved);
  }
  Index count = 0;
  for (Index j = 0; j < n; ++j) {
    // A node that did not arrive (no exact distance, a cut locus) keeps its place on the mesh.
    if (there[static_cast<std::size_t>(j)] == 0) continue;
    x.col(j) = moved.col(j);
    ++count;
  }
  if (num_moved != nullptr) *num_moved = count;
  for (Index begin = 0; Points & line : lines.lines) {
    line = x.middleCols(begin, line.cols());
    begin += line.cols();
  }
  return lines;
}

// Between 0 and the largest finite value, both left out: there the lines would be points.
std::vector<double> even_levels(const Vector& values, int count) {
  double most = 0;
  for (const double u : values) {
    if (std::isfinite(u)) most = std::max(most, u);
  }
  std::vector<double> levels;
  for (int i = 1; i <= count; ++i) levels.push_back(most * i / (count + 1));
  return levels;
}

}  // namespace taut
