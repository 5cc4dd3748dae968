// taut path --via: a path through points in order.

#include "path_via.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report.hpp"

namespace taut::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

void add_legs(const ViaResult& path, Json& json) {
  json["via"] = Json::array();
  json["legs"] = Json::array();
  for (const PathResult& leg : path.legs) {
    if (&leg != path.legs.data()) json["via"].push_back(std::vector<double>(leg.from.begin(), leg.from.end()));
    const bool has_path = leg.points.cols() > 0;
    Json entry = {{"status", to_string(leg.status)},
                  {"length", has_path ? number(leg.length) : Json(nullptr)},
                  {"length_error", has_path ? number(leg.length_error) : Json(nullptr)},
                  {"converged", leg.corrected ? Json(leg.status == Status::ok) : Json(nullptr)},
                  {"locally_shortest", leg.corrected ? Json(leg.locally_shortest) : Json(nullptr)},
                  {"unique", unique_json(leg.unique, leg.tied)}};
    if (!leg.message.empty()) entry["message"] = leg.message;
    json["legs"].push_back(std::move(entry));
  }
}

void add_legs(const ViaResult& path, std::vector<SceneFact>& facts) {
  for (std::size_t i = 0; i < path.legs.size(); ++i) {
    const PathResult& leg = path.legs[i];
    std::string text = leg.points.cols() > 0 ? fmt::format("{:.15g} +- {:.1e}", leg.length, leg.length_error) : "none";
    if (leg.status != Status::ok) text += fmt::format(", {}", to_string(leg.status));
    if (leg.tied) text += ", not the only one as short";
    facts.push_back({fmt::format("leg {}", i + 1), text});
  }
}

}  // namespace taut::app
