// The foot of a point on curves, by branch and bound over single paths.
//
// An interval [a, b] of arc length with u(a), u(b) known holds nothing below (u(a) + u(b) - (b - a)) / 2. The one with
// the least bound is halved while it is wide. A narrow one holds one local minimum at most: u is the least of smooth
// functions, whose kinks (cut points) are maxima. It is found by its slopes where both ends have them, else by golden
// sections of the values (paths over edges, whose end tangents are those of chords).

#include "query/curve_foot.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace taut::detail {
namespace {

/// Measured on the 3-sphere, a cylinder and a flat torus in R^4, and a cube (docs/measured/field.md).
struct FootRule {
  /// Narrow: this part of all curves' length, or of the distance, if that is longer (u cannot turn twice within it).
  double narrow_of_curves = 1.0 / 64;
  double narrow_of_distance = 0.1;
  double fewest = 8;          ///< intervals at first, over all arcs
  double right_angle = 1e-8;  ///< cosine between path and curve: u is off by its square times the distance
  double least_width = 1e-7;  ///< of an interval, of the curves' length: by golden sections u is off by its square
  int most_paths = 400;       ///< a target; then the least bound tells what may be missed
};
constexpr FootRule kFoot;

struct Place {
  std::size_t curve = 0, arc = 0;
  double s = 0;  ///< arc length on the arc
};

struct Probe {
  Place place;
  bool known = false;
  double u = 0;
  double slope = std::numeric_limits<double>::quiet_NaN();  ///< du/ds
  PathResult path;
};

struct Interval {
  std::size_t a, b;  ///< probes
  double bound;
};

class FootSearch {
 public:
  FootSearch(PathSolver& paths, const std::vector<std::vector<SpectralCurve>>& curves, const VectorIn& target,
             double tolerance)
      : paths_(paths), curves_(curves), target_(target), tolerance_(tolerance) {
    for (const auto& arcs : curves) {
      for (const SpectralCurve& arc : arcs) total_ += arc.period();
    }
  }

  CurveFoot run() {
    begin();
    while (!open_.empty() && static_cast<int>(probes_.size()) < kFoot.most_paths) {
      const auto least = std::ranges::min_element(open_, {}, &Interval::bound);
      if (least->bound >= best_u() * (1 - tolerance_)) {
        open_.clear();
        break;
      }
      const Interval interval = *least;
      open_.erase(least);
      look_into(interval);
    }
    return result();
  }

 private:
  [[nodiscard]] double best_u() const {
    return best_ == kNone ? std::numeric_limits<double>::infinity() : probes_[best_].u;
  }
  [[nodiscard]] const SpectralCurve& arc_of(const Place& place) const { return curves_[place.curve][place.arc]; }

  /// The ends of all arcs, and points between them where there are few.
  void begin() {
    std::vector<Place> places;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t c = 0; c < curves_.size(); ++c) {
      for (std::size_t i = 0; i < curves_[c].size(); ++i) {
        const double length = curves_[c][i].period();
        const int count = std::max(1, static_cast<int>(std::ceil(kFoot.fewest * length / total_)));
        for (int p = 0; p <= count; ++p) {
          if (p > 0) pairs.emplace_back(places.size() - 1, places.size());
          places.push_back({c, i, length * p / count});
        }
      }
    }
    Points ends(target_.size(), static_cast<Index>(places.size()));
    for (std::size_t p = 0; p < places.size(); ++p) ends.col(static_cast<Index>(p)) = point(places[p]);
    std::vector<PathResult> found = paths_.solve_from(target_, ends);
    for (std::size_t p = 0; p < places.size(); ++p) take(places[p], std::move(found[p]));
    for (const auto& [a, b] : pairs) open(a, b);
  }

  [[nodiscard]] Vector point(const Place& place) const { return arc_of(place).point(place.s); }

  std::size_t take(const Place& place, PathResult path) {
    Probe probe{.place = place, .known = path.status == Status::ok, .u = path.length, .path = std::move(path)};
    if (probe.known && probe.path.end_direction.size() == target_.size()) {
      probe.slope = probe.path.end_direction.dot(arc_of(place).velocity(place.s).normalized());
    }
    probes_.push_back(std::move(probe));
    const std::size_t i = probes_.size() - 1;
    if (probes_[i].known && probes_[i].u < best_u()) best_ = i;
    return i;
  }

  std::size_t probe_at(const Place& place) { return take(place, paths_.solve(target_, point(place))); }

  void open(std::size_t a, std::size_t b) {
    if (!probes_[a].known || !probes_[b].known) {
      unknown_ = unknown_ == kNone ? (probes_[a].known ? b : a) : unknown_;
      return;
    }
    open_.push_back({a, b, (probes_[a].u + probes_[b].u - (probes_[b].place.s - probes_[a].place.s)) / 2});
  }

  void look_into(const Interval& interval) {
    const Place a = probes_[interval.a].place;
    const Place b = probes_[interval.b].place;
    const double narrow = std::max(kFoot.narrow_of_curves * total_, kFoot.narrow_of_distance * best_u());
    if (b.s - a.s > narrow) {
      const std::size_t middle = probe_at({a.curve, a.arc, (a.s + b.s) / 2});
      open(interval.a, middle);
      open(middle, interval.b);
      return;
    }
    const double before = probes_[interval.a].slope;
    const double after = probes_[interval.b].slope;
    if (std::isnan(before) || std::isnan(after)) {
      by_values(interval);
    } else if (before < 0 && after > 0) {
      by_slopes(interval.a, interval.b);
    }
  }

  /// A minimum between a (falling) and b (rising), by false positions that drop half of the weight of an end that
  /// stays.
  void by_slopes(std::size_t a, std::size_t b) {
    double weight_a = probes_[a].slope;
    double weight_b = probes_[b].slope;
    int stayed = 0;
    for (int i = 0; i < 60; ++i) {
      const double s_a = probes_[a].place.s;
      const double s_b = probes_[b].place.s;
      const double share = std::clamp(weight_a / (weight_a - weight_b), 0.01, 0.99);
      const std::size_t m = probe_at({probes_[a].place.curve, probes_[a].place.arc, s_a + share * (s_b - s_a)});
      const double slope = probes_[m].slope;
      if (!probes_[m].known) unknown_ = m;
      if (!(std::abs(slope) > kFoot.right_angle) || s_b - s_a < 1e-14 * total_) return;
      if (slope < 0) {
        a = m;
        weight_a = slope;
        weight_b *= stayed == 1 ? 0.5 : 1;
        stayed = 1;
      } else {
        b = m;
        weight_b = slope;
        weight_a *= stayed == -1 ? 0.5 : 1;
        stayed = -1;
      }
    }
  }

  void by_values(const Interval& interval) {
    constexpr double kGolden = 0.381966011250105;
    const Place first = probes_[interval.a].place;
    double a = first.s;
    double b = probes_[interval.b].place.s;
    const auto at = [&](double s) { return probe_at({first.curve, first.arc, s}); };
    std::size_t low = at(a + kGolden * (b - a));
    std::size_t high = at(b - kGolden * (b - a));
    while (b - a > kFoot.least_width * total_) {
      if (!probes_[low].known || !probes_[high].known) {
        unknown_ = probes_[low].known ? high : low;
        return;
      }
      if (probes_[low].u < probes_[high].u) {
        b = probes_[high].place.s;
        high = low;
        low = at(a + kGolden * (b - a));
      } else {
        a = probes_[low].place.s;
        low = high;
        high = at(b - kGolden * (b - a));
      }
    }
  }

  CurveFoot result() {
    CurveFoot foot;
    if (best_ == kNone || unknown_ != kNone) {
      const PathResult& path = probes_[unknown_ == kNone ? 0 : unknown_].path;
      const bool apart = best_ == kNone && std::ranges::all_of(probes_, [](const Probe& p) {
                           return p.path.status == Status::disconnected;
                         });
      foot.status = apart ? Status::disconnected : Status::not_converged;
      foot.message = path.message;
      return foot;
    }
    Probe& best = probes_[best_];
    foot.status = Status::ok;
    foot.distance = best.u;
    foot.error = best.path.length_error;
    for (const Interval& interval : open_) foot.error = std::max(foot.error, best.u - interval.bound);
    foot.curve = static_cast<std::int32_t>(best.place.curve);
    foot.foot = point(best.place);
    foot.path = std::move(best.path);
    return foot;
  }

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  PathSolver& paths_;
  const std::vector<std::vector<SpectralCurve>>& curves_;
  Vector target_;
  double tolerance_;
  double total_ = 0;  // length of all curves
  std::vector<Probe> probes_;
  std::vector<Interval> open_;
  std::size_t best_ = kNone;
  std::size_t unknown_ = kNone;  // a probe without a path: a nearer point may lie beside it
};

}  // namespace

CurveFoot nearest_on_curves(PathSolver& paths, const std::vector<std::vector<SpectralCurve>>& curves,
                            const VectorIn& target, double tolerance) {
  return FootSearch(paths, curves, target, tolerance).run();
}

}  // namespace taut::detail
