#include "fan/geodesic_fan.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
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

namespace taut::detail {
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
/// Attempts that lead nowhere, of a whole fan: a surface full of creases ends by them.
constexpr Index kMostVain = 20000;

/// What became of one strip in one round.
struct Outcome {
  std::vector<std::pair<PatchFrame, ExpPatch>> patches;
  std::vector<RayStrip> strips;
  std::vector<RayStrip> broken;  // beyond which nothing is known
  Index num_evaluated = 0;
  Index num_vain = 0;       // attempts that ended in a break
  Index num_looked_at = 0;  // panels that may have held a point
};

}  // namespace

struct GeodesicFan::Impl {
  Surface surface;
  FanOptions options;
  double scale = 0;  // largest coordinate, model units: what rounding is measured by
  struct Source {
    Index number;  // as the caller counts
    Eigen::Vector3d x;
    Eigen::Vector3d first, second;  // tangent frame: angle 0 and a quarter turn
    double value;
    double bend;     // largest principal curvature
    Index arc = -1;  // >= 0: rays leave this arc at right angles, and x and its frame mean nothing
    int side = 0;    // of the arc
  };
  std::vector<Source> sources;
  std::vector<SpectralCurve> arcs;
  std::vector<RayStrip> strips;  // that go on
  std::vector<PatchFrame> frames;
  std::deque<ExpPatch> patches;  // large: none is moved when more come
  detail::PatchIndex index;
  /// Where rays could not be followed: a ball round the strip's end, and the distance of what goes on from there.
  struct Break {
    Eigen::Vector3d centre;
    double radius;
    double distance;
  };
  std::vector<RayStrip> broken;
  std::vector<Break> breaks;  // of those that matter
  Index num_evaluated = 0;
  Index num_vain = 0;
  Index num_looked_at = 0;

  explicit Impl(const Surface& s, const FanOptions& o) : surface(s), options(o) {}

  [[nodiscard]] bool spent() const {
    return static_cast<Index>(patches.size()) >= options.max_patches || num_vain > kMostVain ||
           num_evaluated + num_looked_at > options.max_evaluated;
  }

  [[nodiscard]] double front() const {
    double least = kInfinity;
    for (const RayStrip& strip : strips) least = std::min(least, strip.distance());
    return least;
  }

  /// Where patch p has q, if it has.
  [[nodiscard]] bool invert(std::size_t p, const Eigen::Vector3d& q, PatchHit& hit) const {
    const ExpPatch& patch = patches[p];
    if (patch.length > 0 || patch.beside_curve) return detail::invert(frames[p], patch, q, hit);
    // Round a source the panels are polar: the direction of q is the first guess, not what holds in their middle.
    const Source& source = sources[static_cast<std::size_t>(patch.source)];
    const Eigen::Vector3d r = q - source.x;
    const double angle = std::atan2(r.dot(source.second), r.dot(source.first));
    const double alpha = std::remainder(angle - patch.angle, 2 * std::numbers::pi) / patch.half;
    // Where the surface bends, the straight direction is not that of the ray: by more than a narrow strip is wide.
    constexpr double kMost = 0.6;  // radians: one and a half half-widths of the widest strips
    if (std::abs(alpha) * patch.half > kMost) return false;
    const double beta = std::min(1.0, 2 * r.norm() / patch.step - 1);
    return detail::invert(patch, q, std::clamp(alpha, -1.0, 1.0), beta, false, hit);
  }

  /// A shorter geodesic than `bound` meets x.
  [[nodiscard]] bool met_below(const Eigen::Vector3d& x, double bound, std::int64_t except, Index& looked_at) const {
    bool met = false;
    index.near(x, [&](std::int32_t i) {
      ++looked_at;
      const std::size_t p = static_cast<std::size_t>(i);
      if (frames[p].start >= bound || i == except || !detail::may_hold(frames[p], x)) return true;
      PatchHit hit;
      met = invert(p, x, hit) && hit.distance + hit.error < bound;
      return !met;
    });
    return met;
  }

  /// No shortest way goes on along any ray of the strip: cases (1) and (2) of the class comment.
  [[nodiscard]] bool is_over(const RayStrip& strip, Index& looked_at) const {
    if (strip.length == 0) return false;
    if ((strip.jacobi < 0).all()) return true;
    const auto& node = detail::PanelBasis::tables().ray;
    const double front_speed = 1.1 * strip.half * strip.jacobi.abs().maxCoeff();  // of the front, per alpha
    const auto passed = [&](int i) {
      const double before = i == 0 ? node(0) + 1 : (node(i) - node(i - 1)) / 2;
      const double after = i + 1 == detail::kRays ? 1 - node(i) : (node(i + 1) - node(i)) / 2;
      const double apart = front_speed * std::max(before, after);
      const double slack = strip.error + 16 * kEpsilon * scale + 1e-12 * strip.length;
      return met_below(strip.x.segment<3>(3 * i), strip.distance() - apart - slack, strip.parent, looked_at);
    };
    constexpr int kMiddle = detail::kRays / 2;
    if (!passed(kMiddle) || !passed(0) || !passed(detail::kRays - 1)) return false;
    for (int i = 1; i + 1 < detail::kRays; ++i) {
      if (i != kMiddle && !passed(i)) return false;
    }
    return true;
  }

  /// Follows a strip until all that came of it has passed `until`.
  void follow(const RayStrip& begin, double until, int most_attempts, StripStepper& stepper, Outcome& outcome) const {
    if (is_over(begin, outcome.num_looked_at)) return;
    const Index evaluated = stepper.num_evaluated;
    std::vector<RayStrip> stack{begin};
    int attempts = 0;
    while (!stack.empty()) {
      // The hindmost first.
      std::swap(*std::ranges::min_element(stack, {}, &RayStrip::length), stack.back());
      RayStrip strip = std::move(stack.back());
      stack.pop_back();
      if (strip.distance() >= until) {
        outcome.strips.push_back(std::move(strip));
        continue;
      }
      double h = std::min(strip.step, options.max_panel);
      const int before = attempts;
      while (true) {
        if (++attempts > most_attempts || h < kLeastStep * options.max_panel) {
          outcome.num_vain += attempts - before;
          outcome.broken.push_back(std::move(strip));
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
        const double off = 10 * tolerance + 1e-13 * stepper.width;
        const double too_long = std::max(stepper.error_along / tolerance, stepper.off_along / off);
        const double along = std::pow(1 / std::max(too_long, 1e-300), 1 / kOrder);
        if (too_long > 1) {
          h *= std::clamp(0.9 * along, 0.25, 0.85);
          continue;
        }
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
        (stepper.gone ? outcome.broken : stack).push_back(std::move(strip));
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
    // What is left to be spent, shared out; an attempt visits its points some ten times.
    constexpr Index kPerAttempt = 10 * detail::kRays * detail::kStages;
    constexpr Index kLeastAttempts = 20;
    const Index share = (options.max_evaluated - num_evaluated) / (kPerAttempt * static_cast<Index>(chosen.size()));
    const int most_attempts = static_cast<int>(std::clamp<Index>(share, kLeastAttempts, kMostAttempts));
    constexpr Index kGrain = 4;
    detail::parallel_for(context, 0, static_cast<Index>(chosen.size()), kGrain, [&](Index begin, Index end) {
      StripStepper stepper(surface);
      for (Index i = begin; i < end; ++i) {
        const std::size_t s = static_cast<std::size_t>(i);
        follow(chosen[s], until, most_attempts, stepper, outcomes[s]);
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
      for (RayStrip& strip : outcome.broken) {
        if (strip.parent < -1) strip.parent = base - 2 - strip.parent;
        broken.push_back(std::move(strip));
      }
      num_evaluated += outcome.num_evaluated;
      num_vain += outcome.num_vain;
      num_looked_at += outcome.num_looked_at;
    }
  }

  /// Leaves out what broke off where shorter geodesics arrive by now: no shortest way would have gone on.
  void weigh_breaks() {
    breaks.clear();
    for (const RayStrip& strip : broken) {
      if (is_over(strip, num_looked_at)) continue;
      Eigen::Vector3d centre = Eigen::Vector3d::Zero();
      for (int i = 0; i < detail::kRays; ++i) centre += strip.x.segment<3>(3 * i) / detail::kRays;
      double radius = 0;
      for (int i = 0; i < detail::kRays; ++i) radius = std::max(radius, (strip.x.segment<3>(3 * i) - centre).norm());
      constexpr double kBetweenRays = 1.1;
      breaks.push_back({centre, kBetweenRays * radius, strip.distance()});
    }
  }

  /// Where, and in which direction, the ray of this strip coordinate leaves its arc.
  void leave_arc(const Source& from, double angle, FanHit& result) const {
    const SpectralCurve& arc = arcs[static_cast<std::size_t>(from.arc)];
    const double t = std::clamp(-from.side * angle, 0.0, arc.period());
    const Eigen::Vector3d along = arc.velocity(t);
    result.foot = arc.point(t);
    const Eigen::Vector3d normal = surface.jacobian(Vector(result.foot)).col(0);
    result.departure = (from.side * normal.cross(along)).normalized();
  }

  void check_options() const {
    using detail::describe;
    if (surface.dim() != 3 || surface.codim() != 1) {
      throw InvalidArgument("a geodesic fan is for surfaces of one equation in 3 dimensions");
    }
    if (!(options.tolerance >= 1e-13 && options.tolerance <= 1e-3)) {
      throw InvalidArgument("tolerance is " + describe(options.tolerance) + ", must be in 1e-13 .. 1e-3");
    }
    if (!(options.max_panel > 0 && std::isfinite(options.max_panel))) {
      throw InvalidArgument("max_panel is " + describe(options.max_panel) + ", must be > 0");
    }
  }

  [[nodiscard]] Eigen::Vector3d normal_at(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d gradient = surface.jacobian(Vector(x));
    if (!(gradient.norm() > 0) || !gradient.allFinite()) {
      throw SingularPoint("the surface has no tangent space at the source " + detail::describe(Vector(x)));
    }
    return gradient.normalized();
  }

  /// Rays from x in the directions from `begin` to `begin + turn`, counted from the unit tangent t, in equal strips.
  void add_point(StripStepper& stepper, Index number, const Eigen::Vector3d& x, const Eigen::Vector3d& normal,
                 const Eigen::Vector3d& t, double value, double begin, double turn) {
    const Eigen::MatrixXd hessian = surface.hessian(Vector(x), Vector::Ones(1));
    const double slope = surface.jacobian(Vector(x)).norm();
    sources.push_back({number, x, t, normal.cross(t), value, hessian.norm() / slope});
    scale = std::max(scale, x.cwiseAbs().maxCoeff());
    constexpr double kWidest = 2 * std::numbers::pi / kStartStrips;
    const int count = std::max(1, static_cast<int>(std::ceil(turn / kWidest - 1e-9)));
    const double half = turn / (2 * count);
    for (int i = 0; i < count; ++i) {
      RayStrip strip = stepper.start(x, normal, t, begin + (2 * i + 1) * half, half);
      strip.source = static_cast<Index>(sources.size()) - 1;
      strip.value = value;
      strip.step = options.max_panel;
      strips.push_back(std::move(strip));
    }
  }

  /// Rays from both sides of a geodesic.
  void add_arc(StripStepper& stepper, Index number, const SpectralCurve& arc) {
    arcs.push_back(arc);
    const double length = arc.period();
    const int count = std::max(1, static_cast<int>(std::ceil(length / options.max_panel)));
    const double half = length / (2 * count);
    for (const int side : {1, -1}) {
      sources.push_back({number, arc.point(0), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0, 0,
                         static_cast<Index>(arcs.size()) - 1, side});
      for (int i = 0; i < count; ++i) {
        RayStrip strip = stepper.start_beside(arc, (2 * i + 1) * half, half, side);
        strip.source = static_cast<Index>(sources.size()) - 1;
        strip.step = options.max_panel;
        scale = std::max(scale, strip.x.cwiseAbs().maxCoeff());
        strips.push_back(std::move(strip));
      }
    }
  }

  /// Rays from where two arcs meet, between the right angles of one and of the other, on the side away from which the
  /// curve turns; from an end, half a turn.
  void add_joint(StripStepper& stepper, Index number, const Eigen::Vector3d& x, const Eigen::Vector3d* arriving,
                 const Eigen::Vector3d* leaving) {
    constexpr double kQuarter = std::numbers::pi / 2;
    // Neighbours' rays must not leave a gap between them, whatever rounding does.
    constexpr double kOverlap = 1e-9;
    const Eigen::Vector3d normal = normal_at(x);
    const auto tangent = [&](const Eigen::Vector3d& v) {
      return Eigen::Vector3d((v - normal * normal.dot(v)).normalized());
    };
    if (arriving == nullptr || leaving == nullptr) {
      const Eigen::Vector3d t = tangent(arriving != nullptr ? *arriving : Eigen::Vector3d(-*leaving));
      add_point(stepper, number, x, normal, t, 0, -kQuarter - kOverlap, 2 * (kQuarter + kOverlap));
      return;
    }
    const Eigen::Vector3d t = tangent(*arriving);
    const double turn = std::atan2(normal.dot(t.cross(tangent(*leaving))), t.dot(tangent(*leaving)));
    if (turn >= 0) {  // to the left: a gap opens on the right, from -90 degrees on
      add_point(stepper, number, x, normal, t, 0, -kQuarter - kOverlap, turn + 2 * kOverlap);
    } else {
      add_point(stepper, number, x, normal, t, 0, kQuarter + turn - kOverlap, -turn + 2 * kOverlap);
    }
  }

  [[nodiscard]] FanHit locate(const Eigen::Vector3d& q) const {
    PatchHit best;
    best.distance = kInfinity;
    PatchHit astray;
    astray.distance = kInfinity;
    std::int32_t source = -1;
    std::int32_t astray_source = -1;
    // Beside a source, where d - |q - p| = curvature^2 |q - p|^3 / 24 is below rounding.
    constexpr double kBeside = 1e-6;
    for (std::size_t s = 0; s < sources.size(); ++s) {
      if (sources[s].arc >= 0) continue;
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
      PatchHit& least = patches[p].astray ? astray : best;
      if (frames[p].start < least.distance && detail::may_hold(frames[p], q) && invert(p, q, hit) &&
          hit.distance < least.distance) {
        least = hit;
        (patches[p].astray ? astray_source : source) = patches[p].source;
      }
      return true;
    });
    FanHit result;
    if (source >= 0) result = describe(best, source);
    result.distance = best.distance;
    if (astray.distance < best.distance) {
      const FanHit other = describe(astray, astray_source);
      result.astray = astray.distance;
      result.astray_error = other.error;
      result.astray_value = sources[static_cast<std::size_t>(astray_source)].value;
      result.astray_source = other.source;
      result.astray_foot = other.foot;
      result.astray_departure = other.departure;
    }
    return result;
  }

  [[nodiscard]] std::vector<FanHit> ways(const Eigen::Vector3d& q, double longest) const {
    std::vector<FanHit> found;
    index.near(q, [&](std::int32_t i) {
      const std::size_t p = static_cast<std::size_t>(i);
      PatchHit hit;
      if (patches[p].astray || frames[p].start > longest || !detail::may_hold(frames[p], q)) return true;
      if (!invert(p, q, hit) || hit.distance > longest) return true;
      // Panels side by side hold the same geodesic at their common edge. Two that arrive from nearly one side and are
      // as long are one, or are about to merge at a conjugate point.
      constexpr double kSameWay = 1e-4;  // radians, and relative
      const bool known = std::ranges::any_of(found, [&](const FanHit& other) {
        return (other.arrival - hit.arrival).norm() < kSameWay &&
               std::abs(other.distance - hit.distance) <= kSameWay * hit.distance;
      });
      if (known) return true;
      found.push_back(describe(hit, patches[p].source));
      found.back().distance = hit.distance;
      return true;
    });
    std::ranges::stable_sort(found, {}, &FanHit::distance);
    return found;
  }

  [[nodiscard]] FanHit describe(const PatchHit& hit, std::int32_t source) const {
    const Source& from = sources[static_cast<std::size_t>(source)];
    FanHit result;
    result.distance = hit.distance;
    result.error = hit.error + 4 * kEpsilon * (scale + hit.distance);
    result.source = from.number;
    result.foot = from.x;
    result.departure = std::cos(hit.angle) * from.first + std::sin(hit.angle) * from.second;
    if (from.arc >= 0) leave_arc(from, hit.angle, result);
    result.arrival = hit.arrival;
    return result;
  }
};

GeodesicFan::GeodesicFan(const Surface& surface, const PointsIn& sources, const VectorIn& values,
                         const FanOptions& options)
    : impl_(std::make_unique<Impl>(surface, options)) {
  Impl& impl = *impl_;
  impl.check_options();
  if (sources.rows() != 3 || sources.cols() == 0 || sources.cols() != values.size()) {
    throw InvalidArgument("a geodesic fan needs sources in 3 dimensions and a value for each");
  }
  StripStepper stepper(surface);
  for (Index j = 0; j < sources.cols(); ++j) {
    const Eigen::Vector3d x = sources.col(j);
    const Eigen::Vector3d normal = impl.normal_at(x);
    impl.add_point(stepper, j, x, normal, normal.unitOrthogonal(), values(j), 0, 2 * std::numbers::pi);
  }
  impl.num_evaluated = stepper.num_evaluated;
}

GeodesicFan::GeodesicFan(const Surface& surface, const std::vector<FanCurve>& curves, const FanOptions& options)
    : impl_(std::make_unique<Impl>(surface, options)) {
  Impl& impl = *impl_;
  impl.check_options();
  StripStepper stepper(surface);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const std::vector<SpectralCurve>& arcs = curves[c].arcs;
    const Index number = static_cast<Index>(c);
    if (arcs.empty() || arcs.front().dim() != 3) throw InvalidArgument("a curve to start rays from needs arcs in R^3");
    for (const SpectralCurve& arc : arcs) impl.add_arc(stepper, number, arc);
    const Eigen::Vector3d begin = arcs.front().point(0);
    const Eigen::Vector3d end = arcs.back().point(arcs.back().period());
    const bool closed = begin == end;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      const Eigen::Vector3d arriving = arcs[i].velocity(arcs[i].period());
      const bool last = i + 1 == arcs.size();
      const Eigen::Vector3d leaving = arcs[last ? 0 : i + 1].velocity(0);
      const Eigen::Vector3d x = arcs[i].point(arcs[i].period());
      impl.add_joint(stepper, number, x, &arriving, last && !closed ? nullptr : &leaving);
    }
    if (!closed) {
      const Eigen::Vector3d leaving = arcs.front().velocity(0);
      impl.add_joint(stepper, number, begin, nullptr, &leaving);
    }
  }
  if (impl.strips.empty()) throw InvalidArgument("a geodesic fan needs at least one curve");
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
  impl_->weigh_breaks();
}

double GeodesicFan::reach() const { return impl_->front(); }
double GeodesicFan::bound(const Eigen::Vector3d& q) const {
  double least = kInfinity;
  for (const Impl::Break& b : impl_->breaks) {
    least = std::min(least, b.distance + std::max(0.0, (q - b.centre).norm() - b.radius));
  }
  return least;
}
bool GeodesicFan::finished() const { return impl_->strips.empty() || impl_->spent(); }
bool GeodesicFan::broken() const { return !impl_->breaks.empty(); }
double GeodesicFan::tolerance() const { return impl_->options.tolerance; }
Index GeodesicFan::num_patches() const { return static_cast<Index>(impl_->patches.size()); }
Index GeodesicFan::num_evaluated() const { return impl_->num_evaluated; }

std::vector<FanHit> GeodesicFan::ways(const Eigen::Vector3d& q, double longest) const {
  return impl_->ways(q, longest);
}

std::vector<FanHit> GeodesicFan::locate(const PointsIn& targets, const Context& context) const {
  std::vector<FanHit> hits(static_cast<std::size_t>(targets.cols()));
  constexpr Index kGrain = 256;
  detail::parallel_for(context, 0, targets.cols(), kGrain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) hits[static_cast<std::size_t>(i)] = impl_->locate(targets.col(i));
  });
  return hits;
}

}  // namespace taut::detail
