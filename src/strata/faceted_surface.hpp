#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "surface/formula/kinks.hpp"
#include "taut/curve/newton.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

using Point3 = Eigen::Vector3d;

/// gradient . x + offset.
struct AffineForm {
  Point3 gradient;
  double offset = 0;
};

/// A smooth piece of a faceted surface: the zero set of the formula with one choice of sides. It goes on beyond the
/// piece, where it is no part of the surface.
struct SmoothFace {
  explicit SmoothFace(Surface of) : surface(std::move(of)), evaluator(surface.make_evaluator()) {}
  Surface surface;
  std::unique_ptr<Evaluator> evaluator;
  std::optional<NewtonSolver> solver;
  std::string text;                // its formula
  std::optional<AffineForm> flat;  // of a plane
};

/// Where two faces meet, or a face ends: F_a = 0 and c = 0.
struct SharpEdge {
  int a = -1;          ///< a face
  int b = -1;          ///< the other one; -1: a border
  int condition = -1;  ///< c
};

/// The part of a face next to a point of it: between two rays.
struct Wedge {
  int face = -1;
  Point3 normal = Point3::Zero();  ///< grad F / |grad F|
  Point3 first = Point3::Zero();   ///< unit tangent; the wedge goes from it counterclockwise about `normal`
  Point3 second = Point3::Zero();
  double angle = 0;  ///< radians; 2 pi: all around
  int first_condition = -1;
  int second_condition = -1;
  int first_edge = -1;  ///< the edge along the first ray
  int second_edge = -1;
};

/// All faces around a point, counterclockwise. Open where the surface ends there: then from border to border.
struct Star {
  std::vector<Wedge> wedges;
  bool closed = true;
};

/// A surface in R^3 made of smooth faces that meet in edges and corners: of a formula with `min max abs sign`, or cut
/// by a domain. Faces are found as they are met. One thread's.
class FacetedSurface {
 public:
  /// Null for smooth surfaces without domain, and for those that are not handled: other dimensions.
  [[nodiscard]] static std::unique_ptr<FacetedSurface> of(const Surface& surface);

  /// The same for another thread: the same numbers of faces and edges so far.
  [[nodiscard]] std::unique_ptr<FacetedSurface> clone() const;
  /// How much is known of it.
  struct Known {
    std::size_t faces = 0;
    std::size_t conditions = 0;
    std::size_t edges = 0;
  };
  [[nodiscard]] Known known() const { return {faces_.size(), smooth_.size(), edges_.size()}; }
  /// Forgets what was found since: so that no answer depends on the questions before it.
  void forget_since(const Known& known);

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] SmoothFace& face(int i) { return *faces_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const SharpEdge& edge(int i) const { return edges_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int num_conditions() const { return num_kinks_ + num_domain_; }
  /// Kinks, of the formula and in the domain; the components of the domain come after them.
  [[nodiscard]] int num_kinks() const { return num_kinks_; }
  /// Has the formula itself kinks, so that faces may meet in edges.
  [[nodiscard]] bool has_edges() const { return first_in_domain_ > 0; }
  /// The conditions that may change their sign within the box, by bounds; all where there are none.
  void undecided(const Box& box, std::vector<int>& found);

  /// The face whose sides hold at x, on the surface or not.
  [[nodiscard]] int face_at(const Point3& x);
  /// The faces around x that differ in the sides of `kinks` (or less).
  [[nodiscard]] std::vector<std::pair<int, FormulaKinks::Sides>> faces_near(const Point3& x,
                                                                            const std::vector<int>& kinks);
  /// How far x is outside `face`, model units, to first order; 0 inside; infinite where no near kinks explain it. The
  /// condition that fails goes to `condition`.
  [[nodiscard]] double violation(int face, const Point3& x, int* condition = nullptr);

  /// Which of these points (3 x n) are not inside the face or on its border beyond doubt.
  [[nodiscard]] std::vector<Index> not_inside(int face, const Points& x);

  /// Condition `kink` or domain component made smooth by the sides around it; an index for `project`.
  [[nodiscard]] int smooth_condition(int index, const FormulaKinks::Sides& sides);
  /// A point near x with F_face = 0 and all these conditions zero. False where Newton's method fails.
  [[nodiscard]] bool project(int face, const std::vector<int>& conditions, Point3& x);
  [[nodiscard]] double function(int face, const Point3& x, Point3& gradient);
  [[nodiscard]] double condition(int condition, const Point3& x, Point3& gradient);
  /// The same of n points (3 x n): n values and 3 x n gradients.
  void functions(int face, const Points& x, Vector& value, Points& gradient);
  void conditions(int condition, const Points& x, Vector& value, Points& gradient);
  /// Unit tangent of an edge.
  [[nodiscard]] Point3 tangent(int edge, const Point3& x);
  /// x moved along the edge by about `step`; false where that fails.
  [[nodiscard]] bool move(int edge, double step, Point3& x);
  /// d tangent / d s; zero where the edge is not determined to second order.
  [[nodiscard]] Point3 curvature(int edge, const Point3& x);

  /// The faces around a surface point; conditions that vanish within `tolerance` (model units) count as zero. Empty
  /// where the surface is singular there.
  [[nodiscard]] std::optional<Star> star(const Point3& x, double tolerance);

  double scale = 1;  ///< of the model: what tolerances are relative to

 private:
  struct Condition {
    std::shared_ptr<const ImplicitFunction> function;  // null: the domain
    std::unique_ptr<Evaluator> evaluator;
    int component = 0;
    int count = 1;
    std::optional<AffineForm> flat = {};
  };
  explicit FacetedSurface(const Surface& surface) : surface_(surface) {}
  [[nodiscard]] int face_of(const FormulaKinks::Sides& sides);
  /// The sides at x; values of the conditions in `values_`.
  const FormulaKinks::Sides& sides_at(const Point3& x);
  /// Kinks of the domain matter only next to its border.
  void drop_idle_kinks(std::vector<int>& conditions) const;
  /// Does a kink that vanishes at a point, with all of `zero`, bound the face of these sides there.
  [[nodiscard]] bool matters(int kink, const FormulaKinks::Sides& sides, const std::vector<int>& zero);
  /// The same of each of them, kept: the same ones meet all along an edge.
  [[nodiscard]] const std::vector<bool>& which_matter(const FormulaKinks::Sides& sides, const std::vector<int>& zero);
  [[nodiscard]] int edge_of(int a, int b, int condition);
  void evaluate_conditions(const Point3& x, Eigen::VectorXd& value, Eigen::Matrix<double, 3, Eigen::Dynamic>* gradient);

  Surface surface_;
  std::unique_ptr<FormulaKinks> kinks_;  // null: only a smooth domain
  std::shared_ptr<const ImplicitFunction> conditions_function_;
  std::unique_ptr<Evaluator> conditions_;
  std::unique_ptr<Evaluator> domain_;
  int num_kinks_ = 0;
  int first_in_domain_ = 0;
  int num_domain_ = 0;
  std::vector<std::unique_ptr<SmoothFace>> faces_;
  std::map<FormulaKinks::Sides, int> face_of_sides_;
  FormulaKinks::Sides last_sides_;  // neighbours mostly lie on one face
  int last_face_ = -1;
  Eigen::VectorXd values_;  // scratch of face_at and violation
  FormulaKinks::Sides sides_;
  std::map<std::vector<NodeId>, int> face_of_roots_;
  std::vector<Condition> smooth_;
  std::map<std::pair<int, NodeId>, int> smooth_of_;  // (0, node) or (1, domain component)
  std::map<std::pair<int, FormulaKinks::Sides>, int> smooth_of_sides_;
  std::vector<SharpEdge> edges_;
  std::map<std::tuple<int, int, int>, int> edge_of_;
  std::map<std::pair<FormulaKinks::Sides, std::vector<int>>, std::vector<bool>> which_matter_;
};

/// Is the surface one whose faces may meet in edges: a formula in R^3 with `min max abs sign`.
[[nodiscard]] bool is_kinked(const Surface& surface);

}  // namespace taut::detail
