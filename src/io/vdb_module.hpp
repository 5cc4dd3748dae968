#pragma once

#include <cstddef>
#include <string>

#include "taut/surface/volume.hpp"

namespace taut::detail {

// OpenVDB takes 70 ms to load, several times as long as a path takes. So what needs it is a module of its own, opened
// when a .vdb file is read; it shares nothing with the library but these types.

struct VdbRequest {
  std::string path;
  std::string grid_name;         ///< empty = the only grid
  std::size_t memory_limit = 0;  ///< bytes that the values and their coefficients may take
};

struct VdbAnswer {
  VoxelVolume volume;
  std::string problem;  ///< empty when there is none
};

using ReadVdb = void (*)(const VdbRequest& request, VdbAnswer& answer);
inline constexpr const char* kVdbModule = "libtaut_vdb.so";
inline constexpr const char* kVdbFunction = "taut_read_vdb";

}  // namespace taut::detail
