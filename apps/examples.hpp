#pragma once

#include <string>

namespace taut::app {

/// What stands below the help of a command: how it is mostly used.
[[nodiscard]] std::string examples_of(const std::string& command);

}  // namespace taut::app
