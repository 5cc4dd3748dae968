#include "taut/io/read_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "io/read_text.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using test::from_hex;
using ::testing::HasSubstr;

NeuralNetwork read_as(std::string_view name, std::string_view bytes, const NetworkFileOptions& options = {}) {
  const test::TempFolder folder;
  return read_neural_network(folder.write(name, bytes), options);
}

std::string error_of(std::string_view name, std::string_view bytes, const NetworkFileOptions& options = {}) {
  try {
    (void)read_as(name, bytes, options);
  } catch (const IoError& error) {
    return error.what();
  }
  return {};
}

/// numpy.savez_compressed: W0 2 x 3 (float32), b0, W1 1 x 2, b1, activation = "tanh".
constexpr std::string_view kArchive =
    "504b0304140000000800000021002d8e1ce858000000980000000600140057302e6e707901001000980000000000000058000000"
    "000000009bec17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9366a2aea3a09e965f54529498179f5f94920a12774bcc294e05"
    "8a17672416a402f91a463a0ac69a3a0ab50a64032e0686067b060606072002e206205e00c4171c00504b03041400000008000000"
    "2100bcd4baa14d000000900000000600140062302e6e70790100100090000000000000004d000000000000009bec17ea1b10c9c8"
    "50c650ad9e925a9c5ca46ea5a06e9366a1aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402f91a463a9a"
    "3a0ab50a14002e063078600fa13fec0700504b0304140000000800000021001492e99a4d000000900000000600140057312e6e70"
    "790100100090000000000000004d000000000000009bec17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9366a1aea3a09e965f"
    "54529498179f5f94920a12774bcc294e058a17672416a402f91a863a0a469a3a0ab50a64032e06087080501c0700504b03041400"
    "000008000000210019f35f4249000000880000000600140062312e6e707901001000880000000000000049000000000000009bec"
    "17ea1b10c9c850c650ad9e925a9c5ca46ea5a06e9366a1aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a4"
    "02f91a863a9a3a0ab50a14002e0630b8600f00504b03041400000008000000210079bc4e8e4e000000900000000e001400616374"
    "69766174696f6e2e6e70790100100090000000000000004e000000000000009bec17ea1b10c9c850c650ad9e925a9c5ca46ea5a0"
    "6e136aa2aea3a09e965f54529498179f5f94920a12774bcc294e058a17672416a402f91a9a3a0ab50a1401ae120606864420ce03"
    "e20c200600504b01021403140000000800000021002d8e1ce8580000009800000006000000000000000000000080010000000057"
    "302e6e7079504b0102140314000000080000002100bcd4baa14d0000009000000006000000000000000000000080019000000062"
    "302e6e7079504b01021403140000000800000021001492e99a4d0000009000000006000000000000000000000080011501000057"
    "312e6e7079504b010214031400000008000000210019f35f42490000008800000006000000000000000000000080019a01000062"
    "312e6e7079504b010214031400000008000000210079bc4e8e4e000000900000000e000000000000000000000080011b02000061"
    "637469766174696f6e2e6e7079504b050600000000050005000c010000a90200000000";

struct Tensor {
  std::string name;
  std::string shape;
  std::vector<float> values;
};

std::string safetensors(const std::vector<Tensor>& tensors, const std::string& metadata) {
  std::string header = "{" + (metadata.empty() ? "" : "\"__metadata__\":" + metadata);
  std::string data;
  for (const Tensor& tensor : tensors) {
    const std::size_t begin = data.size();
    for (const float value : tensor.values) data += test::raw(value);
    header += (header.size() > 1 ? ", " : "") + ("\"" + tensor.name) + R"(": {"dtype":"F32","shape":)" + tensor.shape +
              R"(,"data_offsets":[)" + std::to_string(begin) + "," + std::to_string(data.size()) + "]}";
  }
  header += "}";
  return test::raw(static_cast<std::uint64_t>(header.size())) + header + data;
}

std::vector<Tensor> perceptron() {
  return {{"net.10.weight", "[1,2]", {2, -3}},
          {"net.10.bias", "[1]", {0.25F}},
          {"net.9.weight", "[2,3]", {1, 2, 3, 4, 5, 6.5F}},
          {"net.9.bias", "[2]", {0.5F, -1}}};
}

void expect_perceptron(const NeuralNetwork& network) {
  ASSERT_EQ(network.layers.size(), 2U);
  EXPECT_EQ(network.layers[0].weights, (Eigen::Matrix<double, 2, 3>() << 1, 2, 3, 4, 5, 6.5).finished());
  EXPECT_EQ(network.layers[0].bias, Eigen::Vector2d(0.5, -1));
  EXPECT_EQ(network.layers[1].weights, Eigen::RowVector2d(2, -3));
  EXPECT_EQ(network.layers[1].bias(0), 0.25);
}

TEST(ReadNeuralNetwork, Archives) {
  const std::string bytes = from_hex(kArchive);
  const NeuralNetwork network = read_as("a.npz", bytes);
  expect_perceptron(network);
  EXPECT_EQ(network.activation, Activation::tanh);
  EXPECT_EQ(read_as("a.npz", bytes, {.activation = Activation::sine}).activation, Activation::sine);
  for (std::size_t cut = 0; cut < bytes.size(); cut += 41) {
    EXPECT_NE(error_of("a.npz", bytes.substr(0, cut)), "") << cut;
  }
}

TEST(ReadNeuralNetwork, Tensors) {
  const NeuralNetwork network =
      read_as("a.safetensors", safetensors(perceptron(), R"({"activation":"sine","omega":"20","omega_first":"15"})"));
  expect_perceptron(network);
  EXPECT_EQ(network.activation, Activation::sine);
  EXPECT_EQ(network.frequency, 20);
  EXPECT_EQ(network.first_frequency, 15);
  // All matrices in x out.
  std::vector<Tensor> turned = perceptron();
  turned[0].shape = "[2,1]";
  turned[2].shape = "[3,2]";
  turned[2].values = {1, 4, 2, 5, 3, 6.5F};
  expect_perceptron(read_as("a.safetensors", safetensors(turned, ""), {.activation = Activation::softplus}));
}

TEST(ReadNeuralNetwork, MistakesAreNamed) {
  const auto error = [](const std::vector<Tensor>& tensors, const std::string& metadata) {
    return error_of("a.safetensors", safetensors(tensors, metadata));
  };
  EXPECT_THAT(error(perceptron(), ""), HasSubstr("--activation"));
  EXPECT_THAT(error(perceptron(), R"({"activation":"relu"})"), HasSubstr("C^2"));
  EXPECT_THAT(error(perceptron(), R"({"activation":"gelu2"})"), HasSubstr("gelu2"));
  EXPECT_THAT(error(perceptron(), R"({"activation":"tanh","omega":"much"})"), HasSubstr("no number"));
  std::vector<Tensor> skipping = perceptron();
  skipping[0].shape = "[1,5]";
  skipping[0].values = {1, 2, 3, 4, 5};
  EXPECT_THAT(error(skipping, R"({"activation":"tanh"})"), HasSubstr("skip connections"));
  const std::string whole = safetensors(perceptron(), R"({"activation":"tanh"})");
  for (std::size_t cut = 0; cut < whole.size(); cut += 7) {
    EXPECT_NE(error_of("a.safetensors", whole.substr(0, cut)), "") << cut;
  }
  EXPECT_THAT(error_of("a.npz", "PK"), HasSubstr("ZIP"));
}

}  // namespace
}  // namespace taut
