// Which faces does a shortest path cross? The answer comes from a graph: in every cell that the surface may cross,
// bounds of the kinks' conditions tell which sides are possible there; each choice of sides that has a surface point
// nearby gives a node on its face, each kink one on the edge, each pair of kinks one in the corner. So a face or a
// strip much thinner than a cell has its nodes. Nodes on one face are joined where the middle of their chord has its
// foot on the face between them. Within 2.3 cells there are some 20 directions to go: ways are at most 3 % too long.
#include "strata/facet_graph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// A point may be as far from the middle of its cell, in cells.
constexpr double kNearCell = 0.9;
/// Farther from the middle of the cell, in cells, a zero set is not looked for a second time.
constexpr double kFarFromCell = 2;
/// Conditions that vanish within this, relative to the model.
constexpr double kOnEdge = 1e-9;
/// Corners closer than this part of the model, and other nodes closer than this part of a cell, are one.
constexpr double kSameCorner = 1e-7;
constexpr double kSameNode = 1e-3;
/// A wedge of more than this goes all around, radians.
constexpr double kWholeTurn = 6.28;
/// Angles above pi by this, radians, make a corner reach into a face.
constexpr double kReflex = 1e-6;
/// Points tried on faces and edges, times the surface's conditions (a formula's length grows with its kinks), before a
/// graph is given up. A can takes 4e4, three cylinders 1e5, a polyhedron of 20 faces 2e6; a hand of blended capsules,
/// whose kinks are all seams, would take a minute.
constexpr Index kMostWork = 5'000'000;
constexpr float kNone = std::numeric_limits<float>::infinity();

void insert_face(std::vector<int>& faces, int face) {
  if (std::find(faces.begin(), faces.end(), face) == faces.end()) faces.push_back(face);
}

/// Cubes are numbered by 21 bits a coordinate.
constexpr std::int64_t kMiddle = std::int64_t{1} << 20;
constexpr std::uint64_t kMask = (std::uint64_t{1} << 21) - 1;
constexpr std::uint64_t key_of(std::int64_t i, std::int64_t j, std::int64_t k) {
  const auto part = [](std::int64_t n) { return static_cast<std::uint64_t>(n + kMiddle) & kMask; };
  return part(i) << 42 | part(j) << 21 | part(k);
}
std::uint64_t moved(std::uint64_t key, int di, int dj, int dk) {
  const auto part = [&](int shift) { return static_cast<std::int64_t>(key >> shift & kMask) - kMiddle; };
  return key_of(part(42) + di, part(21) + dj, part(0) + dk);
}

/// The same step, for the node it comes to.
FacetLink reversed(const FacetLink& link, std::uint32_t from, const FacetNode& a, const FacetNode& b) {
  FacetLink back{from, link.length, 0};
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    if ((link.faces >> i & 1) == 0) continue;
    const auto at = std::find(b.faces.begin(), b.faces.end(), a.faces[i]) - b.faces.begin();
    back.faces |= std::uint32_t{1} << at;
  }
  return back;
}

}  // namespace

double cell_size_for(const FacetedSurface& surface, const Box& box, double cells, const Context& context) {
  constexpr double kFirstCells = 12;  // a side, for a first count
  const double first = box.extent().maxCoeff() / kFirstCells;
  const Index coarse = subdivide(surface.surface(), {.size = first, .box = box}, context).num_cells();
  return first * std::min(1.0, std::sqrt(static_cast<double>(coarse) / cells));
}

FacetGraph::FacetGraph(FacetedSurface& surface, const Box& box, double size, const Context& context)
    : box_(box), size_(size) {
  const CellGrid grid = subdivide(surface.surface(), {.size = size, .box = box}, context);
  size_ = grid.size();
  num_cells_ = grid.num_cells();
  std::vector<int> kinks;
  for (Index i = 0; i < grid.num_cells(); ++i) {
    if (i % 1024 == 0) context.check_cancelled();
    const Box cell = grid.box(i);
    surface.undecided(cell, kinks);
    fill_cell(surface, cell, kinks);
    if (num_projected_ * surface.num_conditions() > kMostWork) {
      complete_ = false;
      return;
    }
  }
  if (nodes_.empty()) throw EmptySurface("no surface point was found in the cells");
  link(surface);
}

const std::vector<std::uint32_t>* FacetGraph::Bins::at(std::uint64_t key) const {
  const auto found = index.find(key);
  return found == index.end() ? nullptr : &nodes[found->second];
}

std::uint64_t FacetGraph::bin_of(const Point3& x) const {
  const Point3 at = (x - Point3(box_.lower)) / (kReach * size_);
  return key_of(static_cast<std::int64_t>(std::floor(at.x())), static_cast<std::int64_t>(std::floor(at.y())),
                static_cast<std::int64_t>(std::floor(at.z())));
}

void FacetGraph::add(double scale, FacetNode node) {
  // Neighbouring cells find the same corner; and the same edge point where it lies between them.
  const double same = node.corner ? kSameCorner * scale : kSameNode * size_;
  std::array<std::uint64_t, 8> near;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Point3 shift((corner & 1) != 0 ? same : -same, (corner & 2) != 0 ? same : -same,
                       (corner & 4) != 0 ? same : -same);
    near[corner] = bin_of(node.x + shift);
    if (std::find(near.begin(), near.begin() + corner, near[corner]) != near.begin() + corner) continue;
    const std::vector<std::uint32_t>* bin = bins_.at(near[corner]);
    if (bin == nullptr) continue;
    for (const std::uint32_t other : *bin) {
      const FacetNode& known = nodes_[other];
      if (known.corner == node.corner && known.edge == node.edge && (known.x - node.x).squaredNorm() < same * same &&
          known.faces == node.faces) {
        return;
      }
    }
  }
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  if (!node.reflex.empty()) reflex_.push_back(number);
  const std::uint64_t key = bin_of(node.x);
  const auto [at, added] = bins_.index.try_emplace(key, static_cast<std::uint32_t>(bins_.nodes.size()));
  if (added) {
    bins_.keys.push_back(key);
    bins_.nodes.emplace_back();
  }
  bins_.nodes[at->second].push_back(number);
  nodes_.push_back(std::move(node));
}

/// From the centre, and if need be from the corners of the cell: a formula such as sqrt(max(z, 0)^2) - r has a second
/// sheet beyond its face, where a start on the wrong side ends.
template <class IsRight>
bool FacetGraph::find_point(FacetedSurface& surface, const Box& cell, int face, const std::vector<int>& conditions,
                            bool try_corners, const IsRight& is_right, Point3& x) {
  const Point3 centre = (cell.lower + cell.upper) / 2;
  const double near = kNearCell * size_;
  for (int start = -1; start < (try_corners ? 8 : 0); ++start) {
    if (start == 0) {
      // From corners only where the zero sets come near, to first order.
      Point3 gradient;
      const auto is_far = [&](double value) { return !(std::abs(value) <= kFarFromCell * size_ * gradient.norm()); };
      if (is_far(surface.function(face, centre, gradient))) return false;
      for (const int c : conditions) {
        if (is_far(surface.condition(c, centre, gradient))) return false;
      }
    }
    x = centre;
    for (int a = 0; start >= 0 && a < 3; ++a) x(a) = (start >> a & 1) != 0 ? cell.upper(a) : cell.lower(a);
    ++num_projected_;
    if (surface.project(face, conditions, x) && (x - centre).norm() <= near && is_right(x)) return true;
  }
  return false;
}

void FacetGraph::fill_cell(FacetedSurface& surface, const Box& cell, const std::vector<int>& kinks) {
  const Point3 centre = (cell.lower + cell.upper) / 2;
  const double on_edge = kOnEdge * surface.scale;
  const bool try_corners = !kinks.empty();
  std::vector<int> seen;
  Point3 x;
  const auto choices = surface.faces_near(centre, kinks);
  for (const auto& [face, sides] : choices) {
    if (std::find(seen.begin(), seen.end(), face) != seen.end()) continue;
    seen.push_back(face);
    const int wanted = face;
    if (find_point(
            surface, cell, face, {}, try_corners, [&](const Point3& at) { return surface.violation(wanted, at) == 0; },
            x)) {
      add(surface.scale, {x, {face}, -1, false});
    }
  }
  if (kinks.empty()) return;
  std::optional<Star> star;
  const auto add_star = [&](int edge, bool corner) {
    FacetNode node{x, {}, edge, corner};
    for (const Wedge& wedge : star->wedges) {
      insert_face(node.faces, wedge.face);
      if (corner && wedge.angle > std::numbers::pi + kReflex) insert_face(node.reflex, wedge.face);
    }
    std::sort(node.faces.begin(), node.faces.end());
    add(surface.scale, std::move(node));
  };
  const auto is_corner = [&] { return star->wedges.size() > 2 || (!star->closed && star->wedges.size() > 1); };
  std::set<std::pair<int, int>> edges;
  std::set<std::array<int, 3>> corners;
  for (const auto& [face, sides] : choices) {
    for (std::size_t i = 0; i < kinks.size(); ++i) {
      const int c = surface.smooth_condition(kinks[i], sides);
      if (edges.insert({face, c}).second && find_point(
                                                surface, cell, face, {c}, true,
                                                [&](const Point3& at) {
                                                  star = surface.star(at, on_edge);
                                                  return star && star->wedges.front().angle < kWholeTurn;
                                                },
                                                x)) {
        add_star(is_corner() ? -1 : star->wedges.front().second_edge, is_corner());
      }
      for (std::size_t j = 0; j < i; ++j) {
        const int other = surface.smooth_condition(kinks[j], sides);
        if (other == c || !corners.insert({face, std::min(c, other), std::max(c, other)}).second) continue;
        if (find_point(
                surface, cell, face, {c, other}, true,
                [&](const Point3& at) {
                  star = surface.star(at, on_edge);
                  // Closed with two wedges: the kinks do not meet in a corner of this face.
                  return star && star->wedges.front().angle < kWholeTurn && !(star->closed && star->wedges.size() == 2);
                },
                x)) {
          add_star(-1, true);
        }
      }
    }
  }
}

std::vector<FacetLink> FacetGraph::links_of(FacetedSurface& surface, const FacetNode& point, double reach) const {
  std::vector<FacetLink> found;
  const std::uint64_t middle = bin_of(point.x);
  const int wide = static_cast<int>(std::ceil(reach / (kReach * size_)));
  for (int di = -wide; di <= wide; ++di) {
    for (int dj = -wide; dj <= wide; ++dj) {
      for (int dk = -wide; dk <= wide; ++dk) {
        const std::vector<std::uint32_t>* bin = bins_.at(moved(middle, di, dj, dk));
        if (bin == nullptr) continue;
        for (const std::uint32_t other : *bin) {
          if ((nodes_[other].x - point.x).squaredNorm() > reach * reach) continue;
          FacetLink link = step_between(surface, point, nodes_[other]);
          if (link.length == kNone) continue;
          link.to = other;
          found.push_back(link);
        }
      }
    }
  }
  return found;
}

void FacetGraph::link(FacetedSurface& surface) {
  const double reach = kReach * size_;
  constexpr std::size_t kPairsPerNode = 12;  // of a plane; on edges there are more
  FacetSteps steps(surface, kPairsPerNode * nodes_.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // the earlier node first
  pairs.reserve(kPairsPerNode * nodes_.size());
  const auto join = [&](std::uint32_t i, std::uint32_t j) {
    if ((nodes_[j].x - nodes_[i].x).squaredNorm() > reach * reach) return;
    steps.add(nodes_[i], nodes_[j]);
    pairs.emplace_back(i, j);
  };
  for (std::size_t b = 0; b < bins_.nodes.size(); ++b) {
    const std::vector<std::uint32_t>& own = bins_.nodes[b];
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = i + 1; j < own.size(); ++j) join(own[i], own[j]);
    }
    // Half of the cubes around: the other half sees this one.
    for (int n = 14; n < 27; ++n) {
      const std::vector<std::uint32_t>* other = bins_.at(moved(bins_.keys[b], n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1));
      if (other == nullptr) continue;
      for (const std::uint32_t i : own) {
        for (const std::uint32_t j : *other) join(i, j);
      }
    }
  }
  const std::vector<FacetLink> links = steps.links();
  const auto for_each = [&](const auto& visit) {
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      if (links[k].length != kNone) visit(pairs[k].first, pairs[k].second, links[k]);
    }
  };
  first_.assign(nodes_.size() + 1, 0);
  for_each([&](std::uint32_t i, std::uint32_t j, const FacetLink&) {
    ++first_[i + 1];
    ++first_[j + 1];
  });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  links_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each([&](std::uint32_t i, std::uint32_t j, FacetLink link) {
    link.to = j;
    links_[next[i]++] = link;
    links_[next[j]++] = reversed(link, i, nodes_[i], nodes_[j]);
  });
}

}  // namespace taut::detail
