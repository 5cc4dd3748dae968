#include "taut/io/read_points.hpp"

#include <algorithm>
#include <sstream>
#include <vector>

#include "io/readers.hpp"
#include "taut/io/read_point_cloud.hpp"

namespace taut {
namespace {

/// Lines that name samples, as @17, among lines of coordinates.
PointCloud read_named(const detail::InputFile& file, Index dim, const Points* samples) {
  std::istringstream text(file.bytes);
  CsvRows rows(text, file.path);
  if (samples != nullptr) rows.set_samples(*samples);
  std::vector<double> numbers;
  for (CsvRow row; rows.next(row);) {
    if (!row.problem.empty()) file.fail_at_line(row.line, row.problem);
    if (static_cast<Index>(row.values.size()) != dim) {
      file.fail_at_line(row.line, "has " + std::to_string(row.values.size()) + " numbers where a point has " +
                                      std::to_string(dim) + "; correct the line");
    }
    numbers.insert(numbers.end(), row.values.begin(), row.values.end());
  }
  PointCloud cloud;
  cloud.points = Eigen::Map<const Points>(numbers.data(), dim, static_cast<Index>(numbers.size()) / dim);
  return cloud;
}

PointCloud read_plain(const std::filesystem::path& path, Index dim, const Context& context, const Points* samples) {
  detail::InputFile file = detail::read_file(path, context);
  const std::string_view kind = detail::recognise(file.bytes);
  if (!kind.empty()) file.fail("the content is " + std::string(kind) + ", not lines of numbers; rename or convert it");
  detail::normalise_text(file);
  if (file.bytes.starts_with('@') || file.bytes.find("\n@") != file.bytes.npos) return read_named(file, dim, samples);
  return detail::read_columns(file, detail::ColumnFormat::any, {.dim = dim, .whole_lines = true});
}

}  // namespace

Points read_points(const std::filesystem::path& path, Index dim, const Context& context, const Points* samples) {
  const std::string extension = detail::lower_extension(path);
  const std::vector<std::string>& known = point_cloud_extensions();
  const bool is_known = std::find(known.begin(), known.end(), extension) != known.end();
  const bool is_table = extension == ".csv" || extension == ".tsv" || extension == ".txt";
  const bool is_spatial_text = extension == ".xyz" || extension == ".pts" || extension == ".asc";
  const bool plain = (!is_known && extension != ".gz") || is_table || (is_spatial_text && dim != 3);
  PointCloud cloud = plain ? read_plain(path, dim, context, samples) : read_point_cloud(path, context, dim);
  return std::move(cloud.points);
}

}  // namespace taut
