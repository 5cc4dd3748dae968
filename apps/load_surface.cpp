#include "load_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <utility>

#include "checks.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/model_file.hpp"
#include "taut/io/read_clauses.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/io/read_points.hpp"
#include "taut/io/read_volume.hpp"
#include "taut/surface/formula.hpp"

namespace taut::app {
namespace {

FormulaOptions formula_options(const SurfaceArguments& arguments) {
  FormulaOptions options;
  options.dim = arguments.dim;
  options.domain = arguments.domain;
  for (const std::string& text : arguments.parameters) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--set " + text + ": write NAME=VALUE, as in --set R=1.5");
    }
    const std::string name = text.substr(0, equals);
    const Vector value = parse_numbers(text.substr(equals + 1), "--set " + name);
    if (value.size() != 1) throw UsageError("--set " + text + ": give one value");
    options.parameters[name] = value(0);
  }
  return options;
}

Surface load_file(const SurfaceArguments& arguments, const Context& context) {
  if (arguments.surface.ends_with(".vm")) {
    if (const char* option = arguments.volume.given()) {
      throw UsageError(fmt::format("{} is for volumes; {} is a clause file", option, arguments.surface));
    }
    return read_clauses(arguments.surface, formula_options(arguments), context);
  }
  for (const auto& [given, option] :
       {std::pair{!arguments.parameters.empty(), "--set"}, std::pair{!arguments.domain.empty(), "--domain"},
        std::pair{arguments.dim.has_value(), "--dim"}}) {
    if (given) throw UsageError(fmt::format("{} is for formulas; {} is a file", option, arguments.surface));
  }
  if (is_volume_file(arguments.surface)) {
    if (arguments.rbf.max_samples != RbfOptions().max_samples) throw UsageError("--samples-max is for point clouds");
    if (arguments.rbf.support_radius != RbfOptions().support_radius) throw UsageError("--support is for point clouds");
    return load_volume(arguments.surface, arguments.volume, arguments.rbf.smoothing, context);
  }
  if (const char* option = arguments.volume.given()) {
    throw UsageError(fmt::format("{} is for volumes; {} is none", option, arguments.surface));
  }
  if (arguments.surface.ends_with(".taut")) {
    return make_surface(std::make_shared<const RbfModel>(read_model(arguments.surface)));
  }
  return make_surface(std::make_shared<const RbfModel>(fit_file(arguments.surface, arguments.rbf, context)));
}

/// The surface with points on it to start paths from, where there are no cells.
Surface with_samples(const Surface& surface, const std::string& file, const Context& context) {
  constexpr Index kMostDimensionsOfCells = 6;
  if (surface.samples() != nullptr) throw UsageError("--samples is for formulas; a cloud brings its own");
  if (surface.dim() <= kMostDimensionsOfCells) return surface;  // read_seeds
  PointCloud cloud;
  cloud.points = read_points(file, surface.dim(), context);
  return surface.with_samples(std::make_shared<const PointCloud>(std::move(cloud)));
}

}  // namespace

void SurfaceArguments::add_to(CLI::App& command) {
  command
      .add_option(
          "SURFACE", surface,
          "a formula such as 'x^2+y^2+4z^2=1', a point cloud, mesh, volume or clause (.vm) file, or a .taut model")
      ->required();
  command.add_option("--dim", dim, "dimension of a formula's space (default: its largest variable)")
      ->check(whole_number(2, 65535));
  command.add_option("--set", parameters, "a parameter of the formula, NAME=VALUE (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--domain", domain, "keep the surface where this holds, as in 'z >= 0' (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--samples", samples,
                     "points on or near a formula's surface: what --grid grow starts from; in more than 6 dimensions, "
                     "what paths start from");
  command.add_option("--box", box, "where to look: LO,HI or X0,X1,Y0,Y1,... (default: found)");
  add_fit_options(command, rbf);
  volume.add_to(command);
}

void add_fit_options(CLI::App& command, RbfOptions& options) {
  command
      .add_option("--smooth", options.smoothing,
                  "smoothing of the fit; 0 passes through every sample. Of a volume: voxels")
      ->check(number_not_below_zero())
      ->group("Fitting a cloud");
  command.add_option("--samples-max", options.max_samples, "fit at most this many well-spread samples")
      ->check(whole_number(10, 20000))
      ->group("Fitting a cloud");
  command
      .add_option("--support", options.support_radius, "the surface ends this far from its samples; negative = never")
      ->check(any_number())
      ->group("Fitting a cloud");
}

RbfModel fit_file(const std::string& path, const RbfOptions& options, const Context& context) {
  const PointCloud cloud = read_point_cloud(path, context);
  try {
    return fit_rbf(cloud, options, context);
  } catch (const InvalidArgument& error) {
    throw IoError(path, error.what());
  }
}

bool names_a_file(const std::string& surface) {
  std::error_code ignored;
  if (std::filesystem::exists(surface, ignored)) return true;
  // A path that does not exist must be called that, rather than be read as a formula with odd variables.
  const std::string extension = std::filesystem::path(surface).extension().string();
  const bool looks_like_one =
      extension.size() >= 2 && extension.size() <= 6 && std::isalpha(static_cast<unsigned char>(extension[1])) != 0 &&
      std::all_of(extension.begin() + 1, extension.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
  return looks_like_one && surface.find_first_of("=^*+(),;") == std::string::npos;
}

Surface load_surface(const SurfaceArguments& arguments, const Context& context) {
  if (const char* option = arguments.volume.given(); option != nullptr && !names_a_file(arguments.surface)) {
    throw UsageError(fmt::format("{} is for volumes; '{}' is a formula", option, arguments.surface));
  }
  Surface surface = names_a_file(arguments.surface) ? load_file(arguments, context)
                                                    : parse_surface(arguments.surface, formula_options(arguments));
  if (!arguments.samples.empty()) surface = with_samples(surface, arguments.samples, context);
  return arguments.box.empty() ? surface : surface.with_box(parse_box(arguments.box, surface.dim()));
}

}  // namespace taut::app
