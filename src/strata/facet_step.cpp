// A step on a face leads over the foot of its chord's middle, which must lie on the face and near the chord. The feet
// of many steps are found together: three of Newton's steps take them there but where the face bends as much as a step
// is long, and those are looked at one by one.
#include "strata/facet_step.hpp"

#include <algorithm>
#include <cmath>

namespace taut::detail {
namespace {

/// Beyond its face, the middle of a step along an edge may reach by this part of its length, since edges are curved;
/// that of another step by the second part: it must not cut a corner that reaches into the face.
constexpr double kBeyondEdge = 0.15;
constexpr double kBeyond = 0.03;
/// The foot of a step's middle is no farther, of its length, ...
constexpr double kFarFoot = 0.6;
/// ... and known to this part of it: so much less than what steps are wrong by.
constexpr double kFootError = 1e-4;
constexpr int kFootSteps = 3;
/// Steps tried at a time: as many as fit into the cache next to the formula's intermediate values.
constexpr std::size_t kBlock = 256;
constexpr float kNone = std::numeric_limits<float>::infinity();

double beyond(const FacetNode& a, const FacetNode& b) {
  return a.edge >= 0 && a.edge == b.edge ? kBeyondEdge : kBeyond;
}

/// By the foot of its middle: the length of a step of this chord, infinite where it is none.
float length_over(const Point3& foot, const Point3& a, const Point3& b) {
  const double chord = (b - a).norm();
  if ((foot - (a + b) / 2).norm() > kFarFoot * chord) return kNone;
  const double length = (foot - a).norm() + (b - foot).norm();
  return length > FacetSteps::kLongStep * chord ? kNone : static_cast<float>(length);
}

float step_on(FacetedSurface& surface, int face, const FacetNode& a, const FacetNode& b) {
  const double chord = (b.x - a.x).norm();
  if (chord == 0) return 0;
  Point3 foot = (a.x + b.x) / 2;
  if (!surface.project(face, {}, foot)) return kNone;
  const float length = length_over(foot, a.x, b.x);
  return length != kNone && surface.violation(face, foot) <= beyond(a, b) * chord ? length : kNone;
}

/// over(face, bit) for each face that both nodes lie on.
template <class Over>
void for_common_faces(const FacetNode& a, const FacetNode& b, const Over& over) {
  constexpr std::size_t kBits = 32;
  for (std::size_t i = 0; i < std::min(a.faces.size(), kBits); ++i) {
    const auto other = std::find(b.faces.begin(), b.faces.end(), a.faces[i]) - b.faces.begin();
    if (static_cast<std::size_t>(other) >= std::min(b.faces.size(), kBits)) continue;
    over(a.faces[i], std::uint32_t{1} << i);
  }
}

void add_step(float length, std::uint32_t bit, FacetLink& link) {
  if (length == kNone) return;
  link.faces |= bit;
  link.length = std::min(link.length, length);
}

}  // namespace

FacetLink step_between(FacetedSurface& surface, const FacetNode& a, const FacetNode& b) {
  FacetLink link;
  for_common_faces(a, b, [&](int face, std::uint32_t bit) { add_step(step_on(surface, face, a, b), bit, link); });
  return link;
}

void FacetSteps::add(const FacetNode& a, const FacetNode& b) {
  const auto number = static_cast<std::uint32_t>(links_.size());
  links_.emplace_back();
  for_common_faces(a, b, [&](int face, std::uint32_t bit) {
    const auto at = static_cast<std::size_t>(face);
    if (trials_.size() <= at) trials_.resize(at + 1);
    trials_[at].push_back({number, bit, &a, &b});
    if (trials_[at].size() == kBlock) try_block(face);
  });
}

std::vector<FacetLink> FacetSteps::links() {
  for (std::size_t face = 0; face < trials_.size(); ++face) try_block(static_cast<int>(face));
  return std::move(links_);
}

void FacetSteps::try_block(int face) {
  std::vector<Trial>& trials = trials_[static_cast<std::size_t>(face)];
  const auto count = static_cast<Index>(trials.size());
  Points foot(3, count);
  for (Index j = 0; j < count; ++j) {
    const Trial& trial = trials[static_cast<std::size_t>(j)];
    foot.col(j) = (trial.a->x + trial.b->x) / 2;
  }
  const bool flat = surface_.face(face).flat.has_value();
  Vector value;
  Points gradient;
  Vector moved(count);
  for (int step = 0; step < (flat ? 1 : kFootSteps); ++step) {
    surface_.functions(face, foot, value, gradient);
    for (Index j = 0; j < count; ++j) {
      const Point3 change = gradient.col(j) * (value(j) / gradient.col(j).squaredNorm());
      foot.col(j) -= change;
      moved(j) = flat ? 0 : change.norm();
    }
  }
  std::vector<bool> outside(static_cast<std::size_t>(count), false);
  for (const Index j : surface_.not_inside(face, foot)) outside[static_cast<std::size_t>(j)] = true;
  for (Index j = 0; j < count; ++j) {
    const Trial& trial = trials[static_cast<std::size_t>(j)];
    const double chord = (trial.b->x - trial.a->x).norm();
    FacetLink& link = links_[trial.link];
    if (!(moved(j) <= kFootError * chord)) {
      add_step(step_on(surface_, face, *trial.a, *trial.b), trial.bit, link);
      continue;
    }
    const float length = chord > 0 ? length_over(foot.col(j), trial.a->x, trial.b->x) : 0;
    if (length == kNone) continue;
    if (outside[static_cast<std::size_t>(j)] && chord > 0 &&
        !(surface_.violation(face, foot.col(j)) <= beyond(*trial.a, *trial.b) * chord)) {
      continue;
    }
    add_step(length, trial.bit, link);
  }
  trials.clear();
}

}  // namespace taut::detail
