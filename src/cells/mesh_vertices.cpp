// Vertices of meshes onto the surface: Newton's method x -= F grad F / |grad F|^2 in blocks, all vertices of a block at
// a time; where it leaves the neighbourhood of its cell or does not converge, bisection of a crossed edge, which cannot
// fail, but may end at a pole of F instead of a zero: |F| there tells. On a domain's edge F and the nearest inequality
// are solved for together.
#include "cells/mesh_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "core/parallel.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

constexpr Index kBlock = 256;
constexpr int kMaxNewtonSteps = 12;
constexpr int kMaxBisections = 80;
/// How far outside its cell a vertex may lie, in cells.
constexpr double kCellMargin = 0.25;
/// At a zero found by bisection |F| has fallen below this part of its values at the edge's ends; at a pole it has
/// grown.
constexpr double kZeroDrop = 1e-3;

/// One vertex on its Newton way.
struct Walker {
  Index vertex;
  double last_step;
};

class VertexSettler {
 public:
  VertexSettler(const Surface& surface, const CellGrid& grid, double tolerance, CellVertices& vertices)
      : surface_(surface), grid_(grid), tolerance_(tolerance), vertices_(vertices), d_(surface.dim()) {}

  void run(Index first, Index last) {
    const std::unique_ptr<Evaluator> evaluator = surface_.make_evaluator();
    std::vector<Index> failed;
    newton(*evaluator, first, last, failed);
    if (!failed.empty()) bisect(*evaluator, failed);
  }

 private:
  /// The step below which F is rounding noise, model units.
  [[nodiscard]] double rounding(Index v) const {
    return 2 * std::numeric_limits<double>::epsilon() *
           (vertices_.points.col(v).lpNorm<Eigen::Infinity>() + grid_.size());
  }

  [[nodiscard]] bool near_its_cell(const Eigen::Ref<const Vector>& x, Index v) const {
    const auto cell = grid_.cell(vertices_.cell[static_cast<std::size_t>(v)]);
    for (Index a = 0; a < d_; ++a) {
      const double t = (x(a) - grid_.origin()(a)) / grid_.size() - cell[static_cast<std::size_t>(a)];
      if (!(t >= -kCellMargin && t <= 1 + kCellMargin)) return false;
    }
    return true;
  }

  void newton(Evaluator& evaluator, Index first, Index last, std::vector<Index>& failed) {
    std::vector<Walker> walkers;
    for (Index v = first; v < last; ++v) walkers.push_back({v, std::numeric_limits<double>::infinity()});
    Points x(d_, last - first);
    Points gradient(d_, last - first);
    Vector value(last - first);
    for (int step = 0; step <= kMaxNewtonSteps && !walkers.empty(); ++step) {
      const auto n = static_cast<Index>(walkers.size());
      for (Index j = 0; j < n; ++j) x.col(j) = vertices_.points.col(walkers[static_cast<std::size_t>(j)].vertex);
      evaluator.evaluate({.n = n, .x = x.data(), .value = value.data(), .jacobian = gradient.data()});
      std::size_t kept = 0;
      for (Index j = 0; j < n; ++j) {
        Walker walker = walkers[static_cast<std::size_t>(j)];
        const Index v = walker.vertex;
        const double slope = gradient.col(j).norm();
        const double length = std::abs(value(j)) / slope;
        // Near the end rounding takes over: steps stop shrinking although they are tiny.
        const bool stalled = length >= 0.5 * walker.last_step && length <= 1e-8 * grid_.size();
        const bool arrived = length <= std::max(tolerance_, rounding(v)) || stalled;
        if (arrived && slope > 0) {
          vertices_.normals.col(v) = gradient.col(j) / slope;
          vertices_.valid[static_cast<std::size_t>(v)] = 1;
          continue;
        }
        const bool moves = step < kMaxNewtonSteps && slope > 0 && length <= grid_.size();
        if (moves) vertices_.points.col(v) -= gradient.col(j) * (value(j) / slope / slope);
        if (!moves || !near_its_cell(vertices_.points.col(v), v)) {
          failed.push_back(v);
          continue;
        }
        walker.last_step = length;
        walkers[kept++] = walker;
      }
      walkers.resize(kept);
    }
  }

  void bisect(Evaluator& evaluator, const std::vector<Index>& failed) {
    const auto n = static_cast<Index>(failed.size());
    Points low(d_, n);
    Points high(d_, n);
    Points x(d_, n);
    Points gradient(d_, n);
    Vector value(n);
    for (Index j = 0; j < n; ++j) {
      low.col(j) = vertices_.inside.col(failed[static_cast<std::size_t>(j)]);
      high.col(j) = vertices_.outside.col(failed[static_cast<std::size_t>(j)]);
    }
    Vector start_value(n);
    evaluator.evaluate({.n = n, .x = low.data(), .value = start_value.data()});
    evaluator.evaluate({.n = n, .x = high.data(), .value = value.data()});
    start_value = start_value.cwiseAbs().cwiseMax(value.cwiseAbs());
    for (int i = 0; i < kMaxBisections; ++i) {
      x = 0.5 * (low + high);
      evaluator.evaluate({.n = n, .x = x.data(), .value = value.data()});
      for (Index j = 0; j < n; ++j) (value(j) < 0 ? low : high).col(j) = x.col(j);
    }
    x = high;
    evaluator.evaluate({.n = n, .x = x.data(), .value = value.data(), .jacobian = gradient.data()});
    for (Index j = 0; j < n; ++j) {
      const Index v = failed[static_cast<std::size_t>(j)];
      vertices_.points.col(v) = x.col(j);
      vertices_.valid[static_cast<std::size_t>(v)] = std::abs(value(j)) <= kZeroDrop * start_value(j) ? 1 : 0;
      const double slope = gradient.col(j).norm();
      // Where the gradient vanishes (an apex) the crossed edge itself still points outwards.
      if (slope > 0 && std::isfinite(slope)) {
        vertices_.normals.col(v) = gradient.col(j) / slope;
      } else {
        vertices_.normals.col(v) = (vertices_.outside.col(v) - vertices_.inside.col(v)).normalized();
      }
    }
  }

  const Surface& surface_;
  const CellGrid& grid_;
  double tolerance_;
  CellVertices& vertices_;
  Index d_;
};

/// One vertex on its way to the domain's edge, with F and the most violated (or, inside, the nearest) domain component.
bool step_to_edge(const Eigen::Ref<const Vector>& gradient, double value, const Eigen::Ref<const Vector>& edge_gradient,
                  double edge_value, Vector& step) {
  // Least-norm solution of [g; e] step = -[F; D], through the 2 x 2 Gram matrix.
  const double gg = gradient.squaredNorm();
  const double ge = gradient.dot(edge_gradient);
  const double ee = edge_gradient.squaredNorm();
  const double determinant = gg * ee - ge * ge;
  // The edge runs along the surface there: no point of it is better than another.
  if (!(determinant > 1e-12 * gg * ee)) return false;
  const double a = (-value * ee + edge_value * ge) / determinant;
  const double b = (-edge_value * gg + value * ge) / determinant;
  step = a * gradient + b * edge_gradient;
  return step.allFinite();
}

}  // namespace

void check_mesh_size(const CellGrid& grid) {
  constexpr Index kMostCells = std::numeric_limits<int>::max() / 8;
  if (grid.num_cells() <= kMostCells) return;
  throw OutOfMemory("a mesh is made of at most " + std::to_string(kMostCells) + " cells, not " +
                    std::to_string(grid.num_cells()) + ": take larger cells");
}

Vector evaluate_values(const ImplicitFunction& function, const Points& points, const Context& context) {
  Vector values(points.cols());
  parallel_for(context, 0, points.cols(), 4 * kBlock, [&](Index first, Index last) {
    function.make_evaluator()->evaluate(
        {.n = last - first, .x = points.col(first).data(), .value = values.data() + first});
  });
  return values;
}

double inside_level(const Vector& corner_values) {
  std::vector<double> size;
  size.reserve(static_cast<std::size_t>(corner_values.size()));
  for (const double value : corner_values) {
    if (std::isfinite(value)) size.push_back(std::abs(value));
  }
  if (size.empty()) return 0;
  const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
  std::nth_element(size.begin(), middle, size.end());
  // The median says what size F has, whatever its scale.
  return -1e-10 * *middle;
}

void settle_vertices(const Surface& surface, const CellGrid& grid, double tolerance, CellVertices& vertices,
                     const Context& context) {
  const Index n = vertices.points.cols();
  vertices.normals.resize(surface.dim(), n);
  vertices.valid.assign(static_cast<std::size_t>(n), 0);
  VertexSettler settler(surface, grid, tolerance, vertices);
  parallel_for(context, 0, n, kBlock, [&](Index first, Index last) { settler.run(first, last); });
}

void move_to_domain_edge(const Surface& surface, const std::vector<Index>& which, double reach, Points& points,
                         Points& normals, const Context& context) {
  const Index d = surface.dim();
  const ImplicitFunction& domain = *surface.domain();
  const Index m = domain.codim();
  const auto n = static_cast<Index>(which.size());
  parallel_for(context, 0, n, kBlock, [&](Index first, Index last) {
    const std::unique_ptr<Evaluator> evaluator = surface.make_evaluator();
    const std::unique_ptr<Evaluator> domain_evaluator = domain.make_evaluator();
    const Index count = last - first;
    Points x(d, count);
    for (Index j = 0; j < count; ++j) x.col(j) = points.col(which[static_cast<std::size_t>(first + j)]);
    Vector value(count);
    Points gradient(d, count);
    Points domain_value(m, count);
    Points domain_gradient(d * m, count);
    std::vector<char> moving(static_cast<std::size_t>(count), 1);
    std::vector<char> lost(static_cast<std::size_t>(count), 0);
    Vector step(d);
    for (int iteration = 0; iteration <= kMaxNewtonSteps; ++iteration) {
      evaluator->evaluate({.n = count, .x = x.data(), .value = value.data(), .jacobian = gradient.data()});
      domain_evaluator->evaluate(
          {.n = count, .x = x.data(), .value = domain_value.data(), .jacobian = domain_gradient.data()});
      for (Index j = 0; j < count; ++j) {
        if (moving[static_cast<std::size_t>(j)] == 0) continue;
        Index worst = 0;
        double worst_distance = std::numeric_limits<double>::infinity();
        for (Index i = 0; i < m; ++i) {
          const double distance = domain_value(i, j) / domain_gradient.col(j).segment(i * d, d).norm();
          if (distance < worst_distance) {
            worst_distance = distance;
            worst = i;
          }
        }
        const auto edge_gradient = domain_gradient.col(j).segment(worst * d, d);
        if (!step_to_edge(gradient.col(j), value(j), edge_gradient, domain_value(worst, j), step)) {
          lost[static_cast<std::size_t>(j)] = 1;
          moving[static_cast<std::size_t>(j)] = 0;
          continue;
        }
        x.col(j) += step;
        if (step.norm() <= 4 * std::numeric_limits<double>::epsilon() * (x.col(j).lpNorm<Eigen::Infinity>() + reach)) {
          moving[static_cast<std::size_t>(j)] = 0;
        }
      }
    }
    for (Index j = 0; j < count; ++j) {
      const Index v = which[static_cast<std::size_t>(first + j)];
      const double slope = gradient.col(j).norm();
      if (lost[static_cast<std::size_t>(j)] != 0 || !((x.col(j) - points.col(v)).norm() <= reach) || !(slope > 0))
        continue;
      points.col(v) = x.col(j);
      normals.col(v) = gradient.col(j) / slope;
    }
  });
}

}  // namespace taut::detail
