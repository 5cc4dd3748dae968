#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "taut/query/path.hpp"
#include "taut/query/surface_summary.hpp"
#include "taut/view/scene.hpp"

namespace taut::app {

/// The JSON of one path, as the contract in docs/json.md spells it.
[[nodiscard]] nlohmann::ordered_json path_json(const Surface& surface, const PathResult& result,
                                               const PathOptions& options, double surface_seconds,
                                               double total_seconds);

/// What a path on a surface with edges or a border is made of.
[[nodiscard]] nlohmann::ordered_json pieces_json(const std::vector<PathPiece>& pieces);

/// true, false where another is known to be as good, null where neither is known.
[[nodiscard]] nlohmann::ordered_json unique_json(bool unique, bool tied);

/// [[x, y, ...], ...], a point a list.
[[nodiscard]] nlohmann::ordered_json points_json(const PointsIn& points);

/// The same for a person: a few lines, each a name and a value.
[[nodiscard]] std::vector<SceneFact> path_facts(const Surface& surface, const PathResult& result,
                                                const PathOptions& options, double surface_seconds,
                                                double total_seconds);

/// Adds what pictures took to the seconds of a path's JSON.
void add_picture_seconds(double seconds, nlohmann::ordered_json& json);
/// ... and to its facts.
void add_picture_seconds(double seconds, nlohmann::ordered_json& json, std::vector<SceneFact>& facts);

/// The facts as aligned lines.
[[nodiscard]] std::string facts_text(const std::vector<SceneFact>& facts);

[[nodiscard]] nlohmann::ordered_json summary_json(const SurfaceSummary& summary);
[[nodiscard]] std::vector<SceneFact> summary_facts(const SurfaceSummary& summary);

/// 12345 -> "12,345"
[[nodiscard]] std::string grouped(Index n);

/// What the lines of a batch hold.
struct BatchColumns {
  bool unique = false;  ///< one more: 1, 0, or nothing where no other way was looked for
};

/// "length,error,converged,locally_shortest,status", with ",unique" if asked for: the columns' names.
[[nodiscard]] std::string path_csv_header(const BatchColumns& columns);

/// The line of one path, without a newline. A line of the input that has a `problem` gets the status bad_input.
[[nodiscard]] std::string path_csv(const PathResult& result, const std::string& problem, const BatchColumns& columns);

/// "12,345 of size 0.1", and the layers of an envelope, if any.
[[nodiscard]] std::string cells_text(Index num_cells, double cell, Index num_layers);

[[nodiscard]] const char* to_string(CorrectionMethod method);
[[nodiscard]] const char* to_string(MarchMethod method);
[[nodiscard]] const char* to_string(GridMethod method);

}  // namespace taut::app
