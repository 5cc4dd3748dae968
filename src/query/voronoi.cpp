// Geodesic Voronoi parts.
//
// Labels of the mesh's vertices come from the fan of all sources. On an edge whose ends have different labels the place
// where the first one ends is bisected, all edges at a time. In a face with two labels the two such places are joined;
// in one with three labels, all three with the place where the parts meet.

#include "taut/query/point_sets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <unordered_map>
#include <utility>

#include "march/mesh_march.hpp"
#include "query/chains.hpp"
#include "search/cell_levels.hpp"
#include "strata/faceted_surface.hpp"
#include "taut/core/error.hpp"
#include "taut/march/march.hpp"
#include "taut/query/surface_mesh.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// An edge whose ends have different labels.
struct CutEdge {
  Index a, b;  // vertices, a < b
  bool exact;  // both labels are proved
};

/// The edges of a mesh that parts end on, and where.
struct Cuts {
  std::vector<CutEdge> edges;
  std::unordered_map<std::uint64_t, Index> number;
  Points places;  // 3 x n
  Index num_exact = 0;

  [[nodiscard]] static std::uint64_t key(Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
  }
  [[nodiscard]] Index find(Index a, Index b) const { return number.at(key(a, b)); }
};

/// Halves each edge where its first label ends.
void bisect(DistanceSolver& solver, const TriangleMesh& mesh, const std::vector<std::int32_t>& label, Cuts& cuts) {
  const Index n = static_cast<Index>(cuts.edges.size());
  const std::unique_ptr<Evaluator> evaluator = solver.surface().make_evaluator();
  Vector low = Vector::Zero(n);
  Vector high = Vector::Ones(n);
  std::vector<std::uint8_t> known(at(n), 1);
  const auto place = [&](const Vector& share) {
    Points x(3, n);
    for (Index e = 0; e < n; ++e) {
      const CutEdge& edge = cuts.edges[at(e)];
      x.col(e) = (1 - share(e)) * mesh.vertices.col(edge.a) + share(e) * mesh.vertices.col(edge.b);
    }
    (void)project_to_surface(*evaluator, 3, 1, x);
    return x;
  };
  constexpr int kHalvings = 36;  // 1e-11 of an edge
  for (int step = 0; step < kHalvings; ++step) {
    const Vector middle = (low + high) / 2;
    const Points x = place(middle);
    const Distances u = solver.at(x);
    for (Index e = 0; e < n; ++e) {
      const CutEdge& edge = cuts.edges[at(e)];
      // Once a label on the edge is not proved, its place stays where the halving had come to.
      if (!edge.exact || known[at(e)] == 0) continue;
      if (u.proof[at(e)] != DistanceProof::fan) {
        known[at(e)] = 0;
      } else if (u.source[at(e)] == label[at(edge.a)]) {
        low(e) = middle(e);
      } else {
        high(e) = middle(e);
      }
    }
  }
  for (Index e = 0; e < n; ++e) {
    if (cuts.edges[at(e)].exact && known[at(e)] != 0) ++cuts.num_exact;
  }
  cuts.places = place((low + high) / 2);
}

/// The stretches between two parts, and the nodes that they run through: cut edges, then places where parts meet.
class Borders {
 public:
  Borders(const TriangleMesh& mesh, const std::vector<std::int32_t>& label, const Cuts& cuts) {
    points_ = cuts.places;
    Index next = points_.cols();
    points_.conservativeResize(3, next + mesh.faces.cols());
    for (Index f = 0; f < mesh.faces.cols(); ++f) {
      std::array<Index, 3> corner{};
      std::array<std::int32_t, 3> own{};
      for (std::size_t c = 0; c < 3; ++c) {
        corner[c] = mesh.faces(static_cast<Index>(c), f);
        own[c] = label[at(corner[c])];
      }
      // A vertex that no source reaches: no border is told there.
      if (own[0] < 0 || own[1] < 0 || own[2] < 0) continue;
      const bool three = own[0] != own[1] && own[1] != own[2] && own[2] != own[0];
      if (three) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (std::size_t c = 0; c < 3; ++c) sum += cuts.places.col(cuts.find(corner[c], corner[(c + 1) % 3]));
        points_.col(next) = sum / 3;
      }
      Index rises = -1;
      Index falls = -1;
      std::pair<std::int32_t, std::int32_t> two;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::int32_t a = own[c];
        const std::int32_t b = own[(c + 1) % 3];
        if (a == b) continue;
        const Index edge = cuts.find(corner[c], corner[(c + 1) % 3]);
        const auto pair = std::minmax(a, b);
        if (three) {
          // The lower number always lies on the same side, so that segments of neighbouring faces join head to tail.
          if (a < b) {
            join(pair, edge, next);
          } else {
            join(pair, next, edge);
          }
        } else {
          two = pair;
          (a < b ? rises : falls) = edge;
        }
      }
      if (three) ++next;
      if (rises >= 0 && falls >= 0) join(two, rises, falls);
    }
    points_.conservativeResize(3, next);
  }

  /// All nodes, to be brought onto the surface.
  [[nodiscard]] Points& points() { return points_; }

  [[nodiscard]] Polylines lines() const {
    Polylines result;
    std::vector<double> left;
    std::vector<double> right;
    for (const auto& [parts, border] : borders_) {
      for (const std::vector<Index>& chain : border.chains.lines()) {
        Points line(3, static_cast<Index>(chain.size()));
        for (Index i = 0; i < line.cols(); ++i) line.col(i) = points_.col(border.nodes[at(chain[at(i)])]);
        result.lines.push_back(std::move(line));
        left.insert(left.end(), chain.size(), parts.first);
        right.insert(right.end(), chain.size(), parts.second);
      }
    }
    const auto scalar = [](const char* name, const std::vector<double>& values) {
      return VertexScalar{name, Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size()))};
    };
    result.scalars = {scalar("left", left), scalar("right", right)};
    return result;
  }

 private:
  struct Border {
    detail::Chains chains;  // between numbers of its own
    std::unordered_map<Index, Index> number;
    std::vector<Index> nodes;
    [[nodiscard]] Index own(Index node) {
      const auto [place, fresh] = number.try_emplace(node, static_cast<Index>(nodes.size()));
      if (fresh) nodes.push_back(node);
      return place->second;
    }
  };

  void join(std::pair<std::int32_t, std::int32_t> parts, Index from, Index to) {
    Border& border = borders_[parts];
    const Index a = border.own(from);
    border.chains.join(a, border.own(to));
  }

  std::map<std::pair<std::int32_t, std::int32_t>, Border> borders_;
  Points points_;
};

}  // namespace

VoronoiResult geodesic_voronoi(const Surface& surface, const PointsIn& sources, const DistanceOptions& options,
                               const Context& context) {
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument("Voronoi parts are drawn on surfaces in 3 dimensions");
  }
  DistanceOptions by_fan = options;
  by_fan.paths = false;
  DistanceSolver solver(surface, sources, {}, by_fan, context);
  VoronoiResult result;
  result.mesh = display_mesh(
      surface, {.cell_at_most = options.cell, .grid = options.grid, .near = solver.sources(), .seeds = options.seeds},
      context);
  const Index n = result.mesh.vertices.cols();
  result.label.assign(at(n), -1);
  Vector distance = Vector::Constant(n, kNaN);
  std::vector<std::uint8_t> exact(at(n), 0);
  if (solver.has_fan()) {
    const Distances u = solver.at(result.mesh.vertices);
    for (Index v = 0; v < n; ++v) {
      if (u.proof[at(v)] != DistanceProof::fan) continue;
      exact[at(v)] = 1;
      ++result.num_exact;
      distance(v) = u.distance(v);
      result.label[at(v)] = u.source[at(v)];
    }
  }
  if (detail::is_kinked(surface)) {
    // Cells are not marched across edges; the mesh has them.
    detail::MeshMarch march(result.mesh);
    for (const auto& source : solver.sources().colwise()) march.add_source(source, context);
    for (Index v = 0; v < n; ++v) {
      if (!std::isfinite(march.distance()(v)) || march.distance()(v) > options.max_distance) continue;
      distance(v) = march.distance()(v);
      result.label[at(v)] = march.source()[at(v)];
    }
  } else if (result.num_exact < n) {
    detail::CellLevels levels(surface, {options.grid, options.cell, options.seeds}, context);
    levels.prepare(solver.sources());
    SurfaceCells& cells = *levels.cells(0, solver.sources());
    const DistanceField field = march(surface, cells, solver.sources(), {.method = options.march}, context);
    const Vector marched = distance_at(surface, cells, field, result.mesh.vertices);
    for (Index v = 0; v < n; ++v) {
      if (exact[at(v)] != 0 || !std::isfinite(marched(v)) || marched(v) > options.max_distance) continue;
      // The nearest source of the cell that holds the vertex: right but for a cell along the borders.
      const Index cell = cells.grid().find_point(result.mesh.vertices.col(v));
      if (cell == CellGrid::kNone || field.nearest_source[at(cell)] < 0) continue;
      distance(v) = marched(v);
      result.label[at(v)] = field.nearest_source[at(cell)];
    }
  }

  Cuts cuts;
  for (Index f = 0; f < result.mesh.faces.cols(); ++f) {
    for (Index c = 0; c < 3; ++c) {
      const auto [a, b] = std::minmax<Index>({result.mesh.faces(c, f), result.mesh.faces((c + 1) % 3, f)});
      if (result.label[at(a)] < 0 || result.label[at(b)] < 0 || result.label[at(a)] == result.label[at(b)]) continue;
      if (!cuts.number.try_emplace(Cuts::key(a, b), static_cast<Index>(cuts.edges.size())).second) continue;
      cuts.edges.push_back({a, b, exact[at(a)] != 0 && exact[at(b)] != 0});
    }
  }
  if (!cuts.edges.empty()) {
    bisect(solver, result.mesh, result.label, cuts);
    result.num_exact_boundary = cuts.num_exact;
    Borders borders(result.mesh, result.label, cuts);
    const std::unique_ptr<Evaluator> evaluator = surface.make_evaluator();
    (void)project_to_surface(*evaluator, 3, 1, borders.points());
    result.boundaries = borders.lines();
  }
  Vector shown(n);
  for (Index v = 0; v < n; ++v) shown(v) = result.label[at(v)] < 0 ? kNaN : static_cast<double>(result.label[at(v)]);
  result.mesh.scalars = {{"distance", std::move(distance)}, {"source", std::move(shown)}};
  return result;
}

}  // namespace taut
