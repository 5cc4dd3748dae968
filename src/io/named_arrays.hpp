#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/input_file.hpp"

namespace taut::detail {

/// Arrays of numbers with names, and what is said about them.
struct NamedArrays {
  struct Array {
    std::string name;
    std::vector<std::uint64_t> shape;
    std::vector<double> values;  // the last index runs fastest
  };
  struct Remark {
    std::string name;
    std::string text;
  };
  std::vector<Array> arrays;
  std::vector<Remark> remarks;  // an array of one number is a remark, too
};

// Each throws IoError on anything wrong.
[[nodiscard]] NamedArrays read_npz(const InputFile& file);
[[nodiscard]] NamedArrays read_safetensors(const InputFile& file);

/// A number of 16 bits, IEEE or the upper half of a float.
[[nodiscard]] double half_to_double(std::uint16_t bits);
[[nodiscard]] double bfloat_to_double(std::uint16_t bits);

}  // namespace taut::detail
