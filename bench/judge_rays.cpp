// An independent judge of distances on smooth surfaces in R^3: brute force, sharing nothing with Taut's search but F.
//
//   judge_rays FORMULA CLAIMS.csv
//
// CLAIMS.csv has rows px,py,pz,qx,qy,qz,length: points of the surface, and how long the shortest path is claimed to be.
// From each p (rows with the same p follow each other) rays leave in all directions and are followed as far as the
// longest claim, by Dormand and Prince's pair of order five on x'' = -(x'.Hx') g / |g|^2. Between neighbouring rays
// that part by more than kApart of that length more are put, until the budget is spent. A target that two neighbours
// pass on different sides is hit: the direction in between is found by false position, and the length is where that ray
// is nearest to it. Prints one row a claim: length,rays,excess with rays the least length of all hits (nan: none),
// excess = length / rays - 1, and at the end of each p how many rays it took and whether the budget sufficed.
//
// What it cannot see: geodesics between rays that the budget left farther apart (said: "spent"), and those that pass
// within 1e-3 lengths of a conjugate point to the second order, where neighbours pass on the same side.

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "taut/surface/formula.hpp"
#include "taut/surface/projection.hpp"

namespace {

using taut::Index;
using Vec = Eigen::Vector3d;

constexpr int kFirstRays = 720;
constexpr int kMostRays = 12'000;  // for one source
constexpr double kApart = 0.02;    // of the length: neighbouring rays are no farther apart
constexpr double kTolerance = 1e-10;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Node {
  double s;
  Vec x, t;
};

class Tracer {
 public:
  explicit Tracer(const taut::Surface& surface) : evaluator_(surface.make_evaluator()) {}

  struct Local {
    double value;
    Vec gradient;
    double bend;  // t . H t
  };
  Local look(const Vec& x, const Vec& t) {
    const double weight = 1;
    taut::PointBatch batch;
    Local local{};
    Eigen::Matrix3d hessian;
    batch.n = 1;
    batch.x = x.data();
    batch.value = &local.value;
    batch.jacobian = local.gradient.data();
    batch.weight = &weight;
    batch.hessian = hessian.data();
    evaluator_->evaluate(batch);
    local.bend = t.dot(hessian * t);
    return local;
  }

  /// The ray from x along t as far as `length`; ends early where it cannot be followed.
  std::vector<Node> follow(const Vec& x, const Vec& t, double length, double longest_step) {
    std::vector<Node> nodes{{0, x, t}};
    double h = longest_step / 4;
    for (int tries = 0; nodes.back().s < length * (1 - 1e-14) && tries < 20'000; ++tries) {
      const Node& from = nodes.back();
      h = std::min({h, longest_step, length - from.s});
      Node to{};
      const double error = step(from, h, to) / (kTolerance * length);
      if (!(error <= 1)) {
        h *= std::isfinite(error) ? std::clamp(0.9 * std::pow(error, -0.2), 0.1, 0.9) : 0.1;
        if (h < 1e-12 * length) break;
        continue;
      }
      nodes.push_back(to);
      h *= std::clamp(0.9 * std::pow(error + 1e-30, -0.2), 0.2, 4.0);
    }
    return nodes;
  }

 private:
  Vec acceleration(const Vec& x, const Vec& t) {
    const Local local = look(x, t);
    return -local.bend / local.gradient.squaredNorm() * local.gradient;
  }

  /// One step, its end pulled back onto the surface. Returns an estimate of the error.
  double step(const Node& from, double h, Node& to) {
    static constexpr double a[7][6] = {{},
                                       {1.0 / 5},
                                       {3.0 / 40, 9.0 / 40},
                                       {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                       {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                    -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    Vec dx[7], dt[7];
    Vec x = from.x, t = from.t;
    for (int i = 0; i < 7; ++i) {
      x = from.x;
      t = from.t;
      for (int j = 0; j < i; ++j) {
        x += h * a[i][j] * dx[j];
        t += h * a[i][j] * dt[j];
      }
      dx[i] = t;
      dt[i] = acceleration(x, t);
    }
    Vec wrong_x = Vec::Zero(), wrong_t = Vec::Zero();
    for (int i = 0; i < 7; ++i) {
      wrong_x += h * e[i] * dx[i];
      wrong_t += h * e[i] * dt[i];
    }
    for (int i = 0; i < 2; ++i) {
      const Local local = look(x, t);
      x -= local.value / local.gradient.squaredNorm() * local.gradient;
      t -= t.dot(local.gradient) / local.gradient.squaredNorm() * local.gradient;
    }
    to = {from.s + h, x, t.normalized()};
    return std::max(wrong_x.norm(), h * wrong_t.norm());
  }

  std::unique_ptr<taut::Evaluator> evaluator_;
};

/// Where a ray is nearest to a point, in one of its steps.
struct Passing {
  double s = 0;
  double aside = 0;  // signed, seen along the ray
  Vec x;
};

Node between(const Node& a, const Node& b, double u) {
  const double h = b.s - a.s, v = 1 - u;
  const Vec x = v * v * (1 + 2 * u) * a.x + u * u * (3 - 2 * u) * b.x + h * u * v * (v * a.t - u * b.t);
  return {a.s + u * h, x, (v * a.t + u * b.t).normalized()};
}

/// The local minima of the distance from q along a ray.
std::vector<Passing> passings(const std::vector<Node>& ray, const Vec& q, const Vec& normal) {
  std::vector<Passing> found;
  for (std::size_t i = 0; i + 1 < ray.size(); ++i) {
    const Node &a = ray[i], &b = ray[i + 1];
    const bool last = i + 2 == ray.size();
    if ((q - a.x).dot(a.t) < 0 || (q - b.x).dot(b.t) > (last ? 0.1 * (b.s - a.s) : 0)) continue;
    double low = 0, high = 1;
    for (int k = 0; k < 50; ++k) {
      const Node middle = between(a, b, (low + high) / 2);
      ((q - middle.x).dot(middle.t) > 0 ? low : high) = (low + high) / 2;
    }
    const Node nearest = between(a, b, low);
    found.push_back({nearest.s, (q - nearest.x).dot(normal.cross(nearest.t)), nearest.x});
  }
  return found;
}

class Judge {
 public:
  Judge(const taut::Surface& surface, const Vec& p, double longest) : tracer_(surface), p_(p), length_(1.02 * longest) {
    const Vec n = tracer_.look(p, Vec::UnitX()).gradient.normalized();
    e1_ = n.unitOrthogonal();
    e2_ = n.cross(e1_);
    for (int i = 0; i < kFirstRays; ++i) fan_.push_back(shoot(2 * std::numbers::pi * i / kFirstRays));
    fan_.push_back(fan_.front());
    fan_.back().angle = 2 * std::numbers::pi;
    refine();
  }

  double distance(const Vec& q) {
    const Vec normal = tracer_.look(q, Vec::UnitX()).gradient.normalized();
    double least = kNaN;
    std::vector<std::vector<Passing>> all;
    for (const Ray& ray : fan_) all.push_back(passings(ray.nodes, q, normal));
    for (std::size_t i = 0; i + 1 < fan_.size(); ++i) {
      for (const Passing& a : all[i]) {
        for (const Passing& b : all[i + 1]) {
          const double apart = (a.x - b.x).norm();
          if (std::abs(a.s - b.s) > 0.05 * length_ || apart > 4 * kApart * length_) continue;
          if (a.aside * b.aside > 0 || std::abs(a.aside) + std::abs(b.aside) > 2 * apart + 1e-12) continue;
          if (least <= std::min(a.s, b.s) - 0.05 * length_) continue;
          const double s = hit(fan_[i].angle, a, fan_[i + 1].angle, b, q, normal);
          if (!(least <= s)) least = std::isnan(s) ? least : s;
        }
      }
    }
    return least;
  }

  [[nodiscard]] std::size_t num_rays() const { return fan_.size() - 1; }
  [[nodiscard]] bool spent() const { return spent_; }

 private:
  struct Ray {
    double angle;
    std::vector<Node> nodes;
  };

  Ray shoot(double angle) {
    return {angle, tracer_.follow(p_, std::cos(angle) * e1_ + std::sin(angle) * e2_, length_, length_ / 40)};
  }

  /// How far two rays part, at the steps of the first.
  double parting(const Ray& a, const Ray& b) const {
    double most = 0;
    std::size_t j = 0;
    for (const Node& node : a.nodes) {
      while (j + 2 < b.nodes.size() && b.nodes[j + 1].s < node.s) ++j;
      if (b.nodes.size() < 2 || node.s > b.nodes.back().s) break;
      const Node &from = b.nodes[j], &to = b.nodes[j + 1];
      most = std::max(most, (node.x - between(from, to, (node.s - from.s) / (to.s - from.s)).x).norm());
    }
    return most;
  }

  void refine() {
    for (int round = 0; round < 24; ++round) {
      std::vector<Ray> finer;
      bool split = false;
      for (std::size_t i = 0; i + 1 < fan_.size(); ++i) {
        finer.push_back(fan_[i]);
        const bool wanted =
            parting(fan_[i], fan_[i + 1]) > kApart * length_ && fan_[i + 1].angle - fan_[i].angle > 1e-9;
        if (!wanted) continue;
        if (finer.size() + fan_.size() - i > kMostRays) {
          spent_ = true;
          continue;
        }
        finer.push_back(shoot((fan_[i].angle + fan_[i + 1].angle) / 2));
        split = true;
      }
      finer.push_back(fan_.back());
      fan_ = std::move(finer);
      if (!split) return;
    }
  }

  /// The length of the ray between two that passes through q; nan where there is none.
  double hit(double from, Passing a, double to, Passing b, const Vec& q, const Vec& normal) {
    for (int k = 0; k < 60; ++k) {
      const double share = k % 3 == 2 ? 0.5 : std::clamp(a.aside / (a.aside - b.aside), 0.02, 0.98);
      const double angle = from + share * (to - from);
      const double s = (a.s + b.s) / 2;
      const Ray ray = shoot(angle);
      Passing best;
      double off = std::numeric_limits<double>::infinity();
      for (const Passing& c : passings(ray.nodes, q, normal)) {
        if (std::abs(c.s - s) < off) best = c, off = std::abs(c.s - s);
      }
      if (off > 0.1 * length_) return kNaN;
      if (std::abs(best.aside) < 1e-7 * length_ || to - from < 1e-15) return length_at(angle, best.s, q);
      const bool on_side_of_a = best.aside * a.aside > 0;
      (on_side_of_a ? a : b) = best;
      (on_side_of_a ? from : to) = angle;
    }
    return kNaN;
  }

  /// A ray that is to end at q: how long it is where it is nearest to it, its last step to rounding. nan if it misses.
  double length_at(double angle, double s, const Vec& q) {
    const Vec t = std::cos(angle) * e1_ + std::sin(angle) * e2_;
    const Node end = tracer_.follow(p_, t, s, length_ / 40).back();
    const double along = (q - end.x).dot(end.t);
    return (end.x + along * end.t - q).norm() < 1e-6 * length_ ? end.s + along : kNaN;
  }

  Tracer tracer_;
  Vec p_, e1_, e2_;
  double length_;
  std::vector<Ray> fan_;
  bool spent_ = false;
};

struct Claim {
  Vec p, q;
  double length;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: judge_rays FORMULA CLAIMS.csv\n", stderr);
    return 2;
  }
  const taut::Surface surface = taut::parse_surface(argv[1], {.dim = 3});
  std::ifstream in(argv[2]);
  std::vector<Claim> claims;
  for (std::string line; std::getline(in, line);) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream row(line);
    Claim c{};
    row >> c.p(0) >> c.p(1) >> c.p(2) >> c.q(0) >> c.q(1) >> c.q(2) >> c.length;
    c.p = taut::project_to_surface(surface, c.p).point;
    c.q = taut::project_to_surface(surface, c.q).point;
    claims.push_back(c);
  }
  for (std::size_t first = 0; first < claims.size();) {
    std::size_t last = first;
    double longest = 0;
    for (; last < claims.size() && claims[last].p == claims[first].p; ++last) {
      longest = std::max(longest, claims[last].length);
    }
    Judge judge(surface, claims[first].p, longest);
    for (; first < last; ++first) {
      const double rays = judge.distance(claims[first].q);
      std::printf("%.17g,%.17g,%.3g\n", claims[first].length, rays, claims[first].length / rays - 1);
    }
    std::printf("# %zu rays%s\n", judge.num_rays(), judge.spent() ? ", spent" : "");
    std::fflush(stdout);
  }
}
