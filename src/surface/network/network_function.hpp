#pragma once

#include <vector>

#include "taut/surface/implicit_function.hpp"
#include "taut/surface/neural_network.hpp"

namespace taut::detail {

/// One layer as the kernels take it.
struct PackedLayer {
  std::size_t in = 0;
  std::size_t out = 0;        // as many as the layer has
  std::size_t padded_in = 0;  // up to a multiple of kNetworkRows
  std::size_t padded_out = 0;
  std::vector<double> weights;     // padded_out x in, row by row
  std::vector<double> transposed;  // padded_in x out, row by row
  std::vector<double> bias;        // padded_out
};

/// A network less its level, R^d -> R^k.
class NetworkFunction : public ImplicitFunction {
 public:
  NetworkFunction(const NeuralNetwork& network, double iso);
  [[nodiscard]] Index dim() const override { return static_cast<Index>(layers_.front().in); }
  [[nodiscard]] Index codim() const override { return static_cast<Index>(layers_.back().out); }
  [[nodiscard]] std::unique_ptr<Evaluator> make_evaluator() const override;
  [[nodiscard]] std::string_view kind() const override { return "network"; }

  [[nodiscard]] const std::vector<PackedLayer>& layers() const { return layers_; }
  [[nodiscard]] Activation activation() const { return activation_; }
  [[nodiscard]] double steepness() const { return steepness_; }
  [[nodiscard]] double iso() const { return iso_; }

 private:
  std::vector<PackedLayer> layers_;
  Activation activation_;
  double steepness_;
  double iso_;
};

}  // namespace taut::detail
