#pragma once

#include <vector>

#include "homotopy/strand.hpp"
#include "taut/core/context.hpp"
#include "taut/curve/newton.hpp"

namespace taut::detail {

/// A polygon of short geodesic arcs between corners on the surface, closed or with fixed ends, and Newton's method on
/// its corners: its length L(b_1, ..., b_m) has the gradient t_in - t_out at each corner, and its second derivatives
/// say which closed geodesics are minima (Morse's finite-dimensional model of the space of loops).
class GeodesicPolygon {
 public:
  /// No step moves the polygon by more than two `gap`s (model units), so that it stays in its class.
  GeodesicPolygon(const Surface& surface, const StrandMaker& maker, double tolerance, double gap);

  enum class Outcome { smooth, not_converged, too_many_unknowns };

  /// Cuts a strand into arcs that are minima and moves the corners until the kinks there vanish.
  [[nodiscard]] Outcome solve(const Strand& loop, const Context& context);

  [[nodiscard]] double length() const;
  [[nodiscard]] double length_error() const;  ///< of the arcs, and what the kinks leave
  [[nodiscard]] double kink() const;          ///< the largest, radians
  [[nodiscard]] int index() const { return index_; }
  [[nodiscard]] int neutral() const { return neutral_; }
  [[nodiscard]] const std::vector<NewtonResult>& arcs() const { return arcs_; }
  /// The arcs' points in a row; the last is the first.
  [[nodiscard]] Points points() const;
  /// The polygon as one curve: status ok if its error is within the tolerance (relative), or 1e-12.
  [[nodiscard]] Geodesic geodesic(double tolerance) const;
  /// The first arc that is not well, or null.
  [[nodiscard]] const NewtonResult* bad_arc() const;

 private:
  struct Ends {
    Vector leaving;   // unit tangent at the arc's start
    Vector arriving;  // and at its end
    bool good = false;
  };

  [[nodiscard]] bool cut(const Strand& loop, Index num_arcs, const Context& context);
  [[nodiscard]] NewtonResult arc(const Points& start, const VectorIn& from, const VectorIn& to, const Context& context);
  [[nodiscard]] static Ends ends_of(const NewtonResult& arc);
  void make_frames();
  [[nodiscard]] Vector kinks() const;
  [[nodiscard]] bool differentiate(const Context& context);
  [[nodiscard]] bool move(const Vector& step, const Context& context);
  [[nodiscard]] Vector newton_step(const Vector& kinks, double least) const;
  [[nodiscard]] double left_by(const Vector& kinks) const;
  /// Corners that may move, and what lies beside the i-th of them.
  [[nodiscard]] Index num_free() const { return static_cast<Index>(arcs_.size()) - (closed_ ? 0 : 1); }
  [[nodiscard]] Index corner_of(Index i) const { return closed_ ? i : i + 1; }
  [[nodiscard]] const NewtonResult& arc_out_of(Index i) const { return arcs_[static_cast<std::size_t>(corner_of(i))]; }
  [[nodiscard]] const NewtonResult& arc_into(Index i) const {
    const Index corner = corner_of(i);
    return corner > 0 ? arcs_[static_cast<std::size_t>(corner - 1)] : arcs_.back();
  }

  const Surface& surface_;
  const StrandMaker& maker_;
  double gap_;
  NewtonSolver solver_;
  bool closed_ = true;
  Points corners_;                  // d x (m + 1): the last is the first again, or the other end
  std::vector<NewtonResult> arcs_;  // arc i runs from corner i to the next
  /// A free corner each.
  std::vector<Eigen::MatrixXd> frames_;  // d x r each: across the curve in the tangent space, r = d - k - 1
  Eigen::MatrixXd hessian_;              // of the length, r each free corner
  Eigen::MatrixXd modes_;                // its eigenvectors
  Vector curvatures_;                    // and eigenvalues, ascending
  double left_ = 0;                      // of the length, by the last kinks
  int index_ = 0;
  int neutral_ = 0;
};

}  // namespace taut::detail
