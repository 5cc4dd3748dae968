#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.hpp"
#include "surface/describe.hpp"
#include "surface/normals/merged_sheets.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "surface/rbf/off_surface.hpp"
#include "surface/rbf/rbf_function.hpp"
#include "surface/rbf/rbf_solve.hpp"
#include "surface/rbf/support_radius.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

using detail::KdTree;

void require_valid(const PointCloud& cloud, const RbfOptions& options) {
  const auto require = [](bool good, const char* what, double value) {
    if (!good) throw InvalidArgument(std::string(what) + ", not " + detail::describe(value));
  };
  require(cloud.dim() >= 2, "points to fit need at least 2 coordinates", static_cast<double>(cloud.dim()));
  const double smoothing = options.smoothing.value_or(0);
  require(smoothing >= 0 && std::isfinite(smoothing), "the smoothing length must be >= 0", smoothing);
  require(options.offset >= 0 && std::isfinite(options.offset), "the offset must be >= 0", options.offset);
  require(options.max_samples >= 0, "max_samples must be >= 0", static_cast<double>(options.max_samples));
  require(std::isfinite(options.support_radius), "the support radius must be finite", options.support_radius);
  require(options.normal_neighbours >= 2, "normals need at least 2 neighbours",
          static_cast<double>(options.normal_neighbours));
}

/// The ridge, in the unit frame, that halves a bump of wavelength `length` on a (d - 1)-dimensional sheet with one
/// sample per spacing^(d - 1): a bump of wave number k is damped by 1 / (1 + ridge spacing^m / phi^(k)), phi^ being the
/// Fourier transform of r^beta in m = d - 1 dimensions, |phi^(k)| = 2^(beta + m) pi^(m / 2) Gamma((beta + m) / 2) /
/// |Gamma(-beta / 2)| k^-(beta + m) (Wendland, Scattered Data Approximation, theorem 8.16).
double ridge_for(double length, double spacing, RbfKernel kernel, Index d) {
  if (length == 0) return 0;
  const double beta = kernel == RbfKernel::quintic ? 5 : 3;
  const auto m = static_cast<double>(d - 1);
  const double k = 2 * std::numbers::pi / length;
  const double transform = std::pow(2, beta + m) * std::pow(std::numbers::pi, m / 2) * std::tgamma((beta + m) / 2) /
                           std::abs(std::tgamma(-beta / 2)) * std::pow(k, -(beta + m));
  return transform / std::pow(spacing, m);
}

/// Smoothing length, in spacings, for samples with this noise, in spacings. Measured on a torus of tube radius 4 to 6
/// spacings: 0.1 of noise turns the normals of an interpolant by 0.22 (rms), of this fit by 0.03.
double smoothing_for(double noise) {
  constexpr double kClean = 0.06;  // real scans that are clean at their own spacing reach 0.05
  return noise < kClean ? 0 : std::min(4 + 10 * noise, 7.0);
}

/// |F| / |grad F| at all points, and at those that are not among the `chosen` (ascending). `original`: which sample of
/// the cloud each is.
void measure_residual(const Points& points, const std::vector<Index>& chosen, const std::vector<Index>& original,
                      const detail::RbfFunction& function, RbfReport& report, const Context& context) {
  Vector miss(points.cols());
  constexpr Index kGrain = 64;
  detail::parallel_for(context, 0, miss.size(), kGrain, [&](Index first, Index last) {
    Vector gradient(points.rows());
    for (Index i = first; i < last; ++i) {
      double value = 0;
      function.evaluate(points.col(i).data(), &value, gradient.data(), nullptr);
      miss(i) = std::abs(value) / gradient.norm();
    }
  });
  const auto rms = [](const Vector& x) { return std::sqrt(x.squaredNorm() / static_cast<double>(x.size())); };
  Index worst = 0;
  report.residual_max = miss.maxCoeff(&worst);
  report.residual_at = original[static_cast<std::size_t>(worst)];
  report.residual_rms = rms(miss);
  std::vector<Index> left_out;
  for (Index i = 0; i < points.cols(); ++i) {
    if (!std::binary_search(chosen.begin(), chosen.end(), i)) left_out.push_back(i);
  }
  if (left_out.empty()) return;
  const Vector of_those = miss(left_out);
  report.left_out_max = of_those.maxCoeff();
  report.left_out_rms = rms(of_those);
}

}  // namespace

RbfModel fit_rbf(const PointCloud& cloud, const RbfOptions& options, const Context& context) {
  require_valid(cloud, options);
  RbfModel model;
  model.kernel = options.kernel;
  model.samples = cloud;
  model.samples.normals = estimate_normals(cloud, options.normal_neighbours, context);

  const detail::MergedPoints merged = detail::merge_duplicates(cloud.points);
  const Index d = cloud.dim();
  const Index num_merged = cloud.size() - merged.points.cols();
  if (num_merged == 1) context.tell("1 point coincides with another and is merged");
  if (num_merged > 1) context.tell(std::to_string(num_merged) + " points coincide with others and are merged");
  model.report.num_samples = merged.points.cols();

  // The unit frame. Dividing by a power of two is exact, so a model twice as large gives the same bits.
  const Vector low = merged.points.rowwise().minCoeff();
  const Vector high = merged.points.rowwise().maxCoeff();
  model.origin = 0.5 * (low + high);
  model.scale = std::exp2(std::ceil(std::log2(0.5 * (high - low).norm())));
  const Points unit = (merged.points.colwise() - model.origin) / model.scale;
  const Points normals = model.samples.normals(Eigen::all, merged.merged_from);
  const KdTree tree(unit);

  const Index max_samples = options.max_samples > 0 ? options.max_samples : kDefaultMaxSamples;
  std::vector<Index> chosen;
  if (unit.cols() > max_samples) {
    chosen = detail::spread_subset_of_size(unit, tree, max_samples);
    context.tell(std::to_string(unit.cols()) + " points: a well-spread subset of " + std::to_string(chosen.size()) +
                 " is fitted");
  } else {
    for (Index i = 0; i < unit.cols(); ++i) chosen.push_back(i);
  }

  const Points fitted = unit(Eigen::all, chosen);
  const Points fitted_normals = normals(Eigen::all, chosen);
  const KdTree fitted_tree(fitted);
  const double spacing = detail::quantile(detail::local_spacing(fitted, fitted_tree), 0.5);
  const double offset = options.offset > 0 ? options.offset / model.scale : 0.5 * spacing;
  // Meshes are taken at their word: what looks like noise on a coarse one is unresolved shape.
  const bool may_be_noisy = cloud.faces.cols() == 0;
  const double noise = may_be_noisy ? detail::relative_noise(unit, normals, tree) *
                                          detail::quantile(detail::local_spacing(unit, tree), 0.5)
                                    : 0;
  const double smoothing =
      options.smoothing ? *options.smoothing / model.scale : smoothing_for(noise / spacing) * spacing;
  if (!options.smoothing && smoothing > 0) {
    context.tell("the samples are noisy (by " + detail::describe(noise * model.scale) + "): bumps shorter than " +
                 detail::describe(smoothing * model.scale) + " are smoothed");
  }
  // On a flat sheet two layers of constraints are a quadric, which leaves a polynomial of degree 2 open.
  const bool both_sides = options.both_sides || options.kernel == RbfKernel::quintic;
  const detail::Constraints constraints =
      detail::off_surface_constraints(fitted, fitted_normals, fitted_tree, offset, both_sides);
  detail::RbfSolution solution =
      detail::solve_rbf(options.kernel, constraints, ridge_for(smoothing, spacing, options.kernel, d), context);

  model.centres = constraints.at;
  model.weights = std::move(solution.weights);
  model.polynomial = std::move(solution.polynomial);
  model.report.num_fitted = fitted.cols();
  model.report.spacing = spacing * model.scale;
  model.report.noise = noise * model.scale;
  model.report.offset = offset * model.scale;
  model.report.smoothing = smoothing * model.scale;
  model.report.residual = solution.residual * model.scale;
  model.support_radius = options.support_radius;
  if (options.support_radius < 0 || detail::is_watertight(cloud.faces, merged.merged_to)) {
    model.support_radius = std::max(options.support_radius, 0.0);
  } else if (options.support_radius == 0) {
    model.support_radius = model.scale * detail::default_support_radius(unit, normals, tree);
  }

  const detail::RbfFunction function(model);
  measure_residual(merged.points, chosen, merged.merged_from, function, model.report, context);
  const KdTree world_tree(merged.points);
  MergedSheets& sheets = model.report.merged_sheets;
  sheets = detail::find_merged_sheets(merged.points, normals, world_tree, function, cloud.faces.cols() > 0, context);
  sheets.at = merged.merged_from[static_cast<std::size_t>(sheets.at)];
  if (sheets.count > 0) context.tell(detail::doubt(sheets, cloud.points));
  return model;
}

}  // namespace taut
