#include "core/linear_algebra.hpp"
#include "taut/surface/conformance.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/random.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

/// A gradient this small against the gradients around it has vanished; a unit gradient this close to the span of others
/// depends on them. Points found by iteration lie near a singularity only to the root of rounding.
constexpr double kLost = 1e-5;
/// How far around the point is looked, relative to its coordinates.
constexpr double kAround = 1e-3;
constexpr int kDirections = 16;
constexpr int kOtherPoints = 4;
/// Another point of the surface is at least this far away, relative to the coordinates.
constexpr double kElsewhere = 0.02;
/// The coordinates say little about the size of a surface: each other point is sought this many times as far.
constexpr double kFarther = 5;
constexpr int kSeeds = 24;
/// A pivot below this part of the largest is that of a dependent equation.
constexpr double kDependent = 1e-9;

/// Uniform in [-1, 1).
double either_way(std::mt19937_64& random) { return 2 * detail::random_share(random) - 1; }

Vector random_step(Index dim, double size, std::mt19937_64& random) {
  Vector step(dim);
  for (double& c : step) c = either_way(random);
  return size * step.normalized();
}

Points value_of(const ImplicitFunction& function, const Points& x) {
  Points result(function.codim(), x.cols());
  function.make_evaluator()->evaluate({.n = x.cols(), .x = x.data(), .value = result.data()});
  return result;
}

Points jacobian_of(const ImplicitFunction& function, const Points& x) {
  Points result(function.dim() * function.codim(), x.cols());
  function.make_evaluator()->evaluate({.n = x.cols(), .x = x.data(), .jacobian = result.data()});
  return result;
}

double size_of(const Vector& x) { return std::max(x.cwiseAbs().maxCoeff(), 1e-3); }

/// F at x + h u and x - h u for several u, a column each.
Points around(const Vector& x, double h) {
  std::mt19937_64 random(3);
  Points near(x.size(), 2 * kDirections);
  for (Index i = 0; i < kDirections; ++i) {
    const Vector step = random_step(x.size(), h, random);
    near.col(2 * i) = x + step;
    near.col(2 * i + 1) = x - step;
  }
  return near;
}

/// What the values around x say about one equation that touches zero there without crossing it.
std::optional<RankDiagnosis::Fault> touching(const Vector& far, const Vector& near) {
  const bool one_sided = (far.array() > 0).all() || (far.array() < 0).all();
  if (!one_sided) return std::nullopt;
  const double growth = far.cwiseAbs().mean() / near.cwiseAbs().mean();  // over twice the distance
  if (growth > 3 && growth < 6) return RankDiagnosis::Fault::squared;
  if (growth > 1.6 && growth <= 3) return RankDiagnosis::Fault::root;
  return std::nullopt;
}

std::vector<RankDiagnosis::Finding> find_faults(const ImplicitFunction& function, const Vector& x) {
  using Fault = RankDiagnosis::Fault;
  const Index d = function.dim();
  const Index k = function.codim();
  const double h = kAround * size_of(x);
  const Points far_points = around(x, h);
  const Points far = value_of(function, far_points);
  const Points near = value_of(function, around(x, h / 2));
  const Points far_jacobian = jacobian_of(function, far_points);
  const Eigen::MatrixXd gradients = jacobian_of(function, x).reshaped(d, k);

  std::vector<RankDiagnosis::Finding> findings;
  std::vector<Index> independent;
  Eigen::MatrixXd basis(d, 0);  // unit gradients of the independent equations
  for (Index i = 0; i < k; ++i) {
    if (!far.row(i).allFinite()) {
      findings.push_back({Fault::undefined, i, {}});
      continue;
    }
    if (const auto fault = touching(far.row(i), near.row(i))) {
      findings.push_back({*fault, i, {}});
      continue;
    }
    const Vector gradient = gradients.col(i);
    const double usual = far_jacobian.middleRows(i * d, d).colwise().norm().maxCoeff();
    if (!gradient.allFinite() || !(gradient.norm() > kLost * usual)) {
      findings.push_back({Fault::singular, i, {}});
      continue;
    }
    const Vector unit = gradient.normalized();
    if (basis.cols() > 0) {
      const Vector share = detail::least_squares(basis, unit);
      if (basis.cols() == d || (unit - basis * share).norm() <= kLost) {
        RankDiagnosis::Finding finding{Fault::dependent, i, {}};
        for (Index j = 0; j < share.size(); ++j) {
          if (std::abs(share(j)) > kLost) finding.others.push_back(independent[static_cast<std::size_t>(j)]);
        }
        findings.push_back(std::move(finding));
        continue;
      }
    }
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols<1>() = unit;
    independent.push_back(i);
  }
  return findings;
}

/// To the surface by the shortest steps of least squares, which dependent equations do not disturb. False when the
/// steps do not die out.
bool descend_to_surface(const ImplicitFunction& function, Vector& x) {
  double scale = size_of(x);
  for (int step = 0; step < 80; ++step) {
    const Vector value = value_of(function, x);
    const Eigen::MatrixXd gradients = jacobian_of(function, x).reshaped(function.dim(), function.codim());
    if (!value.allFinite()) return false;
    if (!gradients.allFinite()) return value.norm() <= 1e-12;  // exactly on the root of a sum of squares
    const Vector move = detail::least_squares(gradients.transpose(), value, kDependent);
    const double size = move.norm();
    if (!(size < 1e6 * scale)) return false;
    x -= move;
    scale = std::max(scale, size_of(x));
    if (size <= 1e-10 * scale) return true;
  }
  return false;
}

bool same(const std::vector<RankDiagnosis::Finding>& a, const std::vector<RankDiagnosis::Finding>& b) {
  return std::ranges::equal(
      a, b, [](const auto& f, const auto& g) { return f.equation == g.equation && f.fault == g.fault; });
}

std::string counted(const std::vector<Index>& equations) {
  std::string text = equations.size() == 1 ? "equation " : "equations ";
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (i > 0) text += i + 1 == equations.size() ? " and " : ", ";
    text += std::to_string(equations[i] + 1);
  }
  return text;
}

}  // namespace

std::optional<RankDiagnosis> diagnose_rank(const ImplicitFunction& function, const VectorIn& x) {
  if (x.size() != function.dim()) {
    throw InvalidArgument("the point to diagnose has " + std::to_string(x.size()) + " coordinates, the surface " +
                          std::to_string(function.dim()) + " dimensions");
  }
  if (!x.allFinite()) throw InvalidArgument("the point to diagnose is not finite");
  RankDiagnosis result;
  result.point = x;
  result.findings = find_faults(function, result.point);
  if (result.findings.empty()) return std::nullopt;
  std::mt19937_64 random(5);
  std::vector<std::vector<RankDiagnosis::Finding>> elsewhere;
  double step = 0.2 * size_of(result.point);
  for (int i = 0; i < kOtherPoints; ++i, step *= kFarther) {
    Vector other = result.point + random_step(x.size(), step, random);
    if (!descend_to_surface(function, other)) continue;
    if ((other - result.point).norm() < kElsewhere * size_of(result.point)) continue;
    elsewhere.push_back(find_faults(function, other));
  }
  if (elsewhere.empty()) return result;
  result.everywhere =
      std::ranges::all_of(elsewhere, [&](const auto& findings) { return same(findings, result.findings); });
  for (RankDiagnosis::Finding& finding : result.findings) {
    const auto is_this = [&](const auto& f) { return f.equation == finding.equation && f.fault == finding.fault; };
    const bool all_over =
        std::ranges::all_of(elsewhere, [&](const auto& findings) { return std::ranges::any_of(findings, is_this); });
    // An equation that crosses zero elsewhere is no square: here it has a cusp, too thin to be met on its other side.
    const bool here_only =
        finding.fault != RankDiagnosis::Fault::dependent && finding.fault != RankDiagnosis::Fault::undefined;
    if (!all_over && here_only) finding.fault = RankDiagnosis::Fault::singular;
  }
  return result;
}

std::optional<RankDiagnosis> diagnose_rank(const ImplicitFunction& function, const Box& box) {
  if (box.lower.size() != function.dim() || box.upper.size() != function.dim()) {
    throw InvalidArgument("the box to diagnose in has " + std::to_string(box.dim()) + " dimensions, the surface " +
                          std::to_string(function.dim()));
  }
  std::mt19937_64 random(7);
  for (int i = 0; i < kSeeds; ++i) {
    Vector x = (box.lower + box.upper) / 2;
    for (Index c = 0; c < x.size(); ++c) x(c) += 0.45 * either_way(random) * (box.upper(c) - box.lower(c));
    if (!descend_to_surface(function, x)) continue;
    if (auto found = diagnose_rank(function, VectorIn(x)); found && found->everywhere) return found;
    return std::nullopt;  // a regular point of the surface
  }
  return std::nullopt;
}

std::string RankDiagnosis::text() const {
  const Finding& first = findings.front();
  std::vector<Index> alike;
  for (const Finding& finding : findings) {
    if (finding.fault == first.fault && (finding.fault != Fault::dependent || finding.others == first.others)) {
      alike.push_back(finding.equation);
    }
  }
  const std::string where = " at " + detail::describe(point) + (everywhere ? " and all over the surface" : "");
  std::string text = "rank deficient: ";
  switch (first.fault) {
    case Fault::dependent:
      text += counted(alike) + (alike.size() == 1 ? " depends on " : " depend on ") + counted(first.others) + where;
      text += everywhere ? "; leave " + std::string(alike.size() == 1 ? "it" : "them") + " out"
                         : "; the surfaces they describe touch there: take another point";
      break;
    case Fault::squared:
      text +=
          counted(alike) + (alike.size() == 1 ? " does" : " do") + " not change sign" + where +
          ", as if written as a square; write it without the square, or the squared parts as equations of their own";
      break;
    case Fault::root:
      text += counted(alike) + (alike.size() == 1 ? " does" : " do") + " not change sign" + where +
              ", as if written as the root of a sum of squares; write the parts as equations of their own";
      break;
    case Fault::undefined:
      text += counted(alike) + (alike.size() == 1 ? " is" : " are") + " not defined on every side of " +
              detail::describe(point) + ", as a root or a logarithm is not: take a point further in";
      break;
    case Fault::singular:
      text += "the gradient of " + counted(alike) + " vanishes or is undefined" + where +
              ": an apex, a cusp, a node or a kink; take another point";
      break;
  }
  const std::size_t more = findings.size() - alike.size();
  if (more > 0) {
    text += " (and " + std::to_string(more) + " more:";
    for (const Finding& finding : findings) {
      if (std::ranges::find(alike, finding.equation) != alike.end()) continue;
      text.append(" ").append(std::to_string(finding.equation + 1));
      if (finding.fault == Fault::dependent) text += " depends on " + counted(finding.others);
      text += finding.equation == findings.back().equation ? "" : ",";
    }
    text += ")";
  }
  return text;
}

}  // namespace taut
