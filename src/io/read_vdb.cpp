#include "io/volume_readers.hpp"

#ifdef TAUT_OPENVDB
#include <dlfcn.h>

#include "core/memory_limit.hpp"
#include "io/vdb_module.hpp"
#endif

namespace taut::detail {

#ifdef TAUT_OPENVDB
namespace {

ReadVdb load_module(const InputFile& file) {
  void* module = dlopen(kVdbModule, RTLD_NOW | RTLD_LOCAL);  // stays open
  void* function = module != nullptr ? dlsym(module, kVdbFunction) : nullptr;
  if (function == nullptr) {
    const char* reason = dlerror();
    file.fail("the part of Taut that reads .vdb files cannot be loaded (" +
              std::string(reason != nullptr ? reason : kVdbFunction) + "); install it again");
  }
  return reinterpret_cast<ReadVdb>(function);
}

}  // namespace

VoxelVolume read_vdb(const InputFile& file, const std::string& grid_name) {
  // Missing, empty and unreadable files get the same answers as everywhere.
  if (!read_file(file.path, file.context).bytes.starts_with("\x20\x42\x44\x56")) {
    file.fail("does not start like an OpenVDB file; it is damaged or of another format");
  }
  VdbAnswer answer;
  load_module(file)({.path = file.path, .grid_name = grid_name, .memory_limit = memory_limit(file.context)}, answer);
  if (!answer.problem.empty()) file.fail(answer.problem);
  return std::move(answer.volume);
}
#else
VoxelVolume read_vdb(const InputFile& file, const std::string&) {
  file.fail("this Taut was built without OpenVDB; build it with libopenvdb-dev, or convert the grid to .nrrd or .npy");
}
#endif

}  // namespace taut::detail
