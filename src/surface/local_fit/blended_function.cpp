#include "surface/local_fit/blended_function.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "surface/fitted_function.hpp"
#include "surface/local_fit/blend_kernel.hpp"
#include "surface/local_fit/patch_range.hpp"
#include "surface/local_fit/patch_tree.hpp"
#include "surface/normals/merged_sheets.hpp"
#include "surface/rbf/kd_tree.hpp"

// F = sum_i w_i f_i / sum_i w_i over the patches whose balls hold x (a partition of unity: Ohtake, Belyaev, Alexa,
// Turk, Seidel 2003, eq. 2), w_i = (1 - |x - c_i|^2 / R_i^2)^4. With S = sum w f and W = sum w,
//   F    = S / W
//   F_a  = (S_a - F W_a) / W
//   F_ab = (S_ab - F W_ab - F_a W_b - F_b W_a) / W.
// The weights are polynomials that vanish with three derivatives where a ball ends, so F is C^3 within the union of
// the balls. Outside of it (that is: where W is next to nothing) F is the plane of the nearest patch, which leads back;
// it jumps there, far from the samples, where the surface's domain has ended.

namespace taut::detail {
namespace {

/// The weight a single ball has at 0.997 of its radius: less than this is outside.
constexpr double kLeastWeight = 1e-9;
/// A box of which no point is farther from a centre than this part of its ball's radius is inside for certain.
constexpr double kSurelyInside = 0.995;
/// A box that more balls meet (counted once for each leaf of the tree), or that may have more centres nearest, is
/// halved: its parts then take less time than it would.
constexpr std::size_t kMostPatches = 1024;
constexpr std::size_t kMostPlanes = 128;
constexpr int kMostHalvings = 3;
/// Nothing is said about boxes farther from all centres than so many of the largest radius.
constexpr double kFarRadii = 4;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Memory to work in.
struct RangeScratch {
  std::vector<std::uint32_t> patches;
  std::vector<Neighbour> near;
};

template <int D>
class BlendedFunction : public FittedFunction {
 public:
  BlendedFunction(std::vector<Patch<D>> patches, Points centres, double residual_rms, std::string doubt)
      : patches_(std::move(patches)),
        centres_(std::move(centres)),
        tree_(patches_),
        nearest_(centres_),
        residual_rms_(residual_rms),
        doubt_(std::move(doubt)) {
    for (const Patch<D>& patch : patches_) largest_radius_ = std::max(largest_radius_, patch.radius);
  }

  [[nodiscard]] Index dim() const override { return D; }
  [[nodiscard]] Index codim() const override { return 1; }
  [[nodiscard]] std::string_view kind() const override { return "patches"; }
  [[nodiscard]] double residual_rms() const override { return residual_rms_; }
  [[nodiscard]] std::string doubt() const override { return doubt_; }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;

  static constexpr std::size_t kDim = D;
  using Coordinates = std::array<double, kDim>;

  using Jet = BlendJet<D>;

  [[nodiscard]] Jet value(const double* x) const { return blend(x, false); }
  [[nodiscard]] Jet jet(const double* x) const { return blend(x, true); }

  /// F over the box, in at most `halvings` steps of halving it.
  [[nodiscard]] PatchRange range(const MiddleBox<D>& box, int halvings, RangeScratch& scratch) const;

 private:
  [[nodiscard]] Jet blend(const double* x, bool derivatives) const;
  [[nodiscard]] Jet plane_of_nearest(const double* x) const;
  /// None where too many patches meet the box; `nearest`: distance of its middle to a centre.
  [[nodiscard]] std::optional<PatchRange> range_at_once(const MiddleBox<D>& box, double nearest,
                                                        RangeScratch& scratch) const;

  std::vector<Patch<D>> patches_;
  Points centres_;
  PatchTree<D> tree_;
  KdTree nearest_;  // over centres_
  double residual_rms_;
  std::string doubt_;
  double largest_radius_ = 0;
};

template <int D>
auto BlendedFunction<D>::blend(const double* x, bool derivatives) const -> Jet {
  PatchLanes<D> lanes;
  BlendSums<D> sums;
  std::size_t count = 0;
  const auto add = [&] {
    add_patches(lanes, count, x, derivatives, sums);
    count = 0;
  };
  for (const std::uint32_t i : tree_.at(x)) {
    const Patch<D>& patch = patches_[i];
    double squared = 0;
    for (std::size_t a = 0; a < kDim; ++a) squared += (x[a] - patch.centre[a]) * (x[a] - patch.centre[a]);
    if (!(squared < patch.radius * patch.radius)) continue;
    lanes.put(count++, patch);
    if (count == kBlendLanes) add();
  }
  if (count > 0) add();
  const auto& [weights, sum] = sums;
  if (!(weights.value >= kLeastWeight)) return plane_of_nearest(x);
  Jet result;
  result.value = sum.value / weights.value;
  if (!derivatives) return result;
  for (std::size_t a = 0; a < kDim; ++a) {
    result.gradient[a] = (sum.gradient[a] - result.value * weights.gradient[a]) / weights.value;
  }
  for (std::size_t a = 0, ab = 0; a < kDim; ++a) {
    for (std::size_t b = a; b < kDim; ++b, ++ab) {
      const double mixed = result.gradient[a] * weights.gradient[b] + result.gradient[b] * weights.gradient[a];
      result.hessian[ab] = (sum.hessian[ab] - result.value * weights.hessian[ab] - mixed) / weights.value;
    }
  }
  return result;
}

template <int D>
auto BlendedFunction<D>::plane_of_nearest(const double* x) const -> Jet {
  const Neighbour nearest = nearest_.nearest(x);
  Jet jet;
  if (!(nearest.squared_distance < kInfinity)) {  // NaN, or too far for numbers
    jet.value = kNaN;
    jet.gradient.fill(kNaN);
    jet.hessian.fill(kNaN);
    return jet;
  }
  const Patch<D>& patch = patches_[static_cast<std::size_t>(nearest.index)];
  jet.value = patch.radius * patch.cubic.coefficient[0];
  for (std::size_t a = 0; a < kDim; ++a) {
    jet.gradient[a] = patch.cubic.coefficient[Cubic<D>::kLinear + a];
    jet.value += jet.gradient[a] * (x[a] - patch.centre[a]);
  }
  return jet;
}

// A weighted mean lies between the least and the greatest of what it is a mean of. So F over a box lies within the
// hull of what the polynomials of the patches that meet it do there, and of the planes that may be the nearest one's
// where the box may leave the union of balls. A box that many patches meet is halved in each direction first, unless
// one part shows that F may vanish in it. Far from all balls nothing is said: there the domain has ended.
template <int D>
PatchRange BlendedFunction<D>::range(const MiddleBox<D>& box, int halvings, RangeScratch& scratch) const {
  if (!(box.half_diagonal < kInfinity)) return PatchRange::unknown();
  const double nearest = std::sqrt(nearest_.nearest(box.middle.data()).squared_distance);
  if (!(nearest - box.half_diagonal <= kFarRadii * largest_radius_)) return PatchRange::unknown();
  if (const std::optional<PatchRange> range = range_at_once(box, nearest, scratch)) return *range;
  if (halvings == 0) return PatchRange::unknown();
  PatchRange hull;
  for (std::size_t part = 0; part < std::size_t{1} << kDim && !hull.has_zero(); ++part) {
    Coordinates lower = box.lower;
    Coordinates upper = box.upper;
    for (std::size_t a = 0; a < kDim; ++a) ((part >> a & 1U) != 0 ? lower : upper)[a] = box.middle[a];
    const PatchRange of_part = range(MiddleBox<D>(lower.data(), upper.data()), halvings - 1, scratch);
    hull.include(of_part.lower, of_part.upper);
  }
  return hull.has_zero() ? PatchRange::unknown() : hull;
}

template <int D>
std::optional<PatchRange> BlendedFunction<D>::range_at_once(const MiddleBox<D>& box, double nearest,
                                                            RangeScratch& scratch) const {
  std::vector<std::uint32_t>& patches = scratch.patches;
  patches.clear();
  if (!tree_.within(box.lower.data(), box.upper.data(), kMostPatches, patches)) return std::nullopt;
  std::sort(patches.begin(), patches.end());
  patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
  PatchRange range;
  bool inside = false;
  for (const std::uint32_t i : patches) {
    inside = include_patch(patches_[i], box, kSurelyInside, range) == BallMeets::whole || inside;
  }
  if (inside) return range;
  // The nearest centre of any point of the box is no farther from the middle than this.
  nearest_.within(box.middle.data(), (nearest + 2 * box.half_diagonal) * (1 + 16 * kEps), scratch.near);
  if (scratch.near.size() > kMostPlanes) return std::nullopt;
  for (const Neighbour& neighbour : scratch.near) {
    include_plane(patches_[static_cast<std::size_t>(neighbour.index)], box, range);
  }
  return range;
}

template <int D>
class BlendedEvaluator : public Evaluator {
 public:
  explicit BlendedEvaluator(const BlendedFunction<D>& function) : Evaluator(D, 1), function_(function) {}

  void evaluate(const PointBatch& batch) override {
    const bool derivatives = batch.jacobian != nullptr || batch.hessian != nullptr;
    for (Index j = 0; j < batch.n; ++j) {
      const double* const x = batch.x + j * D;
      const typename BlendedFunction<D>::Jet jet = derivatives ? function_.jet(x) : function_.value(x);
      if (batch.value != nullptr) batch.value[j] = jet.value;
      if (batch.jacobian != nullptr) std::copy(jet.gradient.begin(), jet.gradient.end(), batch.jacobian + j * D);
      if (batch.hessian == nullptr) continue;
      double* const hessian = batch.hessian + j * D * D;
      for (std::size_t a = 0; a < D; ++a) {
        for (std::size_t b = 0; b < D; ++b) {
          hessian[a * D + b] = batch.weight[j] * jet.hessian[Cubic<D>::kLayout.pair[a][b]];
        }
      }
    }
  }

  bool bounds(const BoxBatch& batch) override {
    for (Index j = 0; j < batch.n; ++j) {
      const PatchRange range =
          function_.range(MiddleBox<D>(batch.lower + j * D, batch.upper + j * D), kMostHalvings, scratch_);
      batch.value_lower[j] = range.lower;
      batch.value_upper[j] = range.upper;
    }
    return true;
  }

 private:
  const BlendedFunction<D>& function_;
  RangeScratch scratch_;
};

template <int D>
std::unique_ptr<Evaluator> BlendedFunction<D>::make_evaluator() const {
  return std::make_unique<BlendedEvaluator<D>>(*this);
}

template <int D>
std::shared_ptr<const ImplicitFunction> make(const LocalFitModel& model) {
  std::vector<Patch<D>> patches(static_cast<std::size_t>(model.radii.size()));
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto column = static_cast<Index>(i);
    for (std::size_t a = 0; a < D; ++a) patches[i].centre[a] = model.centres(static_cast<Index>(a), column);
    patches[i].radius = model.radii(column);
    for (std::size_t c = 0; c < Cubic<D>::kSize; ++c) {
      patches[i].cubic.coefficient[c] = model.coefficients(static_cast<Index>(c), column);
    }
  }
  return std::make_shared<BlendedFunction<D>>(std::move(patches), model.centres, model.report.residual_rms,
                                              doubt(model.report.merged_sheets, model.samples.points));
}

}  // namespace

std::shared_ptr<const ImplicitFunction> make_blended_function(const LocalFitModel& model) {
  return model.centres.rows() == 2 ? make<2>(model) : make<3>(model);
}

}  // namespace taut::detail
