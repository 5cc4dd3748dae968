// The file readers on arbitrary bytes: each must return a valid cloud or throw an IoError, and hold no more memory than
// a multiple of the input's size. The first line of an input is the extension; one that is none stands for any.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>

#include "io/readers.hpp"
#include "taut/io/read_point_cloud.hpp"
#include "taut/io/read_points.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const taut::PointCloud& cloud) {
  require(cloud.size() > 0 && cloud.points.allFinite() && cloud.normals.allFinite());
  require(cloud.normals.cols() == 0 || cloud.normals.cols() == cloud.size());
  require(cloud.faces.size() == 0 || (cloud.faces.minCoeff() >= 0 && cloud.faces.maxCoeff() < cloud.size()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto& extensions = taut::point_cloud_extensions();
  const std::string input(reinterpret_cast<const char*>(data), size);
  const std::size_t end = input.find('\n');
  if (end == std::string::npos) return 0;
  std::string extension = input.substr(0, end);
  if (std::ranges::find(extensions, extension) == extensions.end()) extension = extensions[size % extensions.size()];
  const std::string bytes = input.substr(end + 1);
  // Tables without a header are read in another way where the user says how many columns are coordinates.
  for (const std::optional<taut::Index> dim : {std::optional<taut::Index>(), std::optional<taut::Index>(3)}) {
    try {
      check(taut::detail::parse_point_cloud({"input" + extension, bytes, {}}, dim));
    } catch (const taut::IoError& error) {
      require(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
  std::istringstream in(bytes);
  taut::CsvRows rows(in, "input");
  for (taut::CsvRow row; rows.next(row);) require(row.problem.empty() || row.line > 0);
  return 0;
}
