#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

#include "taut/core/context.hpp"
#include "taut/surface/neural_network.hpp"
#include "taut/surface/surface.hpp"

namespace taut::app {

/// --activation, --omega and --beta: what a file of weights does not say.
struct NetworkArguments {
  std::optional<Activation> activation;
  std::string omega;  // "30" or "30,1": of the first layer, of the others
  std::optional<double> beta;

  void add_to(CLI::App& command);
  /// The first of these options that was given; null when none was.
  [[nodiscard]] const char* given() const;
};

/// The level set of a network. Throws UsageError for options, what the readers throw, and IoError, which names the
/// file, for weights that make no surface.
[[nodiscard]] Surface load_network(const std::string& file, const NetworkArguments& arguments,
                                   std::optional<double> iso, const Context& context);

}  // namespace taut::app
