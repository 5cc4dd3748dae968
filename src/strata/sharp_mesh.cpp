// A mesh of cells rounds edges off by up to a cell. Three steps mend it, from few to many:
//   1. The vertex of the cell with a corner, or else the nearest one, becomes the corner.
//   2. A vertex within a third of a cell of an edge moves onto it, nearest first, unless a neighbour stands there
//      already: short sides would make needles.
//   3. Where a side of a triangle still leads from one face to another, the point where it crosses the edge becomes a
//      vertex, and the triangle two, three or four.
// What then lies upside down, since vertices have passed each other, is mended by turning sides. Every vertex knows the
// faces it lies on, so no triangle lies across an edge in the end but where the cells are too coarse to tell faces
// apart.
#include "strata/sharp_mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

/// In cells: how far a vertex goes to a corner and to an edge.
constexpr double kToCorner = 1.2;
constexpr double kToEdge = 0.35;
/// It stays where it is if it would come to stand next to another one there, in parts of its way: a short side of a
/// triangle is better than a low height, but not than none.
constexpr double kApart = 1;
/// Places on an edge are looked up by these, in cells apart.
constexpr double kPlaces = 0.25;
/// The crossing of a side lies as far from it, in sides: the more, the sharper the edge.
constexpr double kOffSide = 1.5;

/// A triangle is turned over where its normal makes a cosine less than this with its face's; so many rounds mend it.
constexpr double kFolded = 0.2;
constexpr int kTurns = 3;

using Faces = std::vector<int>;

bool has(const Faces& faces, int face) { return std::find(faces.begin(), faces.end(), face) != faces.end(); }
bool share(const Faces& a, const Faces& b) {
  return std::any_of(a.begin(), a.end(), [&](int face) { return has(b, face); });
}

/// Points by cubes of one cell.
class Places {
 public:
  struct Place {
    Point3 x;
    int line;
  };
  explicit Places(double cube) : cube_(cube) {}
  void add(const Point3& x, int line) { cubes_[key(x, 0, 0, 0)].push_back({x, line}); }
  template <class Visit>
  void around(const Point3& x, const Visit& visit) const {
    for (int n = 0; n < 27; ++n) {
      const auto at = cubes_.find(key(x, n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1));
      if (at == cubes_.end()) continue;
      for (const Place& place : at->second) visit(place);
    }
  }

 private:
  [[nodiscard]] std::uint64_t key(const Point3& x, int i, int j, int k) const {
    constexpr std::int64_t kMiddle = std::int64_t{1} << 20;
    constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
    const auto part = [&](double at, int shift) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(at / cube_)) + shift + kMiddle) & kMask;
    };
    return part(x.x(), i) << 42 | part(x.y(), j) << 21 | part(x.z(), k);
  }
  double cube_;
  std::unordered_map<std::uint64_t, std::vector<Place>> cubes_;
};

class Sharpener {
 public:
  Sharpener(FacetedSurface& surface, const EdgeNetwork& network, const CellGrid& grid, SurfaceMesh& mesh)
      : s_(surface), network_(network), grid_(grid), cell_(grid.size()), mesh_(mesh), places_(grid.size()) {
    const Index n = mesh.vertices.cols();
    for (Index v = 0; v < n; ++v) {
      x_.emplace_back(mesh.vertices.col(v));
      faces_.push_back({s_.face_at(x_.back())});
    }
    settled_.assign(x_.size(), 0);
    for (const auto& face : mesh.faces.colwise()) triangles_.push_back({face(0), face(1), face(2)});
    for (std::size_t l = 0; l < network.lines.size(); ++l) {
      const EdgeLine& line = network.lines[l];
      if (is_seam(line)) continue;
      for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
        const Point3 step = line.points[i + 1] - line.points[i];
        const int pieces = 1 + static_cast<int>(step.norm() / (kPlaces * cell_));
        for (int k = 0; k <= pieces; ++k) places_.add(line.points[i] + k * step / pieces, static_cast<int>(l));
      }
    }
  }

  void run(bool part_faces) {
    take_corners();
    take_edges();
    cut_triangles();
    turn_folded();
    deliver(part_faces);
  }

 private:
  [[nodiscard]] bool is_seam(const EdgeLine& line) const {
    return s_.edge(line.edge).b >= 0 && line.angle <= kSeamAngle;
  }

  void take_corners() {
    Places vertices(kToCorner * cell_);
    for (std::size_t v = 0; v < x_.size(); ++v) vertices.add(x_[v], static_cast<int>(v));
    struct Move {
      double distance;
      std::size_t corner;
      std::size_t vertex;
    };
    std::vector<Move> moves;
    for (std::size_t c = 0; c < network_.corners.size(); ++c) {
      const EdgeCorner& corner = network_.corners[c];
      if (!ends_a_line(corner)) continue;
      const Index own = grid_.find_point(corner.x);
      vertices.around(corner.x, [&](const Places::Place& place) {
        const auto v = static_cast<std::size_t>(place.line);
        const double distance = (place.x - corner.x).norm();
        if (distance > kToCorner * cell_ || !share(faces_[v], corner.faces)) return;
        moves.push_back({mesh_.cell[v] == own ? 0 : distance, c, v});
      });
    }
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return std::pair(a.distance, a.vertex) < std::pair(b.distance, b.vertex);
    });
    std::vector<char> done(network_.corners.size(), 0);
    for (const Move& move : moves) {
      if (done[move.corner] != 0 || settled_[move.vertex] != 0) continue;
      done[move.corner] = settled_[move.vertex] = 1;
      x_[move.vertex] = network_.corners[move.corner].x;
      faces_[move.vertex] = network_.corners[move.corner].faces;
    }
  }

  /// Corners of seams alone are smooth points.
  [[nodiscard]] bool ends_a_line(const EdgeCorner& corner) const {
    return std::any_of(network_.lines.begin(), network_.lines.end(), [&](const EdgeLine& line) {
      const double near = ChainTolerances::at_corner * s_.scale;
      return !is_seam(line) &&
             std::min((line.points.front() - corner.x).norm(), (line.points.back() - corner.x).norm()) <= near;
    });
  }

  void take_edges() {
    struct Move {
      double distance;
      std::size_t vertex;
      Point3 to;
      int line;
    };
    std::vector<Move> moves;
    for (std::size_t v = 0; v < x_.size(); ++v) {
      if (settled_[v] != 0) continue;
      double least = 2 * kToEdge * cell_;
      int line = -1;
      places_.around(x_[v], [&](const Places::Place& place) {
        const SharpEdge edge = s_.edge(network_.lines[static_cast<std::size_t>(place.line)].edge);
        const double distance = (place.x - x_[v]).norm();
        if (distance >= least || (!has(faces_[v], edge.a) && !has(faces_[v], edge.b))) return;
        least = distance;
        line = place.line;
      });
      if (line < 0) continue;
      Point3 to = x_[v];
      const SharpEdge edge = s_.edge(network_.lines[static_cast<std::size_t>(line)].edge);
      if (!s_.project(edge.a, {edge.condition}, to) || !(s_.violation(edge.a, to) <= on_edge())) continue;
      const double distance = (to - x_[v]).norm();
      if (distance <= kToEdge * cell_) moves.push_back({distance, v, to, line});
    }
    std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
      return std::pair(a.distance, a.vertex) < std::pair(b.distance, b.vertex);
    });
    std::vector<std::vector<int>> beside(x_.size());
    for (const auto& t : triangles_) {
      for (std::size_t i = 0; i < 3; ++i) {
        beside[static_cast<std::size_t>(t[i])].push_back(t[(i + 1) % 3]);
        beside[static_cast<std::size_t>(t[i])].push_back(t[(i + 2) % 3]);
      }
    }
    for (const Move& move : moves) {
      const bool crowded = std::any_of(beside[move.vertex].begin(), beside[move.vertex].end(), [&](int other) {
        const auto o = static_cast<std::size_t>(other);
        return settled_[o] != 0 && (x_[o] - move.to).norm() < kApart * move.distance;
      });
      if (crowded) continue;
      settled_[move.vertex] = 1;
      x_[move.vertex] = move.to;
      faces_[move.vertex] = faces_of(move.line);
    }
  }

  [[nodiscard]] double on_edge() const { return ChainTolerances::on_edge * s_.scale; }
  [[nodiscard]] Faces faces_of(int line) const {
    const SharpEdge edge = s_.edge(network_.lines[static_cast<std::size_t>(line)].edge);
    return edge.b >= 0 ? Faces{edge.a, edge.b} : Faces{edge.a};
  }

  /// The vertex where the side from u to v crosses an edge; -1: none is needed, or none was found.
  int crossing(int u, int v) {
    const Faces from = faces_[static_cast<std::size_t>(u)];
    const Faces to = faces_[static_cast<std::size_t>(v)];
    if (share(from, to)) return -1;
    const auto [at, added] = crossings_.try_emplace(std::minmax(u, v), -1);
    if (!added) return at->second;
    const Point3 a = x_[static_cast<std::size_t>(u)];
    const Point3 b = x_[static_cast<std::size_t>(v)];
    const Point3 middle = (a + b) / 2;
    double least = std::numeric_limits<double>::infinity();
    int line = -1;
    places_.around(middle, [&](const Places::Place& place) {
      const Faces both = faces_of(place.line);
      if (!share(both, from) || !share(both, to)) return;
      const double distance = (place.x - middle).norm();
      if (distance >= least) return;
      least = distance;
      line = place.line;
    });
    if (line < 0) return -1;
    const SharpEdge edge = s_.edge(network_.lines[static_cast<std::size_t>(line)].edge);
    Point3 gradient;
    const double at_a = s_.condition(edge.condition, a, gradient);
    const double at_b = s_.condition(edge.condition, b, gradient);
    const double part = at_a * at_b < 0 ? at_a / (at_a - at_b) : 0.5;
    const Point3 straight = a + part * (b - a);
    Point3 x = straight;
    if (!s_.project(edge.a, {edge.condition}, x) || (x - straight).norm() > kOffSide * (b - a).norm()) return -1;
    if (!(s_.violation(edge.a, x) <= on_edge())) return -1;
    at->second = static_cast<int>(x_.size());
    x_.push_back(x);
    faces_.push_back(faces_of(line));
    mesh_.cell.push_back(mesh_.cell[static_cast<std::size_t>(u)]);
    return at->second;
  }

  void cut_triangles() {
    std::vector<std::array<int, 3>> cut;
    for (const std::array<int, 3>& t : triangles_) {
      std::array<int, 3> on{};  // the side from corner i
      int count = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        on[i] = crossing(t[i], t[(i + 1) % 3]);
        count += on[i] >= 0 ? 1 : 0;
      }
      if (count == 0) {
        cut.push_back(t);
        continue;
      }
      if (count == 3) {
        for (std::size_t i = 0; i < 3; ++i) cut.push_back({t[i], on[i], on[(i + 2) % 3]});
        cut.push_back(on);
        continue;
      }
      // The first side that is cut and whose next one is not, or the other way round.
      std::size_t s = 0;
      while (count == 1 ? on[s] < 0 : on[s] >= 0) ++s;
      const int a = t[s];
      const int b = t[(s + 1) % 3];
      const int c = t[(s + 2) % 3];
      if (count == 1) {
        cut.push_back({a, on[s], c});
        cut.push_back({on[s], b, c});
      } else {
        const int bc = on[(s + 1) % 3];
        const int ca = on[(s + 2) % 3];
        cut.push_back({c, ca, bc});
        const bool first = (x_at(a) - x_at(bc)).squaredNorm() <= (x_at(b) - x_at(ca)).squaredNorm();
        cut.push_back(first ? std::array{a, b, bc} : std::array{a, b, ca});
        cut.push_back(first ? std::array{a, bc, ca} : std::array{b, bc, ca});
      }
    }
    triangles_ = std::move(cut);
  }

  [[nodiscard]] const Point3& x_at(int v) const { return x_[static_cast<std::size_t>(v)]; }

  /// The face of a triangle: the one that all its corners lie on, and of several the one with its normal.
  [[nodiscard]] int face_of(const std::array<int, 3>& t) {
    const Point3 normal = (x_at(t[1]) - x_at(t[0])).cross(x_at(t[2]) - x_at(t[0]));
    const Point3 middle = (x_at(t[0]) + x_at(t[1]) + x_at(t[2])) / 3;
    int best = -1;
    double most = 0;
    for (const int v : t) {
      for (const int face : faces_[static_cast<std::size_t>(v)]) {
        int common = 0;
        for (const int other : t) common += has(faces_[static_cast<std::size_t>(other)], face) ? 1 : 0;
        Point3 gradient;
        (void)s_.function(face, middle, gradient);
        const double size = gradient.norm();
        const double along = size > 0 ? gradient.dot(normal) / size / std::max(normal.norm(), 1e-300) : 0;
        const double score = 4 * common + along;
        if (best >= 0 && score <= most) continue;
        most = score;
        best = face;
      }
    }
    return best;
  }

  /// The cosine between a triangle's normal and its face's; -2 where it lies on no one face.
  [[nodiscard]] double quality(const std::array<int, 3>& t) {
    const int face = face_of(t);
    const bool on_it =
        std::all_of(t.begin(), t.end(), [&](int v) { return has(faces_[static_cast<std::size_t>(v)], face); });
    const Point3 normal = (x_at(t[1]) - x_at(t[0])).cross(x_at(t[2]) - x_at(t[0])).normalized();
    return on_it ? normal.dot(normal_of(face, x_at(t[0]))) : -2;
  }

  /// Where vertices have passed each other on their way to an edge, triangles lie upside down: vertices change places,
  /// or the side between such a triangle and its neighbour is turned.
  void turn_folded() {
    std::vector<std::size_t> folded;
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      const auto& t = triangles_[f];
      if (std::all_of(t.begin(), t.end(), [&](int v) { return is_inner(v); })) continue;
      if (quality(t) < kFolded) folded.push_back(f);
    }
    if (folded.empty()) return;
    std::map<std::pair<int, int>, std::size_t> sides;
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      for (std::size_t i = 0; i < 3; ++i) sides[{triangles_[f][i], triangles_[f][(i + 1) % 3]}] = f;
    }
    std::vector<std::vector<std::size_t>> around(x_.size());
    for (std::size_t f = 0; f < triangles_.size(); ++f) {
      for (const int v : triangles_[f]) around[static_cast<std::size_t>(v)].push_back(f);
    }
    for (const std::size_t f : folded) {
      for (std::size_t i = 0; i < 3 && quality(triangles_[f]) < kFolded; ++i) {
        swap_places(triangles_[f][i], triangles_[f][(i + 1) % 3], around);
      }
    }
    for (int round = 0; round < kTurns; ++round) {
      for (const std::size_t f : folded) {
        for (std::size_t i = 0; i < 3 && quality(triangles_[f]) < kFolded; ++i) turn(f, i, sides);
      }
    }
  }

  /// Two vertices on edges stand in the wrong order there: they change places where that mends their triangles.
  void swap_places(int u, int v, const std::vector<std::vector<std::size_t>>& around) {
    if (is_inner(u) || is_inner(v)) return;
    const auto a = static_cast<std::size_t>(u);
    const auto b = static_cast<std::size_t>(v);
    const auto num_folded = [&] {
      int count = 0;
      for (const std::size_t w : {a, b}) {
        for (const std::size_t f : around[w]) count += quality(triangles_[f]) < kFolded ? 1 : 0;
      }
      return count;
    };
    const auto swap = [&] {
      std::swap(x_[a], x_[b]);
      std::swap(faces_[a], faces_[b]);
    };
    const int before = num_folded();
    swap();
    if (num_folded() >= before) swap();
  }

  void turn(std::size_t f, std::size_t i, std::map<std::pair<int, int>, std::size_t>& sides) {
    const std::array<int, 3> one = triangles_[f];
    const int a = one[i];
    const int b = one[(i + 1) % 3];
    const int c = one[(i + 2) % 3];
    const auto beside = sides.find({b, a});
    if (beside == sides.end()) return;
    const std::size_t g = beside->second;
    const std::array<int, 3> two = triangles_[g];
    const int d = *std::find_if(two.begin(), two.end(), [&](int v) { return v != a && v != b; });
    if (d == c || sides.contains({c, d}) || sides.contains({d, c})) return;
    const std::array<int, 3> first{a, d, c};
    const std::array<int, 3> second{d, b, c};
    if (std::min(quality(first), quality(second)) <= std::min(quality(one), quality(two))) return;
    sides.erase({a, b});
    sides.erase(beside);
    triangles_[f] = first;
    triangles_[g] = second;
    for (const std::size_t made : {f, g}) {
      for (std::size_t k = 0; k < 3; ++k) sides[{triangles_[made][k], triangles_[made][(k + 1) % 3]}] = made;
    }
  }

  [[nodiscard]] Point3 normal_of(int face, const Point3& x) {
    Point3 gradient;
    (void)s_.function(face, x, gradient);
    const double size = gradient.norm();
    return size > 0 && std::isfinite(size) ? Point3(gradient / size) : Point3::Zero();
  }

  void deliver(bool part_faces) {
    std::vector<std::pair<int, int>> vertices;  // vertex and face; -1: whichever
    std::map<std::pair<int, int>, int> number;
    std::vector<Point3> normals(x_.size(), Point3::Zero());
    std::vector<std::array<int, 3>> kept;
    for (const std::array<int, 3>& t : triangles_) {
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      std::array<int, 3> made{};
      const bool inner = std::all_of(t.begin(), t.end(), [&](int v) { return is_inner(v); });
      const int face = inner ? -1 : face_of(t);
      for (std::size_t i = 0; i < 3; ++i) {
        const bool own = part_faces && !is_inner(t[i]);
        const auto [at, added] = number.try_emplace({t[i], own ? face : -1}, static_cast<int>(vertices.size()));
        if (added) vertices.emplace_back(t[i], face);
        made[i] = at->second;
        if (!is_inner(t[i])) normals[static_cast<std::size_t>(t[i])] += normal_of(face, x_at(t[i]));
      }
      kept.push_back(made);
    }
    Points x(3, static_cast<Index>(vertices.size()));
    Points n(3, x.cols());
    std::vector<Index> cell(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto [v, face] = vertices[i];
      const auto j = static_cast<Index>(i);
      x.col(j) = x_at(v);
      cell[i] = mesh_.cell[static_cast<std::size_t>(v)];
      Point3 normal = Point3::Zero();
      if (is_inner(v)) {
        normal = mesh_.normals.col(v);
      } else {
        normal = part_faces ? normal_of(face, x_at(v)) : normals[static_cast<std::size_t>(v)].normalized();
      }
      n.col(j) = normal.norm() > 0.5 ? normal : Point3(mesh_.normals.col(std::min<Index>(v, mesh_.normals.cols() - 1)));
    }
    mesh_.faces.resize(3, static_cast<Index>(kept.size()));
    for (std::size_t i = 0; i < kept.size(); ++i) {
      mesh_.faces.col(static_cast<Index>(i)) << kept[i][0], kept[i][1], kept[i][2];
    }
    mesh_.vertices = std::move(x);
    mesh_.normals = std::move(n);
    mesh_.cell = std::move(cell);
  }

  /// As the mesh had it: inside a face, with its own normal.
  [[nodiscard]] bool is_inner(int v) const {
    const auto i = static_cast<std::size_t>(v);
    return i < settled_.size() && settled_[i] == 0;
  }

  FacetedSurface& s_;
  const EdgeNetwork& network_;
  const CellGrid& grid_;
  double cell_;
  SurfaceMesh& mesh_;
  Places places_;
  std::vector<Point3> x_;
  std::vector<Faces> faces_;
  std::vector<char> settled_;  // one a vertex of the given mesh: on an edge or in a corner
  std::vector<std::array<int, 3>> triangles_;
  std::map<std::pair<int, int>, int> crossings_;
};

}  // namespace

void sharpen_mesh(FacetedSurface& surface, const EdgeNetwork& network, const CellGrid& grid, bool part_faces,
                  SurfaceMesh& mesh) {
  Sharpener(surface, network, grid, mesh).run(part_faces);
}

}  // namespace taut::detail
