// A surface as a complex of smooth faces.
//
// A choice of sides s for the kinks makes F smooth: F_s. Equal formulas are one face. Next to a surface point x, where
// the conditions in Z vanish, each choice of sides for Z claims a wedge of its tangent plane,
//   { v : grad F_s . v = 0,  s_z grad c_z . v >= 0 for z in Z,  grad g_j . v >= 0 for domain components in Z },
// and the wedges that are not empty lie around x in a ring, since grad F points to the same side of all of them. Wedges
// of one face that touch are one: there F does not depend on the side.
#include "strata/faceted_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "surface/formula/affine.hpp"
#include "surface/formula/formula_function.hpp"

namespace taut::detail {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
/// More conditions than this at one point are not sorted out: 2^n choices.
constexpr std::size_t kMostAtAPoint = 8;
/// Rays of neighbouring wedges agree within this, radians: the point is known to rounding, the faces are smooth.
constexpr double kSameRay = 1e-5;
/// Thinner wedges are rounding.
constexpr double kThinWedge = 1e-6;
/// Squared sine of the angle between level sets below which they do not cross.
constexpr double kParallel = 1e-14;
/// A condition whose level set is as flat as this against the face has no edge to first order, radians.
constexpr double kTangential = 1e-7;

double in_turn(double angle) {
  angle = std::fmod(angle, kTwoPi);
  return angle < 0 ? angle + kTwoPi : angle;
}

/// Component i of a function with `count` of them, as what it is where it is affine.
AffineForm affine_form(Evaluator& evaluator, int count, int i) {
  const Point3 origin = Point3::Zero();
  Eigen::VectorXd value(count);
  Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(3, count);
  evaluator.evaluate({.n = 1, .x = origin.data(), .value = value.data(), .jacobian = gradient.data()});
  return {gradient.col(i), value(i)};
}

/// Second derivative of component i along t.
double second_derivative(Evaluator& evaluator, int count, int i, const Point3& x, const Point3& t) {
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
  const Eigen::VectorXd weight = Eigen::VectorXd::Unit(count, i);
  evaluator.evaluate({.n = 1, .x = x.data(), .weight = weight.data(), .hessian = hessian.data()});
  return t.dot(hessian * t);
}

}  // namespace

bool is_kinked(const Surface& surface) {
  if (surface.dim() != 3 || surface.codim() != 1) return false;
  const auto* formula = dynamic_cast<const FormulaFunction*>(&surface.function());
  return formula != nullptr && formula->program().has_kinks();
}

std::unique_ptr<FacetedSurface> FacetedSurface::of(const Surface& surface) {
  if (surface.dim() != 3 || surface.codim() != 1) return nullptr;
  std::unique_ptr<FormulaKinks> kinks = FormulaKinks::of(surface.function(), surface.domain());
  if (!kinks && surface.domain() == nullptr) return nullptr;
  std::unique_ptr<FacetedSurface> result(new FacetedSurface(surface));
  if (kinks) {
    result->num_kinks_ = static_cast<int>(kinks->num_kinks());
    result->first_in_domain_ = static_cast<int>(kinks->first_in_domain());
    result->conditions_function_ = kinks->conditions();
    result->conditions_ = result->conditions_function_->make_evaluator();
    result->kinks_ = std::move(kinks);
  }
  if (surface.domain() != nullptr) {
    result->num_domain_ = static_cast<int>(surface.domain()->codim());
    result->domain_ = surface.domain()->make_evaluator();
  }
  return result;
}

std::unique_ptr<FacetedSurface> FacetedSurface::clone() const {
  std::unique_ptr<FacetedSurface> copy(new FacetedSurface(surface_));
  copy->scale = scale;
  copy->num_kinks_ = num_kinks_;
  copy->first_in_domain_ = first_in_domain_;
  copy->num_domain_ = num_domain_;
  if (kinks_) {
    copy->kinks_ = std::make_unique<FormulaKinks>(*kinks_);
    copy->conditions_function_ = conditions_function_;
    copy->conditions_ = conditions_function_->make_evaluator();
  }
  if (domain_) copy->domain_ = surface_.domain()->make_evaluator();
  for (const std::unique_ptr<SmoothFace>& face : faces_) {
    copy->faces_.push_back(std::make_unique<SmoothFace>(face->surface));
    copy->faces_.back()->text = face->text;
    copy->faces_.back()->flat = face->flat;
  }
  for (const Condition& c : smooth_) {
    copy->smooth_.push_back(
        {c.function, (c.function ? *c.function : *surface_.domain()).make_evaluator(), c.component, c.count, c.flat});
  }
  copy->face_of_sides_ = face_of_sides_;
  copy->face_of_roots_ = face_of_roots_;
  copy->smooth_of_ = smooth_of_;
  copy->smooth_of_sides_ = smooth_of_sides_;
  copy->edges_ = edges_;
  copy->edge_of_ = edge_of_;
  return copy;
}

void FacetedSurface::forget_since(const Known& known) {
  const auto forget = [](auto& map, std::size_t count) {
    std::erase_if(map, [&](const auto& entry) { return static_cast<std::size_t>(entry.second) >= count; });
  };
  if (faces_.size() > known.faces) {
    faces_.resize(known.faces);
    forget(face_of_sides_, known.faces);
    forget(face_of_roots_, known.faces);
    last_face_ = -1;
  }
  if (smooth_.size() > known.conditions) {
    smooth_.erase(smooth_.begin() + static_cast<std::ptrdiff_t>(known.conditions), smooth_.end());
    forget(smooth_of_, known.conditions);
    forget(smooth_of_sides_, known.conditions);
  }
  if (edges_.size() > known.edges) {
    edges_.resize(known.edges);
    forget(edge_of_, known.edges);
  }
}

void FacetedSurface::undecided(const Box& box, std::vector<int>& found) {
  found.clear();
  const auto look = [&](Evaluator* evaluator, int count, int first) {
    if (evaluator == nullptr) return;
    Eigen::VectorXd lower(count);
    Eigen::VectorXd upper(count);
    const bool bounded = evaluator->bounds({.n = 1,
                                            .lower = box.lower.data(),
                                            .upper = box.upper.data(),
                                            .value_lower = lower.data(),
                                            .value_upper = upper.data()});
    for (int i = 0; i < count; ++i) {
      if (!bounded || !(lower(i) > 0 || upper(i) < 0)) found.push_back(first + i);
    }
  };
  look(conditions_.get(), num_kinks_, 0);
  look(domain_.get(), num_domain_, num_kinks_);
  drop_idle_kinks(found);
}

void FacetedSurface::drop_idle_kinks(std::vector<int>& conditions) const {
  if (std::any_of(conditions.begin(), conditions.end(), [&](int i) { return i >= num_kinks_; })) return;
  std::erase_if(conditions, [&](int i) { return i >= first_in_domain_; });
}

void FacetedSurface::evaluate_conditions(const Point3& x, Eigen::VectorXd& value,
                                         Eigen::Matrix<double, 3, Eigen::Dynamic>* gradient) {
  value.resize(num_conditions());
  if (gradient != nullptr) gradient->resize(3, num_conditions());
  const auto fill = [&](Evaluator* evaluator, int first) {
    if (evaluator == nullptr) return;
    evaluator->evaluate({.n = 1,
                         .x = x.data(),
                         .value = value.data() + first,
                         .jacobian = gradient != nullptr ? gradient->data() + 3 * first : nullptr});
  };
  if (gradient != nullptr) gradient->setZero();
  fill(conditions_.get(), 0);
  fill(domain_.get(), num_kinks_);
}

int FacetedSurface::face_of(const FormulaKinks::Sides& sides) {
  if (last_face_ >= 0 && sides == last_sides_) return last_face_;
  last_sides_ = sides;
  const auto known = face_of_sides_.find(sides);
  if (known != face_of_sides_.end()) return last_face_ = known->second;
  const std::vector<NodeId> roots = kinks_ ? kinks_->face(sides) : std::vector<NodeId>{};
  auto found = face_of_roots_.find(roots);
  if (found == face_of_roots_.end()) {
    std::shared_ptr<const ImplicitFunction> function;
    if (!roots.empty()) {
      function = kinks_->function(roots);
    } else {
      function = std::shared_ptr<const ImplicitFunction>(std::make_shared<Surface>(surface_), &surface_.function());
    }
    faces_.push_back(std::make_unique<SmoothFace>(Surface(std::move(function))));
    SmoothFace& made = *faces_.back();
    if (!roots.empty()) made.text = kinks_->text(roots.front());
    if (affine_components(made.surface.function()).front()) made.flat = affine_form(*made.evaluator, 1, 0);
    found = face_of_roots_.emplace(roots, static_cast<int>(faces_.size()) - 1).first;
  }
  face_of_sides_.emplace(sides, found->second);
  return last_face_ = found->second;
}

const FormulaKinks::Sides& FacetedSurface::sides_at(const Point3& x) {
  evaluate_conditions(x, values_, nullptr);
  sides_.resize(static_cast<std::size_t>(num_kinks_));
  for (int i = 0; i < num_kinks_; ++i) sides_[static_cast<std::size_t>(i)] = values_(i) >= 0 ? 1 : -1;
  return sides_;
}

int FacetedSurface::face_at(const Point3& x) { return face_of(sides_at(x)); }

std::vector<std::pair<int, FormulaKinks::Sides>> FacetedSurface::faces_near(const Point3& x,
                                                                            const std::vector<int>& kinks) {
  const FormulaKinks::Sides sides = sides_at(x);
  std::vector<std::pair<int, FormulaKinks::Sides>> found;
  if (!kinks_) {
    found.emplace_back(face_of(sides), sides);
    return found;
  }
  for (FormulaKinks::Sides& choice : kinks_->choices(sides, kinks)) {
    const int face = face_of(choice);
    found.emplace_back(face, std::move(choice));
  }
  return found;
}

double FacetedSurface::violation(int face, const Point3& x, int* condition) {
  (void)sides_at(x);
  bool outside = false;
  for (int i = num_kinks_; i < num_conditions(); ++i) outside = outside || values_(i) < 0;
  const bool same = face_of(sides_) == face;
  if (same && !outside) return 0;
  Eigen::VectorXd value;
  Eigen::Matrix<double, 3, Eigen::Dynamic> gradient;
  const FormulaKinks::Sides sides = sides_;
  evaluate_conditions(x, value, &gradient);
  const auto distance = [&](int i) { return std::abs(value(i)) / std::max(gradient.col(i).norm(), 1e-300); };
  double worst = 0;
  int worst_condition = -1;
  for (int i = num_kinks_; i < num_conditions(); ++i) {
    if (value(i) < 0 && distance(i) > worst) {
      worst = distance(i);
      worst_condition = smooth_condition(i, sides);
    }
  }
  if (!same) {
    // The nearest kinks whose other sides lead to the face: choices in the order of their farthest kink.
    std::vector<int> order(static_cast<std::size_t>(first_in_domain_));
    for (int i = 0; i < first_in_domain_; ++i) order[static_cast<std::size_t>(i)] = i;
    std::sort(order.begin(), order.end(), [&](int i, int j) { return distance(i) < distance(j); });
    if (order.size() > kMostAtAPoint) order.resize(kMostAtAPoint);
    double least = std::numeric_limits<double>::infinity();
    int deepest = -1;
    FormulaKinks::Sides at;
    for (std::size_t choice = 1; choice < (std::size_t{1} << order.size()) && deepest < 0; ++choice) {
      at = sides;
      int far = -1;
      for (std::size_t i = 0; i < order.size(); ++i) {
        if (!(choice >> i & 1)) continue;
        auto& side = at[static_cast<std::size_t>(order[i])];
        side = static_cast<std::int8_t>(-side);
        far = order[i];
      }
      if (face_of(at) != face) continue;
      least = distance(far);
      deepest = far;
    }
    if (least > worst || deepest < 0) {
      worst = least;
      worst_condition = deepest >= 0 ? smooth_condition(deepest, at) : -1;
    }
  }
  if (condition != nullptr) *condition = worst_condition;
  return worst;
}

std::vector<Index> FacetedSurface::not_inside(int face, const Points& x) {
  Points kinks(num_kinks_, x.cols());
  Points domain(num_domain_, x.cols());
  if (conditions_) conditions_->evaluate({.n = x.cols(), .x = x.data(), .value = kinks.data()});
  if (domain_) domain_->evaluate({.n = x.cols(), .x = x.data(), .value = domain.data()});
  std::vector<Index> found;
  sides_.resize(static_cast<std::size_t>(num_kinks_));
  for (Index j = 0; j < x.cols(); ++j) {
    for (int i = 0; i < num_kinks_; ++i) sides_[static_cast<std::size_t>(i)] = kinks(i, j) >= 0 ? 1 : -1;
    const bool inside = (domain.col(j).array() >= 0).all() && face_of(sides_) == face;
    if (!inside) found.push_back(j);
  }
  return found;
}

int FacetedSurface::smooth_condition(int index, const FormulaKinks::Sides& sides) {
  if (index >= num_kinks_ && !(kinks_ && kinks_->in_domain())) {
    const auto [at, added] = smooth_of_.try_emplace({1, static_cast<NodeId>(index - num_kinks_)}, 0);
    if (added) {
      at->second = static_cast<int>(smooth_.size());
      Condition made{nullptr, surface_.domain()->make_evaluator(), index - num_kinks_, num_domain_};
      if (affine_components(*surface_.domain())[static_cast<std::size_t>(made.component)]) {
        made.flat = affine_form(*made.evaluator, made.count, made.component);
      }
      smooth_.push_back(std::move(made));
    }
    return at->second;
  }
  const auto [known, unknown] = smooth_of_sides_.try_emplace({index, sides}, 0);
  if (!unknown) return known->second;
  const NodeId node = index < num_kinks_ ? kinks_->condition(index, sides) : kinks_->bound(index - num_kinks_, sides);
  const auto [at, added] = smooth_of_.try_emplace({0, node}, 0);
  if (added) {
    at->second = static_cast<int>(smooth_.size());
    const std::shared_ptr<const ImplicitFunction> function = kinks_->function({node});
    Condition made{function, function->make_evaluator(), 0, 1};
    if (affine_components(*function).front()) made.flat = affine_form(*made.evaluator, 1, 0);
    smooth_.push_back(std::move(made));
  }
  known->second = at->second;
  return at->second;
}

double FacetedSurface::function(int face, const Point3& x, Point3& gradient) {
  const SmoothFace& of = this->face(face);
  if (of.flat) {
    gradient = of.flat->gradient;
    return gradient.dot(x) + of.flat->offset;
  }
  double value = 0;
  of.evaluator->evaluate({.n = 1, .x = x.data(), .value = &value, .jacobian = gradient.data()});
  return value;
}

double FacetedSurface::condition(int condition, const Point3& x, Point3& gradient) {
  const Condition& c = smooth_[static_cast<std::size_t>(condition)];
  if (c.flat) {
    gradient = c.flat->gradient;
    return gradient.dot(x) + c.flat->offset;
  }
  if (c.count == 1) {
    double value = 0;
    c.evaluator->evaluate({.n = 1, .x = x.data(), .value = &value, .jacobian = gradient.data()});
    return value;
  }
  Eigen::VectorXd values(c.count);
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(3, c.count);
  c.evaluator->evaluate({.n = 1, .x = x.data(), .value = values.data(), .jacobian = gradients.data()});
  gradient = gradients.col(c.component);
  return values(c.component);
}

void FacetedSurface::functions(int face, const Points& x, Vector& value, Points& gradient) {
  const SmoothFace& of = this->face(face);
  value.resize(x.cols());
  gradient.setZero(3, x.cols());
  if (of.flat) {
    gradient.colwise() = of.flat->gradient;
    value = (of.flat->gradient.transpose() * x).transpose().array() + of.flat->offset;
    return;
  }
  of.evaluator->evaluate({.n = x.cols(), .x = x.data(), .value = value.data(), .jacobian = gradient.data()});
}

void FacetedSurface::conditions(int condition, const Points& x, Vector& value, Points& gradient) {
  const Condition& c = smooth_[static_cast<std::size_t>(condition)];
  const Index n = x.cols();
  value.resize(n);
  gradient.setZero(3, n);
  if (c.flat) {
    gradient.colwise() = c.flat->gradient;
    value = (c.flat->gradient.transpose() * x).transpose().array() + c.flat->offset;
    return;
  }
  if (c.count == 1) {
    c.evaluator->evaluate({.n = n, .x = x.data(), .value = value.data(), .jacobian = gradient.data()});
    return;
  }
  Points values(c.count, n);
  Points gradients = Points::Zero(3, c.count * n);
  c.evaluator->evaluate({.n = n, .x = x.data(), .value = values.data(), .jacobian = gradients.data()});
  value = values.row(c.component).transpose();
  for (Index j = 0; j < n; ++j) gradient.col(j) = gradients.col(j * c.count + c.component);
}

/// A residual of this part of the model is rounding. Steps that only shuffle it took 5 of 44 ms of a can, cold.
constexpr double kRounding = 1e-16;

/// Newton's method with the shortest step, halved while the rows' scaled residual grows.
bool FacetedSurface::project(int face, const std::vector<int>& conditions, Point3& x) {
  const auto rows = static_cast<Index>(1 + conditions.size());
  if (rows > 3) return false;
  Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3, 3> jacobian(rows, 3);
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1> residual(rows);
  const auto visit = [&](const Point3& at) {
    Point3 gradient;
    for (Index i = 0; i < rows; ++i) {
      double value =
          i == 0 ? function(face, at, gradient) : condition(conditions[static_cast<std::size_t>(i - 1)], at, gradient);
      const double size = gradient.norm();
      if (!(size > 1e-300) || !std::isfinite(value) || !std::isfinite(size)) return false;
      residual(i) = value / size;
      jacobian.row(i) = gradient.transpose() / size;
    }
    return true;
  };
  if (!visit(x)) return false;
  constexpr int kMostSteps = 40;
  for (int step = 0; step < kMostSteps; ++step) {
    const double before = residual.norm();
    if (before <= kRounding * scale) return true;
    Point3 change;
    if (rows == 1) {
      change = -jacobian.transpose() * residual;
    } else if (rows == 2) {
      const Point3 a = jacobian.row(0);
      const Point3 b = jacobian.row(1);
      const double cosine = a.dot(b);
      const double det = 1 - cosine * cosine;
      if (!(det > kParallel)) return false;
      change = (a * (cosine * residual(1) - residual(0)) + b * (cosine * residual(0) - residual(1))) / det;
    } else {
      const Point3 a = jacobian.row(0);
      const Point3 b = jacobian.row(1);
      const Point3 c = jacobian.row(2);
      const double det = a.dot(b.cross(c));
      if (!(det * det > kParallel)) return false;
      change = -(b.cross(c) * residual(0) + c.cross(a) * residual(1) + a.cross(b) * residual(2)) / det;
    }
    if (!change.allFinite()) return false;
    const Point3 from = x;
    double part = 1;
    bool better = false;
    for (int halving = 0; halving < 12; ++halving, part /= 2) {
      x = from + part * change;
      if (visit(x) && residual.norm() < before) {
        better = true;
        break;
      }
    }
    if (!better) {
      x = from;
      return before <= 1e-11 * scale;
    }
    if (change.norm() <= 1e-15 * scale) return true;
  }
  return residual.norm() <= 1e-11 * scale;
}

Point3 FacetedSurface::tangent(int e, const Point3& x) {
  const SharpEdge& edge = this->edge(e);
  Point3 f;
  Point3 c;
  (void)function(edge.a, x, f);
  (void)condition(edge.condition, x, c);
  return f.normalized().cross(c.normalized()).normalized();
}

bool FacetedSurface::move(int e, double step, Point3& x) {
  const SharpEdge edge = this->edge(e);
  Point3 to = x + step * tangent(e, x);
  if (!project(edge.a, {edge.condition}, to)) return false;
  if ((to - x).norm() > 2 * std::abs(step) + 1e-12 * scale) return false;
  x = to;
  return true;
}

/// F_a and c vanish along the edge to second order: grad . kappa = -t . H t for both, and kappa is across t.
Point3 FacetedSurface::curvature(int e, const Point3& x) {
  const SharpEdge& edge = this->edge(e);
  const SmoothFace& face = this->face(edge.a);
  const Condition& second = smooth_[static_cast<std::size_t>(edge.condition)];
  if (face.flat && second.flat) return Point3::Zero();
  Point3 f;
  Point3 c;
  (void)function(edge.a, x, f);
  (void)condition(edge.condition, x, c);
  const Point3 cross = f.cross(c);
  const double size = cross.squaredNorm();
  if (!(size > kParallel * f.squaredNorm() * c.squaredNorm())) return Point3::Zero();
  const Point3 t = cross / std::sqrt(size);
  const double bend_f = face.flat ? 0 : second_derivative(*face.evaluator, 1, 0, x, t);
  const double bend_c = second.flat ? 0 : second_derivative(*second.evaluator, second.count, second.component, x, t);
  return -(bend_f * c.cross(cross) + bend_c * cross.cross(f)) / size;
}

int FacetedSurface::edge_of(int a, int b, int condition) {
  if (b >= 0 && b < a) std::swap(a, b);
  const auto [at, added] = edge_of_.try_emplace({a, b, condition}, 0);
  if (added) {
    at->second = static_cast<int>(edges_.size());
    edges_.push_back({a, b, condition});
  }
  return at->second;
}

/// A kink of a branch that is not taken bounds no face, though it may vanish along an edge, or in a face's own plane:
/// that of max(1-x, x-3) in x = 2. Flipping it changes neither the face nor another condition.
bool FacetedSurface::matters(int kink, const FormulaKinks::Sides& sides, const std::vector<int>& zero) {
  if (kink >= first_in_domain_ || zero.size() < 2) return true;
  FormulaKinks::Sides flipped = sides;
  auto& side = flipped[static_cast<std::size_t>(kink)];
  side = static_cast<std::int8_t>(-side);
  if (face_of(flipped) != face_of(sides)) return true;
  return std::any_of(zero.begin(), zero.end(), [&](int other) {
    return other != kink && smooth_condition(other, flipped) != smooth_condition(other, sides);
  });
}

const std::vector<bool>& FacetedSurface::which_matter(const FormulaKinks::Sides& sides, const std::vector<int>& zero) {
  const auto [known, added] = which_matter_.try_emplace({sides, zero});
  if (added) {
    for (const int kink : zero) known->second.push_back(matters(kink, sides, zero));
  }
  return known->second;
}

std::optional<Star> FacetedSurface::star(const Point3& x, double tolerance) {
  Eigen::VectorXd value;
  Eigen::Matrix<double, 3, Eigen::Dynamic> gradient;
  evaluate_conditions(x, value, &gradient);
  std::vector<int> zero;
  FormulaKinks::Sides sides(static_cast<std::size_t>(num_kinks_));
  for (int i = 0; i < num_conditions(); ++i) {
    if (i < num_kinks_) sides[static_cast<std::size_t>(i)] = value(i) >= 0 ? 1 : -1;
    if (std::abs(value(i)) <= tolerance * gradient.col(i).norm()) {
      zero.push_back(i);
    } else if (i >= num_kinks_ && value(i) < 0) {
      return std::nullopt;  // outside the domain
    }
  }
  drop_idle_kinks(zero);
  std::vector<int> flips;
  for (const int i : zero) {
    if (i < num_kinks_) flips.push_back(i);
  }
  if (flips.size() > kMostAtAPoint) return std::nullopt;

  std::vector<Wedge> wedges;
  for (std::size_t choice = 0; choice < (std::size_t{1} << flips.size()); ++choice) {
    FormulaKinks::Sides other = sides;
    for (std::size_t i = 0; i < flips.size(); ++i) {
      other[static_cast<std::size_t>(flips[i])] = (choice >> i & 1) != 0 ? -1 : 1;
    }
    Wedge wedge;
    wedge.face = face_of(other);
    Point3 f;
    const double off = function(wedge.face, x, f);
    if (!(f.norm() > 0) || !f.allFinite()) return std::nullopt;
    if (!(std::abs(off) <= 4 * tolerance * f.norm())) continue;
    wedge.normal = f.normalized();
    const Point3 e1 = wedge.normal.unitOrthogonal();
    const Point3 e2 = wedge.normal.cross(e1);
    double low = 0;
    double width = kTwoPi;
    bool empty = false;
    const std::vector<bool>& bounding = which_matter(other, zero);
    for (std::size_t k = 0; k < zero.size(); ++k) {
      if (!bounding[k]) continue;
      const int z = zero[k];
      const int smooth = smooth_condition(z, other);
      Point3 g;
      (void)condition(smooth, x, g);
      if (z < num_kinks_) g *= other[static_cast<std::size_t>(z)];
      const double size = g.norm();
      const Eigen::Vector2d flat(g.dot(e1), g.dot(e2));
      if (size == 0) continue;
      if (flat.norm() <= kTangential * size) return std::nullopt;
      const double from = std::atan2(flat.y(), flat.x()) - std::numbers::pi / 2;
      if (width == kTwoPi) {
        low = from;
        width = std::numbers::pi;
        wedge.first_condition = wedge.second_condition = smooth;
        continue;
      }
      double ahead = in_turn(from - low);  // where the new half circle begins, seen from the old arc
      if (ahead > kTwoPi - kThinWedge) ahead -= kTwoPi;
      if (std::abs(ahead) < kThinWedge) continue;
      if (ahead < width) {  // begins inside: cut the front
        low += ahead;
        width -= ahead;
        wedge.first_condition = smooth;
      } else {  // ends inside: cut the back
        const double end = ahead - std::numbers::pi;
        if (end <= kThinWedge) {
          empty = true;
          break;
        }
        if (end < width) {
          width = end;
          wedge.second_condition = smooth;
        }
      }
      if (width <= kThinWedge) {
        empty = true;
        break;
      }
    }
    if (empty) continue;
    wedge.angle = width;
    if (width < kTwoPi) {
      wedge.first = std::cos(low) * e1 + std::sin(low) * e2;
      wedge.second = std::cos(low + width) * e1 + std::sin(low + width) * e2;
    }
    wedges.push_back(wedge);
  }
  if (wedges.empty()) return std::nullopt;

  // The same wedge may be claimed by several choices, where a kink does not matter.
  const auto meets = [](const Point3& a, const Point3& b) { return (a - b).norm() < kSameRay; };
  Star star;
  for (const Wedge& wedge : wedges) {
    const bool known = std::any_of(star.wedges.begin(), star.wedges.end(), [&](const Wedge& other) {
      return other.face == wedge.face &&
             (wedge.angle == kTwoPi ? other.angle == kTwoPi
                                    : meets(other.first, wedge.first) && meets(other.second, wedge.second));
    });
    if (!known) star.wedges.push_back(wedge);
  }
  // Wedges of one face that touch are one.
  for (bool merged = true; merged;) {
    merged = false;
    for (std::size_t i = 0; i < star.wedges.size() && !merged; ++i) {
      for (std::size_t j = 0; j < star.wedges.size() && !merged; ++j) {
        Wedge& a = star.wedges[i];
        const Wedge b = star.wedges[j];
        if (i == j || a.face != b.face || a.angle == kTwoPi || b.angle == kTwoPi) continue;
        if (!meets(a.second, b.first)) continue;
        a.second = b.second;
        a.second_condition = b.second_condition;
        a.angle += b.angle;
        if (meets(a.second, a.first) && a.angle > kTwoPi - 1e-4) a.angle = kTwoPi;
        star.wedges.erase(star.wedges.begin() + static_cast<std::ptrdiff_t>(j));
        merged = true;
      }
    }
  }
  if (star.wedges.size() == 1 && star.wedges.front().angle == kTwoPi) return star;
  // Into a row, from border to border if there is one.
  std::vector<Wedge> row;
  std::vector<Wedge> left = std::move(star.wedges);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const bool has_before = std::any_of(left.begin(), left.end(), [&](const Wedge& other) {
      return other.angle < kTwoPi && meets(other.second, left[i].first);
    });
    if (!has_before) {
      begin = i;
      star.closed = false;
      break;
    }
  }
  row.push_back(left[begin]);
  left.erase(left.begin() + static_cast<std::ptrdiff_t>(begin));
  while (true) {
    const auto next = std::find_if(left.begin(), left.end(),
                                   [&](const Wedge& wedge) { return meets(row.back().second, wedge.first); });
    if (next == left.end()) break;
    row.push_back(*next);
    left.erase(next);
  }
  if (!left.empty()) return std::nullopt;  // several sheets touch
  if (star.closed && !meets(row.back().second, row.front().first)) return std::nullopt;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const bool last = i + 1 == row.size();
    Wedge& wedge = row[i];
    if (last && !star.closed) {
      wedge.second_edge = edge_of(wedge.face, -1, wedge.second_condition);
    } else {
      Wedge& next = row[last ? 0 : i + 1];
      wedge.second_edge = edge_of(wedge.face, next.face, wedge.second_condition);
      next.first_edge = wedge.second_edge;
    }
  }
  if (!star.closed) row.front().first_edge = edge_of(row.front().face, -1, row.front().first_condition);
  star.wedges = std::move(row);
  return star;
}

}  // namespace taut::detail
