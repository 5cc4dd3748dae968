// taut field: distances from sources to everywhere, or to given points.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>

#include "batch_errors.hpp"
#include "cell_arguments.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "ignored_faces.hpp"
#include "input_files.hpp"
#include "load_surface.hpp"
#include "output.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/distance.hpp"
#include "taut/query/field.hpp"

namespace taut::app {
namespace {

struct FieldArguments {
  CommonArguments common;
  SurfaceArguments surface;
  std::vector<std::string> from;
  std::vector<std::string> from_curves;  // files
  std::string at;
  FieldOptions options;
  std::optional<double> tolerance;  // of exact distances
  bool header = false;
  double max_distance = std::numeric_limits<double>::infinity();
  bool grid_only = false;
  bool directions = false;
  std::string isolines;
  FileArguments files;

  /// Surfaces that stand for data are no smoother than C^2, and no more exact than the data: 1e-6 is enough for them,
  /// and several times as quick as 1e-9.
  [[nodiscard]] DistanceOptions distance_options(const Surface& loaded, bool paths) const {
    constexpr double kForData = 1e-6;
    return {.tolerance = tolerance.value_or(loaded.kind() == "formula" ? DistanceOptions{}.tolerance : kForData),
            .max_distance = max_distance,
            .grid = options.grid,
            .cell = options.cell,
            .seeds = options.seeds,
            .march = options.march,
            .paths = paths};
  }
};

Points parse_sources(const std::vector<std::string>& texts, const Surface& surface) {
  Points sources(surface.dim(), static_cast<Index>(texts.size()));
  for (std::size_t j = 0; j < texts.size(); ++j) {
    sources.col(static_cast<Index>(j)) = parse_point(texts[j], "--from", surface);
  }
  return sources;
}

/// Distances from the sources, or the curves, as asked for.
DistanceSolver make_solver(const FieldArguments& arguments, const Surface& surface, const Points& sources, bool paths,
                           const Context& context) {
  if (arguments.from_curves.empty()) return {surface, sources, {}, arguments.distance_options(surface, paths), context};
  std::vector<Points> curves;
  for (const std::string& file : arguments.from_curves) {
    curves.push_back(read_point_list(file, surface, context));
    if (curves.back().cols() < 2) throw InvalidArgument(file + ": a curve takes two points or more");
  }
  DistanceSolver solver(surface, curves.front().col(0), {}, arguments.distance_options(surface, paths), context);
  solver.set_curves(curves);
  return solver;
}

/// ",x,y,z"
std::string columns(const Points& vectors, Index j) {
  std::string text;
  for (Index c = 0; c < vectors.rows(); ++c) text += fmt::format(",{}", vectors(c, j));
  return text;
}

/// "distance,error", and with --directions "source,departure1,...,arrival1,...", of curves "foot1,..." before them.
std::string header_line(Index dim, bool directions, bool curves) {
  std::string line = "distance,error";
  if (directions) {
    line += ",source";
    for (const char* name : {"foot", "departure", "arrival"}) {
      if (name[0] == 'f' && !curves) continue;
      for (Index c = 1; c <= dim; ++c) line += fmt::format(",{}{}", name, c);
    }
  }
  return line + "\n";
}

/// Exact distances at given points, a line each.
ExitCode distances_at(const FieldArguments& arguments, const Surface& surface, const Points& sources,
                      const Context& context) {
  const Points at = read_point_list(arguments.at, surface, context);
  DistanceSolver solver = make_solver(arguments, surface, sources, true, context);
  const bool curves = !arguments.from_curves.empty();
  const Distances found = solver.at(at);
  clear_progress();
  BatchErrors errors(arguments.at == "-" ? "standard input" : arguments.at);
  std::string lines = arguments.header ? header_line(surface.dim(), arguments.directions, curves) : "";
  for (Index j = 0; j < at.cols(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const bool ok = found.status[i] == Status::ok;
    if (!ok) errors.tell(i + 1, found.message.at(j), "point");
    const bool unknown = !ok && found.status[i] != Status::disconnected;
    lines +=
        fmt::format("{},{}", unknown ? std::numeric_limits<double>::quiet_NaN() : found.distance(j), found.error(j));
    if (arguments.directions) {
      lines += fmt::format(",{}{}{}{}", found.source[i], curves ? columns(found.foot, j) : "",
                           columns(found.departure, j), columns(found.arrival, j));
    }
    lines += '\n';
  }
  std::cout << lines;
  const auto by_path = std::ranges::count(found.proof, DistanceProof::path);
  if (solver.has_fan() && by_path > 0) {
    context.tell(
        fmt::format("{} of {} distances are the shortest of corrected paths: not all geodesics could be "
                    "followed as far (borders, creases, singular points, or the budget)",
                    grouped(by_path), grouped(at.cols())));
  }
  return errors.any() ? kSomeLinesFailed : kDone;
}

/// Distances are numbers a vertex, which some formats have no room for.
void tell_lost_distances(const std::vector<std::string>& files, const Context& context) {
  for (const std::string& file : files) {
    for (const char* extension : {".obj", ".off", ".stl"}) {
      if (!file.ends_with(extension)) continue;
      context.tell(fmt::format("{}: holds the surface without its distances; .vtp and .ply hold both", file));
    }
  }
}

/// "8" = so many at equal steps; "0.5,1" = these.
std::vector<double> parse_levels(const std::string& text, const Vector& values) {
  std::vector<double> levels;
  const Vector numbers = parse_numbers(text, "--isolines");
  const double first = numbers(0);
  constexpr int kMost = 1000;
  if (numbers.size() == 1 && text.find_first_of(".e") == std::string::npos && first >= 1 && first <= kMost) {
    return even_levels(values, static_cast<int>(first));
  }
  for (const double level : numbers) levels.push_back(level);
  return levels;
}

/// Puts exact distances in the place of marched ones at the vertices, as far as all geodesics can be followed, and the
/// estimated errors beside them (NaN = marched). Marches do not start from curves: then nothing stays. Returns how
/// many.
Index make_exact(DistanceSolver& solver, SurfaceMesh& mesh, bool keep_marched) {
  const Distances exact = solver.at(mesh.vertices);
  VertexScalar error{"error", Vector::Constant(mesh.vertices.cols(), std::numeric_limits<double>::quiet_NaN())};
  Index count = 0;
  for (Index v = 0; v < mesh.vertices.cols(); ++v) {
    const auto i = static_cast<std::size_t>(v);
    if (exact.proof[i] == DistanceProof::fan) {
      mesh.scalars.front().values(v) = exact.distance(v);
      error.values(v) = exact.error(v);
      ++count;
    } else if (exact.status[i] == Status::ok || exact.status[i] == Status::disconnected || !keep_marched) {
      mesh.scalars.front().values(v) = std::numeric_limits<double>::quiet_NaN();  // beyond --max-distance, or apart
    }
  }
  mesh.scalars.push_back(std::move(error));
  return count;
}

ExitCode run(FieldArguments arguments, const CLI::App& command) {
  if (!arguments.at.empty() && !arguments.files.out.empty()) {
    throw UsageError("--at writes its lines to stdout, as in > distances.csv; --out is for the whole surface");
  }
  if (arguments.at.empty() && arguments.files.out.empty()) {
    throw UsageError(
        "give --out FILE for the whole surface, or --at POINTS.csv for given points (see taut field --help)");
  }
  if (arguments.from.empty() == arguments.from_curves.empty()) {
    throw UsageError("give --from, or --from-curve (see taut field --help)");
  }
  if (!arguments.from_curves.empty() && arguments.grid_only) {
    throw UsageError("--grid-only marches from points, not from --from-curve");
  }
  if (!arguments.at.empty() && (arguments.grid_only || !arguments.isolines.empty())) {
    throw UsageError("--grid-only and --isolines go with --out, not with --at");
  }
  if (arguments.at.empty())
    refuse_without_effect(command, {"--directions", "--header"}, "it is for distances --at points");
  if (arguments.grid_only && std::isfinite(arguments.max_distance)) {
    throw UsageError("--max-distance bounds exact distances, not those of --grid-only");
  }
  if (!arguments.at.empty()) {
    refuse_without_effect(command, {"--march", "--envelope"}, "distances --at points are exact, not marched");
  } else if (command.count("--march") + command.count("--envelope") > 0) {
    refuse_without_effect(command, {"--from-curve"}, "distances are marched from points only");
    arguments.grid_only = true;  // asked for by name: what that march says, nothing better
  }
  if (arguments.grid_only) refuse_without_effect(command, {"--tol"}, "marched distances are as exact as the cells");
  refuse_to_overwrite({arguments.surface.surface, arguments.at}, arguments.files.out);
  check_envelope_usage(arguments.options.march, arguments.options.envelope);
  arguments.files.check(arguments.isolines.empty() ? OutputKind::mesh : OutputKind::path);
  const Context context = terminal_context(arguments.common.terminal);
  const Surface surface = load_surface(arguments.surface, context);
  arguments.options.seeds = read_seeds(arguments.surface, surface, arguments.options.grid, context);
  Points sources = parse_sources(arguments.from, surface);
  if (!arguments.at.empty()) return distances_at(arguments, surface, sources, context);
  if (surface.dim() != 3 || surface.codim() != 1) {
    throw InvalidArgument(
        fmt::format("a field is drawn on surfaces in 3 dimensions, this one lies in {} with {} "
                    "equation{}; use --at POINTS.csv",
                    surface.dim(), surface.codim(), surface.codim() == 1 ? "" : "s"));
  }
  tell_lost_distances(arguments.files.out, context);
  DistanceSolver solver = make_solver(arguments, surface, sources, false, context);
  const bool curves = !arguments.from_curves.empty();
  if (curves) sources = solver.sources();
  FieldResult field = marched_field(surface, sources, arguments.options, context);
  const bool exact = !arguments.grid_only && solver.has_fan();
  const Index num_exact = exact ? make_exact(solver, field.mesh, !curves) : 0;
  std::optional<Polylines> isolines;
  if (!arguments.isolines.empty()) {
    const Vector& values = field.mesh.scalars.front().values;
    const std::vector<double> levels = parse_levels(arguments.isolines, values);
    isolines =
        exact ? distance_isolines(solver, field.mesh, values, levels) : trace_isolines(field.mesh, values, levels);
  }
  clear_progress();
  const Vector& distance = field.mesh.scalars.front().values;
  Index reached = 0;
  double farthest = 0;
  for (const double u : distance) {
    if (!std::isfinite(u)) continue;
    ++reached;
    farthest = std::max(farthest, u);
  }
  tell_of_ignored_faces(surface, farthest, context);
  const std::vector<SceneFact> facts = {
      field.over_mesh ? SceneFact{"triangles", grouped(field.mesh.faces.cols())}
                      : SceneFact{"cells", cells_text(field.num_cells, field.cell, field.num_layers)},
      {"reached", fmt::format("{} of {} vertices", grouped(reached), grouped(distance.size()))},
      {"farthest", fmt::format("{:.6g}", farthest)},
      {"exact", exact ? fmt::format("{} of {} vertices", grouped(num_exact), grouped(distance.size()))
                      : std::string(field.over_mesh ? "none: marched over triangles, since the surface has edges; "
                                                      "--at gives exact distances"
                                                    : "none: marched distances")}};
  write_mesh_files(arguments.files, {.surface = surface,
                                     .mesh = field.mesh,
                                     .isolines = isolines,
                                     .edges = field.mesh.edges,
                                     .marks = sources,
                                     .facts = facts,
                                     .title = "Distances on " + picture_title(arguments.surface.surface)});
  std::cout << facts_text(facts);
  return kDone;
}

}  // namespace

Run add_field_command(CLI::App& app) {
  auto arguments = std::make_shared<FieldArguments>();
  CLI::App& command = *app.add_subcommand("field", "distances from a source to everywhere");
  arguments->surface.add_to(command);
  command.add_option("--from", arguments->from, "a source: 1,0,0 or @17 (repeatable: the nearest one counts)")
      ->allow_extra_args(false);
  command
      .add_option("--from-curve", arguments->from_curves,
                  "a curve as source, a point a line: the shortest paths from each to the next (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--at", arguments->at,
                     "points, one a line, - = stdin: writes distance,error for each, exact to --tol");
  command.add_flag("--directions", arguments->directions,
                   "with --at: also the number of the nearest source (from 0), and the unit directions in which the "
                   "geodesic leaves it and arrives");
  command.add_option("--max-distance", arguments->max_distance, "leave out what is farther away")
      ->check(positive_number());
  command.add_flag("--grid-only", arguments->grid_only,
                   "with --out: marched distances, as exact as the cells (so do --march and --envelope)");
  command.add_option("--isolines", arguments->isolines,
                     "lines of equal distance: how many, or their distances (0.5,1,2). Pictures show them on the "
                     "surface, other files hold them alone");
  command
      .add_option("--tol", arguments->tolerance,
                  "relative tolerance of exact distances (default: 1e-9 on formulas, 1e-6 on surfaces fitted to data)")
      ->check(number_between(1e-13, 1e-3));
  command.add_flag("--header", arguments->header, "with --at: a first line with the columns' names");
  add_cell_options(command, arguments->options.cell, arguments->options.grid);
  add_march_option(command, arguments->options.march);
  add_envelope_option(command, arguments->options.envelope);
  arguments->files.add_to(command, OutputKind::mesh, "the surface with its distances, or the isolines,");
  arguments->common.add_to(command);
  return [arguments, &command] { return run(*arguments, command); };
}

}  // namespace taut::app
