// The readers of volumes, heights, networks, scenes and clauses on arbitrary bytes: each must return what it promises
// or throw an error of one line, and hold no more memory than a multiple of the input's size. The first line of an
// input is the extension; one that is none stands for any.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "io/height_readers.hpp"
#include "io/named_arrays.hpp"
#include "io/volume_readers.hpp"
#include "taut/surface/formula.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

/// Without `.mhd`, `.nhdr` and `.vdb`, which open files by themselves.
constexpr std::array<std::string_view, 13> kExtensions = {
    ".nii", ".nii.gz", ".nrrd", ".mha", ".inr", ".inr.gz", ".vtk", ".npy", ".pgm", ".png", ".npz", ".scene", ".vm"};
constexpr std::string_view kSafetensors = ".safetensors";

void read(const taut::detail::InputFile& file, std::string_view extension) {
  namespace detail = taut::detail;
  if (extension == ".pgm" || extension == ".png") {
    const taut::HeightField field = detail::parse_height_field(file);
    require(static_cast<taut::Index>(field.heights.size()) == field.rows * field.columns);
  } else if (extension == ".npz" || extension == kSafetensors) {
    const detail::NamedArrays arrays = extension == ".npz" ? detail::read_npz(file) : detail::read_safetensors(file);
    for (const auto& array : arrays.arrays) {
      std::uint64_t size = 1;
      for (const std::uint64_t extent : array.shape) size *= extent;
      require(size == array.values.size());
    }
  } else if (extension == ".scene") {
    (void)taut::parse_scene(file.bytes);
  } else if (extension == ".vm") {
    (void)taut::parse_clauses(file.bytes);
  } else {
    const taut::VoxelVolume volume = detail::parse_volume(file);
    require(static_cast<taut::Index>(volume.values.size()) == volume.size[0] * volume.size[1] * volume.size[2]);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = input.find('\n');
  if (end == std::string::npos) return 0;
  std::string extension = input.substr(0, end);
  if (extension != kSafetensors && std::ranges::find(kExtensions, extension) == kExtensions.end()) {
    extension = kExtensions[size % kExtensions.size()];
  }
  try {
    read({"input" + extension, input.substr(end + 1), {}}, extension);
  } catch (const taut::IoError& error) {
    require(std::string(error.what()).find('\n') == std::string::npos);
  } catch (const taut::Error&) {
  }
  return 0;
}
