#include "taut/io/read_point_cloud.hpp"

#include <algorithm>
#include <array>
#include <new>

#include "io/readers.hpp"

namespace taut {
namespace detail {
namespace {

struct Format {
  std::string_view extension;
  std::string_view kind;  // as `recognise` calls it; empty when such files have no mark of their own
  bool text;              // may hold no zero byte
  PointCloud (*read)(const InputFile&);
};

constexpr std::array kFormats = {
    Format{".ply", "a PLY file", false, read_ply},
    Format{".obj", "", true, read_obj},
    Format{".off", "an OFF file", true, read_off},
    Format{".stl", "an STL file", false, read_stl},
    Format{".xyz", "", true, [](const InputFile& file) { return read_columns(file, ColumnFormat::xyz); }},
    Format{".pts", "", true, [](const InputFile& file) { return read_columns(file, ColumnFormat::pts); }},
    Format{".pwn", "", true, [](const InputFile& file) { return read_columns(file, ColumnFormat::pwn); }},
    Format{".pcd", "a PCD file", false, read_pcd},
    Format{".csv", "", true, [](const InputFile& file) { return read_columns(file, ColumnFormat::csv); }},
    Format{".npy", "a NumPy array", false, read_npy},
};

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
  const std::string extension = lower_extension(path);
  const auto* format =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& f) { return f.extension == extension; });
  if (format != kFormats.end()) return *format;
  const std::string problem = extension.empty() ? "the name has no extension" : "unknown extension " + quote(extension);
  throw IoError(path.string(), problem + "; point clouds and meshes are read from " + known_extensions());
}

/// What every format promises: some points, all finite, normals finite or zero.
void check_cloud(const InputFile& file, PointCloud& cloud) {
  if (cloud.size() == 0) file.fail("holds no points; check how it was written");
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
}

}  // namespace

PointCloud parse_point_cloud(InputFile file) {
  const Format format = format_of(file.path);
  const std::string_view kind = recognise(file.bytes);
  if (!kind.empty() && kind != format.kind) {
    file.fail("the content is " + std::string(kind) + ", not what " + std::string(format.extension) +
              " stands for; rename, unpack or convert it");
  }
  if (format.text) normalise_text(file);
  try {
    PointCloud cloud = format.read(file);
    check_cloud(file, cloud);
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

PointCloud read_point_cloud(const std::filesystem::path& path, const Context& context) {
  static_cast<void>(
      detail::format_of(path));  // an unknown extension is the clearer answer, even if the file is missing
  return detail::parse_point_cloud(detail::read_file(path, context));
}

}  // namespace taut
