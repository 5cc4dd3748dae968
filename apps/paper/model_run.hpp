#pragma once

#include <vector>

#include "models.hpp"
#include "study.hpp"
#include "taut/query/path.hpp"

namespace taut::paper {

/// One method's answers for all pairs, source by source.
struct MethodRun {
  std::vector<PathResult> paths;
  double seconds = 0;  ///< of the processor, cells and marches included
};

/// One row of the paper's table: three sources, each to all destinations, on about as many cells as the paper had.
struct ModelRun {
  double cell = 0;
  Index num_cells = 0;
  double cells_seconds = 0;  ///< Algorithm II alone
  Points sources;            ///< 3 x 3
  Points destinations;       ///< 3 x n
  MethodRun flow;            ///< the paper's chain on these cells
  MethodRun newton;          ///< Newton's method from the convergent march on these cells
  MethodRun fine;            ///< Newton's method on cells that Taut chooses: what the others are compared with
};

inline constexpr Index kSources = 3;

/// Runs the three methods on a model. Made once a study.
[[nodiscard]] const ModelRun& model_run(Study& study, ModelKind kind, Index wanted_cells);

/// The cell size for which Algorithm II makes about that many cells of the model.
[[nodiscard]] double cell_for_count(const Model& model, Index wanted_cells, const Context& context);

}  // namespace taut::paper
