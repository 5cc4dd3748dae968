#include "batch_errors.hpp"

#include <fmt/format.h>

#include "terminal.hpp"

namespace taut::app {
namespace {

constexpr std::size_t kTold = 5;

}  // namespace

BatchErrors::~BatchErrors() {
  if (count_ > kTold) print_error(fmt::format("{}: and {} more without an answer", file_, count_ - kTold));
}

void BatchErrors::tell(std::size_t number, std::string_view problem, std::string_view noun) {
  if (++count_ <= kTold) print_error(fmt::format("{} {} {}: {}", file_, noun, number, problem));
}

}  // namespace taut::app
