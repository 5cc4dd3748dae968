// A* over the points of the cells. Steps lead to cells up to two away, where both normals say that they stay on one
// sheet (make_edge), and where the cubic between the two points that has the surface's tangents at its ends stays in
// the domain: looked at in so many places, unless both ends are farther from the border than the step is long.
#include "search/way_inside.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <queue>
#include <utility>
#include <vector>

#include "march/edge.hpp"
#include "surface/sign_evaluator.hpp"

namespace taut::detail {
namespace {

/// Steps are no longer than so many cells.
constexpr double kReach = 2.3;
constexpr std::int32_t kAround = 2;
/// Places looked at on a step: so many a cell.
constexpr double kLooksPerCell = 8;
/// Beyond the border by this part of a cell is rounding: points pulled to the border lie as far outside.
constexpr double kSlack = 0.01;
constexpr double kFar = std::numeric_limits<double>::infinity();

using Point3 = Eigen::Vector3d;

class InsideSearch {
 public:
  InsideSearch(const Surface& surface, const SurfaceCells& cells, const Vector& p, const Vector& q)
      : surface_(surface),
        cells_(cells),
        domain_(surface.domain()->make_evaluator()),
        num_domain_(surface.domain()->codim()),
        size_(cells.grid().size()),
        first_(cells.num_cells()),
        count_(cells.num_cells() + 2) {
    for (int end = 0; end < 2; ++end) {
      ends_[end] = end == 0 ? p : q;
      normals_[end] = Point3(surface.jacobian(ends_[end])).normalized();
    }
    distance_.assign(static_cast<std::size_t>(count_), kFar);
    from_.assign(static_cast<std::size_t>(count_), -1);
    room_.assign(static_cast<std::size_t>(count_), std::numeric_limits<double>::quiet_NaN());
  }

  [[nodiscard]] std::optional<StartPath> run(const Context& context) {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const Index source = first_;
    const Index target = first_ + 1;
    distance_[static_cast<std::size_t>(source)] = 0;
    open.emplace(0, source);
    std::vector<bool> done(static_cast<std::size_t>(count_), false);
    Index visited = 0;
    constexpr Index kBetweenChecks = 1024;
    while (!open.empty()) {
      const Index at = open.top().second;
      open.pop();
      if (done[static_cast<std::size_t>(at)]) continue;
      done[static_cast<std::size_t>(at)] = true;
      if (at == target) return trace(target);
      if (++visited % kBetweenChecks == 0) context.check_cancelled();
      const auto offer = [&](Index to) {
        if (done[static_cast<std::size_t>(to)] || to == at) return;
        if ((point(to) - point(at)).squaredNorm() > kReach * kReach * size_ * size_) return;
        Edge<3> edge;
        if (!make_edge<3, 1>({point(at).data(), normal(at).data()}, {point(to).data(), normal(to).data()}, 3, 1, edge))
          return;
        const double there = distance_[static_cast<std::size_t>(at)] + edge.length;
        if (!(there < distance_[static_cast<std::size_t>(to)]) || !stays_inside(at, to)) return;
        distance_[static_cast<std::size_t>(to)] = there;
        from_[static_cast<std::size_t>(to)] = at;
        open.emplace(there + (point(to) - ends_[1]).norm(), to);
      };
      std::array<std::int32_t, 3> middle{};
      for (std::size_t a = 0; a < 3; ++a) {
        const double in_cells =
            (point(at)(static_cast<Index>(a)) - cells_.grid().origin()(static_cast<Index>(a))) / size_;
        middle[a] = static_cast<std::int32_t>(std::floor(in_cells));
      }
      std::array<std::int32_t, 3> cell{};
      for (cell[0] = middle[0] - kAround; cell[0] <= middle[0] + kAround; ++cell[0]) {
        for (cell[1] = middle[1] - kAround; cell[1] <= middle[1] + kAround; ++cell[1]) {
          for (cell[2] = middle[2] - kAround; cell[2] <= middle[2] + kAround; ++cell[2]) {
            const Index to = cells_.grid().find(cell);
            if (to != CellGrid::kNone && cells_.valid(to)) offer(to);
          }
        }
      }
      offer(target);
    }
    return std::nullopt;
  }

 private:
  [[nodiscard]] Eigen::Map<const Point3> point(Index i) const {
    return Eigen::Map<const Point3>(i < first_ ? cells_.point(i).data() : ends_[i - first_].data());
  }
  [[nodiscard]] Eigen::Map<const Point3> normal(Index i) const {
    return Eigen::Map<const Point3>(i < first_ ? cells_.normals(i).data() : normals_[i - first_].data());
  }

  /// How far x is from the border, to first order; negative outside.
  [[nodiscard]] double room_at(const Point3& x) {
    value_.resize(num_domain_);
    gradient_.resize(3, num_domain_);
    domain_->evaluate({.n = 1, .x = x.data(), .value = value_.data(), .jacobian = gradient_.data()});
    double least = kFar;
    for (Index m = 0; m < num_domain_; ++m) {
      least = std::min(least, value_(m) / std::max(gradient_.col(m).norm(), 1e-300));
    }
    return least;
  }
  [[nodiscard]] double room(Index i) {
    double& known = room_[static_cast<std::size_t>(i)];
    if (std::isnan(known)) known = room_at(point(i));
    return known;
  }

  [[nodiscard]] bool stays_inside(Index from, Index to) {
    const Point3 a = point(from);
    const Point3 e = point(to) - a;
    const double length = e.norm();
    if (std::min(room(from), room(to)) > length) return true;
    const Point3 out = e - e.dot(normal(from)) * normal(from);
    const Point3 in = e - e.dot(normal(to)) * normal(to);
    const int looks = 1 + static_cast<int>(kLooksPerCell * length / size_);
    for (int k = 1; k < looks; ++k) {
      const double t = static_cast<double>(k) / looks;
      const double s = 1 - t;
      const Point3 x = a + t * t * (3 - 2 * t) * e + t * s * s * out - t * t * s * in;
      bool inside = false;
      are_nonnegative(*domain_, num_domain_, 1, x.data(), &inside);
      if (!inside && room_at(x) < -kSlack * size_) return false;
    }
    return true;
  }

  [[nodiscard]] StartPath trace(Index target) const {
    std::vector<Index> way;
    for (Index at = target; at >= 0; at = from_[static_cast<std::size_t>(at)]) way.push_back(at);
    StartPath path;
    path.length = distance_[static_cast<std::size_t>(target)];
    path.points.resize(3, static_cast<Index>(way.size()));
    for (std::size_t k = 0; k < way.size(); ++k) {
      path.points.col(static_cast<Index>(k)) = point(way[way.size() - 1 - k]);
    }
    return path;
  }

  const Surface& surface_;
  const SurfaceCells& cells_;
  std::unique_ptr<Evaluator> domain_;
  Index num_domain_;
  double size_;
  Index first_;  // the number of cells: p and q come after them
  Index count_;
  std::array<Point3, 2> ends_;
  std::array<Point3, 2> normals_;
  std::vector<double> distance_;
  std::vector<Index> from_;
  std::vector<double> room_;  // NaN: not known yet
  Vector value_;
  Points gradient_;
};

}  // namespace

std::optional<StartPath> way_inside(const Surface& surface, const SurfaceCells& cells, const Vector& p, const Vector& q,
                                    const Context& context) {
  return InsideSearch(surface, cells, p, q).run(context);
}

}  // namespace taut::detail
