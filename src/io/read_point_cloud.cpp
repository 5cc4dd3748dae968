#include "taut/io/read_point_cloud.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "io/inflate.hpp"
#include "io/readers.hpp"

namespace taut {
namespace detail {
namespace {

struct Format {
  std::string_view extension;
  std::string_view kind;  // as `recognise` calls it; empty when such files have no mark of their own
  bool text;              // may hold no zero byte
  PointCloud (*read)(const InputFile&) = nullptr;
  ColumnFormat columns = ColumnFormat::spatial;  // without a reader of its own: lines of numbers
};

constexpr std::array kFormats = {
    Format{".ply", "a PLY file", false, read_ply},
    Format{".obj", "", true, read_obj},
    Format{".off", "an OFF file", true, read_off},
    Format{".stl", "an STL file", false, read_stl},
    Format{".xyz", "", true},
    Format{".pts", "", true},
    Format{".asc", "", true},
    Format{".txt", "", true},
    Format{".pwn", "", true, nullptr, ColumnFormat::pwn},
    Format{".pcd", "a PCD file", false, read_pcd},
    Format{".csv", "", true, nullptr, ColumnFormat::any},
    Format{".tsv", "", true, nullptr, ColumnFormat::any},
    Format{".npy", "a NumPy array", false, read_npy},
    Format{".las", "a LAS file", false, read_las},
    Format{".vtk", "a legacy VTK file", false, read_vtk_points},
    Format{".vtp", "an XML file", false, read_vtk_xml},
    Format{".vtu", "an XML file", false, read_vtk_xml},
};

struct OtherFile {
  std::string_view extension;
  std::string_view advice;
};

/// What people have of the same kind of thing, and how they get what is read.
constexpr std::array kOtherFiles = {
    OtherFile{".laz", "compressed LAS; unpack it first: las2las -i in.laz -o out.las, or pdal translate"},
    OtherFile{".e57", "E57 is not read; convert it first: pdal translate in.e57 out.las, or CloudCompare"},
    OtherFile{".step", "STEP is not read; export a mesh from the CAD program, as .stl or .obj"},
    OtherFile{".stp", "STEP is not read; export a mesh from the CAD program, as .stl or .obj"},
    OtherFile{".iges", "IGES is not read; export a mesh from the CAD program, as .stl or .obj"},
    OtherFile{".igs", "IGES is not read; export a mesh from the CAD program, as .stl or .obj"},
    OtherFile{".3mf", "3MF is not read; export the mesh as .stl or .obj"},
    OtherFile{".gltf", "glTF is not read; export the mesh as .ply or .obj"},
    OtherFile{".glb", "glTF is not read; export the mesh as .ply or .obj"},
    OtherFile{".fbx", "FBX is not read; export the mesh as .ply or .obj"},
    OtherFile{".dcm", "DICOM is not read; convert the series to NIfTI first, as dcm2niix does"},
    OtherFile{".xlsx", "a spreadsheet; save the table as .csv"},
    OtherFile{".ods", "a spreadsheet; save the table as .csv"},
};

constexpr std::string_view kCompressed = ".gz";

/// "scan.ply" of "scan.ply.gz"
std::filesystem::path without_gz(const std::filesystem::path& path) {
  return lower_extension(path) == kCompressed ? path.parent_path() / path.stem() : path;
}

std::string known_extensions() {
  std::string list;
  for (const Format& format : kFormats) {
    if (!list.empty()) list += ' ';
    list += format.extension;
  }
  return list;
}

/// Throws IoError for an extension nobody reads.
Format format_of(const std::filesystem::path& path) {
  const std::string extension = lower_extension(without_gz(path));
  const auto* format =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.extension == extension; });
  if (format != kFormats.end()) return *format;
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored)) {
    throw IoError(path.string(), "is a folder, not a file; name a file inside it");
  }
  for (const OtherFile& other : kOtherFiles) {
    if (extension == other.extension) throw IoError(path.string(), std::string(other.advice));
  }
  const std::string problem = extension.empty() ? "the name has no extension" : "unknown extension " + quote(extension);
  throw IoError(path.string(), problem + "; point clouds and meshes are read from " + known_extensions() +
                                   " (also compressed, as .ply.gz)");
}

/// What every format promises: some points, all finite, normals finite or zero.
void check_cloud(const InputFile& file, PointCloud& cloud, std::optional<Index> dim) {
  if (cloud.size() == 0) file.fail("holds no points; check how it was written");
  if (dim && cloud.dim() != *dim) {
    file.fail("its points have " + std::to_string(cloud.dim()) + " coordinates where " + std::to_string(*dim) +
              " are needed");
  }
  if (static_cast<std::uint64_t>(cloud.size()) > kMostPoints) {
    file.fail("holds " + std::to_string(cloud.size()) + " points, more than 2^31 - 1; thin it");
  }
  for (Index j = 0; j < cloud.size(); ++j) {
    if (cloud.points.col(j).allFinite()) continue;
    for (Index i = 0; i < cloud.dim(); ++i) {
      if (std::isfinite(cloud.points(i, j))) continue;
      file.fail("point " + std::to_string(j) + " (from 0): " + coordinate_name(i) + " is " +
                (std::isnan(cloud.points(i, j)) ? "nan" : "infinite") + "; remove the point or give it a finite value");
    }
  }
  if (cloud.normals.cols() == 0) cloud.normals.resize(cloud.dim(), 0);
  std::size_t unknown = 0;
  for (Index j = 0; j < cloud.normals.cols(); ++j) {
    if (cloud.normals.col(j).allFinite()) continue;
    cloud.normals.col(j).setZero();
    ++unknown;
  }
  if (unknown > 0) file.note(counted(unknown, "normal") + " not finite: taken as unknown");
  drop_missing_values(file, cloud);
}

}  // namespace

PointCloud parse_point_cloud(InputFile file, std::optional<Index> dim) {
  const Format format = format_of(file.path);
  try {
    if (lower_extension(file.path) == kCompressed) gunzip(file);
    const std::string_view kind = recognise(file.bytes);
    if (!kind.empty() && kind != format.kind) {
      file.fail("the content is " + std::string(kind) + ", not what " + std::string(format.extension) +
                " stands for; rename, unpack or convert it");
    }
    if (format.text) normalise_text(file);
    PointCloud cloud = format.read != nullptr ? format.read(file) : read_columns(file, format.columns, {.dim = dim});
    check_cloud(file, cloud, dim);
    if (!dim && format.read == read_npy && cloud.dim() > 3) {
      file.note("its points lie in " + std::to_string(cloud.dim()) + " dimensions, one a column");
    }
    return cloud;
  } catch (const std::bad_alloc&) {
    file.fail("its points do not fit into memory; thin the file");
  }
}

void check_declared(const InputFile& file, std::uint64_t count, std::uint64_t bytes_each, std::uint64_t available,
                    const std::string& where) {
  if (bytes_each == 0 || count <= available / bytes_each) return;
  file.fail(where + " says " + std::to_string(count) + ", but only " + counted(available, "byte") +
            (available == 1 ? " follows" : " follow") + "; the file is cut short or its header is wrong");
}

std::string coordinate_name(Index i) {
  constexpr std::string_view kLetters = "xyz";
  return i < 3 ? std::string("coordinate ") + kLetters[static_cast<std::size_t>(i)]
               : "coordinate " + std::to_string(i + 1);
}

}  // namespace detail

const std::vector<std::string>& point_cloud_extensions() {
  static const std::vector<std::string> extensions = [] {
    std::vector<std::string> list;
    for (const detail::Format& format : detail::kFormats) list.emplace_back(format.extension);
    return list;
  }();
  return extensions;
}

PointCloud read_point_cloud(const std::filesystem::path& path, const Context& context, std::optional<Index> dim) {
  static_cast<void>(
      detail::format_of(path));  // an unknown extension is the clearer answer, even if the file is missing
  return detail::parse_point_cloud(detail::read_file(path, context), dim);
}

}  // namespace taut
