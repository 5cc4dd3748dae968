#pragma once

#include "taut/search/path_options.hpp"

namespace taut::detail {

/// Throws InvalidArgument when an option that every way of finding paths uses is out of range.
void check_options(const PathOptions& options);

/// The same for an envelope (PathOptions::envelope) to march in.
void check_envelope(Index layers, MarchMethod march);

/// Throws InvalidArgument where options for cells do not fit a surface in more dimensions than cells are made in.
void check_cells(const Surface& surface, const PathOptions& options);

}  // namespace taut::detail
