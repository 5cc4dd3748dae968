#include "surface/formula/solids.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

// Bodies as functions in formulas: F < 0 inside, F = 0 on the surface. Each becomes nodes of the graph that every other
// formula is made of, so derivatives, bounds and the faces and edges of min, max and abs come by themselves.
//
// Smooth operations. A blend of two bodies has to be C^2 for Newton's method and for geodesics to be smooth, so the
// usual polynomial blends, which are C^1 and act within a strip only, do not serve. Instead of max(a, b) there is
//   (a + b + sqrt((a - b)^2 + 2 r^2)) / 2,
// analytic everywhere. It vanishes where a b = r^2 / 2: of two planes at right angles that is a hyperbola whose least
// radius of curvature, on the diagonal, is r. Farther off, where |a - b| = D, the surface moves by r^2 / (2 D).

namespace taut::detail {
namespace {

using Arguments = std::span<const NodeId>;
using Place = std::array<NodeId, 3>;
constexpr std::size_t kAnyNumber = 1U << 20;

Place coordinates(Graph& g) { return {g.variable(0), g.variable(1), g.variable(2)}; }

Place minus(Graph& g, const Place& a, const Place& b) {
  return {g.subtract(a[0], b[0]), g.subtract(a[1], b[1]), g.subtract(a[2], b[2])};
}

/// The coordinates seen from the point that the first three arguments are.
Place from(Graph& g, Arguments a) { return minus(g, coordinates(g), {a[0], a[1], a[2]}); }

/// Without what is multiplied by 0, which the graph would keep.
NodeId dot(Graph& g, const Place& a, const Place& b) {
  std::vector<NodeId> terms;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!g.is_constant(a[i], 0) && !g.is_constant(b[i], 0)) terms.push_back(g.multiply(a[i], b[i]));
  }
  return g.sum(terms);
}

NodeId length(Graph& g, const Place& a) { return g.unary(Op::sqrt, dot(g, a, a)); }

NodeId around_z(Graph& g, const Place& p) { return g.unary(Op::sqrt, g.add(g.square(p[0]), g.square(p[1]))); }

NodeId half(Graph& g, NodeId a) { return g.multiply(a, g.constant(0.5)); }

NodeId most(Graph& g, NodeId a, NodeId b) { return g.binary(Op::maximum, a, b); }

NodeId sphere(Graph& g, Arguments a) { return g.subtract(length(g, from(g, a)), a[3]); }

NodeId box(Graph& g, Arguments a) {
  const Place p = from(g, a);
  Place over{};
  for (std::size_t i = 0; i < 3; ++i) over[i] = g.subtract(g.unary(Op::absolute, p[i]), half(g, a[3 + i]));
  return most(g, most(g, over[0], over[1]), over[2]);
}

NodeId cylinder(Graph& g, Arguments a) {
  const Place p = from(g, a);
  const NodeId side = g.subtract(around_z(g, p), a[3]);
  return most(g, side, g.subtract(g.unary(Op::absolute, p[2]), half(g, a[4])));
}

/// rho / r + z / h = 1, times the distance that this is steep by.
NodeId cone(Graph& g, Arguments a) {
  const Place p = from(g, a);
  const NodeId slope = g.divide(a[3], a[4]);
  const NodeId over = g.subtract(g.add(around_z(g, p), g.multiply(p[2], slope)), a[3]);
  const NodeId steepness = g.unary(Op::sqrt, g.add(g.square(slope), g.constant(1)));
  return most(g, g.divide(over, steepness), g.negate(p[2]));
}

NodeId torus(Graph& g, Arguments a) {
  const Place p = from(g, a);
  const NodeId across = g.subtract(around_z(g, p), a[3]);
  return g.subtract(g.unary(Op::sqrt, g.add(g.square(across), g.square(p[2]))), a[4]);
}

NodeId plane(Graph& g, Arguments a) {
  const Place normal = {a[0], a[1], a[2]};
  return g.divide(g.subtract(dot(g, normal, coordinates(g)), a[3]), length(g, normal));
}

/// The distance to the segment between two points: where its ends begin, the curvature jumps.
NodeId capsule(Graph& g, Arguments a) {
  const Place p = from(g, a);
  const Place axis = minus(g, {a[3], a[4], a[5]}, {a[0], a[1], a[2]});
  const NodeId along = g.divide(dot(g, p, axis), dot(g, axis, axis));
  const NodeId clamped = g.binary(Op::minimum, most(g, along, g.constant(0)), g.constant(1));
  Place away{};
  for (std::size_t i = 0; i < 3; ++i) {
    away[i] = g.is_constant(axis[i], 0) ? p[i] : g.subtract(p[i], g.multiply(clamped, axis[i]));
  }
  return g.subtract(length(g, away), a[6]);
}

template <class Two>
NodeId folded(Arguments a, const Two& two) {
  NodeId result = a[0];
  for (std::size_t i = 1; i < a.size(); ++i) result = two(result, a[i]);
  return result;
}

NodeId unite(Graph& g, Arguments a) {
  return folded(a, [&](NodeId x, NodeId y) { return g.binary(Op::minimum, x, y); });
}
NodeId intersect(Graph& g, Arguments a) {
  return folded(a, [&](NodeId x, NodeId y) { return most(g, x, y); });
}
NodeId subtract(Graph& g, Arguments a) {
  return folded(a, [&](NodeId x, NodeId y) { return most(g, x, g.negate(y)); });
}

/// The smooth greater one of two, see above.
NodeId smooth_most(Graph& g, NodeId a, NodeId b, NodeId radius) {
  const NodeId apart = g.add(g.square(g.subtract(a, b)), g.multiply(g.square(radius), g.constant(2)));
  return half(g, g.add(g.add(a, b), g.unary(Op::sqrt, apart)));
}
NodeId smooth_unite(Graph& g, Arguments a) {
  return folded(a.first(a.size() - 1),
                [&](NodeId x, NodeId y) { return g.negate(smooth_most(g, g.negate(x), g.negate(y), a.back())); });
}
NodeId smooth_intersect(Graph& g, Arguments a) {
  return folded(a.first(a.size() - 1), [&](NodeId x, NodeId y) { return smooth_most(g, x, y, a.back()); });
}
NodeId smooth_subtract(Graph& g, Arguments a) {
  return folded(a.first(a.size() - 1), [&](NodeId x, NodeId y) { return smooth_most(g, x, g.negate(y), a.back()); });
}

/// `root` with other expressions for x, y and z.
NodeId replaced(Graph& g, NodeId root, const Place& by) {
  const std::vector<NodeId> nodes = g.reachable({root});
  std::vector<NodeId> now(root + 1, kNoNode);
  for (const NodeId id : nodes) {
    const Node node = g[id];
    const int operands = operand_count(node.op);
    if (node.op == Op::variable && node.a < 3) {
      now[id] = by[node.a];
    } else if (operands == 0) {
      now[id] = id;
    } else if (node.op == Op::odd_power) {  // its exponent is no node
      now[id] = g.power(now[node.a], g.constant(node.b));
    } else if (operands == 1) {
      now[id] = g.unary(node.op, now[node.a]);
    } else {
      now[id] = g.binary(node.op, now[node.a], now[node.b]);
    }
  }
  return now[root];
}

NodeId translate(Graph& g, Arguments a) { return replaced(g, a[0], minus(g, coordinates(g), {a[1], a[2], a[3]})); }

/// A sine or cosine that is 0 or 1 but for rounding, as those of quarter turns are, becomes that.
NodeId tidy(Graph& g, NodeId a) {
  constexpr double kRounding = 4e-16;
  if (!g.is_constant(a)) return a;
  const double nearest = std::round(g[a].value);
  return std::abs(g[a].value - nearest) < kRounding ? g.constant(nearest) : a;
}

/// F(R^T x) with Rodrigues' R = cos I + (1 - cos) u u^T + sin [u]x.
NodeId rotate(Graph& g, Arguments a) {
  const NodeId norm = length(g, {a[1], a[2], a[3]});
  Place u{};
  for (std::size_t i = 0; i < 3; ++i) u[i] = g.divide(a[1 + i], norm);
  const NodeId c = tidy(g, g.unary(Op::cos, a[4]));
  const NodeId s = tidy(g, g.unary(Op::sin, a[4]));
  const NodeId rest = g.subtract(g.constant(1), c);
  const Place x = coordinates(g);
  Place turned{};
  for (std::size_t i = 0; i < 3; ++i) {
    Place column{};  // of R, entry j: R_ji
    for (std::size_t j = 0; j < 3; ++j) {
      column[j] = g.multiply(rest, g.multiply(u[j], u[i]));
      if (i == j) column[j] = g.add(column[j], c);
      if (i == j) continue;
      const NodeId turn = g.multiply(s, u[3 - i - j]);  // [u]x_ji is -u_k for (j, i, k) in cyclic order, else +u_k
      column[j] = (j + 1) % 3 == i ? g.subtract(column[j], turn) : g.add(column[j], turn);
    }
    for (NodeId& entry : column) entry = tidy(g, entry);
    turned[i] = dot(g, column, x);
  }
  return replaced(g, a[0], turned);
}

/// Times the least factor: what was no longer than a distance stays so.
NodeId scale(Graph& g, Arguments a) {
  const Place factor = a.size() == 2 ? Place{a[1], a[1], a[1]} : Place{a[1], a[2], a[3]};
  Place x = coordinates(g);
  for (std::size_t i = 0; i < 3; ++i) x[i] = g.divide(x[i], factor[i]);
  NodeId least = factor[0];
  for (std::size_t i = 1; i < 3; ++i) least = g.binary(Op::minimum, least, factor[i]);
  return g.multiply(replaced(g, a[0], x), least);
}

constexpr std::uint32_t bits(std::initializer_list<unsigned> places) {
  std::uint32_t mask = 0;
  for (const unsigned place : places) mask |= 1U << place;
  return mask;
}

constexpr SolidFunction kSolids[] = {
    {"sphere", "x, y, z, r", 4, 4, bits({3}), sphere},
    {"box", "x, y, z, width, depth, height", 6, 6, bits({3, 4, 5}), box},
    {"cylinder", "x, y, z, r, height", 5, 5, bits({3, 4}), cylinder},
    {"cone", "x, y, z, r, height", 5, 5, bits({3, 4}), cone},
    {"torus", "x, y, z, R, r", 5, 5, bits({3, 4}), torus},
    {"plane", "nx, ny, nz, d", 4, 4, 0, plane},
    {"capsule", "x1, y1, z1, x2, y2, z2, r", 7, 7, bits({6}), capsule},
    {"union", "a, b, ...", 1, kAnyNumber, 0, unite},
    {"intersection", "a, b, ...", 1, kAnyNumber, 0, intersect},
    {"difference", "a, b, ...", 2, kAnyNumber, 0, subtract},
    {"smooth_union", "a, b, ..., r", 3, kAnyNumber, SolidFunction::kLast, smooth_unite},
    {"smooth_intersection", "a, b, ..., r", 3, kAnyNumber, SolidFunction::kLast, smooth_intersect},
    {"smooth_difference", "a, b, ..., r", 3, kAnyNumber, SolidFunction::kLast, smooth_subtract},
    {"translate", "a, x, y, z", 4, 4, 0, translate},
    {"rotate", "a, ux, uy, uz, angle", 5, 5, 0, rotate},
    {"scale", "a, s or a, sx, sy, sz", 2, 4, bits({1, 2, 3}), scale},
};

}  // namespace

std::span<const SolidFunction> solid_functions() { return kSolids; }

const SolidFunction* find_solid_function(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kSolids), std::end(kSolids),
                                         [&](const SolidFunction& solid) { return solid.name == name; });
  return found == std::end(kSolids) ? nullptr : found;
}

}  // namespace taut::detail
