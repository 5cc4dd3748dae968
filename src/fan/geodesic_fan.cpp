#include "taut/fan/geodesic_fan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <numbers>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "fan/exp_patch.hpp"
#include "fan/patch_index.hpp"
#include "fan/strip_stepper.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using detail::ExpPatch;
using detail::PatchFrame;
using detail::PatchHit;
using detail::RayStrip;
using detail::StripStepper;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Strips round a source at first. A quarter turn is known to 1e-12 on kRays rays.
constexpr int kStartStrips = 8;
/// Part of the tolerance that a panel's series may leave out. Errors of neighbouring panels do not add up (each
/// begins with true rays), those of a row of splits do.
constexpr double kShare = 0.1;
/// Steps shorter than this part of max_panel are not tried: a crease, a singular point.
constexpr double kLeastStep = 1e-5;
/// Attempts for one strip in one round, all that it is split into together. The rim of an ellipsoid 1:1:0.02 takes some
/// hundred; a seam across which curvature jumps would take millions.
constexpr int kMostAttempts = 4000;

/// What became of one strip in one round.
struct Outcome {
  std::vector<std::pair<PatchFrame, ExpPatch>> patches;
  std::vector<RayStrip> strips;
  double broken_at = kInfinity;
  Index num_evaluated = 0;
};

}  // namespace

struct GeodesicFan::Impl {
  Surface surface;
  FanOptions options;
  double scale = 0;  // largest coordinate, model units: what rounding is measured by
  struct Source {
    Eigen::Vector3d x;
    Eigen::Vector3d first, second;  // tangent frame: angle 0 and a quarter turn
    double value;
    double bend;  // largest principal curvature
  };
  std::vector<Source> sources;
  std::vector<RayStrip> strips;  // that go on
  std::vector<PatchFrame> frames;
  std::vector<ExpPatch> patches;
  detail::PatchIndex index;
  double broken_at = kInfinity;
  Index num_evaluated = 0;

  explicit Impl(const Surface& s, const FanOptions& o) : surface(s), options(o) {}

  [[nodiscard]] bool spent() const { return static_cast<Index>(patches.size()) >= options.max_patches; }

  [[nodiscard]] double front() const {
    double least = kInfinity;
    for (const RayStrip& strip : strips) least = std::min(least, strip.distance());
    return least;
  }

  /// Where patch p has q, if it has.
  [[nodiscard]] bool invert(std::size_t p, const Eigen::Vector3d& q, PatchHit& hit) const {
    const ExpPatch& patch = patches[p];
    if (patch.length > 0) return detail::invert(frames[p], patch, q, hit);
    // Round a source the panels are polar: the direction of q is the first guess, not what holds in their middle.
    const Source& source = sources[static_cast<std::size_t>(patch.source)];
    const Eigen::Vector3d r = q - source.x;
    const double angle = std::atan2(r.dot(source.second), r.dot(source.first));
    const double alpha = std::remainder(angle - patch.angle, 2 * std::numbers::pi) / patch.half;
    constexpr double kMost = 1.5;
    if (std::abs(alpha) > kMost) return false;
    return detail::invert(patch, q, alpha, std::min(1.0, 2 * r.norm() / patch.step - 1), hit);
  }

  /// A shorter geodesic than `bound` meets x.
  [[nodiscard]] bool met_below(const Eigen::Vector3d& x, double bound, std::int64_t except) const {
    bool met = false;
    index.near(x, [&](std::int32_t i) {
      const std::size_t p = static_cast<std::size_t>(i);
      if (frames[p].start >= bound || i == except || !detail::may_hold(frames[p], x)) return true;
      PatchHit hit;
      met = invert(p, x, hit) && hit.distance + hit.error < bound;
      return !met;
    });
    return met;
  }

  /// No shortest way goes on along any ray of the strip: cases (1) and (2) of the class comment.
  [[nodiscard]] bool is_over(const RayStrip& strip) const {
    if (strip.length == 0) return false;
    if ((strip.jacobi < 0).all()) return true;
    const auto& node = detail::PanelBasis::tables().ray;
    const double front_speed = 1.1 * strip.half * strip.jacobi.abs().maxCoeff();  // of the front, per alpha
    const auto passed = [&](int i) {
      const double before = i == 0 ? node(0) + 1 : (node(i) - node(i - 1)) / 2;
      const double after = i + 1 == detail::kRays ? 1 - node(i) : (node(i + 1) - node(i)) / 2;
      const double apart = front_speed * std::max(before, after);
      const double slack = strip.error + 16 * kEpsilon * scale + 1e-12 * strip.length;
      return met_below(strip.x.segment<3>(3 * i), strip.distance() - apart - slack, strip.parent);
    };
    constexpr int kMiddle = detail::kRays / 2;
    if (!passed(kMiddle) || !passed(0) || !passed(detail::kRays - 1)) return false;
    for (int i = 1; i + 1 < detail::kRays; ++i) {
      if (i != kMiddle && !passed(i)) return false;
    }
    return true;
  }

  /// Follows a strip until all that came of it has passed `until`.
  void follow(const RayStrip& begin, double until, StripStepper& stepper, Outcome& outcome) const {
    if (is_over(begin)) return;
    const Index evaluated = stepper.num_evaluated;
    std::vector<RayStrip> stack{begin};
    int attempts = 0;
    while (!stack.empty()) {
      // The hindmost first: where rays break off, their first break is found before much is spent on later ones.
      std::swap(*std::ranges::min_element(stack, {}, &RayStrip::length), stack.back());
      RayStrip strip = std::move(stack.back());
      stack.pop_back();
      // Beyond the first break nothing can be proved any more.
      if (strip.distance() >= std::min(until, outcome.broken_at)) {
        outcome.strips.push_back(std::move(strip));
        continue;
      }
      double h = std::min(strip.step, options.max_panel);
      while (true) {
        if (++attempts > kMostAttempts || h < kLeastStep * options.max_panel) {
          outcome.broken_at = std::min(outcome.broken_at, strip.distance());
          break;
        }
        const double tolerance = std::max(kShare * options.tolerance * (strip.length + h), 32 * kEpsilon * scale);
        const auto verdict = stepper.attempt(strip, h, tolerance);
        if (verdict != StripStepper::Verdict::good) {
          // Which of the two it is, length or width, is not told: take turns by size.
          const double width = strip.width();
          if (width > h && divide(strip, h, stepper, stack)) break;
          h *= 0.5;
          continue;
        }
        constexpr double kOrder = detail::kSeries;
        const double along = std::pow(tolerance / std::max(stepper.error_along, 1e-300), 1 / kOrder);
        if (stepper.error_along > tolerance) {
          h *= std::clamp(0.9 * along, 0.25, 0.85);
          continue;
        }
        const double off = 10 * tolerance + 1e-13 * stepper.width;
        const bool narrow = stepper.error_across <= tolerance && stepper.width <= options.max_panel &&
                            stepper.off_surface <= off &&
                            stepper.mismatch <= 300 * tolerance + 1e-12 * (stepper.width + scale);
        if (!narrow) {
          if (2 * stepper.width > h && divide(strip, h, stepper, stack)) break;
          h *= 0.5;
          continue;
        }
        auto [frame, patch] = stepper.patch(strip);
        stepper.arrive(strip);
        strip.step = std::min(options.max_panel, h * std::clamp(0.9 * along, 0.5, 2.0));
        strip.parent = -2 - static_cast<std::int64_t>(outcome.patches.size());
        outcome.patches.emplace_back(frame, patch);
        stack.push_back(std::move(strip));
        break;
      }
    }
    outcome.num_evaluated += stepper.num_evaluated - evaluated;
  }

  static bool divide(const RayStrip& strip, double step, StripStepper& stepper, std::vector<RayStrip>& stack) {
    RayStrip lower;
    RayStrip upper;
    if (!stepper.split(strip, lower, upper)) return false;
    lower.step = upper.step = step;
    stack.push_back(std::move(upper));
    stack.push_back(std::move(lower));
    return true;
  }

  /// Carries the hindmost strips on by about a step. Strips see only the patches of earlier rounds, so that neither
  /// their order nor the number of threads matters.
  void advance(const Context& context) {
    const double from = front();
    double mean = 0;
    for (const RayStrip& strip : strips) mean += strip.step / static_cast<double>(strips.size());
    const double until = from + mean;
    std::vector<RayStrip> chosen;
    std::vector<RayStrip> rest;
    for (RayStrip& strip : strips) (strip.distance() < until ? chosen : rest).push_back(std::move(strip));
    std::vector<Outcome> outcomes(chosen.size());
    constexpr Index kGrain = 4;
    detail::parallel_for(context, 0, static_cast<Index>(chosen.size()), kGrain, [&](Index begin, Index end) {
      StripStepper stepper(surface);
      for (Index i = begin; i < end; ++i) {
        const std::size_t s = static_cast<std::size_t>(i);
        follow(chosen[s], until, stepper, outcomes[s]);
      }
    });
    strips = std::move(rest);
    for (Outcome& outcome : outcomes) {
      const std::int64_t base = static_cast<std::int64_t>(patches.size());
      for (auto& [frame, patch] : outcome.patches) {
        index.add(frame, static_cast<std::int32_t>(patches.size()));
        frames.push_back(frame);
        patches.push_back(patch);
      }
      for (RayStrip& strip : outcome.strips) {
        if (strip.parent < -1) strip.parent = base - 2 - strip.parent;
        strips.push_back(std::move(strip));
      }
      broken_at = std::min(broken_at, outcome.broken_at);
      num_evaluated += outcome.num_evaluated;
    }
  }

  [[nodiscard]] FanHit locate(const Eigen::Vector3d& q) const {
    PatchHit best;
    best.distance = kInfinity;
    std::int32_t source = -1;
    // Beside a source, where d - |q - p| = curvature^2 |q - p|^3 / 24 is below rounding.
    constexpr double kBeside = 1e-6;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      const Eigen::Vector3d r = q - sources[s].x;
      const double chord = r.norm();
      if (chord * sources[s].bend > kBeside || chord > kBeside * options.max_panel) continue;
      if (sources[s].value + chord >= best.distance) continue;
      best.distance = sources[s].value + chord;
      best.angle = std::atan2(r.dot(sources[s].second), r.dot(sources[s].first));
      best.arrival = chord > 0 ? Eigen::Vector3d(r / chord) : sources[s].first;
      source = static_cast<std::int32_t>(s);
    }
    index.near(q, [&](std::int32_t i) {
      const std::size_t p = static_cast<std::size_t>(i);
      PatchHit hit;
      if (frames[p].start < best.distance && detail::may_hold(frames[p], q) && invert(p, q, hit) &&
          hit.distance < best.distance) {
        best = hit;
        source = patches[p].source;
      }
      return true;
    });
    FanHit result;
    result.distance = best.distance;
    if (source < 0) return result;
    const std::size_t s = static_cast<std::size_t>(source);
    result.error = best.error + 4 * kEpsilon * (scale + best.distance);
    result.source = source;
    result.departure = std::cos(best.angle) * sources[s].first + std::sin(best.angle) * sources[s].second;
    result.arrival = best.arrival;
    return result;
  }
};

GeodesicFan::GeodesicFan(const Surface& surface, const PointsIn& sources, const VectorIn& values,
                         const FanOptions& options)
    : impl_(std::make_unique<Impl>(surface, options)) {
  using detail::describe;
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument("a geodesic fan is for surfaces of one equation in 3 dimensions");
  }
  if (sources.rows() != 3 || sources.cols() == 0 || sources.cols() != values.size()) {
    throw InvalidArgument("a geodesic fan needs sources in 3 dimensions and a value for each");
  }
  if (!(options.tolerance >= 1e-13 && options.tolerance <= 1e-3)) {
    throw InvalidArgument("tolerance is " + describe(options.tolerance) + ", must be in 1e-13 .. 1e-3");
  }
  if (!(options.max_panel > 0 && std::isfinite(options.max_panel))) {
    throw InvalidArgument("max_panel is " + describe(options.max_panel) + ", must be > 0");
  }
  Impl& impl = *impl_;
  StripStepper stepper(surface);
  for (Index j = 0; j < sources.cols(); ++j) {
    const Eigen::Vector3d x = sources.col(j);
    const Eigen::Vector3d gradient = surface.jacobian(sources.col(j));
    if (!(gradient.norm() > 0) || !gradient.allFinite()) {
      throw SingularPoint("the surface has no tangent space at the source " + describe(sources.col(j)));
    }
    const Eigen::Vector3d normal = gradient.normalized();
    const Eigen::Vector3d t = normal.unitOrthogonal();
    const Eigen::MatrixXd hessian = surface.hessian(sources.col(j), Vector::Ones(1));
    impl.sources.push_back({x, t, normal.cross(t), values(j), hessian.norm() / gradient.norm()});
    impl.scale = std::max(impl.scale, x.cwiseAbs().maxCoeff());
    constexpr double kHalf = std::numbers::pi / kStartStrips;
    for (int i = 0; i < kStartStrips; ++i) {
      RayStrip strip = stepper.start(x, normal, t, (2 * i + 1) * kHalf, kHalf);
      strip.source = j;
      strip.value = values(j);
      strip.step = options.max_panel;
      impl.strips.push_back(std::move(strip));
    }
  }
  impl.num_evaluated = stepper.num_evaluated;
}

GeodesicFan::~GeodesicFan() = default;
GeodesicFan::GeodesicFan(GeodesicFan&&) noexcept = default;
GeodesicFan& GeodesicFan::operator=(GeodesicFan&&) noexcept = default;

void GeodesicFan::extend(double distance, const Context& context) {
  while (!finished() && impl_->front() < distance) {
    context.check_cancelled();
    impl_->advance(context);
  }
}

double GeodesicFan::reach() const { return std::min(impl_->front(), impl_->broken_at); }
bool GeodesicFan::finished() const {
  return impl_->strips.empty() || impl_->spent() || impl_->front() >= impl_->broken_at;
}
double GeodesicFan::broken_at() const { return impl_->broken_at; }
Index GeodesicFan::num_patches() const { return static_cast<Index>(impl_->patches.size()); }
Index GeodesicFan::num_evaluated() const { return impl_->num_evaluated; }

std::vector<FanHit> GeodesicFan::locate(const PointsIn& targets, const Context& context) const {
  std::vector<FanHit> hits(static_cast<std::size_t>(targets.cols()));
  constexpr Index kGrain = 256;
  detail::parallel_for(context, 0, targets.cols(), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) hits[static_cast<std::size_t>(i)] = impl_->locate(targets.col(i));
  });
  return hits;
}

}  // namespace taut
