// Bodies are smooth unions of round cones: with distances s_i to each, F = -log(sum_i exp(-k s_i)) / k, which is close
// to the least of them and rounds the joints over about 1 / k (Ricci 1973, in exponential form).

#include "model_formulas.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace taut::paper {
namespace {

using Place = Eigen::Vector3d;

class Body {
 public:
  explicit Body(double sharpness) : sharpness_(sharpness) {}

  /// A cone with round ends: radius `ra` about a, growing evenly to `rb` about b.
  void cone(const Place& a, double ra, const Place& b, double rb) {
    const Place ab = b - a;
    const std::string along = fmt::format("min(max(({:.6g}*(x-({:.6g}))+{:.6g}*(y-({:.6g}))+{:.6g}*(z-({:.6g}))),0),1)",
                                          ab.x() / ab.squaredNorm(), a.x(), ab.y() / ab.squaredNorm(), a.y(),
                                          ab.z() / ab.squaredNorm(), a.z());
    add(
        fmt::format("sqrt((x-({:.6g})-({:.6g})*{t})^2+(y-({:.6g})-({:.6g})*{t})^2+(z-({:.6g})-({:.6g})*{t})^2)-({:.6g})"
                    "-({:.6g})*{t}",
                    a.x(), ab.x(), a.y(), ab.y(), a.z(), ab.z(), ra, rb - ra, fmt::arg("t", along)));
  }

  /// A chain of cones through places, each with its radius.
  struct Joint {
    Place place;
    double radius;
  };
  void chain(const std::vector<Joint>& joints) {
    for (std::size_t i = 0; i + 1 < joints.size(); ++i) {
      cone(joints[i].place, joints[i].radius, joints[i + 1].place, joints[i + 1].radius);
    }
  }

  /// An ellipsoid with axes along x, y and z; its distance to first order near the surface.
  void ellipsoid(const Place& centre, const Place& axes) {
    const double least = axes.minCoeff();
    add(fmt::format("{:.6g}*(sqrt(((x-({:.6g}))/{:.6g})^2+((y-({:.6g}))/{:.6g})^2+((z-({:.6g}))/{:.6g})^2)-1)", least,
                    centre.x(), axes.x(), centre.y(), axes.y(), centre.z(), axes.z()));
  }

  [[nodiscard]] std::string formula() const { return fmt::format("-log({})/{:.6g}", sum_, sharpness_); }

 private:
  void add(const std::string& distance) {
    sum_ += fmt::format("{}exp(-{:.6g}*({}))", sum_.empty() ? "" : "+", sharpness_, distance);
  }

  double sharpness_;
  std::string sum_;
};

}  // namespace

std::string hand_formula() {
  Body hand(26);
  // The wrist and the palm: bones side by side, from the wrist to the knuckles.
  hand.cone({-0.10, 0, -0.62}, 0.19, {-0.11, 0, 0}, 0.18);
  hand.cone({0.12, 0, -0.62}, 0.19, {0.12, 0, 0}, 0.18);
  struct Finger {
    Place wrist, knuckle, tip_direction;
    double lengths[3];
    double radius;
  };
  const Finger fingers[] = {{{-0.16, 0, 0.08}, {-0.37, -0.01, 0.92}, {-0.23, -0.10, 1}, {0.43, 0.27, 0.20}, 0.125},
                            {{-0.05, 0, 0.10}, {-0.12, 0.03, 0.99}, {-0.06, -0.08, 1}, {0.47, 0.31, 0.22}, 0.130},
                            {{0.06, 0, 0.10}, {0.13, 0.02, 0.95}, {0.12, -0.08, 1}, {0.44, 0.28, 0.21}, 0.122},
                            {{0.15, 0, 0.07}, {0.36, -0.03, 0.83}, {0.33, -0.10, 1}, {0.34, 0.20, 0.18}, 0.105}};
  for (const Finger& finger : fingers) {
    std::vector<Body::Joint> joints = {{finger.wrist, 0.17}, {finger.knuckle, 0.155}};
    Place at = finger.knuckle;
    Place along = finger.tip_direction.normalized();
    double radius = finger.radius;
    for (const double length : finger.lengths) {
      at += length * along;
      joints.push_back({at, radius});
      radius *= 0.90;
      along = (along + Place(0, -0.16, 0)).normalized();  // each joint bends a little towards the palm
    }
    hand.chain(joints);
  }
  hand.chain({{{-0.12, 0, 0.02}, 0.19},
              {{-0.46, -0.12, 0.38}, 0.165},
              {{-0.70, -0.20, 0.68}, 0.135},
              {{-0.80, -0.25, 0.95}, 0.105}});
  hand.cone({-0.22, -0.09, 0.30}, 0.15, {-0.30, -0.06, 0.62}, 0.13);  // the ball of the thumb
  hand.cone({0.20, -0.06, 0.22}, 0.13, {0.27, -0.05, 0.55}, 0.12);    // and the heel of the hand
  return hand.formula();
}

std::string pot_formula() {
  Body pot(18);
  // The body, wide at the foot, with a neck and a rim.
  pot.ellipsoid({0, 0, 0.62}, {0.80, 0.80, 0.74});
  pot.cone({0, 0, 0.10}, 0.52, {0, 0, 0.55}, 0.58);
  pot.ellipsoid({0, 0, -0.02}, {0.66, 0.66, 0.13});
  pot.cone({0, 0, 1.15}, 0.36, {0, 0, 1.38}, 0.33);
  pot.ellipsoid({0, 0, 1.50}, {0.54, 0.54, 0.14});
  // The spout, out of the low body, with its rose.
  pot.chain({{{0.55, 0, 0.42}, 0.24}, {{1.12, 0, 0.80}, 0.17}, {{1.55, 0, 1.42}, 0.13}, {{1.78, 0, 1.66}, 0.13}});
  pot.ellipsoid({1.86, 0, 1.72}, {0.26, 0.26, 0.26});
  // The stay between spout and neck closes one loop; the handle at the back closes the other.
  pot.chain({{{0.30, 0, 1.36}, 0.10}, {{0.88, 0, 1.46}, 0.085}, {{1.52, 0, 1.40}, 0.10}});
  std::vector<Body::Joint> handle;
  constexpr int kJoints = 9;
  for (int i = 0; i <= kJoints; ++i) {
    const double a = std::numbers::pi * (0.43 + 1.05 * i / kJoints);
    handle.push_back({{-0.52 + 0.86 * std::cos(a), 0, 0.86 + 0.62 * std::sin(a)}, 0.115});
  }
  pot.chain(handle);
  return pot.formula();
}

std::string sculpture_formula() {
  Body sculpture(16);
  sculpture.ellipsoid({0, 0, -0.10}, {0.66, 0.56, 0.17});  // the plinth
  struct Ring {
    Place centre;
    double radius, turn, tilt, thin, thick;
  };
  const Ring rings[] = {{{-0.06, 0, 0.74}, 0.66, 0.35, 0.10, 0.15, 0.26},
                        {{0.16, 0.02, 1.86}, 0.50, 1.75, -0.16, 0.12, 0.22}};
  for (const Ring& ring : rings) {
    const Place across(std::cos(ring.turn), std::sin(ring.turn), 0);
    const Place up = Place(-std::sin(ring.turn) * ring.tilt, std::cos(ring.turn) * ring.tilt, 1).normalized();
    std::vector<Body::Joint> joints;
    constexpr int kJoints = 18;
    for (int i = 0; i <= kJoints; ++i) {
      const double a = 2 * std::numbers::pi * i / kJoints - 0.5 * std::numbers::pi;  // from below, where it is thickest
      const double weight = 0.5 * (1 - std::sin(a));
      joints.push_back({ring.centre + ring.radius * (std::cos(a) * across + 1.12 * std::sin(a) * up),
                        ring.thin + (ring.thick - ring.thin) * weight * weight});
    }
    sculpture.chain(joints);
  }
  return sculpture.formula();
}

std::string face_formula() {
  // Hills and hollows on an egg: height * exp(-((x - x0) / a)^2 - ((z - z0) / b)^2), on both sides where x0 is not 0.
  struct Hill {
    double height, x, z, a, b;
  };
  const Hill hills[] = {{0.100, 0.00, 0.40, 0.62, 0.16},      // brow
                        {0.085, 0.30, 0.30, 0.20, 0.075},     // brow ridges
                        {-0.150, 0.32, 0.13, 0.20, 0.13},     // eye sockets
                        {0.085, 0.32, 0.12, 0.115, 0.075},    // eyeballs
                        {0.030, 0.32, 0.150, 0.13, 0.022},    // lids
                        {0.150, 0.00, 0.13, 0.085, 0.26},     // bridge of the nose
                        {0.250, 0.00, -0.13, 0.105, 0.150},   // nose
                        {0.100, 0.00, -0.20, 0.085, 0.070},   // its tip
                        {0.105, 0.115, -0.22, 0.065, 0.055},  // its wings
                        {0.070, 0.42, -0.10, 0.22, 0.17},     // cheekbones
                        {-0.040, 0.34, -0.46, 0.14, 0.22},    // cheeks
                        {0.075, 0.00, -0.50, 0.30, 0.17},     // the mouth's roundness
                        {-0.022, 0.00, -0.34, 0.035, 0.07},   // the groove above the lips
                        {0.050, 0.085, -0.445, 0.10, 0.035},  // upper lip
                        {0.062, 0.00, -0.560, 0.135, 0.042},  // lower lip
                        {-0.050, 0.00, -0.500, 0.20, 0.028},  // between the lips
                        {-0.045, 0.00, -0.655, 0.17, 0.045},  // below them
                        {0.125, 0.00, -0.83, 0.19, 0.12}};    // chin
  std::string height = "0.86*sqrt(max(1-(x/0.86)^2-((z-0.03)/1.22)^2,0.02))";
  for (const Hill& hill : hills) {
    const auto term = [&](double x) {
      height += fmt::format("+({:.4g})*exp(-((x-({:.4g}))/{:.4g})^2-((z-({:.4g}))/{:.4g})^2)", hill.height, x, hill.a,
                            hill.z, hill.b);
    };
    term(hill.x);
    if (hill.x != 0) term(-hill.x);
  }
  return "-y=" + height;
}

std::string face_domain() { return "(x/0.74)^2+((z-0.02)/1.06)^2<=1"; }

}  // namespace taut::paper
