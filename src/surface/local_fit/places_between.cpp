// A mesh says more than its vertices: there is surface over each of its faces. Where a face is large beside what its
// corners speak for, or the surface arches over it, balls around its corners do not hold all of that; larger ones
// would, but would hold bubbles beside the sheet as well. So such a face is divided into k^2 triangles like itself, and
// the surface over the middle of each speaks for it. It is found by Newton's method on F, straight down on the face, or
// along the gradient where that does not lead to it (over a sliver, say).
#include "surface/local_fit/places_between.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "core/parallel.hpp"
#include "surface/local_fit/support_radii.hpp"

namespace taut::detail {
namespace {

/// Lengths in the longest edge of a face, if nothing else is said. Chosen by components, Euler numbers and boundaries
/// of eleven meshes on cells of two sizes (docs/measured/scans.md).
struct PlaceRules {
  double margin = 0.25;  ///< a point is covered where a corner says so much: 1 at itself, 0 where it ends alone
  double flat = 0.1;     ///< radians: where normals of corners and face differ by less, only its middle is asked about
  double radius = 0.75;  ///< of a place, in the edge of its small triangle, whose corners are at most 0.58 away; with 1
                         ///< bubbles come back
  double turn = 0.35;    ///< radians: a small triangle takes so much of the corners' turn
  int most = 12;         ///< small triangles along an edge
  double arch = 0.25;    ///< the surface is sought so far from a face
  double slope = 0.3;    ///< cosine between gradient and descent: beyond, the surface is none over this face
  int steps = 10;        ///< of Newton's method
  double close = 1e-3;   ///< the last step; places need not be on the surface to the last bit
};
constexpr PlaceRules kRules;

/// Where an arched face is looked at: barycentric coordinates of its middle, of the middles of its sides, and beside
/// them.
const std::array<Eigen::Vector3d, 7> kAsked = {Eigen::Vector3d::Constant(1.0 / 3), Eigen::Vector3d(0, 0.5, 0.5),
                                               Eigen::Vector3d(0.5, 0, 0.5),       Eigen::Vector3d(0.5, 0.5, 0),
                                               Eigen::Vector3d(0.5, 0.25, 0.25),   Eigen::Vector3d(0.25, 0.5, 0.25),
                                               Eigen::Vector3d(0.25, 0.25, 0.5)};

constexpr Index kGrain = 1024;

struct Place {
  Eigen::Vector3d at;
  Eigen::Vector3d normal;
  double radius;
};

class FaceFiller {
 public:
  FaceFiller(OrientedSamples samples, const Vector& support, const ImplicitFunction& function)
      : samples_(samples), support_(support), evaluator_(function.make_evaluator()) {}

  /// Appends the places that a face needs.
  void fill(const std::array<Index, 3>& corners, std::vector<Place>& places) {
    for (int i = 0; i < 3; ++i) {
      corner_.col(i) = samples_.points.col(corners[static_cast<std::size_t>(i)]);
      corner_normal_.col(i) = samples_.normals.col(corners[static_cast<std::size_t>(i)]);
      reach_(i) = support_(corners[static_cast<std::size_t>(i)]);
    }
    const Eigen::Vector3d across = (corner_.col(1) - corner_.col(0)).cross(corner_.col(2) - corner_.col(0));
    longest_ = std::max({(corner_.col(1) - corner_.col(0)).norm(), (corner_.col(2) - corner_.col(1)).norm(),
                         (corner_.col(0) - corner_.col(2)).norm()});
    normal_ = across.normalized();
    if (!(across.norm() > 0)) return;
    if (corner_normal_.rowwise().sum().dot(normal_) < 0) normal_ = -normal_;  // wound the other way round
    turn_ = std::acos(std::clamp((corner_normal_.transpose() * normal_).minCoeff(), -1.0, 1.0));
    if (covered()) return;
    divide(places);
  }

 private:
  /// Flat faces are asked about their middle. Over others the surface is looked for, at places along the sides, too.
  [[nodiscard]] bool covered() const {
    if (turn_ <= kRules.flat) return word(corner_.rowwise().mean()) >= kRules.margin;
    for (const Eigen::Vector3d& w : kAsked) {
      std::optional<Place> place = descend(corner_ * w, true);
      if (!place) place = descend(corner_ * w, false);
      if (!place || word(place->at) < kRules.margin) return false;
    }
    return true;
  }

  /// What the corner says that says most: 1 at itself, 0 where it ends alone.
  [[nodiscard]] double word(const Eigen::Vector3d& x) const {
    double most = -1;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d away = x - corner_.col(i);
      const double along = away.dot(corner_normal_.col(i));
      const double squared = away.squaredNorm() + (kFlatnessOfMesh * kFlatnessOfMesh - 1) * along * along;
      most = std::max(most, 1 - squared / (reach_(i) * reach_(i)));
    }
    return most;
  }

  void divide(std::vector<Place>& places) {
    const double by_reach = kRules.radius * longest_ / reach_.mean();
    const int k = static_cast<int>(
        std::clamp(std::ceil(std::max(by_reach, turn_ / kRules.turn)), 1.0, static_cast<double>(kRules.most)));
    const Eigen::Vector3d u = (corner_.col(1) - corner_.col(0)) / k;
    const Eigen::Vector3d v = (corner_.col(2) - corner_.col(0)) / k;
    for (int i = 0; i < k; ++i) {
      for (int j = 0; i + j < k; ++j) {
        const Eigen::Vector3d corner = corner_.col(0) + i * u + j * v;
        seek(corner + (u + v) / 3, k, places);
        if (i + j + 1 < k) seek(corner + (u + v) * (2.0 / 3), k, places);
      }
    }
  }

  /// The surface near x, straight down where that leads on, else along the gradient; no farther away than an arch.
  void seek(const Eigen::Vector3d& x, int k, std::vector<Place>& places) const {
    std::optional<Place> place = descend(x, true);
    if (!place) place = descend(x, false);
    if (!place) return;
    place->radius = kRules.radius * longest_ / k;
    places.push_back(*place);
  }

  /// F = 0 near x; none where another sheet would be met.
  [[nodiscard]] std::optional<Place> descend(const Eigen::Vector3d& from, bool straight) const {
    Eigen::Vector3d x = from;
    for (int step = 0; step < kRules.steps; ++step) {
      double value = 0;
      Eigen::Vector3d gradient;
      evaluator_->evaluate({.n = 1, .x = x.data(), .value = &value, .jacobian = gradient.data()});
      const Eigen::Vector3d along = straight ? normal_ : gradient.normalized();
      const double slope = gradient.dot(along);
      if (!(slope > kRules.slope * gradient.norm())) return std::nullopt;
      x -= value / slope * along;
      if (!((x - from).norm() <= kRules.arch * longest_)) return std::nullopt;
      if (std::abs(value / slope) <= kRules.close * longest_) return Place{x, gradient.normalized(), 0};
    }
    return std::nullopt;
  }

  OrientedSamples samples_;
  const Vector& support_;
  std::unique_ptr<Evaluator> evaluator_;
  Eigen::Matrix3d corner_, corner_normal_;
  Eigen::Vector3d reach_, normal_;
  double longest_ = 0;
  double turn_ = 0;  // of the corners' normals, at most
};

}  // namespace

SupportPlaces places_between(const FacedSamples& mesh, const Vector& support, const ImplicitFunction& function,
                             const Context& context) {
  const Points& points = mesh.samples.points;
  const Eigen::Matrix3Xi& faces = mesh.faces;
  std::vector<std::vector<Place>> blocks(static_cast<std::size_t>((faces.cols() + kGrain - 1) / kGrain));
  parallel_for(context, 0, faces.cols(), kGrain, [&](Index first, Index last) {
    FaceFiller filler(mesh.samples, support, function);
    for (Index f = first; f < last; ++f) {
      std::array<Index, 3> corners{};
      for (int i = 0; i < 3; ++i)
        corners[static_cast<std::size_t>(i)] = mesh.merged_to[static_cast<std::size_t>(faces(i, f))];
      filler.fill(corners, blocks[static_cast<std::size_t>(f / kGrain)]);
    }
  });
  Index count = 0;
  for (const std::vector<Place>& block : blocks) count += static_cast<Index>(block.size());
  SupportPlaces result{Points(points.rows(), count), Points(points.rows(), count), Vector(count)};
  Index at = 0;
  for (const std::vector<Place>& block : blocks) {
    for (const Place& place : block) {
      result.points.col(at) = place.at;
      result.normals.col(at) = place.normal;
      result.radius(at++) = place.radius;
    }
  }
  return result;
}

}  // namespace taut::detail
