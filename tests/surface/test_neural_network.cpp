#include "taut/surface/neural_network.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/clouds.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"
#include "taut/surface/formula.hpp"

namespace taut {
namespace {

NeuralNetwork random_network(const std::vector<Index>& widths, Activation activation) {
  test::Uniform uniform(7);
  NeuralNetwork network;
  network.activation = activation;
  network.frequency = 1.5;
  network.first_frequency = 2;
  network.sharpness = 3;
  for (std::size_t l = 0; l + 1 < widths.size(); ++l) {
    DenseLayer layer{Eigen::MatrixXd(widths[l + 1], widths[l]), Vector(widths[l + 1])};
    for (double& w : layer.weights.reshaped()) w = uniform.normal() / std::sqrt(static_cast<double>(widths[l]));
    for (double& b : layer.bias) b = 0.3 * uniform.normal();
    network.layers.push_back(layer);
  }
  return network;
}

/// The network written out as a formula.
std::string formula_of(const NeuralNetwork& network) {
  std::vector<std::string> values;
  for (Index a = 0; a < network.layers.front().weights.cols(); ++a) values.push_back(fmt::format("x{}", a + 1));
  for (std::size_t l = 0; l < network.layers.size(); ++l) {
    const DenseLayer& layer = network.layers[l];
    const bool last = l + 1 == network.layers.size();
    std::vector<std::string> next;
    for (Index row = 0; row < layer.weights.rows(); ++row) {
      std::string z = fmt::format("({:.17g})", layer.bias(row));
      for (Index k = 0; k < layer.weights.cols(); ++k) {
        z += fmt::format("+({:.17g})*{}", layer.weights(row, k), values[static_cast<std::size_t>(k)]);
      }
      const double frequency = l == 0 ? network.first_frequency : network.frequency;
      if (last) {
        next.push_back(z);
      } else if (network.activation == Activation::sine) {
        next.push_back(fmt::format("sin({:.17g}*({}))", frequency, z));
      } else if (network.activation == Activation::tanh) {
        next.push_back(fmt::format("tanh({})", z));
      } else {
        next.push_back(fmt::format("(log(1+exp({:.17g}*({})))/{:.17g})", network.sharpness, z, network.sharpness));
      }
    }
    values = next;
  }
  std::string text;
  for (const std::string& value : values) text += (text.empty() ? "" : ";") + value;
  return text;
}

TEST(NeuralNetwork, IsTheFormulaItStandsFor) {
  for (const Activation activation : {Activation::sine, Activation::softplus, Activation::tanh}) {
    for (const std::vector<Index>& widths : {std::vector<Index>{3, 5, 4, 1}, {4, 6, 3, 2}, {2, 3, 1}}) {
      const NeuralNetwork network = random_network(widths, activation);
      const Surface surface = network_surface(network);
      const Surface formula = parse_surface(formula_of(network), {.dim = widths.front()});
      ASSERT_EQ(surface.codim(), formula.codim());
      const Points x = Points::Random(widths.front(), 11);
      EXPECT_LT((surface.value(x) - formula.value(x)).cwiseAbs().maxCoeff(), 1e-13);
      EXPECT_LT((surface.jacobian(x) - formula.jacobian(x)).cwiseAbs().maxCoeff(), 1e-12);
      const Vector weight = Vector::LinSpaced(surface.codim(), 0.7, 1.9);
      EXPECT_LT((surface.hessian(x.col(3), weight) - formula.hessian(x.col(3), weight)).cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

TEST(NeuralNetwork, KeepsTheRulesOfEvaluators) {
  for (const Activation activation : {Activation::sine, Activation::softplus, Activation::tanh}) {
    const Surface surface = network_surface(random_network({3, 17, 9, 1}, activation));
    const ConformanceReport report = check_conformance(surface.function(), *surface.box());
    EXPECT_TRUE(report.ok()) << report.text();
  }
}

/// cos x + cos y + cos z is a network of three sines.
TEST(NeuralNetwork, HoldsASurfaceExactly) {
  NeuralNetwork network{.layers = {{Eigen::Matrix3d::Identity(), Vector::Constant(3, std::numbers::pi / 2)},
                                   {Eigen::MatrixXd::Ones(1, 3), Vector::Zero(1)}},
                        .frequency = 1,
                        .first_frequency = 1};
  const Surface surface = network_surface(network, {.iso = 0.25});
  const Surface formula = parse_surface("cos(x)+cos(y)+cos(z)=0.25");
  const Points x = 3 * Points::Random(3, 20);
  EXPECT_LT((surface.value(x) - formula.value(x)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(NeuralNetwork, RefusesWhatIsNoPerceptron) {
  NeuralNetwork network = random_network({3, 4, 1}, Activation::tanh);
  network.layers[1].weights.resize(1, 5);
  EXPECT_THROW((void)network_surface(network), InvalidArgument);
  network = random_network({3, 4, 1}, Activation::tanh);
  network.layers[0].bias(2) = std::nan("");
  EXPECT_THROW((void)network_surface(network), InvalidArgument);
  EXPECT_THROW((void)network_surface(random_network({3, 4, 3}, Activation::tanh)), InvalidArgument);
  EXPECT_THROW((void)network_surface({}), InvalidArgument);
}

}  // namespace
}  // namespace taut
