#pragma once

#include <string>
#include <vector>

#include "deliver_path.hpp"
#include "exit_code.hpp"
#include "report.hpp"
#include "taut/core/context.hpp"
#include "taut/query/path.hpp"
#include "timer.hpp"

namespace taut::app {

/// From one source, or several, to every destination of a file.
struct SourcesRequest {
  std::vector<std::string> from;  ///< sources, as typed
  std::string to_file;            ///< destinations, one a line
  PathOptions options;
  std::string surface;  ///< as typed, for the title
  PathShow show;
  BatchColumns columns;
  bool header = false;      ///< the columns' names first
  Index samples_along = 0;  ///< points a path at equal arc lengths; 0 = its own
  double surface_seconds = 0;
};

/// Answers `length,error,converged,locally_shortest,status` a line, or with --json an array of paths: all destinations
/// of the first source in the order of the file, then those of the second, and so on.
[[nodiscard]] ExitCode answer_sources(const SourcesRequest& request, const DeliveryArguments& delivery,
                                      const Surface& surface, const Context& context, const Timer& timer);

}  // namespace taut::app
