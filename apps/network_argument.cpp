#include "network_argument.hpp"

#include "checks.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_surface.hpp"

namespace taut::app {

void NetworkArguments::add_to(CLI::App& command) {
  constexpr const char* kGroup = "Networks";
  command
      .add_option("--activation", activation, "between the layers: sine, softplus or tanh (default: as the file says)")
      ->transform(one_of<Activation>(
          {{"sine", Activation::sine}, {"softplus", Activation::softplus}, {"tanh", Activation::tanh}}))
      ->group(kGroup);
  command.add_option("--omega", omega, "frequency of sines: W, or FIRST,OTHERS (default: as the file says, else 30)")
      ->group(kGroup);
  command.add_option("--sharpness", beta, "sharpness of softplus (default: as the file says, else 1)")
      ->check(any_number())
      ->group(kGroup);
}

const char* NetworkArguments::given() const {
  if (activation) return "--activation";
  if (!omega.empty()) return "--omega";
  return beta ? "--sharpness" : nullptr;
}

Surface load_network(const std::string& file, const NetworkArguments& arguments, std::optional<double> iso,
                     const Context& context) {
  NetworkFileOptions options{.activation = arguments.activation, .sharpness = arguments.beta};
  if (!arguments.omega.empty()) {
    const Vector omega = parse_numbers(arguments.omega, "--omega");
    if (omega.size() > 2) throw UsageError("--omega " + arguments.omega + ": give one number, or two: FIRST,OTHERS");
    options.first_frequency = omega(0);
    options.frequency = omega(omega.size() - 1);
  }
  try {
    return network_surface(read_neural_network(file, options, context), {.iso = iso.value_or(0)});
  } catch (const InvalidArgument& error) {
    throw IoError(file, error.what());
  }
}

}  // namespace taut::app
