#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// May the surface cross a closed cell? The one test that Algorithms I and II share.
///
/// Where F has interval bounds (`rigorous()`), the answer "no" is a proof, up to the bounds' own: some component of F
/// keeps off 0 in the whole closed cell, or some component of the domain stays negative. So no crossed cell is ever
/// lost; overestimating bounds keep a few cells too many. Where the Jacobian has bounds |F_a| <= G_a over the cell,
/// too, the mean value theorem is asked as well (Moore 1966): "no" when for some component, with c the centre,
///   |F(c)| > h/2 sum_a G_a.
/// That overestimates by O(h^2), so the smaller the cells, the fewer too many.
///
/// Where it has none, F is taken as its Taylor polynomial at the centre c of the cell of edge h, the second-order
/// term doubled as an allowance for what the third derivatives do: "no" when for some component
///   |F(c)| > h/2 sum_a |F_a| + 2 (1/2) (h/2)^2 sum_ab |F_ab|.
/// That is exact for quadrics and safe where the Hessian at most doubles within the cell; it is blind to anything finer
/// than a cell. A cell where F(c) is NaN is not crossed. A domain without bounds is judged by twice its first-order
/// change.
///
/// Where the surface has a box, cells that do not meet it are not crossed.
///
/// Owns an evaluator: one test a thread.
class CrossingTest {
 public:
  /// Cells of edge `size` (model units), cell c covering origin + size * [c, c + 1].
  CrossingTest(const Surface& surface, Vector origin, double size);

  /// `cells`: d x n coordinates at `level`, where cell c covers [c, c + 1] 2^level cells of level 0. Writes 1 to
  /// `may_cross` (n) where the surface may cross the closed cell, else 0. Best called for hundreds of cells.
  void test(std::span<const std::int32_t> cells, int level, std::span<std::uint8_t> may_cross);

  /// How many cells were tested so far.
  [[nodiscard]] Index num_tested() const { return num_tested_; }

  /// Do F and the domain have interval bounds?
  [[nodiscard]] bool rigorous() const { return has_bounds_ && (domain_ == nullptr || domain_has_bounds_); }
  /// Has F interval bounds, so that cells of any size may be tested?
  [[nodiscard]] bool has_bounds() const { return has_bounds_; }

 private:
  // Each drops cells of the block.
  void test_box();
  void test_bounds();
  void test_slopes();
  void test_taylor();
  void test_domain();
  /// Leaves only the cells of the block for which `keep(slot)`.
  template <class Keep>
  void retain(const Keep& keep);
  void find_centres();

  Surface surface_;
  Vector origin_;
  double size_;
  Index num_tested_ = 0;
  std::unique_ptr<Evaluator> function_;
  std::unique_ptr<Evaluator> domain_;  // null = nowhere cut
  bool has_bounds_ = false;
  bool has_slopes_ = false;
  bool domain_has_bounds_ = false;
  // Of the block being tested: the cells still in question, a slot each.
  std::vector<Index> kept_;
  std::vector<double> lower_, upper_, centre_, value_lower_, value_upper_, jacobian_, jacobian_upper_, weight_,
      hessian_;
};

}  // namespace taut::detail
