#include "taut/io/read_surface.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <new>

#include "io/volume_readers.hpp"

namespace taut {
namespace detail {
namespace {

struct Format {
  std::string_view extension;
  std::string_view kind;  // as `recognise` calls it; empty when such files have no mark of their own
  VoxelVolume (*read)(const InputFile&);
};

constexpr std::string_view kPacked = "a gzip-compressed file";

/// Longer extensions first where one ends in another.
constexpr std::array kFormats = {
    Format{".nii.gz", kPacked, read_nifti},
    Format{".nii", "", read_nifti},
    Format{".nrrd", "an NRRD volume", read_nrrd},
    Format{".nhdr", "an NRRD volume", read_nrrd},
    Format{".mha", "", read_metaimage},
    Format{".mhd", "", read_metaimage},
    Format{".inr.gz", kPacked, read_inrimage},
    Format{".inr", "an INRIMAGE volume", read_inrimage},
    Format{".vtk", "a legacy VTK file", read_vtk_volume},
    Format{".npy", "a NumPy array", read_npy_volume},
};
constexpr std::string_view kVdb = ".vdb";

/// Null for an extension no volume has, and for `.vdb`, which OpenVDB opens.
const Format* format_of(const std::filesystem::path& path) {
  const std::string name = lower(path.filename().string());
  const auto* format = std::ranges::find_if(
      kFormats, [&](const Format& f) { return name.size() > f.extension.size() && name.ends_with(f.extension); });
  return format == kFormats.end() ? nullptr : format;
}

bool is_vdb(const std::filesystem::path& path) { return lower_extension(path) == kVdb; }

std::string known_extensions() {
  std::string list;
  for (const std::string& extension : volume_extensions()) list += (list.empty() ? "" : " ") + extension;
  return list;
}

}  // namespace

InputFile read_detached(const InputFile& header, const std::string& name) {
  if (name.empty()) header.fail("the header names no data file; correct it");
  try {
    return read_file(std::filesystem::path(header.path).parent_path() / name, header.context);
  } catch (const IoError& error) {
    header.fail("its data: " + std::string(error.what()));
  }
}

VoxelVolume parse_volume(const InputFile& file, const VolumeFileOptions& options) {
  if (is_vdb(file.path)) return read_vdb(file, options.grid_name);
  if (!options.grid_name.empty()) file.fail("a grid's name (--grid-name) is for .vdb files; leave it out");
  const Format* format = format_of(file.path);
  if (format == nullptr) {
    const std::string extension = lower_extension(file.path);
    file.fail((extension.empty() ? "the name has no extension" : "unknown extension " + quote(extension)) +
              "; volumes are read from " + known_extensions());
  }
  const std::string_view kind = recognise(file.bytes);
  const bool unmarked = format->kind.empty() && kind.empty();
  if (!unmarked && kind != format->kind) {
    file.fail("the content is " + (kind.empty() ? "of no known kind" : std::string(kind)) + ", not what " +
              std::string(format->extension) + " stands for; rename, unpack or convert it");
  }
  try {
    return format->read(file);
  } catch (const std::bad_alloc&) {
    file.fail("its voxels do not fit into memory; crop or thin the volume");
  }
}

}  // namespace detail

const std::vector<std::string>& volume_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> list;
    for (const detail::Format& format : detail::kFormats) list.emplace_back(format.extension);
    list.emplace_back(detail::kVdb);
    return list;
  }();
  return extensions;
}

bool is_volume_file(const std::filesystem::path& path) {
  if (detail::is_vdb(path)) return true;
  const detail::Format* format = detail::format_of(path);
  if (format == nullptr || (format->extension != ".npy" && format->extension != ".vtk")) return format != nullptr;
  constexpr std::size_t kStart = 4096;
  detail::InputFile start{path.string(), std::string(kStart, '\0'), {}};
  std::ifstream in(path, std::ios::binary);
  in.read(start.bytes.data(), static_cast<std::streamsize>(kStart));
  start.bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (format->extension == ".vtk") return detail::lower(start.bytes).find("structured_points") != std::string::npos;
  try {
    return detail::is_npy_volume(start);
  } catch (const IoError&) {
    return false;
  }
}

VoxelVolume read_volume(const std::filesystem::path& path, const VolumeFileOptions& options, const Context& context) {
  if (detail::is_vdb(path) || detail::format_of(path) == nullptr) {
    return detail::parse_volume({path.string(), {}, context}, options);  // an unknown extension is the clearer answer
  }
  return detail::parse_volume(detail::read_file(path, context), options);
}

}  // namespace taut
