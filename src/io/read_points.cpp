#include "taut/io/read_points.hpp"

#include <algorithm>

#include "io/readers.hpp"
#include "taut/io/read_point_cloud.hpp"

namespace taut {
namespace {

PointCloud read_plain(const std::filesystem::path& path, Index dim, const Context& context) {
  detail::InputFile file = detail::read_file(path, context);
  const std::string_view kind = detail::recognise(file.bytes);
  if (!kind.empty()) file.fail("the content is " + std::string(kind) + ", not lines of numbers; rename or convert it");
  detail::normalise_text(file);
  return detail::read_columns(file, detail::ColumnFormat::any, {.dim = dim, .whole_lines = true});
}

}  // namespace

Points read_points(const std::filesystem::path& path, Index dim, const Context& context) {
  const std::string extension = detail::lower_extension(path);
  const std::vector<std::string>& known = point_cloud_extensions();
  const bool is_known = std::find(known.begin(), known.end(), extension) != known.end();
  const bool is_table = extension == ".csv" || extension == ".tsv" || extension == ".txt";
  const bool is_spatial_text = extension == ".xyz" || extension == ".pts" || extension == ".asc";
  const bool plain = (!is_known && extension != ".gz") || is_table || (is_spatial_text && dim != 3);
  PointCloud cloud = plain ? read_plain(path, dim, context) : read_point_cloud(path, context, dim);
  return std::move(cloud.points);
}

}  // namespace taut
