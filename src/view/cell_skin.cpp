#include "view/cell_skin.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <vector>

namespace taut::detail {
namespace {

/// A cell's place on the lattice of the first one, in 21 bits an axis.
std::int64_t key_of(const Eigen::Vector3i& place) {
  constexpr int kMiddle = 1 << 20;
  std::int64_t key = 0;
  for (const int k : place) key = (key << 21) | ((k + kMiddle) & ((1 << 21) - 1));
  return key;
}

struct Side {
  Index cell;
  int axis;
  int sign;
};

}  // namespace

CellSkin make_cell_skin(const Stage& stage) {
  const Index n = stage.cell_centres.cols();
  std::vector<Eigen::Vector3i> places(static_cast<std::size_t>(n));
  std::unordered_set<std::int64_t> taken;
  for (Index c = 0; c < n; ++c) {
    const Eigen::Vector3f steps = (stage.cell_centres.col(c) - stage.cell_centres.col(0)) / stage.cell_size;
    Eigen::Vector3i& place = places[static_cast<std::size_t>(c)];
    for (Index a = 0; a < 3; ++a) place(a) = static_cast<int>(std::lround(steps(a)));
    taken.insert(key_of(place));
  }
  std::vector<Side> sides;
  for (Index c = 0; c < n; ++c) {
    if (stage.flat) {
      sides.push_back({c, 2, 1});
      continue;
    }
    for (int axis = 0; axis < 3; ++axis) {
      for (const int sign : {-1, 1}) {
        Eigen::Vector3i beyond = places[static_cast<std::size_t>(c)];
        beyond(axis) += sign;
        if (!taken.contains(key_of(beyond))) sides.push_back({c, axis, sign});
      }
    }
  }
  const auto m = static_cast<Index>(sides.size());
  CellSkin skin{Eigen::Matrix3Xf(3, 4 * m), Eigen::Matrix3Xf(3, 4 * m), Eigen::Matrix3Xi(3, 2 * m),
                Eigen::Matrix2Xi(2, 4 * m)};
  const float half = 0.5F * stage.cell_size;
  constexpr std::array<std::array<float, 2>, 4> kCorners = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
  for (Index i = 0; i < m; ++i) {
    const Side& side = sides[static_cast<std::size_t>(i)];
    const Eigen::Vector3f normal = static_cast<float>(side.sign) * Eigen::Vector3f::Unit(side.axis);
    const int first = static_cast<int>(4 * i);
    for (int k = 0; k < 4; ++k) {
      Eigen::Vector3f corner = stage.cell_centres.col(side.cell);
      if (!stage.flat) corner += half * normal;
      corner((side.axis + 1) % 3) += half * kCorners[static_cast<std::size_t>(k)][0];
      corner((side.axis + 2) % 3) += half * kCorners[static_cast<std::size_t>(k)][1];
      skin.positions.col(first + k) = corner;
      skin.normals.col(first + k) = normal;
      skin.edges.col(first + k) << first + k, first + (k + 1) % 4;
    }
    skin.faces.col(2 * i) << first, first + 1, first + 2;
    skin.faces.col(2 * i + 1) << first, first + 2, first + 3;
  }
  return skin;
}

}  // namespace taut::detail
