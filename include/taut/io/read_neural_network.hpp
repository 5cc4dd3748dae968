#pragma once

#include <filesystem>
#include <optional>

#include "taut/core/context.hpp"
#include "taut/surface/neural_network.hpp"

namespace taut {

/// Does the extension name a file of weights: `.npz` or `.safetensors`?
[[nodiscard]] bool is_network_file(const std::filesystem::path& path);

/// What a file of weights may leave open, or say otherwise.
struct NetworkFileOptions {
  std::optional<Activation> activation = std::nullopt;
  std::optional<double> frequency = std::nullopt;
  std::optional<double> first_frequency = std::nullopt;  ///< unset = as `frequency`
  std::optional<double> sharpness = std::nullopt;
};

/// Reads a multilayer perceptron from a NumPy archive (`.npz`, packed or not) or a `.safetensors` file. The layers are
/// the arrays of two dimensions, in the order of the numbers in their names ("net.10.weight" after "net.9.weight",
/// "W1" after "W0"), out x in as PyTorch has them, or all of them in x out; each has the array of one dimension that is
/// called "bias" for "weight" or "kernel", "b1" for "W1" (none: zero). Numbers of 16, 32 and 64 bits. What else is
/// needed stands in arrays "activation" (text: sine, softplus, tanh), "omega", "omega_first" and "beta" (of an `.npz`),
/// in the metadata of those names (of a `.safetensors`), or in `options`, which come first. A sine without omega has
/// 30, a softplus without beta 1.
/// Throws IoError, naming the file, for what cannot be read, arrays that make no perceptron (skip connections, normal-
/// isation), an activation that is not said, and one that is not C^2, such as relu.
[[nodiscard]] NeuralNetwork read_neural_network(const std::filesystem::path& path,
                                                const NetworkFileOptions& options = {}, const Context& context = {});

}  // namespace taut
