// Charts for chart_march.cpp: at every valid cell an orthonormal basis of the tangent plane (d x 2), right-handed about
// the normals, and the edges from all neighbours unrolled into it. The geometry of an edge is that of make_edge() and
// ArrivalSolver::unroll(), by the same rules, for kLanes neighbours at once in single precision. What a march takes
// from it: where the neighbour lies (2 numbers), and the rotation of its chart into this one (2 numbers).
//
// A record of a cell holds its integer coordinates apart from where its point lies in it. Differences of the former are
// exact, so that chords keep all digits, however far from the origin. Everything is laid out in whole lanes; links are
// filled up with a cell that no march settles.
#include "march/surface_charts.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/parallel.hpp"
#include "march/dimensions.hpp"
#include "march/lanes.hpp"
#include "march/tangent_coordinates.hpp"

namespace taut::detail {
namespace {

std::size_t in_lanes(std::size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// A link while the links of a cell are collected.
struct Link {
  std::uint32_t cell;
  float numbers[4];
};

/// The edges from kLanes cells y to a cell x, as Edge and as unrolled.
struct LaneEdges {
  Ints joined;
  Floats numbers[4];  // as those of ChartLinks
};

/// Of points as SurfaceCharts records them. D and K as constants where they are.
template <int D, int K>
class LaneGeometry {
 public:
  LaneGeometry(std::size_t d, std::size_t k) : d_(d), k_(k) {}

  [[nodiscard]] std::size_t dim() const { return D == Eigen::Dynamic ? d_ : static_cast<std::size_t>(D); }
  [[nodiscard]] std::size_t codim() const { return K == Eigen::Dynamic ? k_ : static_cast<std::size_t>(K); }
  [[nodiscard]] std::size_t num_fields() const { return in_lanes(dim() * (codim() + 4)); }

  static constexpr std::size_t kMostFields =
      D == Eigen::Dynamic ? kMaxMarchDim * (kMaxMarchDim + 4) : (D * (K + 4) + kLanes - 1) / kLanes * kLanes;
  using Fields = Floats[kMostFields];

  /// make_edge and ArrivalSolver::unroll, with the same rules.
  [[nodiscard]] LaneEdges unroll(const Fields& y, const Fields& x) const {
    const std::size_t d = dim();
    const std::size_t k = codim();
    Floats chord[D == Eigen::Dynamic ? kMaxMarchDim : D];
    Floats chord2 = all_lanes(0);
    for (std::size_t a = 0; a < d; ++a) {
      chord[a] = (x[a] - y[a]) + (x[d + a] - y[d + a]);
      chord2 += chord[a] * chord[a];
    }
    const auto along = [&](const Fields& of, std::size_t at) {
      Floats sum = of[at] * chord[0];
      for (std::size_t a = 1; a < d; ++a) sum += of[at + a] * chord[a];
      return sum;
    };
    Floats part2_y;  // as in make_edge
    Floats part2_x;
    Floats product;
    Floats parts;
    LaneEdges edges;
    if constexpr (K == 1) {
      const Floats cosine = dot(y, 2 * d, x, 2 * d);
      const Floats part_y = along(y, 2 * d);
      const Floats part_x = along(x, 2 * d);
      part2_y = part_y * part_y;
      part2_x = part_x * part_x;
      product = part_y * part_x * cosine;
      parts = abs(part_y) + abs(part_x);
      edges.joined = cosine > static_cast<float>(kMinNormalCosine);
    } else {
      part2_y = part2_x = product = all_lanes(0);
      Floats cosine2 = all_lanes(0);
      for (std::size_t i = 0; i < k; ++i) {
        const Floats part_y = along(y, (2 + i) * d);
        const Floats part_x = along(x, (2 + i) * d);
        part2_y += part_y * part_y;
        part2_x += part_x * part_x;
        for (std::size_t j = 0; j < k; ++j) {
          const Floats cosine = dot(y, (2 + i) * d, x, (2 + j) * d);
          cosine2 += cosine * cosine;
          product += part_y * cosine * along(x, (2 + j) * d);
        }
      }
      parts = sqrt(part2_y) + sqrt(part2_x);
      // For k = 1 the cosine of the normals has its sign; a basis of more has none.
      // Of right-handed frames about normals that point the same way.
      const std::size_t first = (2 + k) * d;
      const std::size_t second = (3 + k) * d;
      const Floats overlap =
          dot(x, first, y, first) * dot(x, second, y, second) - dot(x, first, y, second) * dot(x, second, y, first);
      const auto least_cosine2 = static_cast<float>(static_cast<double>(k) - 1 + kMinNormalCosine * kMinNormalCosine);
      edges.joined = (overlap > 0) & (cosine2 > least_cosine2);
    }
    // The directions of the edge in the charts of x and y.
    Floats here[2] = {along(x, (2 + k) * d), along(x, (3 + k) * d)};
    Floats there[2] = {along(y, (2 + k) * d), along(y, (3 + k) * d)};
    normalise(here);
    normalise(there);
    const Floats chord_length = sqrt(chord2);
    const Floats allowed =
        static_cast<float>(kMaxJump) * parts + static_cast<float>(kMaxCurvatureChange) * chord_length;
    edges.joined &= part2_y + part2_x + 2 * product <= allowed * allowed;
    constexpr float kTiny = 1e-30F;
    const Floats bend = (2 * part2_y - product + 2 * part2_x) / (30 * chord2 + kTiny);
    const Floats length = chord_length * (1 + bend * (1 + 2.7F * bend));
    // z, and the rotation that takes the edge's direction at y to its direction at x: parallel transport along the
    // edge.
    edges.numbers[0] = -length * here[0];
    edges.numbers[1] = -length * here[1];
    edges.numbers[2] = here[0] * there[0] + here[1] * there[1];
    edges.numbers[3] = there[0] * here[1] - there[1] * here[0];
    return edges;
  }

 private:
  /// Of vectors among the fields of x and y.
  [[nodiscard]] Floats dot(const Fields& x, std::size_t at_x, const Fields& y, std::size_t at_y) const {
    Floats sum = x[at_x] * y[at_y];
    for (std::size_t a = 1; a < dim(); ++a) sum += x[at_x + a] * y[at_y + a];
    return sum;
  }
  /// Zero stays zero.
  static void normalise(Floats (&v)[2]) {
    const Floats per_norm = inverse_sqrt(v[0] * v[0] + v[1] * v[1]);
    v[0] *= per_norm;
    v[1] *= per_norm;
  }

  std::size_t d_;
  std::size_t k_;
};

}  // namespace

SurfaceCharts::SurfaceCharts(const SurfaceCells& cells, const AnyNeighbourIndex& neighbours, const Context& context)
    : cells_(cells), blocks_(static_cast<std::size_t>((cells.num_cells() + kBlock - 1) / kBlock)) {
  const auto d = static_cast<std::size_t>(cells.dim());
  const auto k = static_cast<std::size_t>(cells.codim());
  record_size_ = in_lanes(d * (k + 4));
  axes_at_ = d * (k + 2);
  records_.resize(static_cast<std::size_t>(cells.num_cells()) * record_size_);
  with_dimensions(cells.dim(), cells.codim(), [&]<int D, int K>() {
    const auto for_all = [&](const auto& body) { parallel_for(context, 0, cells.num_cells(), kBlock, body); };
    for_all([&](Index first, Index last) { fill_records<D, K>(first, last); });
    for_all([&](Index first, Index last) {
      link<D, K>(static_cast<const NeighbourIndex<D>&>(neighbours), first, last,
                 blocks_[static_cast<std::size_t>(first / kBlock)]);
    });
  });
  for (const Block& block : blocks_) {
    for (std::size_t i = 1; i < block.first.size(); ++i) {
      most_links_ = std::max<std::size_t>(most_links_, block.first[i] - block.first[i - 1]);
    }
  }
}

template <int D, int K>
void SurfaceCharts::fill_records(Index first, Index last) {
  const Index d = cells_.dim();
  const Index k = cells_.codim();
  const double h = cells_.grid().size();
  // Only how cells lie to each other counts. Far from the origin their own numbers are beyond single precision.
  const std::int32_t* base = cells_.grid().cell(0).data();
  TangentCoordinates<D, K> frame(d, k);
  for (Index i = first; i < last; ++i) {
    if (!cells_.valid(i)) continue;
    float* to = record(i);
    const std::int32_t* cell = cells_.grid().cell(i).data();
    const double* x = cells_.point(i).data();
    for (Index a = 0; a < d; ++a) *to++ = static_cast<float>(cell[a] - base[a]);
    for (Index a = 0; a < d; ++a) *to++ = static_cast<float>((x[a] - cells_.grid().face(a, cell[a])) / h);
    const auto normals = cells_.normals(i);
    for (Index n = 0; n < d * k; ++n) *to++ = static_cast<float>(normals.data()[n]);
    frame.set(normals.data());
    for (Index axis = 0; axis < 2; ++axis) {
      // Householder frames come in both orientations. Turning over one axis makes all alike, so that rotations suffice.
      const double sign = axis == 1 ? frame.handedness() : 1.0;
      const SmallVector<D> lifted = frame.lift(SmallVector<D>(sign * SmallVector<D>::Unit(d, k + axis)));
      for (Index a = 0; a < d; ++a) *to++ = static_cast<float>(lifted(a));
    }
  }
}

template <int D, int K>
void SurfaceCharts::link(const NeighbourIndex<D>& neighbours, Index first, Index last, Block& block) const {
  using Geometry = LaneGeometry<D, K>;
  const Geometry geometry(static_cast<std::size_t>(cells_.dim()), static_cast<std::size_t>(cells_.codim()));
  const std::size_t num_fields = geometry.num_fields();
  typename Geometry::Fields here;
  typename Geometry::Fields there;
  std::vector<Index> around;
  std::vector<Link> links;
  const auto none = static_cast<std::uint32_t>(cells_.num_cells());
  constexpr std::size_t kTypicalLinks = 20;  // and what they are filled up with
  block.first.reserve(static_cast<std::size_t>(last - first) + 1);
  block.linked.reserve(kTypicalLinks * static_cast<std::size_t>(last - first));
  block.numbers.reserve(kTypicalLinks * kNumbers * static_cast<std::size_t>(last - first));
  block.first.push_back(0);
  for (Index i = first; i < last; ++i) {
    links.clear();
    if (cells_.valid(i)) {
      neighbours.around(i, around);
      // Without the cell itself, which then fills up the last lanes and is left out again below.
      around.erase(std::ranges::find(around, i));
      around.resize(in_lanes(around.size()), i);
      for (std::size_t f = 0; f < num_fields; ++f) here[f] = all_lanes(record(i)[f]);
      for (std::size_t l = 0; l < around.size(); l += kLanes) {
        for (std::size_t f = 0; f < num_fields; f += kLanes) {
          for (std::size_t lane = 0; lane < kLanes; ++lane) there[f + lane] = load(record(around[l + lane]) + f);
          transpose(there[f], there[f + 1], there[f + 2], there[f + 3]);
        }
        LaneEdges edges = geometry.unroll(there, here);
        transpose(edges.numbers[0], edges.numbers[1], edges.numbers[2], edges.numbers[3]);
        for (unsigned joined = bits(edges.joined); joined != 0; joined &= joined - 1) {
          const auto lane = static_cast<std::size_t>(std::countr_zero(joined));
          if (around[l + lane] == i) continue;
          Link& link = links.emplace_back();
          link.cell = static_cast<std::uint32_t>(around[l + lane]);
          store(edges.numbers[lane], link.numbers);
        }
      }
    }
    const std::size_t n = in_lanes(links.size());
    links.resize(n, {none, {0, 0, 0, 0}});
    block.linked.resize(block.linked.size() + n);
    block.numbers.resize(kNumbers * block.linked.size());
    std::uint32_t* linked = block.linked.data() + block.first.back();
    float* numbers = block.numbers.data() + kNumbers * block.first.back();
    for (std::size_t l = 0; l < n; ++l) {
      linked[l] = links[l].cell;
      // From a link's four numbers to four rows of all links: gather() loads kLanes links at once.
      for (std::size_t m = 0; m < kNumbers; ++m) numbers[m * n + l] = links[l].numbers[m];
    }
    block.first.push_back(static_cast<std::uint32_t>(block.linked.size()));
  }
}

std::optional<std::pair<float, Eigen::Vector2f>> SurfaceCharts::edge(const SurfacePoint& from, Index x,
                                                                     double radius) const {
  using Result = std::optional<std::pair<float, Eigen::Vector2f>>;
  return with_dimensions(cells_.dim(), cells_.codim(), [&]<int D, int K>() -> Result {
    Edge<D> edge;
    const SurfacePoint to{cells_.point(x).data(), cells_.normals(x).data()};
    if (!make_edge<D, K>(from, to, cells_.dim(), cells_.codim(), edge) || edge.chord.norm() > radius * cell_size()) {
      return std::nullopt;
    }
    const Eigen::Vector2f direction = axes(x).transpose() * edge.chord.template cast<float>();
    const float norm = direction.norm();
    return std::pair(static_cast<float>(edge.length / cell_size()),
                     norm > 0 ? Eigen::Vector2f(direction / norm) : direction);
  });
}

}  // namespace taut::detail
