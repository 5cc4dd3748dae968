// taut curve: Bezier curves on a surface.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "geodesic_arguments.hpp"
#include "input_files.hpp"
#include "output.hpp"
#include "points_argument.hpp"
#include "report.hpp"
#include "taut/core/error.hpp"
#include "taut/io/write_geometry.hpp"
#include "taut/query/bezier.hpp"
#include "taut/query/surface_mesh.hpp"
#include "terminal.hpp"
#include "vector_text.hpp"

namespace taut::app {
namespace {

struct CurveArguments {
  GeodesicArguments geodesic;
  std::string bezier;
  Index degree = 0;
  Index count = 65;
  FileArguments files;
  bool json = false;
};

/// Pieces of one degree, end to end.
struct Curve {
  Status status = Status::ok;
  std::string message;
  Points points;
  double length = 0;
  Index num_pieces = 0;
  bool unique = true;
};

Curve draw(const CurveArguments& arguments, const Surface& surface, const Points& controls, const Context& context) {
  const Index last = controls.cols() - 1;
  const Index degree = arguments.degree > 0 ? arguments.degree : last;
  if (last < 1) throw InvalidArgument(arguments.bezier + ": a curve takes two control points or more");
  if (last % degree != 0) {
    throw InvalidArgument(fmt::format("{}: {} control points make no whole pieces of degree {}: give {} or {}",
                                      arguments.bezier, last + 1, degree, last / degree * degree + 1,
                                      (last / degree + 1) * degree + 1));
  }
  PathSolver solver(surface, arguments.geodesic.options, context);
  Curve curve{.message = {}, .points = Points(surface.dim(), 0)};
  for (Index first = 0; first < last; first += degree) {
    const BezierCurve piece = bezier_curve(solver, controls.middleCols(first, degree + 1), arguments.count, context);
    const Index before = curve.points.cols();
    const Index skip = before > 0 ? 1 : 0;  // the joint is there already
    if (piece.points.cols() > skip) {
      curve.points.conservativeResize(surface.dim(), before + piece.points.cols() - skip);
      curve.points.rightCols(piece.points.cols() - skip) = piece.points.rightCols(piece.points.cols() - skip);
    }
    curve.length += piece.length;
    curve.unique = curve.unique && piece.unique;
    if (curve.message.empty() && !piece.message.empty()) {
      curve.message = last > degree ? fmt::format("piece {}: {}", curve.num_pieces + 1, piece.message) : piece.message;
    }
    curve.status = piece.status;
    if (piece.status != Status::ok) break;
    ++curve.num_pieces;
  }
  return curve;
}

void write_files(const CurveArguments& arguments, const Surface& surface, const Curve& curve, const Points& controls,
                 const nlohmann::ordered_json& json, const std::vector<SceneFact>& facts, const Context& context) {
  write_json_files(arguments.files, json);
  if (curve.points.cols() < 2) return;
  const Polylines lines{.lines = {curve.points}, .scalars = {}};
  std::optional<SurfaceMesh> mesh;
  for (const std::string& file : arguments.files.out) {
    if (file.ends_with(".json")) continue;
    FileArguments one = arguments.files;
    one.out = {file};
    if (!one.has_picture()) {
      write_polylines(file, lines);
      continue;
    }
    if (!mesh) mesh = display_mesh(surface, {.part_faces = true}, context);
    write_mesh_files(one, {.surface = surface,
                           .mesh = *mesh,
                           .isolines = {},
                           .edges = mesh->edges,
                           .marks = controls,
                           .mark_name = "control point",
                           .curves = {curve.points},
                           .facts = facts,
                           .title = "Bezier curve on " + picture_title(arguments.geodesic.surface.surface)});
  }
}

ExitCode run(CurveArguments arguments) {
  arguments.files.check(OutputKind::path);
  refuse_to_overwrite({arguments.geodesic.surface.surface, arguments.bezier}, arguments.files.out);
  const Context context = terminal_context(arguments.geodesic.common.terminal);
  const Surface surface = arguments.geodesic.load(context);
  if (arguments.files.has_picture() && (surface.dim() != 3 || surface.codim() != 1)) {
    throw UsageError("pictures of curves show surfaces in space; write .csv or .json here");
  }
  const Points controls = read_point_list(arguments.bezier, surface, context);
  const Curve curve = draw(arguments, surface, controls, context);
  nlohmann::ordered_json json;
  json["command"] = "curve";
  json["status"] = to_string(curve.status);
  if (!curve.message.empty()) json["message"] = curve.message;
  json["surface"] = {{"kind", surface.kind()}, {"dim", surface.dim()}, {"codim", surface.codim()}};
  json["length"] = curve.length;
  json["pieces"] = curve.num_pieces;
  json["unique"] = curve.unique;
  json["points"] = nlohmann::ordered_json::array();
  for (Index j = 0; j < curve.points.cols(); ++j) json["points"].push_back(vector_json(curve.points.col(j)));
  std::string status(to_string(curve.status));
  if (!curve.message.empty()) status += ": " + curve.message;
  const std::vector<SceneFact> facts = {{"length", fmt::format("{:.9g}", curve.length)},
                                        {"pieces", grouped(curve.num_pieces)},
                                        {"points", grouped(curve.points.cols())},
                                        {"status", status}};
  write_files(arguments, surface, curve, controls, json, facts, context);
  clear_progress();
  if (arguments.json) {
    std::cout << json.dump() << "\n";
  } else if (arguments.files.out.empty()) {
    for (Index j = 0; j < curve.points.cols(); ++j) {
      std::string line = vector_columns(curve.points.col(j));
      line.back() = '\n';
      std::cout << line;
    }
  } else {
    std::cout << facts_text(facts);
  }
  if (curve.status != Status::ok) {
    print_error(fmt::format("{}: {}", to_string(curve.status), curve.message));
  } else if (!curve.message.empty()) {
    context.tell(curve.message);
  }
  return exit_code(curve.status);
}

}  // namespace

Run add_curve_command(CLI::App& app) {
  auto arguments = std::make_shared<CurveArguments>();
  CLI::App& command = *app.add_subcommand("curve", "Bezier curves on a surface");
  arguments->geodesic.add_to(command);
  command
      .add_option("--bezier", arguments->bezier,
                  "control points, one a line, - = stdin: one curve of as many as there are, unless --degree is given")
      ->required();
  command
      .add_option("--degree", arguments->degree,
                  "pieces of this degree, each from the last control point of the one before")
      ->check(whole_number(1, 64));
  command.add_option("-n,--number", arguments->count, "points a piece, at equal steps of the parameter")
      ->check(whole_number(2, 1000000))
      ->capture_default_str();
  arguments->files.add_to(command, OutputKind::path, "the curve");
  command.add_flag("--json", arguments->json, "the result as one JSON object on stdout");
  return [arguments] { return run(*arguments); };
}

}  // namespace taut::app
