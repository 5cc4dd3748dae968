#include "taut/io/read_surface.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

#include "io/named_arrays.hpp"

namespace taut {
namespace {

using detail::InputFile;
using detail::NamedArrays;
using detail::quote;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Names in the order of the numbers in them: "net.9.weight" before "net.10.weight".
bool numbers_first(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      std::size_t m = 0;
      std::size_t n = 0;
      const auto take = [](const std::string& text, std::size_t& at, std::size_t& value) {
        const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
        at = error == std::errc() ? static_cast<std::size_t>(end - text.data()) : text.size();
      };
      take(a, i, m);
      take(b, j, n);
      if (m != n) return m < n;
    } else {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
    }
  }
  return a.size() - i < b.size() - j;
}

/// The name of the bias that belongs to a matrix; empty where the name says nothing.
std::string bias_name(const std::string& name) {
  for (const std::string_view word : {"weights", "weight", "kernel"}) {
    const std::size_t at = name.rfind(word);
    if (at == name.npos) continue;
    const std::string_view other = word == "weights" ? "biases" : "bias";
    return name.substr(0, at) + std::string(other) + name.substr(at + word.size());
  }
  const std::size_t at = name.find_last_of("wW");
  if (at == name.npos) return {};
  std::string bias = name;
  bias[at] = name[at] == 'w' ? 'b' : 'B';
  return bias;
}

const NamedArrays::Array* find(const NamedArrays& arrays, const std::string& name) {
  const auto same = [&](const NamedArrays::Array& array) {
    return array.name.size() == name.size() &&
           std::equal(name.begin(), name.end(), array.name.begin(), [](char a, char b) {
             return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
           });
  };
  const auto found = std::ranges::find_if(arrays.arrays, same);
  return found == arrays.arrays.end() ? nullptr : &*found;
}

std::string remark(const NamedArrays& arrays, std::string_view name) {
  const auto found = std::ranges::find_if(arrays.remarks, [&](const auto& entry) { return entry.name == name; });
  return found == arrays.remarks.end() ? std::string() : found->text;
}

std::optional<double> number(const InputFile& file, const NamedArrays& arrays, std::string_view name) {
  const std::string text = remark(arrays, name);
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    file.fail(std::string(name) + " is " + quote(text) + " and no number");
  }
  return value;
}

Activation activation_of(const InputFile& file, const NamedArrays& arrays, const NetworkFileOptions& options) {
  if (options.activation) return *options.activation;
  const std::string name = detail::lower(remark(arrays, "activation"));
  if (name == "sine" || name == "sin" || name == "siren") return Activation::sine;
  if (name == "softplus") return Activation::softplus;
  if (name == "tanh") return Activation::tanh;
  if (name.empty()) {
    file.fail("does not say what stands between its layers: give the activation (--activation sine, softplus or tanh)");
  }
  if (name.find("relu") != name.npos || name == "elu" || name == "selu") {
    file.fail("its activation is " + name +
              ", whose bends make the surface a polyhedron, or leave it without "
              "curvature: geodesics need a C^2 one; train with sine, softplus or tanh");
  }
  file.fail("its activation is " + quote(name) + "; sine, softplus and tanh are read");
}

/// The layers, weights as they are or all transposed; empty where they do not fit together.
std::vector<DenseLayer> chained(const NamedArrays& arrays, const std::vector<const NamedArrays::Array*>& matrices,
                                bool transposed) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  std::vector<DenseLayer> layers;
  for (const NamedArrays::Array* matrix : matrices) {
    DenseLayer layer;
    const Eigen::Map<const RowMajor> entries(matrix->values.data(), static_cast<Index>(matrix->shape[0]),
                                             static_cast<Index>(matrix->shape[1]));
    if (transposed) {
      layer.weights = entries.transpose();
    } else {
      layer.weights = entries;
    }
    if (!layers.empty() && layer.weights.cols() != layers.back().weights.rows()) return {};
    layer.bias = Vector::Zero(layer.weights.rows());
    if (const NamedArrays::Array* bias = find(arrays, bias_name(matrix->name))) {
      const bool is_vector = bias->shape.size() <= 1 || (bias->shape.size() == 2 && bias->shape[0] == 1);
      if (!is_vector || static_cast<Index>(bias->values.size()) != layer.bias.size()) {
        return {};
      }
      layer.bias = Eigen::Map<const Vector>(bias->values.data(), layer.bias.size());
    }
    layers.push_back(std::move(layer));
  }
  return layers;
}

}  // namespace

bool is_network_file(const std::filesystem::path& path) {
  const std::string extension = detail::lower_extension(path);
  return extension == ".npz" || extension == ".safetensors";
}

NeuralNetwork read_neural_network(const std::filesystem::path& path, const NetworkFileOptions& options,
                                  const Context& context) {
  const InputFile file = detail::read_file(path, context);
  const NamedArrays arrays =
      detail::lower_extension(path) == ".npz" ? detail::read_npz(file) : detail::read_safetensors(file);
  std::vector<const NamedArrays::Array*> matrices;
  for (const NamedArrays::Array& array : arrays.arrays) {
    const bool is_bias = array.name.find("bias") != std::string::npos;
    if (array.shape.size() == 2 && !is_bias) matrices.push_back(&array);
  }
  std::ranges::sort(matrices, [](const auto* a, const auto* b) { return numbers_first(a->name, b->name); });
  if (matrices.empty()) file.fail("holds no matrix of weights; save each layer's weights and bias");
  NeuralNetwork network;
  network.activation = activation_of(file, arrays, options);
  network.layers = chained(arrays, matrices, false);
  if (network.layers.empty()) network.layers = chained(arrays, matrices, true);
  if (network.layers.empty()) {
    std::string shapes;
    for (const NamedArrays::Array* matrix : matrices) {
      shapes += (shapes.empty() ? "" : ", ") + matrix->name + " " + std::to_string(matrix->shape[0]) + " x " +
                std::to_string(matrix->shape[1]);
    }
    file.fail("its matrices and biases do not follow each other as the layers of a perceptron: " + shapes +
              " (skip connections are not read)");
  }
  const auto given = [&](const std::optional<double>& option, std::string_view name, double otherwise) {
    return option ? *option : number(file, arrays, name).value_or(otherwise);
  };
  constexpr double kUsualFrequency = 30;  // of the networks that made sines known
  network.frequency = given(options.frequency, "omega", kUsualFrequency);
  network.first_frequency = options.frequency && !options.first_frequency
                                ? *options.frequency
                                : given(options.first_frequency, "omega_first", network.frequency);
  network.sharpness = given(options.sharpness, "beta", 1);
  return network;
}

}  // namespace taut
