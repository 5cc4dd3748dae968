#pragma once

#include <optional>
#include <string>

#include "exit_code.hpp"
#include "report.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"

namespace taut::app {

struct PairsRequest {
  std::string file;                ///< lines p1,...,pd,q1,...,qd
  std::optional<std::string> out;  ///< .csv; stdout if there is none
  std::string surface;             ///< all that says which surface it is, on one line
  PathOptions options;
  BatchColumns columns;
  bool header = false;  ///< a first line with the columns' names
};

/// Answers line k of the file in line k of the output, `length,error,converged,locally_shortest,status`, on all cores;
/// a line that cannot be answered carries its status, and its reason goes to stderr. Holds a few thousand pairs at a
/// time. With an output file, goes on where an earlier run of the same request was stopped.
[[nodiscard]] ExitCode answer_pairs(const PairsRequest& request, const Surface& surface, const Context& context);

}  // namespace taut::app
