// Tables of Gauss-Lobatto-Legendre elements on [-1, 1], degree p = 1 .. kMaxDegree. Nodes are -1, 1 and the zeros of
// P_p', weights 2 / (p (p + 1) P_p^2); nodal derivatives come from barycentric weights (Berrut and Trefethen 2004).
// Check points are the zeros of P_{p+2} with Gauss' weights. All is found by Newton's method in extended precision and
// rounded once. Lobatto's rule is exact to degree 2 p - 1, hence so is the stiffness, of degree 2 p - 2.
#include "curve/reference_element.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <vector>

namespace taut::detail {
namespace {

using Real = long double;

struct Legendre {
  Real value;       // P_n(x)
  Real derivative;  // P_n'(x), |x| < 1
  Real previous;    // P_{n-1}(x)
};

Legendre legendre(int n, Real x) {
  Real before = 1;
  Real now = n == 0 ? Real(1) : x;
  for (int i = 2; i <= n; ++i) {
    const Real next = ((2 * i - 1) * x * now - (i - 1) * before) / i;
    before = now;
    now = next;
  }
  const Real derivative = std::abs(x) < 1 ? n * (before - x * now) / (1 - x * x) : Real(0);
  return {now, derivative, before};
}

std::vector<Real> lobatto_nodes(int p) {
  std::vector<Real> node(static_cast<std::size_t>(p + 1));
  for (int i = 0; i <= p; ++i) {
    // Chebyshev's extrema lie close to Lobatto's nodes; likewise below for Gauss.
    Real x = -std::cos(std::numbers::pi_v<Real> * i / p);
    if (i == 0 || i == p) {
      node[static_cast<std::size_t>(i)] = i == 0 ? -1 : 1;
      continue;
    }
    for (int step = 0; step < 50; ++step) {  // zero of P_p', using (1 - x^2) P'' = 2 x P' - p (p + 1) P
      const Legendre l = legendre(p, x);
      const Real second = (2 * x * l.derivative - p * (p + 1) * l.value) / (1 - x * x);
      const Real change = l.derivative / second;
      x -= change;
      if (std::abs(change) < 1e-19L) break;
    }
    node[static_cast<std::size_t>(i)] = x;
  }
  for (int i = 0; i <= p / 2; ++i) {  // exactly symmetric
    const auto low = static_cast<std::size_t>(i);
    const auto high = static_cast<std::size_t>(p - i);
    const Real half = (node[high] - node[low]) / 2;
    node[low] = -half;
    node[high] = half;
  }
  return node;
}

// The derivative of nodal values at the nodes; row i. From barycentric weights b.
Eigen::Matrix<Real, -1, -1> differentiation(const std::vector<Real>& node, const std::vector<Real>& b) {
  const auto n = static_cast<Eigen::Index>(node.size());
  Eigen::Matrix<Real, -1, -1> result(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Real sum = 0;
    for (Eigen::Index j = 0; j < n; ++j) {
      if (j == i) continue;
      const auto a = static_cast<std::size_t>(i);
      const auto c = static_cast<std::size_t>(j);
      result(i, j) = b[c] / b[a] / (node[a] - node[c]);
      sum += result(i, j);
    }
    // The derivative of a constant is zero, exactly.
    result(i, i) = -sum;
  }
  return result;
}

ReferenceElement build(int p) {
  ReferenceElement element;
  element.degree = p;
  const int n = p + 1;
  const std::vector<Real> node = lobatto_nodes(p);
  std::vector<Real> bary(node.size());
  for (std::size_t i = 0; i < node.size(); ++i) {
    Real product = 1;
    for (std::size_t j = 0; j < node.size(); ++j) {
      // The factor 2 keeps the products near 1: the capacity of [-1, 1] is a half.
      if (j != i) product *= 2 * (node[i] - node[j]);
    }
    bary[i] = 1 / product;
  }
  const auto derivative = differentiation(node, bary);

  Eigen::Matrix<Real, -1, 1> weight(n);
  for (int i = 0; i < n; ++i) {
    const Real value = legendre(p, node[static_cast<std::size_t>(i)]).value;
    weight(i) = 2 / (p * (p + 1) * value * value);
  }
  const Eigen::Matrix<Real, -1, -1> stiffness = derivative.transpose() * weight.asDiagonal() * derivative;

  const int checks = p + 2;
  element.check_node.resize(checks);
  element.check_weight.resize(checks);
  Eigen::Matrix<Real, -1, -1> value(n, checks);
  for (int g = 0; g < checks; ++g) {
    Real x = -std::cos(std::numbers::pi_v<Real> * (g + Real(0.75)) / (checks + Real(0.5)));
    for (int step = 0; step < 50; ++step) {
      const Legendre l = legendre(checks, x);
      const Real change = l.value / l.derivative;
      x -= change;
      if (std::abs(change) < 1e-19L) break;
    }
    const Legendre l = legendre(checks, x);
    element.check_node(g) = static_cast<double>(x);
    element.check_weight(g) = static_cast<double>(2 / ((1 - x * x) * l.derivative * l.derivative));
    Real sum = 0;
    for (int i = 0; i < n; ++i) {
      const auto a = static_cast<std::size_t>(i);
      value(i, g) = bary[a] / (x - node[a]);
      sum += value(i, g);
    }
    value.col(g) /= sum;
  }
  // u'(x) = sum_i u'(node_i) l_i(x): the derivative of a nodal polynomial is nodal again.
  const Eigen::Matrix<Real, -1, -1> first = derivative.transpose() * value;
  const Eigen::Matrix<Real, -1, -1> second = derivative.transpose() * first;

  element.check_modes.setZero(checks, 4);
  for (int c = 0; c < 4 && p >= 5; ++c) {
    const int k = p - 5 + c;
    for (int g = 0; g < checks; ++g) {
      const Real mode = k == 0 ? Real(1) : legendre(k, element.check_node(g)).value;
      element.check_modes(g, c) = static_cast<double>(mode * (2 * k + 1) / 2) * element.check_weight(g);
    }
  }

  element.node.resize(n);
  element.barycentric.resize(n);
  for (int i = 0; i < n; ++i) {
    element.node(i) = static_cast<double>(node[static_cast<std::size_t>(i)]);
    element.barycentric(i) = static_cast<double>(bary[static_cast<std::size_t>(i)]);
  }
  element.weight = weight.cast<double>();
  element.derivative = derivative.cast<double>();
  element.stiffness = stiffness.cast<double>();
  element.check_value = value.cast<double>();
  element.check_first = first.cast<double>();
  element.check_second = second.cast<double>();
  return element;
}

}  // namespace

void ReferenceElement::basis(double xi, Eigen::Ref<Eigen::VectorXd> values) const {
  double sum = 0;
  for (int i = 0; i <= degree; ++i) {
    const double distance = xi - node(i);
    // At a node the barycentric formula is 0 / 0.
    if (distance == 0) {
      values.setZero();
      values(i) = 1;
      return;
    }
    values(i) = barycentric(i) / distance;
    sum += values(i);
  }
  values /= sum;
}

const ReferenceElement& ReferenceElement::of_degree(int degree) {
  assert(degree >= 1 && degree <= kMaxDegree);
  static const auto tables = [] {
    std::array<ReferenceElement, kMaxDegree + 1> all;
    for (int p = 1; p <= kMaxDegree; ++p) all[static_cast<std::size_t>(p)] = build(p);
    return all;
  }();
  return tables[static_cast<std::size_t>(degree)];
}

}  // namespace taut::detail
