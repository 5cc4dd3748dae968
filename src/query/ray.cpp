// Geodesics told by start, direction and length: one, or many in parallel. The start is brought onto the surface, the
// direction onto its tangent plane, and the exponential map follows (curve/exponential_map); on surfaces with edges the
// ray goes on over them (strata/facet_ray), where it is bent as the unfolded faces ask. Negative lengths go backwards.
#include "taut/query/tangent_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "core/parallel.hpp"
#include "search/cell_levels.hpp"
#include "strata/facet_ray.hpp"
#include "strata/faceted_surface.hpp"
#include "surface/normal_space.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

/// A start that moves by less than this part of its coordinates is merely rounded: no cells are needed to judge it.
constexpr double kRounded = 1e-6;
/// A direction off the tangent plane by less is merely rounded, radians.
constexpr double kTilted = std::numbers::pi / 180;

void check_direction(const Surface& surface, const VectorIn& direction, double length) {
  if (direction.size() != surface.dim()) {
    throw InvalidArgument(fmt::format("direction {}: has {} coordinates, the surface lies in {} dimensions",
                                      detail::text_of(direction), direction.size(), surface.dim()));
  }
  if (!direction.allFinite()) {
    throw InvalidArgument(fmt::format("direction {}: coordinates must be finite", detail::text_of(direction)));
  }
  if (!(direction.stableNorm() > 0)) throw InvalidArgument("direction: is zero; give one to go in");
  if (!std::isfinite(length)) throw InvalidArgument(fmt::format("length {}: must be finite", length));
}

/// What `answer` makes of one ray of many; what it throws becomes the ray's message, Cancelled apart.
template <class Answer>
void guard(RayResult& result, const Answer& answer) {
  try {
    answer();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    result.message = error.what();
    if (dynamic_cast<const SingularPoint*>(&error) != nullptr) result.status = Status::rank_deficient;
  }
}

std::string explain(const ExponentialResult& result, double length) {
  if (result.status == Status::ok) return {};
  if (result.length == length) return std::string(result.reason);
  return fmt::format("{}; it stops after {:.6g}, at {}", result.reason, result.length, detail::text_of(result.point));
}

/// At every sample of a dense fit third derivatives jump, and no step is exact to rounding there. Of rays from samples
/// of a bunny, oni and fran_cut, 2,000 to 4,900 centres, all five tried stop at rounding, one of eight at 1e-9.
ExponentialOptions options_on(const Surface& surface, ExponentialOptions options) {
  constexpr double kOnDenseFits = 1e-9;
  if (options.tolerance == 0 && surface.kind() == "rbf") options.tolerance = kOnDenseFits;
  return options;
}

}  // namespace

struct RaySolver::Impl {
  Impl(Surface s, const ExponentialOptions& o, Context c)
      : surface(std::move(s)),
        options(options_on(surface, o)),
        context(std::move(c)),
        levels(surface, {}, context),
        map(surface, options) {}

  Surface surface;
  ExponentialOptions options;
  Context context;
  detail::CellLevels levels;
  ExponentialMap map;

  std::unique_ptr<detail::FacetedSurface> faces;  // of a surface with edges; made where it is first needed
  bool sought_faces = false;

  Vector start(const VectorIn& from);
  /// Null where the surface has no edges.
  [[nodiscard]] const detail::FacetedSurface* facets(const PointsIn& near);
  /// `over`: the caller's own clone of the faces, or null.
  void trace(RayResult& result, const VectorIn& direction, double length, detail::FacetedSurface* over,
             ExponentialMap& along, const Context& told) const;
  void tell_tilt(const Vector& from, const VectorIn& direction) const;
};

RaySolver::RaySolver(Surface surface, ExponentialOptions options, Context context)
    : impl_(std::make_unique<Impl>(std::move(surface), options, std::move(context))) {}
RaySolver::~RaySolver() = default;
RaySolver::RaySolver(RaySolver&&) noexcept = default;
RaySolver& RaySolver::operator=(RaySolver&&) noexcept = default;

Vector RaySolver::Impl::start(const VectorIn& from) {
  detail::check_point(surface, from, "start");
  const ProjectionResult projected = project_to_surface(surface, from);
  const double scale = std::max(from.lpNorm<Eigen::Infinity>(), projected.point.lpNorm<Eigen::Infinity>());
  if (projected.converged && projected.distance <= kRounded * scale &&
      surface.inside_domain(projected.point, kRounded * scale)(0)) {
    return projected.point;
  }
  // Only now is a size needed to judge the distance by, which may cost a search for the box.
  levels.prepare(from);
  return levels.on_surface(from, "start");
}

const detail::FacetedSurface* RaySolver::Impl::facets(const PointsIn& near) {
  if (!std::exchange(sought_faces, true)) {
    faces = detail::FacetedSurface::of(surface);
    if (faces && !faces->has_edges()) faces.reset();
    if (faces) {
      levels.prepare(near);
      faces->scale = levels.extent().box.diagonal();
    }
  }
  return faces.get();
}

void RaySolver::Impl::trace(RayResult& result, const VectorIn& direction, double length, detail::FacetedSurface* over,
                            ExponentialMap& along, const Context& told) const {
  if (over == nullptr || length == 0) {
    static_cast<ExponentialResult&>(result) = along.trace(result.from, direction, length, told);
    result.message = explain(result, length);
    return;
  }
  // Over faces rays only go forwards: backwards is forwards the other way, with the signs put back afterwards.
  const detail::Point3 way = length < 0 ? detail::Point3(-direction) : detail::Point3(direction);
  const detail::FacetRay found = detail::trace_over_faces(*over, result.from, way, std::abs(length), options, told);
  static_cast<ExponentialResult&>(result) = found.ray;
  if (length < 0) {
    result.length = -result.length;
    result.direction = -result.direction;
    result.conjugate_searched = -result.conjugate_searched;
    if (result.conjugate_at) result.conjugate_at = -*result.conjugate_at;
  }
  for (std::size_t i = 0; i < found.arcs.size(); ++i) {
    const detail::FacetRay::Arc& arc = found.arcs[i];
    if (i > 0) {
      PathPiece crossing;
      crossing.kind = PathPiece::Kind::crossing;
      crossing.point = arc.x;
      crossing.left = crossing.right = found.arcs[i - 1].angle;
      result.pieces.push_back(std::move(crossing));
    }
    PathPiece piece;
    piece.kind = PathPiece::Kind::face;
    piece.face = over->face(arc.face).text;
    piece.length = arc.length;
    piece.point = arc.x;
    result.pieces.push_back(std::move(piece));
  }
  if (!options.points) result.points.resize(3, 0);
  result.message = explain(result, length);
}

void RaySolver::Impl::tell_tilt(const Vector& from, const VectorIn& direction) const {
  const Index d = surface.dim();
  const Index k = surface.codim();
  const Points jacobian = surface.jacobian(from);
  Eigen::MatrixXd q(d, k);
  Eigen::MatrixXd r(k, k);
  if (detail::NormalSpace<Eigen::Dynamic>::factor(d, k, jacobian.data(), q.data(), r.data()) < k) return;
  const double tilt = std::asin(std::min(1.0, (q.transpose() * direction.stableNormalized()).norm()));
  if (tilt > kTilted) {
    context.tell(fmt::format("the direction points {:.3g} degrees off the surface; its tangential part is taken",
                             tilt / std::numbers::pi * 180));
  }
}

RayResult RaySolver::solve(const VectorIn& from, const VectorIn& direction, double length) {
  Impl& impl = *impl_;
  check_direction(impl.surface, direction, length);
  RayResult result;
  result.from = impl.start(from);
  // At an edge there are two tangent planes: nothing to compare with.
  if (impl.facets(result.from) == nullptr) impl.tell_tilt(result.from, direction);
  const detail::FacetedSurface* faces = impl.facets(result.from);
  const std::unique_ptr<detail::FacetedSurface> own = faces != nullptr ? faces->clone() : nullptr;
  impl.trace(result, direction, length, own.get(), impl.map, impl.context);
  return result;
}

std::vector<RayResult> RaySolver::solve_many(const PointsIn& from, const PointsIn& directions,
                                             const VectorIn& lengths) {
  Impl& impl = *impl_;
  if (directions.cols() != from.cols() || lengths.size() != from.cols()) {
    throw InvalidArgument(fmt::format("{} starts, {} directions and {} lengths: give as many of each", from.cols(),
                                      directions.cols(), lengths.size()));
  }
  constexpr Index kGrain = 32;
  std::vector<RayResult> results(static_cast<std::size_t>(from.cols()));
  for (Index j = 0; j < from.cols(); ++j) {  // the cells that judge a start are made once
    RayResult& result = results[static_cast<std::size_t>(j)];
    guard(result, [&] {
      check_direction(impl.surface, directions.col(j), lengths(j));
      result.from = impl.start(from.col(j));
    });
  }
  Points starts(impl.surface.dim(), from.cols());
  Index num_starts = 0;
  for (const RayResult& result : results) {
    if (result.message.empty()) starts.col(num_starts++) = result.from;
  }
  const detail::FacetedSurface* faces = num_starts > 0 ? impl.facets(starts.leftCols(num_starts)) : nullptr;
  detail::parallel_for(impl.context, 0, from.cols(), kGrain, [&](Index first, Index last) {
    ExponentialMap map(impl.surface, impl.options);
    const std::unique_ptr<detail::FacetedSurface> own = faces != nullptr ? faces->clone() : nullptr;
    // Nobody could tell whose progress and notes those were.
    Context quiet;
    quiet.cancel = impl.context.cancel;
    for (Index j = first; j < last; ++j) {
      RayResult& result = results[static_cast<std::size_t>(j)];
      // Refused already when its start was judged.
      if (!result.message.empty()) continue;
      guard(result, [&] { impl.trace(result, directions.col(j), lengths(j), own.get(), map, quiet); });
    }
  });
  return results;
}

}  // namespace taut
