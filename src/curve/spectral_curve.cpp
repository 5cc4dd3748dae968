// A curve as polynomials of degree p on elements in a row: nodes d x (m p + 1), neighbours sharing the node between
// them. Points are evaluated by the barycentric formula, which is stable anywhere in an element; t is clamped to the
// curve.
#include "taut/curve/spectral_curve.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "curve/reference_element.hpp"
#include "taut/core/error.hpp"

namespace taut {

using detail::ReferenceElement;

SpectralCurve::SpectralCurve(int degree, std::vector<double> lengths, Points nodes)
    : degree_(degree), lengths_(std::move(lengths)), nodes_(std::move(nodes)) {
  if (degree < 1 || degree > ReferenceElement::kMaxDegree) {
    throw InvalidArgument("the degree of a curve is 1.." + std::to_string(ReferenceElement::kMaxDegree) + ", not " +
                          std::to_string(degree));
  }
  const Index expected = num_elements() * degree + 1;
  if (lengths_.empty() || nodes_.cols() != expected) {
    throw InvalidArgument(std::to_string(num_elements()) + " elements of degree " + std::to_string(degree) + " have " +
                          std::to_string(expected) + " nodes, not " + std::to_string(nodes_.cols()));
  }
  breaks_.assign(1, 0.0);
  for (const double length : lengths_) {
    if (!(length > 0)) throw InvalidArgument("an element of a curve has no length");
    breaks_.push_back(breaks_.back() + length);
  }
}

SpectralCurve::Place SpectralCurve::locate(double t) const {
  if (breaks_.empty()) throw InvalidArgument("an empty curve has no points");
  // A break belongs to the element on its right; the last element holds its end.
  const auto next = std::upper_bound(breaks_.begin() + 1, breaks_.end() - 1, t);
  const Index element = next - breaks_.begin() - 1;
  const auto e = static_cast<std::size_t>(element);
  return {element, std::clamp(2 * (t - breaks_[e]) / lengths_[e] - 1, -1.0, 1.0)};
}

Vector SpectralCurve::point(double t) const {
  const auto [element, local] = locate(t);
  Vector basis(degree_ + 1);
  ReferenceElement::of_degree(degree_).basis(local, basis);
  return nodes_.middleCols(element * degree_, degree_ + 1) * basis;
}

Vector SpectralCurve::velocity(double t) const {
  const auto [element, local] = locate(t);
  const ReferenceElement& reference = ReferenceElement::of_degree(degree_);
  Vector basis(degree_ + 1);
  reference.basis(local, basis);
  // d/dt from the derivative on [-1, 1].
  const double scale = 2 / lengths_[static_cast<std::size_t>(element)];
  return scale * (nodes_.middleCols(element * degree_, degree_ + 1) * (reference.derivative.transpose() * basis));
}

Points SpectralCurve::sample(const VectorIn& t) const {
  Points result(dim(), t.size());
  for (Index j = 0; j < t.size(); ++j) result.col(j) = point(t(j));
  return result;
}

}  // namespace taut
