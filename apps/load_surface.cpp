#include "load_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <utility>

#include "checks.hpp"
#include "formula_argument.hpp"
#include "help_format.hpp"
#include "input_files.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/io/read_points.hpp"
#include "taut/io/read_surface.hpp"

namespace taut::app {
namespace {

/// Options that say nothing about such a surface are mistakes, not wishes. `given` pairs each with its name.
void refuse_options(const std::vector<std::pair<bool, const char*>>& given, const std::string& surface,
                    const char* rule) {
  for (const auto& [is_given, option] : given) {
    if (is_given) throw UsageError(fmt::format("{} is for {}", option, fmt::format(fmt::runtime(rule), surface)));
  }
}

std::vector<std::pair<bool, const char*>> fit_options(const FitOptions& options) {
  return {{options.method != FitMethod::automatic, "--fit"},
          {options.smoothing.has_value(), "--smooth"},
          {options.max_samples != 0, "--samples-max"},
          {options.support_radius != 0, "--support"}};
}

std::vector<std::pair<bool, const char*>> volume_options(const VolumeArguments& volume) {
  return {{volume.given() != nullptr, volume.given()}};
}

Surface load_file(const SurfaceArguments& arguments, const Context& context) {
  const std::string& file = arguments.surface;
  if (is_height_file(file, arguments.height)) {
    refuse_options({{!arguments.parameters.empty(), "--set"},
                    {!arguments.variables.empty(), "--vars"},
                    {!arguments.domain.empty(), "--domain"},
                    {arguments.dim.has_value(), "--dim"}},
                   file, "formulas; {} holds heights");
    refuse_options(volume_options(arguments.volume), file, "volumes; {} holds heights");
    refuse_options(fit_options(arguments.fit), file, "point files; {} holds heights");
    return load_heights(file, arguments.height, context);
  }
  if (is_network_file(file)) {
    refuse_options({{!arguments.parameters.empty(), "--set"},
                    {!arguments.variables.empty(), "--vars"},
                    {!arguments.domain.empty(), "--domain"},
                    {arguments.dim.has_value(), "--dim"},
                    {arguments.volume.label.has_value(), "--label"},
                    {arguments.height.given() != nullptr, arguments.height.given()}},
                   file, "other surfaces; {} holds the weights of a network");
    refuse_options(fit_options(arguments.fit), file, "point files; {} holds the weights of a network");
    return load_network(file, arguments.network, arguments.volume.iso, context);
  }
  refuse_options({{arguments.network.given() != nullptr, arguments.network.given()}}, file,
                 "networks (.npz, .safetensors); {} is none");
  refuse_options({{arguments.height.given() != nullptr, arguments.height.given()}}, file,
                 "pictures (.pgm, .png) and, with --heights, .npy arrays; {} is none");
  if (file.ends_with(".vm")) {
    refuse_options(volume_options(arguments.volume), file, "volumes; {} is a clause file");
    refuse_options(fit_options(arguments.fit), file, "point files; {} is a clause file");
    return read_clauses(file, formula_options(arguments), context);
  }
  if (file.ends_with(".scene")) {
    refuse_options(volume_options(arguments.volume), file, "volumes; {} is a scene");
    refuse_options(fit_options(arguments.fit), file, "point files; {} is a scene");
    return read_scene(file, formula_options(arguments), context);
  }
  if (file.ends_with(".txt") && holds_formula(file)) {
    throw UsageError(fmt::format("{}: holds a formula and no points; write @{}", file, file));
  }
  refuse_options({{!arguments.parameters.empty(), "--set"},
                  {!arguments.variables.empty(), "--vars"},
                  {!arguments.domain.empty(), "--domain"}},
                 file, "formulas; {} is a file");
  if (is_volume_file(file)) {
    refuse_options({{arguments.dim.has_value(), "--dim"}}, file, "formulas and point files; {} is a volume");
    FitOptions others = arguments.fit;
    others.smoothing.reset();  // --smooth is for volumes, too
    refuse_options(fit_options(others), file, "point files; {} is a volume");
    return load_volume(file, arguments.volume, arguments.fit.smoothing, context);
  }
  refuse_options(volume_options(arguments.volume), file, "volumes; {} is none");
  if (file.ends_with(".taut")) {
    refuse_options({{arguments.dim.has_value(), "--dim"}}, file, "formulas and point files; {} is a model");
    refuse_options(fit_options(arguments.fit), file, "point files; {} is fitted already");
    return make_surface(read_model(file));
  }
  return make_surface(fit_file(file, arguments.fit, context, arguments.dim));
}

Surface load_formula(const SurfaceArguments& arguments) {
  refuse_options(volume_options(arguments.volume), arguments.surface, "volumes; '{}' is a formula");
  refuse_options({{arguments.height.given() != nullptr, arguments.height.given()}}, arguments.surface,
                 "height fields; '{}' is a formula");
  refuse_options({{arguments.network.given() != nullptr, arguments.network.given()}}, arguments.surface,
                 "networks; '{}' is a formula");
  refuse_options(fit_options(arguments.fit), arguments.surface, "point files; '{}' is a formula");
  return read_formula(arguments);
}

/// The surface with points on it to start paths from, where there are no cells.
Surface with_samples(const Surface& surface, const std::string& file, const Context& context) {
  constexpr Index kMostDimensionsOfCells = 6;
  if (surface.samples() != nullptr) throw UsageError("--samples is for formulas; a cloud brings its own");
  if (surface.dim() <= kMostDimensionsOfCells) return surface;  // read_seeds
  PointCloud cloud;
  cloud.points = read_points(file_or_stdin(file), surface.dim(), context);
  return surface.with_samples(std::make_shared<const PointCloud>(std::move(cloud)));
}

}  // namespace

void SurfaceArguments::add_to(CLI::App& command) {
  const OptionGroup group(command, "Surface");
  command
      .add_option("SURFACE", surface,
                  "a formula such as 'x^2+y^2+4z^2=1' or @FILE that holds one, a point cloud, mesh, volume, clause "
                  "(.vm), scene (.scene), height (.pgm, .png) or network (.npz, .safetensors) file, or a .taut model")
      ->required();
  command
      .add_option("--dim", dim,
                  "dimension of a formula's space (default: its largest variable), or how many columns of a table "
                  "without a header are coordinates")
      ->check(whole_number(2, 65535));
  command.add_option("--vars", variables, "the formula's variables in place of x y z w or x1 x2 ..., as in theta,phi");
  command.add_option("--set", parameters, "parameters of the formula, as in R=1.5,r=0.5 (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--domain", domain, "keep the surface where this holds, as in 'z >= 0' (repeatable)")
      ->allow_extra_args(false);
  // After --domain, whose values the parser sets first.
  command
      .add_option_function<std::vector<std::string>>(
          "--obstacle",
          [this](const std::vector<std::string>& obstacles) {
            for (const std::string& expression : obstacles) domain.push_back("(" + expression + ") >= 0");
          },
          "keep out where this is negative, as in 'x^2+y^2-1': the same as --domain 'x^2+y^2-1 >= 0' (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--samples", samples,
                     "points on or near a formula's surface: what --grid grow starts from; in more than 6 dimensions, "
                     "what paths start from");
  command.add_option("--box", box, "where to look: LO,HI or X0,X1,Y0,Y1,... (default: found)");
  add_fit_options(command, fit);
  volume.add_to(command);
  height.add_to(command);
  network.add_to(command);
}

void add_fit_options(CLI::App& command, FitOptions& options) {
  const OptionGroup group(command, "Fitting a cloud");
  command
      .add_option("--fit", options.method,
                  "dense: one system, of at most 2,500 samples; local: small patches, of all (default: by size)")
      ->transform(one_of<FitMethod>({{"dense", FitMethod::dense}, {"local", FitMethod::local}}));
  command
      .add_option("--smooth", options.smoothing,
                  "smoothing of the fit; 0 passes through every sample. Of a volume: voxels")
      ->check(number_not_below_zero());
  command.add_option("--samples-max", options.max_samples, "dense: fit at most this many well-spread samples")
      ->check(whole_number(10, 20000));
  command
      .add_option("--support", options.support_radius, "the surface ends this far from its samples; negative = never")
      ->check(any_number());
}

FitModel fit_file(const std::string& path, const FitOptions& options, const Context& context,
                  std::optional<Index> dim) {
  if (options.method == FitMethod::local && options.max_samples > 0) {
    throw UsageError("--samples-max is for --fit dense: a local fit takes every sample");
  }
  if (options.method == FitMethod::local && options.support_radius < 0) {
    throw UsageError("--support -1 is for --fit dense: a local fit ends with its samples");
  }
  PointCloud cloud;
  try {
    cloud = read_point_cloud(path, context, dim);
  } catch (const UnnamedColumns& error) {
    throw InvalidArgument(std::string(error.what()) + ", or give --dim 3 to take the first three");
  }
  try {
    return fit_surface(cloud, options, context);
  } catch (const InvalidArgument& error) {
    throw IoError(path, error.what());
  }
}

bool names_a_file(const std::string& surface) {
  if (surface.starts_with('@')) return false;  // a formula in a file
  std::error_code ignored;
  if (std::filesystem::exists(surface, ignored)) return true;
  // A path that does not exist must be called that, rather than be read as a formula with odd variables.
  const std::string extension = std::filesystem::path(surface).extension().string();
  const bool looks_like_one =
      extension == ".safetensors" ||
      (extension.size() >= 2 && extension.size() <= 6 && std::isalpha(static_cast<unsigned char>(extension[1])) != 0 &&
       std::all_of(extension.begin() + 1, extension.end(), [](unsigned char c) { return std::isalnum(c) != 0; }));
  return looks_like_one && surface.find_first_of("=^*+(),;") == std::string::npos;
}

Surface load_surface(const SurfaceArguments& arguments, const Context& context) {
  if (arguments.surface == "-") {
    throw UsageError("SURFACE -: a surface is not read from standard input; write it to a file first");
  }
  Surface surface = names_a_file(arguments.surface) ? load_file(arguments, context) : load_formula(arguments);
  if (!arguments.samples.empty()) surface = with_samples(surface, arguments.samples, context);
  return arguments.box.empty() ? surface : surface.with_box(parse_box(arguments.box, surface.dim()));
}

}  // namespace taut::app
