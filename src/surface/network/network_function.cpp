#include "surface/network/network_function.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "surface/describe.hpp"
#include "surface/network/network_kernel.hpp"
#include "taut/core/error.hpp"

// With z_l = W_l a_{l-1} + b_l, a_0 = x, a_l = s(z_l) and F = z_L - iso:
//   forward    a_l, s'(z_l), s''(z_l)
//   back       g_L = the weights of the components; g_{l-1} = W_l^T (g_l s'(z_l)), without s' for the last layer; then
//              g_l = dF/da_l and g_0 = grad F
//   tangents   T_l = dz_l/dx = W_l (s'(z_{l-1}) T_{l-1}), T_1 = W_1
//   Hessian    sum_l sum over neurons i of g_l,i s''(z_l,i) T_l,i T_l,i^T:
// z_1 is linear in x, and every later second derivative comes from one s'' with what depends on it in front. That is
// d + 2 products with each matrix for all second derivatives, against (d + 1)(d + 2) / 2 by Taylor series.
// Eight points are evaluated at once, one a lane of the kernels; a batch's last ones are filled up with copies.

namespace taut::detail {
namespace {

constexpr std::size_t kLanes = kNetworkLanes;

std::size_t padded(std::size_t rows) { return (rows + kNetworkRows - 1) / kNetworkRows * kNetworkRows; }

class NetworkEvaluator : public Evaluator {
 public:
  explicit NetworkEvaluator(const NetworkFunction& function)
      : Evaluator(function.dim(), function.codim()), function_(function), states_(function.layers().size()) {
    std::size_t widest = static_cast<std::size_t>(dim_);
    for (std::size_t l = 0; l < states_.size(); ++l) {
      const PackedLayer& layer = function.layers()[l];
      const std::size_t size = layer.padded_out * kLanes;
      for (auto* part : {&states_[l].z, &states_[l].value, &states_[l].slope, &states_[l].curvature})
        part->resize(size);
      widest = std::max({widest, layer.padded_out, layer.padded_in});
    }
    input_.resize(static_cast<std::size_t>(dim_) * kLanes);
    back_.resize(widest * kLanes);
    next_back_.resize(widest * kLanes);
    tangents_.resize(widest * kLanes * static_cast<std::size_t>(dim_));
    next_tangents_.resize(tangents_.size());
  }

  void evaluate(const PointBatch& batch) override {
    for (Index first = 0; first < batch.n; first += static_cast<Index>(kLanes)) {
      const Index count = std::min(batch.n - first, static_cast<Index>(kLanes));
      load(batch, first, count);
      forward();
      if (batch.value != nullptr) store_values(batch, first, count);
      if (batch.jacobian != nullptr) store_jacobian(batch, first, count);
      if (batch.hessian != nullptr) store_hessian(batch, first, count);
    }
  }

 private:
  struct State {
    std::vector<double> z;  // out x lanes, as all of these
    std::vector<double> value;
    std::vector<double> slope;
    std::vector<double> curvature;
  };

  void load(const PointBatch& batch, Index first, Index count) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double* const x = batch.x + dim_ * (first + std::min(static_cast<Index>(lane), count - 1));
      for (Index a = 0; a < dim_; ++a) input_[static_cast<std::size_t>(a) * kLanes + lane] = x[a];
    }
  }

  void forward() {
    const double* in = input_.data();
    for (std::size_t l = 0; l < states_.size(); ++l) {
      const PackedLayer& layer = function_.layers()[l];
      State& state = states_[l];
      multiply_network(layer.weights.data(), layer.padded_out, layer.in, in, state.z.data(), kLanes);
      for (std::size_t row = 0; row < layer.out; ++row) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) state.z[row * kLanes + lane] += layer.bias[row];
      }
      if (l + 1 == states_.size()) return;
      activate_network(function_.activation(), function_.steepness(), state.z.data(), layer.padded_out * kLanes,
                       state.value.data(), state.slope.data(), state.curvature.data());
      in = state.value.data();
    }
  }

  /// From what stands in `back_` for the outputs to dF/dx there. `visit(l, g)` gets dF/da_l on the way.
  template <class Visit>
  void backward(const Visit& visit) {
    for (std::size_t l = states_.size(); l-- > 0;) {
      const PackedLayer& layer = function_.layers()[l];
      multiply_network(layer.transposed.data(), layer.padded_in, layer.out, back_.data(), next_back_.data(), kLanes);
      std::swap(back_, next_back_);
      if (l == 0) return;
      visit(l - 1, back_);
      const std::vector<double>& slope = states_[l - 1].slope;
      for (std::size_t i = 0; i < layer.in * kLanes; ++i) back_[i] *= slope[i];
    }
  }

  void store_values(const PointBatch& batch, Index first, Index count) {
    for (Index lane = 0; lane < count; ++lane) {
      for (Index i = 0; i < codim_; ++i) {
        batch.value[codim_ * (first + lane) + i] =
            states_.back().z[static_cast<std::size_t>(i) * kLanes + static_cast<std::size_t>(lane)] - function_.iso();
      }
    }
  }

  void store_jacobian(const PointBatch& batch, Index first, Index count) {
    for (Index i = 0; i < codim_; ++i) {
      std::fill(back_.begin(), back_.end(), 0.0);
      std::fill_n(back_.begin() + i * static_cast<Index>(kLanes), kLanes, 1.0);
      backward([](std::size_t, const std::vector<double>&) {});
      for (Index lane = 0; lane < count; ++lane) {
        double* const gradient = batch.jacobian + dim_ * (codim_ * (first + lane) + i);
        for (Index a = 0; a < dim_; ++a) {
          gradient[a] = back_[static_cast<std::size_t>(a) * kLanes + static_cast<std::size_t>(lane)];
        }
      }
    }
  }

  void store_hessian(const PointBatch& batch, Index first, Index count) {
    std::fill(back_.begin(), back_.end(), 0.0);
    for (Index i = 0; i < codim_; ++i) {
      for (Index lane = 0; lane < count; ++lane) {
        back_[static_cast<std::size_t>(i) * kLanes + static_cast<std::size_t>(lane)] =
            batch.weight[codim_ * (first + lane) + i];
      }
    }
    // s'' is not needed without g: their product takes its place.
    backward([&](std::size_t l, const std::vector<double>& g) {
      std::vector<double>& curvature = states_[l].curvature;
      const std::size_t size = function_.layers()[l].out * kLanes;
      for (std::size_t i = 0; i < size; ++i) curvature[i] *= g[i];
    });
    const auto d = static_cast<std::size_t>(dim_);
    const std::size_t columns = d * kLanes;
    const std::size_t pairs = d * (d + 1) / 2;
    sums_.assign(pairs * kLanes, 0.0);
    // The first layer's in front: the unit vectors.
    std::fill(tangents_.begin(), tangents_.end(), 0.0);
    for (std::size_t a = 0; a < d; ++a)
      std::fill_n(tangents_.begin() + static_cast<Index>(a * columns + a * kLanes), kLanes, 1.0);
    for (std::size_t l = 0; l + 1 < states_.size(); ++l) {
      const PackedLayer& layer = function_.layers()[l];
      multiply_network(layer.weights.data(), layer.padded_out, layer.in, tangents_.data(), next_tangents_.data(),
                       columns);
      std::swap(tangents_, next_tangents_);
      const State& state = states_[l];
      for (std::size_t row = 0; row < layer.out; ++row) {
        double* const t = tangents_.data() + row * columns;
        const double* const bend = state.curvature.data() + row * kLanes;
        const double* const slope = state.slope.data() + row * kLanes;
        double* sum = sums_.data();
        for (std::size_t a = 0; a < d; ++a) {
          for (std::size_t b = 0; b <= a; ++b, sum += kLanes) {
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
              sum[lane] += bend[lane] * (t[a * kLanes + lane] * t[b * kLanes + lane]);
            }
          }
        }
        for (std::size_t a = 0; a < d; ++a) {
          for (std::size_t lane = 0; lane < kLanes; ++lane) t[a * kLanes + lane] *= slope[lane];
        }
      }
    }
    for (Index lane = 0; lane < count; ++lane) {
      double* const hessian = batch.hessian + dim_ * dim_ * (first + lane);
      const double* sum = sums_.data() + lane;
      for (Index a = 0; a < dim_; ++a) {
        for (Index b = 0; b <= a; ++b, sum += kLanes) hessian[a * dim_ + b] = hessian[b * dim_ + a] = *sum;
      }
    }
  }

  const NetworkFunction& function_;
  std::vector<State> states_;
  std::vector<double> input_;
  std::vector<double> back_;
  std::vector<double> next_back_;
  std::vector<double> tangents_;  // out x (d lanes)
  std::vector<double> next_tangents_;
  std::vector<double> sums_;
};

PackedLayer pack(const DenseLayer& layer, double factor) {
  PackedLayer packed;
  packed.in = static_cast<std::size_t>(layer.weights.cols());
  packed.out = static_cast<std::size_t>(layer.weights.rows());
  packed.padded_in = padded(packed.in);
  packed.padded_out = padded(packed.out);
  packed.weights.assign(packed.padded_out * packed.in, 0.0);
  packed.transposed.assign(packed.padded_in * packed.out, 0.0);
  packed.bias.assign(packed.padded_out, 0.0);
  for (std::size_t r = 0; r < packed.out; ++r) {
    for (std::size_t c = 0; c < packed.in; ++c) {
      const double w = factor * layer.weights(static_cast<Index>(r), static_cast<Index>(c));
      packed.weights[r * packed.in + c] = w;
      packed.transposed[c * packed.out + r] = w;
    }
    packed.bias[r] = factor * layer.bias(static_cast<Index>(r));
  }
  return packed;
}

void require_layers(const NeuralNetwork& network) {
  if (network.layers.empty()) throw InvalidArgument("the network has no layers");
  Index width = network.layers.front().weights.cols();
  for (std::size_t l = 0; l < network.layers.size(); ++l) {
    const DenseLayer& layer = network.layers[l];
    const std::string name = "layer " + std::to_string(l) + " of the network";
    if (layer.weights.cols() != width) {
      throw InvalidArgument(name + " takes " + std::to_string(layer.weights.cols()) + " numbers, but gets " +
                            std::to_string(width));
    }
    if (layer.bias.size() != layer.weights.rows() || layer.weights.rows() == 0) {
      throw InvalidArgument(name + " has " + std::to_string(layer.weights.rows()) + " outputs and " +
                            std::to_string(layer.bias.size()) + " biases");
    }
    if (!layer.weights.allFinite() || !layer.bias.allFinite())
      throw InvalidArgument(name + " has weights that are not finite");
    width = layer.weights.rows();
  }
  for (const double factor : {network.frequency, network.first_frequency, network.sharpness}) {
    if (!(factor > 0) || !std::isfinite(factor)) {
      throw InvalidArgument("a frequency or sharpness of an activation must be above 0, not " + describe(factor));
    }
  }
}

}  // namespace

NetworkFunction::NetworkFunction(const NeuralNetwork& network, double iso)
    : activation_(network.activation), steepness_(network.sharpness), iso_(iso) {
  require_layers(network);
  for (std::size_t l = 0; l < network.layers.size(); ++l) {
    const bool is_sine = activation_ == Activation::sine && l + 1 < network.layers.size();
    const double factor = !is_sine ? 1 : l == 0 ? network.first_frequency : network.frequency;
    layers_.push_back(pack(network.layers[l], factor));
  }
}

std::unique_ptr<Evaluator> NetworkFunction::make_evaluator() const { return std::make_unique<NetworkEvaluator>(*this); }

}  // namespace taut::detail

namespace taut {

Surface network_surface(const NeuralNetwork& network, const NetworkOptions& options) {
  if (!std::isfinite(options.iso)) throw InvalidArgument("iso must be a finite number");
  auto function = std::make_shared<const detail::NetworkFunction>(network, options.iso);
  SurfaceExtras extras;
  const Index d = function->dim();
  extras.box = options.box.value_or(Box{Vector::Constant(d, -1), Vector::Constant(d, 1)});
  return Surface(std::move(function), std::move(extras));
}

}  // namespace taut
