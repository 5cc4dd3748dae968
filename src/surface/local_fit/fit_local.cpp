#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/memory_limit.hpp"
#include "core/parallel.hpp"
#include "surface/describe.hpp"
#include "surface/local_fit/blended_function.hpp"
#include "surface/local_fit/patch_cover.hpp"
#include "surface/local_fit/patch_solve.hpp"
#include "surface/local_fit/places_between.hpp"
#include "surface/local_fit/support_radii.hpp"
#include "surface/normals/merged_sheets.hpp"
#include "surface/rbf/cloud_geometry.hpp"
#include "surface/rbf/kd_tree.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/point_cloud.hpp"

// Four steps, each linear in the number of samples but for the searching of neighbours:
//   1. unit normals; the spacing around each sample;
//   2. how many samples a patch should hold, by leave-one-out cross-validation on patches spread over the cloud;
//   3. balls that cover the samples, thinned greedily;
//   4. in each ball the cubic that fits samples and normals best (Hermite least squares).
// A mesh says more than its vertices: where its faces are large or arched, places over them say how far the surface
// reaches, too. The balls depend on the cloud alone and each patch on its ball alone, so that threads change nothing.

namespace taut {
namespace {

using detail::Ball;
using detail::KdTree;
using detail::Neighbour;
using detail::OrientedSamples;

/// A patch of radius R flattens ripples of wavelength R / kRadiusPerWavelength to half (measured by a test).
constexpr double kRadiusPerWavelength = 1.0;
constexpr double kBytesPerSample = 1200;
/// A point of a triangle is no farther than 1 / sqrt(3) = 0.58 of its longest edge from a corner.
constexpr double kOfEdge = 0.6;

void require_valid(const PointCloud& cloud, const LocalFitOptions& options) {
  const auto require = [](bool good, const char* what, double value) {
    if (!good) throw InvalidArgument(std::string(what) + ", not " + detail::describe(value));
  };
  require(cloud.dim() == 2 || cloud.dim() == 3, "points of a local fit need 2 or 3 coordinates",
          static_cast<double>(cloud.dim()));
  const double smoothing = options.smoothing.value_or(0);
  require(smoothing >= 0 && std::isfinite(smoothing), "the smoothing length must be >= 0", smoothing);
  require(options.support_radius >= 0 && std::isfinite(options.support_radius),
          "the support radius of a local fit must be >= 0", options.support_radius);
  require(options.normal_neighbours >= 2, "normals need at least 2 neighbours",
          static_cast<double>(options.normal_neighbours));
}

void require_memory(Index num_samples, const Context& context) {
  const double needed = local_fit_bytes(num_samples);
  const auto limit = static_cast<double>(detail::memory_limit(context));
  if (needed <= limit) return;
  const auto megabytes = [](double bytes) { return std::to_string(static_cast<long>(bytes / (1 << 20))) + " MB"; };
  throw OutOfMemory("a fit of " + std::to_string(num_samples) + " samples needs " + megabytes(needed) + " of the " +
                    megabytes(limit) + " it may take: thin the cloud");
}

/// What patches are fitted to, and how far each sample's should speak.
struct FittedSamples {
  OrientedSamples samples;
  const KdTree& tree;
  const Vector& spacing;
  const Vector& reach;
};

/// Patches at a rim, and where a mesh is coarse, are so large that the surface is theirs as far as it goes.
void wish_for_rims(const FittedSamples& fitted, detail::BallWishes& wishes, const Context& context) {
  constexpr double kBeyondReach = 1.15;
  constexpr double kCoarse = 3;  // spacings
  wishes.own = detail::find_rim(fitted.samples, fitted.tree, context);
  for (Index i = 0; i < fitted.reach.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (fitted.reach(i) > kCoarse * fitted.spacing(i)) wishes.own[at] = true;
    if (wishes.own[at]) wishes.radius(i) = std::max(wishes.radius(i), kBeyondReach * fitted.reach(i));
  }
}

/// A large smoothing length may put the whole cloud into one ball. So many samples tell a cubic all there is to tell:
/// of more, ordered by their distance, every second, third, ... is taken.
void thin(std::vector<Neighbour>& near) {
  constexpr std::size_t kMostSamples = 2000;
  const std::size_t step = near.size() / kMostSamples + 1;
  if (step == 1) return;
  for (std::size_t kept = 0; kept * step < near.size(); ++kept) near[kept] = near[kept * step];
  near.resize((near.size() + step - 1) / step);
}

/// Fits the patches; returns the median number of samples in one.
template <int D>
Index fit_patches(OrientedSamples samples, const KdTree& tree, const std::vector<Ball>& balls, LocalFitModel& model,
                  const Context& context) {
  constexpr Index kGrain = 64;
  constexpr Index kBetweenReports = 8192;
  const auto m = static_cast<Index>(balls.size());
  model.centres.resize(D, m);
  model.radii.resize(m);
  model.coefficients.resize(static_cast<Index>(detail::Cubic<D>::kSize), m);
  Vector num_samples(m);
  const auto fit = [&](Index first, Index last) {
    detail::PatchSolver<D> solver(samples);
    std::vector<Neighbour> near;
    for (Index i = first; i < last; ++i) {
      const Ball& ball = balls[static_cast<std::size_t>(i)];
      tree.within(samples.points.col(ball.sample).data(), ball.radius, near);
      thin(near);
      std::array<double, D> centre{};
      for (int a = 0; a < D; ++a) centre[static_cast<std::size_t>(a)] = samples.points(a, ball.sample);
      const detail::Patch<D> patch = solver.fit(centre, ball.radius, near);
      model.centres.col(i) = samples.points.col(ball.sample);
      model.radii(i) = ball.radius;
      model.coefficients.col(i) = Eigen::Map<const Vector>(patch.cubic.coefficient.data(), model.coefficients.rows());
      num_samples(i) = static_cast<double>(near.size());
    }
  };
  for (Index begin = 0; begin < m; begin += kBetweenReports) {
    const Index end = std::min(m, begin + kBetweenReports);
    detail::parallel_for(context, begin, end, kGrain, fit);
    context.report("fit", static_cast<double>(end) / static_cast<double>(m));
  }
  return static_cast<Index>(detail::quantile(num_samples, 0.5));
}

/// Steps 2 to 4.
void fit_to(const FittedSamples& fitted, bool by_size, double least_radius, LocalFitModel& model,
            const Context& context) {
  const Points& points = fitted.samples.points;
  const Index d = points.rows();
  detail::BallWishes wishes;
  wishes.samples = by_size ? std::vector<Index>(static_cast<std::size_t>(points.cols()), detail::fewest_samples(d))
                           : detail::samples_by_cross_validation(fitted.samples, fitted.tree, context);
  wishes.radius = Vector::Constant(points.cols(), least_radius);
  wish_for_rims(fitted, wishes, context);
  const std::vector<Ball> balls = detail::cover(points, fitted.tree, wishes, context);
  model.report.samples_per_patch = d == 2 ? fit_patches<2>(fitted.samples, fitted.tree, balls, model, context)
                                          : fit_patches<3>(fitted.samples, fitted.tree, balls, model, context);
}

/// How far the surface stands off the samples; `original`: which sample of the cloud each is.
void measure_residual(const Points& points, const std::vector<Index>& original, const ImplicitFunction& function,
                      LocalFitReport& report, const Context& context) {
  constexpr Index kGrain = 1024;
  Vector miss(points.cols());
  detail::parallel_for(context, 0, points.cols(), kGrain, [&](Index first, Index last) {
    const auto evaluator = function.make_evaluator();
    const Points x = points.middleCols(first, last - first);
    Vector value(x.cols());
    Points gradient(x.rows(), x.cols());
    evaluator->evaluate({.n = x.cols(), .x = x.data(), .value = value.data(), .jacobian = gradient.data()});
    miss.segment(first, last - first) = value.array().abs() / gradient.colwise().norm().transpose().array();
  });
  Index worst = 0;
  report.residual_max = miss.maxCoeff(&worst);
  report.residual_at = original[static_cast<std::size_t>(worst)];
  report.residual_rms = std::sqrt(miss.squaredNorm() / static_cast<double>(miss.size()));
}

}  // namespace

double local_fit_bytes(Index num_samples) { return kBytesPerSample * static_cast<double>(num_samples); }

LocalFitModel fit_local(const PointCloud& cloud, const LocalFitOptions& options, const Context& context) {
  require_valid(cloud, options);
  require_memory(cloud.size(), context);
  LocalFitModel model;
  model.samples = cloud;
  model.samples.normals = estimate_normals(cloud, options.normal_neighbours, context);
  const detail::MergedPoints merged = detail::merge_duplicates(cloud.points);
  const Points normals = model.samples.normals(Eigen::all, merged.merged_from);
  const OrientedSamples samples{merged.points, normals};
  const KdTree tree(samples.points);
  const Index n = samples.points.cols();

  const Vector spacing = detail::local_spacing(samples.points, tree, context);
  const bool ends_chosen = !(options.support_radius > 0);
  Vector reach = ends_chosen ? detail::support_radii(samples, tree, spacing, context)
                             : Vector(Vector::Constant(n, options.support_radius));
  Vector support = reach;
  const detail::FacedSamples mesh{samples, cloud.faces, merged.merged_to};
  const bool faced = ends_chosen && cloud.faces.cols() > 0;
  // A smoothed surface may leave the vertices by more than they reach across.
  const bool of_mesh = faced && !(options.smoothing.value_or(0) > 0);
  model.flatness = of_mesh ? detail::kFlatnessOfMesh : detail::kFlatnessOfCloud;
  if (faced) {
    // Over a mesh's faces patches speak, whatever it takes to cover them.
    reach = reach.cwiseMax(kOfEdge * detail::longest_edges(mesh));
    support = of_mesh ? detail::support_of_vertices(mesh, support) : reach;
  }
  context.check_cancelled();

  // Meshes are taken at their word: what looks like noise on a coarse one is unresolved shape.
  const bool by_size = options.smoothing.has_value() || cloud.faces.cols() > 0;
  const double least_radius = kRadiusPerWavelength * options.smoothing.value_or(0);
  LocalFitReport& report = model.report;
  fit_to({samples, tree, spacing, reach}, by_size, least_radius, model, context);
  model.support.resize(cloud.size());
  for (Index i = 0; i < cloud.size(); ++i) model.support(i) = support(merged.merged_to[static_cast<std::size_t>(i)]);
  report.num_samples = n;
  report.spacing = detail::quantile(spacing, 0.5);
  report.noise =
      by_size && !options.smoothing ? 0 : report.spacing * detail::relative_noise(samples.points, normals, tree);
  const std::shared_ptr<const ImplicitFunction> function = detail::make_blended_function(model);
  if (of_mesh) model.between = detail::places_between(mesh, support, *function, context);
  measure_residual(samples.points, merged.merged_from, *function, report, context);
  report.merged_sheets =
      detail::find_merged_sheets(samples.points, normals, tree, *function, cloud.faces.cols() > 0, context);
  report.merged_sheets.at = merged.merged_from[static_cast<std::size_t>(report.merged_sheets.at)];
  if (report.merged_sheets.count > 0) context.tell(detail::doubt(report.merged_sheets, cloud.points));
  return model;
}

}  // namespace taut
