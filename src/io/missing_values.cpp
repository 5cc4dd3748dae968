// Points that stand for a missing value. Scanners and terrain programs write 0,0,0 or a number such as -9999 where they
// have none; one such point far from all others ruins a fit. Only these values are looked for, and only where they lie
// far outside: a sphere around the origin may well have a sample there.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "io/readers.hpp"

namespace taut::detail {
namespace {

constexpr std::array kMissing = {-9999.0, -99999.0, -999999.0, -32768.0, -32767.0};
constexpr double kBeyondAll = 1e30;  // 1e30, 1e38 and the largest float are in use
/// How far outside the box of all others, as a multiple of its longest edge.
constexpr double kFar = 10;
/// Fewer others make no cloud that a point could lie outside of.
constexpr Index kFewestOthers = 10;

bool may_be_missing(const VectorIn& point) {
  if (point.isZero(0)) return true;
  return std::any_of(point.begin(), point.end(), [](double x) {
    return std::abs(x) >= kBeyondAll || std::find(kMissing.begin(), kMissing.end(), x) != kMissing.end();
  });
}

}  // namespace

void drop_missing_values(const InputFile& file, PointCloud& cloud) {
  if (cloud.faces.cols() > 0) return;  // their corners are numbered
  const Index n = cloud.size();
  std::vector<Index> suspects;
  Vector lower = Vector::Constant(cloud.dim(), std::numeric_limits<double>::infinity());
  Vector upper = -lower;
  for (Index j = 0; j < n; ++j) {
    const auto point = cloud.points.col(j);
    if (may_be_missing(point)) {
      suspects.push_back(j);
    } else {
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
  }
  const Index num_others = n - static_cast<Index>(suspects.size());
  if (suspects.empty() || num_others < std::max(kFewestOthers, n / 2)) return;
  const double edge = (upper - lower).maxCoeff();
  const auto outside = [&](Index j) {
    const auto point = cloud.points.col(j);
    return (lower - point).cwiseMax(point - upper).maxCoeff();
  };
  std::erase_if(suspects, [&](Index j) { return outside(j) <= kFar * edge; });
  if (suspects.empty()) return;
  const Index first = suspects.front();
  const Vector shown = cloud.points.col(first);
  file.note(fmt::format(
      "point {} (from 0) is {:g}, {:.3g} away from all others, which lie within {:.3g}: {} for a "
      "missing value and left out; points behind it move up by one number{}",
      first, fmt::join(shown.begin(), shown.end(), ","), outside(first), edge,
      suspects.size() == 1 ? "taken" : fmt::format("this and {} more like it are taken", suspects.size() - 1),
      suspects.size() == 1 ? "" : " for each"));
  const bool normals = cloud.has_normals();
  Index kept = first;
  for (Index j = first, k = 0; j < n; ++j) {
    if (k < static_cast<Index>(suspects.size()) && suspects[static_cast<std::size_t>(k)] == j) {
      ++k;
      continue;
    }
    cloud.points.col(kept) = cloud.points.col(j);
    if (normals) cloud.normals.col(kept) = cloud.normals.col(j);
    ++kept;
  }
  cloud.points.conservativeResize(Eigen::NoChange, kept);
  if (normals) cloud.normals.conservativeResize(Eigen::NoChange, kept);
}

}  // namespace taut::detail
