#pragma once

#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// What stands between the layers of a network. Geodesics need F to be C^2: there is no rectifier among them.
enum class Activation {
  sine,      ///< sin(w t)
  softplus,  ///< log(1 + exp(b t)) / b
  tanh,      ///< tanh(t)
};

struct DenseLayer {
  Eigen::MatrixXd weights;  ///< out x in
  Vector bias;              ///< out
};

/// A multilayer perceptron: x -> W x + b, then the activation, ..., the last layer without one.
struct NeuralNetwork {
  std::vector<DenseLayer> layers;
  Activation activation = Activation::sine;
  double frequency = 30;        ///< w of `sine`
  double first_frequency = 30;  ///< the same of the first layer
  double sharpness = 1;         ///< b of `softplus`
};

struct NetworkOptions {
  /// The surface is where the network's output (each of them) is this.
  double iso = 0;
  /// Where it was trained, and so where to look for the surface. Unset = [-1, 1] in each direction, as is usual.
  std::optional<Box> box = std::nullopt;
};

/// The level set of a network: a neural signed distance or occupancy. Weights are taken as doubles; the frequency of a
/// sine is multiplied into them. Derivatives are exact: the gradient by one pass back, the Hessian as
/// sum over neurons of (dF/da) s''(z) grad z grad z^T, with grad z from a pass forward. There are no bounds over boxes
/// (those of many layers say nothing): cells are tested by value and derivatives.
/// Throws InvalidArgument for no layers, layers that do not fit together, fewer inputs than 2, as many outputs as
/// inputs, and numbers that are not finite.
[[nodiscard]] Surface network_surface(const NeuralNetwork& network, const NetworkOptions& options = {});

}  // namespace taut
