#include "view/path_runs.hpp"

#include <algorithm>
#include <cmath>

namespace taut::detail {
namespace {

constexpr double kStep = 1.5;    // pixels between the places asked about
constexpr double kShortest = 6;  // pixels
constexpr double kPointSpacing = 0.8;

struct Place {
  Eigen::Vector2d pixel;
  bool hidden;
};

std::vector<Place> sample(const Eigen::Matrix3Xf& path, const Camera& camera, const DepthImage& depth, double lift) {
  std::vector<Place> places;
  const auto add = [&](const Eigen::Vector3d& x) {
    const Seen seen = camera.see(x);
    const Eigen::Vector2d pixel(seen.x, seen.y);
    if (!places.empty() && (places.back().pixel - pixel).norm() < kPointSpacing) return;
    places.push_back({pixel, depth.hides({seen.x, seen.y, camera.see(x + lift * camera.towards_viewer(x)).nearness})});
  };
  for (Index i = 0; i + 1 < path.cols(); ++i) {
    const Eigen::Vector3d a = path.col(i).cast<double>();
    const Eigen::Vector3d b = path.col(i + 1).cast<double>();
    const Seen from = camera.see(a);
    const Seen to = camera.see(b);
    const int pieces = std::clamp(static_cast<int>(std::hypot(to.x - from.x, to.y - from.y) / kStep), 1, 20000);
    for (int k = 0; k < pieces; ++k) add(a + (b - a) * k / pieces);
  }
  add(path.col(path.cols() - 1).cast<double>());
  return places;
}

/// Gives stretches shorter than kShortest the state of what lies before them (the first: of what lies after).
void smooth(std::vector<Place>& places) {
  std::size_t start = 0;
  while (start < places.size()) {
    std::size_t end = start;
    double length = 0;
    while (end + 1 < places.size() && places[end + 1].hidden == places[start].hidden) {
      length += (places[end + 1].pixel - places[end].pixel).norm();
      ++end;
    }
    const bool whole = start == 0 && end + 1 == places.size();
    if (length < kShortest && !whole) {
      const bool state = start > 0 ? places[start - 1].hidden : places[end + 1].hidden;
      for (std::size_t i = start; i <= end; ++i) places[i].hidden = state;
    }
    start = end + 1;
  }
}

}  // namespace

std::vector<PathRun> cut_path(const Eigen::Matrix3Xf& path, const Camera& camera, const DepthImage& depth,
                              double lift) {
  std::vector<PathRun> runs;
  if (path.cols() < 2) return runs;
  std::vector<Place> places = sample(path, camera, depth, lift);
  smooth(places);
  for (const Place& place : places) {
    if (runs.empty() || runs.back().hidden != place.hidden) {
      PathRun run{.hidden = place.hidden, .pixels = {}};
      if (!runs.empty()) {
        runs.back().pixels.push_back(place.pixel);
      }
      runs.push_back(std::move(run));
    }
    runs.back().pixels.push_back(place.pixel);
  }
  std::erase_if(runs, [](const PathRun& run) { return run.pixels.size() < 2; });
  return runs;
}

}  // namespace taut::detail
