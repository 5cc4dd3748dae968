// Starts from parts of known geodesics: up to where one comes near another, and from there along that one. Stations at
// sixteen equal parts stand for a curve, so that all pairs cost some hundreds of distances each. Corners at the bridge
// are left to the correction.
#include "search/splices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "curve/polyline.hpp"
#include "march/point_normals.hpp"
#include "surface/normal_angle.hpp"

namespace taut::detail {
namespace {

constexpr Index kStations = 16;
/// Two geodesics come near each other where they are closer than this part of how far apart they are before and after.
constexpr double kNear = 0.5;
/// One is left for the other this many stations before and after.
constexpr Index kBridge = 1;
/// A splice that never strays this many stations from a known geodesic is that one.
constexpr double kSameWay = 0.75;
constexpr std::size_t kMostSplices = 4;

struct Track {
  double length;
  Points stations;  // d x (kStations + 1), at equal parts of the length
};

/// Squared distances between the stations of a and those of b.
Eigen::MatrixXd distances2(const Points& a, const Points& b) {
  Eigen::MatrixXd result(a.cols(), b.cols());
  for (Index j = 0; j < b.cols(); ++j) {
    result.col(j).setZero();
    for (Index axis = 0; axis < a.rows(); ++axis) {
      result.col(j).array() += (a.row(axis).transpose().array() - b(axis, j)).square();
    }
  }
  return result;
}

/// Where `first` comes near `second`.
struct Crossing {
  Index i, j;  // stations of the first and of the second
  double gap;
};

/// Crossings by the squared distances from the stations of the first (rows) to those of the second.
std::vector<Crossing> crossings(const Eigen::MatrixXd& distance2) {
  std::vector<Crossing> found;
  std::array<double, kStations + 1> gap2;
  std::array<Index, kStations + 1> partner;
  for (Index i = 0; i <= kStations; ++i) gap2[i] = distance2.row(i).minCoeff(&partner[i]);
  for (Index i = kBridge + 1; i + kBridge < kStations; ++i) {
    const Index j = partner[i];
    if (gap2[i] > gap2[i - 1] || gap2[i] >= gap2[i + 1] || j - kBridge < 1 || j + kBridge >= kStations) continue;
    const auto here = gap2.begin() + i;
    const double apart2 = std::min(*std::max_element(gap2.begin(), here), *std::max_element(here, gap2.end()));
    if (gap2[i] <= kNear * kNear * apart2) found.push_back({i, j, std::sqrt(gap2[i])});
  }
  return found;
}

/// The first track up to the crossing, then the second.
StartPath splice(const Track& first, const Track& second, const Crossing& at) {
  constexpr double kStation = 1.0 / kStations;
  const Index before = at.i - kBridge;
  const Index after = kStations - at.j - kBridge;
  // From a station before the crossing to one behind it: along both curves, and across the gap.
  const double bridge = std::hypot((first.length + second.length) * kStation * kBridge, at.gap);
  StartPath path;
  path.length =
      (first.length * static_cast<double>(before) + second.length * static_cast<double>(after)) * kStation + bridge;
  path.points.resize(first.stations.rows(), before + after + 2);
  path.points << first.stations.leftCols(before + 1), second.stations.rightCols(after + 1);
  return path;
}

/// Do both tracks run on the same side of the body where they come near each other?
bool on_same_side(const Surface& surface, const Track& first, const Track& second, const Crossing& at) {
  Points x(surface.dim(), 2);
  x << first.stations.col(at.i), second.stations.col(at.j);
  const Points normals = normals_at(surface, x);
  const auto basis = [&](Index column) {
    return Eigen::Map<const Points>(normals.col(column).data(), surface.dim(), surface.codim());
  };
  return same_side(basis(0), basis(1));
}

bool keeps_near(const StartPath& path, const Track& track) {
  const double far = kSameWay * path.length / static_cast<double>(kStations);
  return distances2(path.points, track.stations).rowwise().minCoeff().maxCoeff() < far * far;
}

}  // namespace

std::vector<StartPath> splices(const Surface& surface, const std::vector<PathCandidate>& geodesics, double most) {
  std::vector<StartPath> found;
  if (geodesics.size() < 2) return found;
  std::vector<Track> tracks;
  for (const PathCandidate& geodesic : geodesics) {
    tracks.push_back({geodesic.length, at_equal_parts(geodesic.points, kStations)});
  }
  const auto add = [&](const Track& first, const Track& second, const Eigen::MatrixXd& distance2) {
    for (const Crossing& at : crossings(distance2)) {
      StartPath path = splice(first, second, at);
      const auto known = [&](const Track& track) { return keeps_near(path, track); };
      if (path.length > most || std::ranges::any_of(tracks, known) || !on_same_side(surface, first, second, at))
        continue;
      found.push_back(std::move(path));
    }
  };
  for (auto first = tracks.begin(); first != tracks.end(); ++first) {
    for (auto second = std::next(first); second != tracks.end(); ++second) {
      const Eigen::MatrixXd distance2 = distances2(first->stations, second->stations);
      add(*first, *second, distance2);
      add(*second, *first, distance2.transpose());
    }
  }
  std::ranges::stable_sort(found, {}, &StartPath::length);
  if (found.size() > kMostSplices) found.resize(kMostSplices);
  return found;
}

}  // namespace taut::detail
