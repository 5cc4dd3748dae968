#include "taut/curve/exponential_map.hpp"

#include <cmath>
#include <string>

#include "curve/ray_backend.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

using detail::describe;

void check(const ExponentialOptions& options) {
  if (!(options.tolerance >= 0 && options.tolerance <= 1e-3)) {
    throw InvalidArgument("tolerance is " + describe(options.tolerance) + ", must be in 0 .. 1e-3");
  }
  if (options.max_steps < 1) {
    throw InvalidArgument("max_steps is " + std::to_string(options.max_steps) + ", must be at least 1");
  }
  if (options.max_fields < 0) {
    throw InvalidArgument("max_fields is " + std::to_string(options.max_fields) + ", must not be negative");
  }
}

std::unique_ptr<ExponentialMap::Backend> make_backend(const Surface& surface, const ExponentialOptions& options) {
  check(options);
  if (surface.dim() == 3 && surface.codim() == 1) return detail::make_ray_tracer<3>(surface, options);
  return detail::make_ray_tracer<Eigen::Dynamic>(surface, options);
}

/// Projects the start before its direction is known.
class OnSurface : public ExponentialMap::Backend {
 public:
  OnSurface(const Surface& surface, const ExponentialOptions& options)
      : surface_(surface), evaluator_(surface.make_evaluator()), tracer_(make_backend(surface, options)) {}

  ExponentialResult trace(const Vector& from, const Vector& direction, double length, const Context& context) override {
    for (const auto& [vector, name] : {std::pair{&from, "start"}, std::pair{&direction, "direction"}}) {
      if (vector->size() != surface_.dim()) {
        throw InvalidArgument("the " + std::string(name) + " has " + std::to_string(vector->size()) +
                              " coordinates, the surface lies in " + std::to_string(surface_.dim()) + " dimensions");
      }
      if (!vector->allFinite()) {
        throw InvalidArgument("the " + std::string(name) + " is not finite: " + describe(*vector));
      }
    }
    if (!std::isfinite(length)) throw InvalidArgument("the length is " + describe(length) + ", must be finite");
    if (!(direction.stableNorm() > 0)) throw InvalidArgument("the direction is zero; give one to go in");
    Points start = from;
    // The single point's projection would make an evaluator each time, but it says what is wrong.
    if (!project_to_surface(*evaluator_, surface_.dim(), surface_.codim(), start)(0) &&
        !project_to_surface(surface_, from).converged) {
      throw InvalidArgument("no point of the surface was found near the start " + describe(from) + "; give one closer");
    }
    return tracer_->trace(start, direction / direction.stableNorm(), length, context);
  }

 private:
  Surface surface_;
  std::unique_ptr<Evaluator> evaluator_;
  std::unique_ptr<ExponentialMap::Backend> tracer_;
};

}  // namespace

ExponentialMap::ExponentialMap(const Surface& surface, const ExponentialOptions& options)
    : backend_(std::make_unique<OnSurface>(surface, options)) {}
ExponentialMap::~ExponentialMap() = default;
ExponentialMap::ExponentialMap(ExponentialMap&&) noexcept = default;
ExponentialMap& ExponentialMap::operator=(ExponentialMap&&) noexcept = default;

ExponentialResult ExponentialMap::trace(const VectorIn& from, const VectorIn& direction, double length,
                                        const Context& context) {
  return backend_->trace(from, direction, length, context);
}

ExponentialResult exponential_map(const Surface& surface, const VectorIn& from, const VectorIn& direction,
                                  double length, const ExponentialOptions& options, const Context& context) {
  return ExponentialMap(surface, options).trace(from, direction, length, context);
}

}  // namespace taut
