// Shortens a strand within its class. Energy E = 1/2 sum |p_{i+1} - p_i|^2 / w_i with w_i the segments' lengths at the
// last weighing; the step is the gradient of E in the metric of the stiffness matrix (a Sobolev gradient), which moves
// long waves as fast as short ones, so that the number of steps hardly depends on that of points. A step must gain
// enough (Armijo) and keep its bounds: no point farther than a gap, no normal turned by more than half a radian, no
// segment that could go round another way. So every strand is joined to the one before by short segments, and no handle
// is jumped over.
#include "homotopy/shortening.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>

#include "core/random.hpp"

namespace taut::detail {
namespace {

constexpr double kMostTurn = 0.5;         // of a point's normal in one step, radians
constexpr double kCutTurn = 0.5;          // segments along which the normal turns by more are cut...
constexpr double kMostSegmentTurn = 0.9;  // ... and no step may make it turn by more than this
constexpr double kMostStretch = 3;        // gaps that a segment may grow to before it is cut
constexpr double kSufficient = 0.1;       // of the predicted decrease
constexpr int kReweighEvery = 8;
constexpr int kMostSteps = 8000;  // in all
constexpr Index kFewestPoints = 12;

/// Solves the symmetric tridiagonal system with this diagonal and `off(i)` between i and i + 1 in place, a column of
/// `x` an unknown. With `corner` != 0, there is that between the last and the first as well.
void solve_tridiagonal(std::vector<double> diagonal, const std::vector<double>& off, double corner, Points& x) {
  const auto n = static_cast<Index>(diagonal.size());
  // The corner as a rank-one change (Sherman and Morrison): A = B + v v^T corner, v = e_1 + e_n.
  Vector v;
  if (corner != 0) {
    v = Vector::Zero(n);
    v(0) = v(n - 1) = 1;
    diagonal.front() -= corner;
    diagonal.back() -= corner;
  }
  const auto at = [](Index i) { return static_cast<std::size_t>(i); };
  for (Index i = 1; i < n; ++i) {
    const double factor = off[at(i - 1)] / diagonal[at(i - 1)];
    diagonal[at(i)] -= factor * off[at(i - 1)];
    x.col(i) -= factor * x.col(i - 1);
    if (corner != 0) v(i) -= factor * v(i - 1);
  }
  for (Index i = n; i-- > 0;) {
    if (i + 1 < n) {
      x.col(i) -= off[at(i)] * x.col(i + 1);
      if (corner != 0) v(i) -= off[at(i)] * v(i + 1);
    }
    x.col(i) /= diagonal[at(i)];
    if (corner != 0) v(i) /= diagonal[at(i)];
  }
  if (corner == 0) return;
  const Vector overlap = x.col(0) + x.col(n - 1);
  const double factor = corner / (1 + corner * (v(0) + v(n - 1)));
  x -= factor * overlap * v.transpose();
}

}  // namespace

Shortening::Shortening(const StrandMaker& maker, Strand strand, double gap, Index most_projected)
    : maker_(maker),
      strand_(std::move(strand)),
      gap_(gap),
      scale_(strand_.points.cwiseAbs().maxCoeff()),
      last_projected_(maker.num_projected() + most_projected) {
  set_weights();
}

void Shortening::set_weights() {
  weights_.resize(static_cast<std::size_t>(strand_.num_segments()));
  // Segments much shorter than others would only spoil the condition.
  const double least = 1e-6 * strand_.length() / static_cast<double>(strand_.num_segments());
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    weights_[i] = std::max(strand_.segment(static_cast<Index>(i)), least);
  }
}

double Shortening::energy(const Points& points) const {
  double sum = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    const auto j = static_cast<Index>(i);
    sum += (points.col(strand_.after(j)) - points.col(j)).squaredNorm() / weights_[i];
  }
  return sum / 2;
}

/// P G P f: f the pull of the segments on each point, G the inverse of the stiffness matrix (and a mass for a loop,
/// which nothing holds in place), P the projection onto the tangent spaces. slope = f . P G P f.
Points Shortening::direction(double& slope) const {
  const Index n = strand_.num_points();
  const Index dim = strand_.points.rows();
  const Index codim = strand_.normals.rows() / dim;
  const auto make_tangent = [&](Points& x) {
    for (Index i = 0; i < n; ++i) {
      const Eigen::Map<const Eigen::MatrixXd> normal(strand_.normals.col(i).data(), dim, codim);
      x.col(i) -= normal * (normal.transpose() * x.col(i)).eval();
    }
    if (!strand_.closed) x.col(0).setZero(), x.col(n - 1).setZero();
  };
  Points pull = Points::Zero(dim, n);
  double length = 0;
  for (Index i = 0; i < strand_.num_segments(); ++i) {
    const double h = weights_[static_cast<std::size_t>(i)];
    const Vector tension = (strand_.points.col(strand_.after(i)) - strand_.points.col(i)) / h;
    pull.col(i) += tension;
    pull.col(strand_.after(i)) -= tension;
    length += h;
  }
  make_tangent(pull);
  const Index first = strand_.closed ? 0 : 1;
  const Index inner = strand_.closed ? n : n - 2;
  // A loop can be moved as a whole at no cost: the mass, of the size of the longest wave's stiffness, makes that
  // regular.
  const double mass = strand_.closed ? std::pow(2 * std::numbers::pi / length, 2) : 0;
  std::vector<double> diagonal(static_cast<std::size_t>(inner));
  std::vector<double> off(static_cast<std::size_t>(inner));
  for (Index i = 0; i < inner; ++i) {
    const Index j = first + i;
    const double before = weights_[static_cast<std::size_t>(j > 0 ? j - 1 : n - 1)];
    const double after = weights_[static_cast<std::size_t>(j)];
    diagonal[static_cast<std::size_t>(i)] = 1 / before + 1 / after + mass * (before + after) / 2;
    off[static_cast<std::size_t>(i)] = -1 / after;
  }
  Points x = pull.middleCols(first, inner);
  solve_tridiagonal(std::move(diagonal), off, strand_.closed ? off.back() : 0, x);
  Points move = Points::Zero(dim, n);
  move.middleCols(first, inner) = x;
  make_tangent(move);
  slope = pull.cwiseProduct(move).sum();
  return move;
}

bool Shortening::is_bounded(const Strand& moved) const {
  for (Index i = 0; i < moved.num_points(); ++i) {
    if (maker_.turn(strand_.normals.col(i), moved.normals.col(i)) > kMostTurn) return false;
  }
  for (Index i = 0; i < moved.num_segments(); ++i) {
    const Index j = moved.after(i);
    if (moved.segment(i) > kMostStretch * gap_) return false;
    const double before = maker_.turn(strand_.normals.col(i), strand_.normals.col(j));
    if (maker_.turn(moved.normals.col(i), moved.normals.col(j)) > std::max(kMostSegmentTurn, before)) return false;
  }
  return true;
}

bool Shortening::step(const Points& move, double most, double slope) {
  const double before = energy(strand_.points);
  double part = most > gap_ ? gap_ / most : 1.0;
  for (int halving = 0; halving < 30; ++halving, part /= 2) {
    Strand moved{strand_.points + part * move, {}, strand_.closed};
    const auto found = maker_.project(moved.points, moved.normals, part * most + 1e-12 * scale_);
    if (!found.all()) continue;
    if (!strand_.closed) {
      const Index last = strand_.num_points() - 1;
      for (const Index end : {Index{0}, last}) {
        moved.points.col(end) = strand_.points.col(end);
        moved.normals.col(end) = strand_.normals.col(end);
      }
    }
    if (!(energy(moved.points) <= before - kSufficient * part * slope) || !is_bounded(moved)) continue;
    strand_ = std::move(moved);
    return true;
  }
  return false;
}

/// Leaves out points that crowd where the surface is nearly flat.
void Shortening::thin_out() {
  std::vector<Index> kept;
  const Index n = strand_.num_points();
  for (Index i = 0; i < n; ++i) {
    const bool must_stay = i == 0 || i + 1 == n || n - i + static_cast<Index>(kept.size()) <= kFewestPoints;
    if (!must_stay) {
      const Index before = kept.back();
      const double length = (strand_.points.col(i + 1) - strand_.points.col(before)).norm();
      const bool crowded =
          strand_.segment(i) + (strand_.points.col(i) - strand_.points.col(before)).norm() < 0.8 * gap_;
      if (crowded && length > 0 && maker_.turn(strand_.normals.col(before), strand_.normals.col(i + 1)) < 0.2) continue;
    }
    kept.push_back(i);
  }
  if (static_cast<Index>(kept.size()) == n) return;
  strand_.points = strand_.points(Eigen::all, kept).eval();
  strand_.normals = strand_.normals(Eigen::all, kept).eval();
}

bool Shortening::returns() const {
  const double apart = (strand_.points.col(strand_.num_points() - 1) - strand_.points.col(0)).norm();
  return strand_.closed || apart <= 1e-12 * scale_;
}

// A loop of half a segment whose normals agree lies on a flat piece of surface and bounds a disc there.
bool Shortening::is_a_point() const {
  const double length = strand_.length();
  if (!returns() || length > gap_ / 2) return false;
  if (length < 1e-9 * scale_) return true;
  for (Index i = 1; i < strand_.num_points(); ++i) {
    if (maker_.turn(strand_.normals.col(0), strand_.normals.col(i)) > kMostTurn) return false;
  }
  return true;
}

Shortening::Outcome Shortening::run(double settle, const Context& context) {
  for (int i = 0; num_steps_ < kMostSteps && maker_.num_projected() < last_projected_; ++i) {
    context.check_cancelled();
    if (strand_.num_points() < 3 || is_a_point()) return is_a_point() ? Outcome::a_point : Outcome::settled;
    if (i % kReweighEvery == 0) {
      thin_out();
      set_weights();
    }
    double slope = 0;
    const Points move = direction(slope);
    const double most = move.colwise().norm().maxCoeff();
    // Small steps, or a gain that rounding would hide.
    if (!(most > settle) || !(slope > 1e-13 * energy(strand_.points))) return Outcome::settled;
    if (!step(move, most, slope)) return Outcome::stuck;
    ++num_steps_;
    const Index points = strand_.num_points();
    if (maker_.refine(strand_, 2 * gap_, kCutTurn) >= 0) return Outcome::stuck;
    if (strand_.num_points() != points) set_weights();
  }
  return Outcome::stuck;
}

void Shortening::disturb(int round) {
  std::mt19937_64 random(static_cast<std::uint64_t>(round));
  const Index n = strand_.num_points();
  Points move = Points::Zero(strand_.points.rows(), n);
  for (int wave = 1; wave <= 3; ++wave) {
    const Vector sine = random_direction(strand_.points.rows(), random);
    Vector cosine = Vector::Zero(sine.size());
    // A loop has waves of both phases, and a shift; with fixed ends only sines vanish there.
    if (strand_.closed) cosine = random_direction(sine.size(), random);
    for (Index i = 0; i < n; ++i) {
      const double angle = std::numbers::pi * (strand_.closed ? 2 * (wave - 1) : wave) * static_cast<double>(i) /
                           static_cast<double>(n - (strand_.closed ? 0 : 1));
      move.col(i) += std::sin(angle) * sine + std::cos(angle) * cosine;
    }
  }
  if (!strand_.closed) move.col(0).setZero(), move.col(n - 1).setZero();
  const double most = move.colwise().norm().maxCoeff();
  for (double part = 0.25 * gap_ / most; part > 1e-6 * gap_ / most; part /= 2) {
    Strand moved{strand_.points + part * move, {}, strand_.closed};
    const auto found = maker_.project(moved.points, moved.normals, gap_);
    if (!found.all() || !is_bounded(moved)) continue;
    if (!strand_.closed) {
      for (const Index end : {Index{0}, n - 1}) {
        moved.points.col(end) = strand_.points.col(end);
        moved.normals.col(end) = strand_.normals.col(end);
      }
    }
    strand_ = std::move(moved);
    set_weights();
    return;
  }
}

bool Shortening::is_followed_by(const PointsIn& curve) const {
  return maker_.is_near(strand_.polyline(), curve, 2 * gap_);
}

}  // namespace taut::detail
