#include "report.hpp"

#include "exit_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <optional>
#include <vector>

#include "flow_report.hpp"
#include "taut/surface/fit.hpp"

namespace taut::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json vector_json(const VectorIn& x) { return std::vector<double>(x.data(), x.data() + x.size()); }

Json doubts_json(Doubts doubts) {
  Json list = Json::array();
  doubts.for_each([&](Doubt doubt) { list.push_back(taut::to_string(doubt)); });
  return list;
}

/// Angles in degrees; null over a border, where there is no other side.
Json piece_json(const PathPiece& piece) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  Json json = {{"kind", taut::to_string(piece.kind)}, {"point", vector_json(piece.point)}};
  switch (piece.kind) {
    case PathPiece::Kind::face: json["face"] = piece.face; [[fallthrough]];
    case PathPiece::Kind::edge:
    case PathPiece::Kind::border: json["length"] = number(piece.length); break;
    case PathPiece::Kind::crossing: json["angle"] = number(kDegrees * piece.left); break;
    case PathPiece::Kind::corner:
      json["angles"] = {number(kDegrees * piece.left), number(kDegrees * piece.right)};
      break;
  }
  return json;
}

Json obstacle_json(const Obstacle& obstacle) {
  Json json = {{"kind", taut::to_string(obstacle.kind)}};
  if (obstacle.place.size() > 0) json["place"] = vector_json(obstacle.place);
  if (std::isfinite(obstacle.size)) json["size"] = obstacle.size;
  return json;
}

Json rung_json(const RungReport& report) {
  return {{"rung", taut::to_string(report.rung)},
          {"cell", report.cell},
          {"cells", report.num_cells},
          {"length", number(report.length)},
          {"doubts", doubts_json(report.doubts)}};
}

bool has_path(const PathResult& result) { return result.points.cols() > 0; }

std::string duration(double seconds) {
  return seconds < 1 ? fmt::format("{:.3g} ms", 1e3 * seconds) : fmt::format("{:.3g} s", seconds);
}

/// With its error; without one, all digits.
std::string length_text(const PathResult& result) {
  if (!std::isfinite(result.length_error)) return fmt::format("{:.15g}", result.length);
  return fmt::format("{:.15g} +- {:.1e}", result.length, result.length_error);
}

}  // namespace

nlohmann::ordered_json pieces_json(const std::vector<PathPiece>& pieces) {
  Json list = Json::array();
  for (const PathPiece& piece : pieces) list.push_back(piece_json(piece));
  return list;
}

nlohmann::ordered_json unique_json(bool unique, bool tied) { return unique || tied ? Json(unique) : Json(nullptr); }

nlohmann::ordered_json points_json(const PointsIn& points) {
  Json list = Json::array();
  for (Index j = 0; j < points.cols(); ++j) list.push_back(vector_json(points.col(j)));
  return list;
}

std::string grouped(Index n) {
  std::string text = std::to_string(n);
  for (auto i = static_cast<std::ptrdiff_t>(text.size()) - 3; i > 0; i -= 3)
    text.insert(static_cast<std::size_t>(i), 1, ',');
  return text;
}

const char* to_string(CorrectionMethod method) {
  switch (method) {
    case CorrectionMethod::newton: return "newton";
    case CorrectionMethod::flow: return "flow";
    case CorrectionMethod::grid: return "grid";
  }
  return "unknown";
}

const char* to_string(MarchMethod method) {
  switch (method) {
    case MarchMethod::convergent: return "convergent";
    case MarchMethod::axis: return "axis";
    case MarchMethod::dijkstra: return "dijkstra";
  }
  return "unknown";
}

const char* to_string(GridMethod method) {
  switch (method) {
    case GridMethod::automatic: return "automatic";
    case GridMethod::subdivide: return "subdivide";
    case GridMethod::grow: return "grow";
  }
  return "unknown";
}

std::string cells_text(Index num_cells, double cell, Index num_layers) {
  std::string text = fmt::format("{} of size {:.4g}", grouped(num_cells), cell);
  if (num_layers > 0) text += fmt::format(", an envelope with {} layer{}", num_layers, num_layers == 1 ? "" : "s");
  return text;
}

Json path_json(const Surface& surface, const PathResult& result, const PathOptions& options, double surface_seconds,
               double total_seconds) {
  Json json;
  json["command"] = "path";
  json["status"] = to_string(result.status);
  if (!result.message.empty()) json["message"] = result.message;
  json["surface"] = {{"kind", surface.kind()}, {"dim", surface.dim()}, {"codim", surface.codim()}};
  if (const std::optional<double> residual = fit_residual(surface)) json["fit_residual"] = number(*residual);
  json["from"] = vector_json(result.from);
  json["to"] = vector_json(result.to);
  json["length"] = has_path(result) ? number(result.length) : Json(nullptr);
  json["length_error"] = has_path(result) ? number(result.length_error) : Json(nullptr);
  json["converged"] = result.corrected ? Json(result.status == Status::ok) : Json(nullptr);
  json["locally_shortest"] = result.corrected ? Json(result.locally_shortest) : Json(nullptr);
  json["index"] = has_path(result) && result.index ? Json(*result.index) : Json(nullptr);
  const auto direction = [](const Vector& unit) { return unit.size() > 0 ? vector_json(unit) : Json(nullptr); };
  json["start_direction"] = direction(result.start_direction);
  json["end_direction"] = direction(result.end_direction);
  if (result.conjugate_at) json["conjugate_at"] = *result.conjugate_at;
  json["residual"] = {{"surface", number(result.residual.surface)},
                      {"geodesic_curvature", number(result.residual.geodesic_curvature)}};
  json["candidates"] = Json::array();
  for (const PathCandidate& candidate : result.candidates) {
    Json entry = {{"length", candidate.length},
                  {"length_error", number(candidate.length_error)},
                  {"locally_shortest", candidate.locally_shortest}};
    if (options.all) entry["points"] = points_json(candidate.points);
    json["candidates"].push_back(std::move(entry));
  }
  if (!result.pieces.empty()) json["pieces"] = pieces_json(result.pieces);
  json["unique"] = has_path(result) ? unique_json(result.unique, result.tied) : Json(nullptr);
  json["doubts"] = doubts_json(result.doubts);
  if (result.obstacle.kind != Obstacle::Kind::none) json["obstacle"] = obstacle_json(result.obstacle);
  json["method"] = to_string(options.method);
  json["march"] = result.num_cells > 0 ? Json(to_string(options.march)) : Json(nullptr);
  json["marched"] = number(result.marched);
  json["grid"] = result.grid == GridMethod::automatic ? Json(nullptr) : Json(to_string(result.grid));
  json["envelope"] = result.num_layers;
  json["cell"] = result.cell;
  json["cells"] = result.num_cells;
  json["iterations"] = result.num_iterations;
  json["rungs"] = Json::array();
  for (const RungReport& report : result.rungs) json["rungs"].push_back(rung_json(report));
  json["seconds"] = {{"surface", surface_seconds},
                     {"cells", result.seconds.cells},
                     {"march", result.seconds.march},
                     {"correct", result.seconds.correct},
                     {"total", total_seconds}};
  if (result.flow) json["flow"] = flow_json(*result.flow);
  json["points"] = points_json(result.points);
  json["grid_path"] = points_json(result.grid_path);
  return json;
}

void add_picture_seconds(double seconds, Json& json) {
  if (json.contains("seconds")) {
    Json& known = json["seconds"];
    if (known.is_object()) {
      known["pictures"] = seconds;
      if (known.contains("total")) known["total"] = known["total"].get<double>() + seconds;
    } else {
      known = known.get<double>() + seconds;  // of a command without stages
    }
  }
}

void add_picture_seconds(double seconds, Json& json, std::vector<SceneFact>& facts) {
  add_picture_seconds(seconds, json);
  facts.push_back({"pictures", duration(seconds)});
}

std::vector<SceneFact> path_facts(const Surface& surface, const PathResult& result, const PathOptions& options,
                                  double surface_seconds, double total_seconds) {
  std::vector<SceneFact> facts;
  if (has_path(result)) {
    facts.push_back({"length", length_text(result)});
    if (const std::optional<double> residual = fit_residual(surface)) {
      facts.push_back(
          {"fit", fmt::format("stands {:.1e} (rms) off its samples: digits beyond are the fit's alone", *residual)});
    }
  }
  std::string status(to_string(result.status));
  if (!result.corrected && result.status == Status::ok) status += ", the path on the grid, not corrected";
  if (result.status == Status::ok && result.corrected) {
    if (result.locally_shortest) {
      status += ", locally shortest";
    } else if (result.index.value_or(0) > 0) {
      status += fmt::format(", not locally shortest: index {}", *result.index);
    } else {
      status += ", not certified as locally shortest";
    }
  }
  if (!result.message.empty()) status += ": " + result.message;
  facts.push_back({"status", status});
  for (std::size_t i = 1; i < result.candidates.size(); ++i) {
    const bool as_short = i == 1 && result.tied;
    facts.push_back({i == 1 ? "also" : "", fmt::format("{:.15g}{}", result.candidates[i].length,
                                                       as_short ? ", as short: the shortest path is not unique" : "")});
  }
  if (has_path(result)) {
    facts.push_back({"residual", fmt::format("off the surface {:.1e}, geodesic curvature {:.1e}",
                                             result.residual.surface, result.residual.geodesic_curvature)});
  }
  if (has_path(result) && result.corrected) {
    facts.push_back({"method", fmt::format("{}, {} iteration{}", to_string(options.method), result.num_iterations,
                                           result.num_iterations == 1 ? "" : "s")});
  }
  if (result.flow) std::ranges::move(flow_facts(*result.flow), std::back_inserter(facts));
  if (has_path(result) && options.march != MarchMethod::convergent) {
    facts.push_back({"march", fmt::format("{}, {:.6g} long", to_string(options.march), result.marched)});
  }
  if (result.num_cells > 0) {
    facts.push_back({"cells", cells_text(result.num_cells, result.cell, result.num_layers)});
  }
  facts.push_back({"time", fmt::format("{} (surface {}, cells {}, march {}, correct {})", duration(total_seconds),
                                       duration(surface_seconds), duration(result.seconds.cells),
                                       duration(result.seconds.march), duration(result.seconds.correct))});
  return facts;
}

std::string facts_text(const std::vector<SceneFact>& facts) {
  std::size_t width = 0;
  for (const SceneFact& fact : facts) width = std::max(width, fact.name.size());
  std::string text;
  for (const SceneFact& fact : facts) text += fmt::format("{:<{}}  {}\n", fact.name, width, fact.value);
  return text;
}

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

void add_edges(const SurfaceEdges& found, Json& json) {
  json["faces"] = Json::array();
  for (const SurfaceFace& face : found.faces) {
    json["faces"].push_back({{"face", face.formula}, {"patches", face.patches}});
  }
  json["edges"] = Json::array();
  for (const SurfaceEdge& edge : found.edges) {
    json["edges"].push_back({{"kind", to_string(edge.kind)},
                             {"length", number(edge.length)},
                             {"angle", number(kDegrees * edge.angle)},
                             {"closed", edge.closed},
                             {"cut_by_box", edge.cut},
                             {"faces", edge.faces}});
  }
  json["corners"] = points_json(found.corners);
}

/// A total for each kind, and a line for each edge where they are few.
void add_edges(const SurfaceEdges& found, std::vector<SceneFact>& facts) {
  constexpr std::size_t kMostShown = 12;
  std::vector<std::string> formulas;
  int patches = 0;
  for (const SurfaceFace& face : found.faces) {
    patches += face.patches;
    if (formulas.size() == kMostShown) continue;
    if (face.formula.empty()) continue;  // the whole surface, with a border
    formulas.push_back(face.patches == 1 ? face.formula : fmt::format("{} ({} patches)", face.formula, face.patches));
  }
  if (found.faces.size() > kMostShown) formulas.emplace_back("...");
  facts.push_back({"faces", fmt::format("{}{}{}", patches, formulas.empty() ? "" : ": ", fmt::join(formulas, ", "))});
  for (const auto kind : {SurfaceEdge::Kind::sharp, SurfaceEdge::Kind::seam, SurfaceEdge::Kind::border}) {
    Index count = 0;
    double length = 0;
    bool cut = false;
    for (const SurfaceEdge& edge : found.edges) {
      if (edge.kind != kind) continue;
      ++count;
      length += edge.length;
      cut = cut || edge.cut;
    }
    if (count == 0) continue;
    const char* name = kind == SurfaceEdge::Kind::sharp  ? "edges"
                       : kind == SurfaceEdge::Kind::seam ? "seams"
                                                         : "borders";
    facts.push_back({name, fmt::format("{} of length {:.15g}{}", grouped(count), length,
                                       cut ? " within the box: they go on beyond" : "")});
    if (found.edges.size() > kMostShown) continue;
    for (const SurfaceEdge& edge : found.edges) {
      if (edge.kind != kind) continue;
      std::string text = fmt::format("{:.15g}{}", edge.length, edge.closed ? ", closed" : "");
      if (kind == SurfaceEdge::Kind::sharp) text += fmt::format(", {:.4g} degrees", kDegrees * edge.angle);
      if (!edge.faces.front().empty()) text += fmt::format(": {}", fmt::join(edge.faces, " | "));
      facts.push_back({"", text});
    }
  }
  facts.push_back({"corners", grouped(found.corners.cols())});
}

}  // namespace

nlohmann::ordered_json summary_json(const SurfaceSummary& summary) {
  Json json;
  json["command"] = "info";
  json["surface"] = {{"kind", summary.kind}, {"dim", summary.dim}, {"codim", summary.codim}};
  json["box"] = {{"lower", vector_json(summary.box.lower)}, {"upper", vector_json(summary.box.upper)}};
  json["cell"] = summary.cell;
  json["cells"] = summary.num_cells;
  json["cells_complete"] = summary.counts.complete;
  json["grid"] = summary.num_cells > 0 ? Json(to_string(summary.grid)) : Json(nullptr);
  json["crossing_tests"] = summary.counts.num_tests;
  if (summary.num_layers > 0)
    json["envelope"] = {{"layers", summary.num_layers}, {"cells", summary.num_envelope_cells}};
  json["components"] = summary.counts.complete ? Json(summary.components) : Json(nullptr);
  if (summary.shape) {
    json["area"] = number(summary.shape->area);
    json["euler"] = summary.shape->euler;
    json["closed"] = summary.shape->closed;
    json["cut_by_box"] = summary.shape->cut_by_box;
    json["shape_cell"] = summary.shape->cell;
    json["shape_settled"] = summary.shape->settled;
  }
  if (summary.edges) add_edges(*summary.edges, json);
  json["samples"] = summary.num_samples;
  if (summary.num_samples > 0) {
    json["sample_residual"] = {{"rms", number(summary.sample_rms)}, {"max", number(summary.sample_max)}};
  }
  return json;
}

namespace {

std::string shape_text(const SurfaceShape& shape) {
  return fmt::format("area {:.4g}, Euler number {}, {}{}", shape.area, shape.euler,
                     shape.closed       ? "closed"
                     : shape.cut_by_box ? "open where the box cuts it: the surface goes on beyond"
                                        : "open",
                     shape.settled ? "" : fmt::format(" (on cells of {:.4g}; finer ones may tell more)", shape.cell));
}

}  // namespace

std::vector<SceneFact> summary_facts(const SurfaceSummary& summary) {
  const auto corner = [](const Vector& x) { return fmt::format("({:.4g})", fmt::join(x, ", ")); };
  std::vector<SceneFact> facts;
  facts.push_back({"kind", summary.kind});
  facts.push_back({"space", fmt::format("{} dimensions, {} equation{}: a surface of dimension {}", summary.dim,
                                        summary.codim, summary.codim == 1 ? "" : "s", summary.dim - summary.codim)});
  if (summary.box.dim() == summary.dim) {
    facts.push_back({"box", corner(summary.box.lower) + " to " + corner(summary.box.upper)});
  }
  if (summary.num_cells > 0 && !summary.counts.complete) {
    facts.push_back({"cells", "at least " + cells_text(summary.num_cells, summary.cell, 0) +
                                  ", and no more were grown: take larger ones (--cell) to see all"});
  } else if (summary.num_cells > 0) {
    facts.push_back({"cells", cells_text(summary.num_cells, summary.cell, 0)});
    if (summary.num_layers > 0) {
      facts.push_back({"envelope", cells_text(summary.num_envelope_cells, summary.cell, summary.num_layers)});
    }
    std::string components = std::to_string(summary.components.size());
    if (summary.components.size() > 1) {
      constexpr std::size_t kShown = 6;
      const std::size_t shown = std::min(kShown, summary.components.size());
      components += fmt::format(
          ", of {} cells{}",
          fmt::join(summary.components.begin(), summary.components.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
          shown < summary.components.size() ? ", ..." : "");
    }
    facts.push_back({"components", components});
    if (summary.shape) facts.push_back({"shape", shape_text(*summary.shape)});
    if (summary.edges) add_edges(*summary.edges, facts);
  } else {
    facts.push_back(
        {"cells", "none: there would be too many in more than 6 dimensions (--grid grow grows some from --samples)"});
  }
  if (summary.num_samples > 0) {
    facts.push_back({"samples", grouped(summary.num_samples)});
    facts.push_back({"residual", fmt::format("samples lie {:.2e} (rms), {:.2e} (most) off the surface",
                                             summary.sample_rms, summary.sample_max)});
  }
  return facts;
}

std::string path_csv_header(const BatchColumns& columns) {
  return std::string("length,error,converged,locally_shortest,status") + (columns.unique ? ",unique" : "");
}

std::string path_csv(const PathResult& result, const std::string& problem, const BatchColumns& columns) {
  const std::string_view status = problem.empty() ? to_string(result.status) : kBadInputStatus;
  const bool answered = problem.empty() && has_path(result);
  std::string line = answered
                         ? fmt::format("{},{},{:d},{:d},{}", result.length, result.length_error,
                                       result.corrected && result.status == Status::ok, result.locally_shortest, status)
                         : fmt::format("nan,inf,0,0,{}", status);
  if (!columns.unique) return line;
  const bool known = answered && (result.unique || result.tied);
  return line + (known ? fmt::format(",{:d}", result.unique) : ",");
}

}  // namespace taut::app
