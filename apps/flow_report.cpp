// Appendix II of the paper, measured on one corrected curve: for programs and for people.

#include "flow_report.hpp"

#include <fmt/format.h>

namespace taut::app {

nlohmann::ordered_json flow_json(const FlowSummary& summary) {
  return {{"m", summary.num_intervals},
          {"length", summary.length},
          {"interval", {{"mean", summary.mean_interval}, {"longest", summary.longest_interval}}},
          {"cst", summary.cst},
          {"error_a1", summary.error_a1},
          {"error_sum", summary.error_sum},
          {"inserted", summary.num_inserted},
          {"inserted_in_plane", summary.num_plane_inserted},
          {"inserted_across_cells", summary.num_across_cells},
          {"iterations", summary.num_iterations},
          {"evaluated", summary.num_evaluated},
          {"seconds", summary.seconds},
          {"seconds_per_node", summary.seconds_per_node},
          {"seconds_a2", summary.seconds_a2}};
}

std::vector<SceneFact> flow_facts(const FlowSummary& summary) {
  return {{"intervals", fmt::format("{}, {:.4g} long on average, {:.4g} at most", summary.num_intervals,
                                    summary.mean_interval, summary.longest_interval)},
          {"inserted", fmt::format("{} by projection, {} in the plane of equation (5)", summary.num_inserted,
                                   summary.num_plane_inserted)},
          {"error", fmt::format("{:.2e} by (A1) with Cst {:.3g}, {:.2e} by the sum over its circles", summary.error_a1,
                                summary.cst, summary.error_sum)},
          {"cost",
           fmt::format("{} steps, {} nodes evaluated; K = {:.3g} s a node, {:.3g} s by (A2)", summary.num_iterations,
                       summary.num_evaluated, summary.seconds_per_node, summary.seconds_a2)}};
}

}  // namespace taut::app
