// Legacy VTK files (version 1 to 5) with DATASET POLYDATA, UNSTRUCTURED_GRID or STRUCTURED_GRID: their points, the
// polygons of POLYDATA, and NORMALS on the points. Binary data are big-endian. Everything else is skipped.

#include <algorithm>
#include <optional>

#include "io/readers.hpp"
#include "io/text_reader.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

/// Bytes of a number of VTK's type, 0 = unknown.
std::size_t size_of_type(std::string_view type) {
  if (type == "double" || type == "long" || type == "vtktypeint64" || type == "unsigned_long") return 8;
  if (type == "float" || type == "int" || type == "unsigned_int" || type == "vtkidtype") return 4;
  if (type == "short" || type == "unsigned_short") return 2;
  if (type == "char" || type == "unsigned_char" || type == "signed_char") return 1;
  return 0;
}

double load(std::string_view type, const char* p) {
  constexpr std::endian kOrder = std::endian::big;
  if (type == "double") return load_number<double>(p, kOrder);
  if (type == "float") return load_number<float>(p, kOrder);
  if (type == "int" || type == "vtkidtype") return load_number<std::int32_t>(p, kOrder);
  if (type == "unsigned_int") return load_number<std::uint32_t>(p, kOrder);
  if (type == "short") return load_number<std::int16_t>(p, kOrder);
  if (type == "unsigned_short") return load_number<std::uint16_t>(p, kOrder);
  if (type == "char" || type == "signed_char") return static_cast<signed char>(*p);
  if (type == "unsigned_char") return static_cast<unsigned char>(*p);
  if (type == "unsigned_long") return static_cast<double>(load_number<std::uint64_t>(p, kOrder));
  return static_cast<double>(load_number<std::int64_t>(p, kOrder));
}

/// Goes through the sections of one file. A TextReader knows lines only, so binary data move its place.
class Sections {
 public:
  explicit Sections(const InputFile& file) : file_(file), reader_(std::in_place, file, 0) {
    reader_->next_line();
    reader_->next_line();  // the title
    if (!reader_->next_line()) file.fail("the file ends inside its header; it is cut short");
    const std::string kind(reader_->rest());
    if (kind != "ASCII" && kind != "BINARY") {
      reader_->fail(quote(kind) + " is neither ASCII nor BINARY; correct the header");
    }
    binary_ = kind == "BINARY";
  }

  bool next() { return reader_->next_line(); }
  TextReader& line() { return *reader_; }

  /// `count` numbers of `type`, which follow the present line.
  std::vector<double> numbers(std::uint64_t count, const std::string& type, const std::string& what) {
    const std::size_t size = size_of_type(type);
    if (size == 0) reader_->fail(what + " of type " + quote(type) + " are not read; save float or double");
    check_declared(file_, count, binary_ ? size : 2, reader_->remaining() + 1, what);
    std::vector<double> values;
    values.reserve(count);
    if (!binary_) {
      while (values.size() < count) {
        if (reader_->line_is_done() && !reader_->next_line())
          file_.fail("the file ends inside " + what + "; it is cut short");
        values.push_back(reader_->number(what));
      }
      return values;
    }
    const std::size_t first = file_.bytes.size() - reader_->remaining();
    check_declared(file_, count, size, file_.bytes.size() - first, what);
    for (std::uint64_t i = 0; i < count; ++i) values.push_back(load(type, file_.bytes.data() + first + i * size));
    reader_.emplace(file_, 0, first + count * size, reader_->line_number() + 1);
    return values;
  }

 private:
  const InputFile& file_;
  std::optional<TextReader> reader_;
  bool binary_ = false;
};

std::uint64_t count_of(TextReader& line, std::string_view what) {
  const std::int64_t count = line.integer(what);
  if (count < 0 || static_cast<std::uint64_t>(count) > kMostPoints) {
    line.fail(std::string(what) + " is impossible; correct the header");
  }
  return static_cast<std::uint64_t>(count);
}

/// Polygons as VTK writes them before version 5: the number of corners, then the corners.
std::vector<int> fans(const InputFile& file, const std::vector<double>& entries, std::uint64_t num_points) {
  std::vector<int> corners;
  std::vector<int> polygon;
  for (std::size_t at = 0; at < entries.size();) {
    const double size = entries[at++];
    if (!(size >= 0 && size <= static_cast<double>(entries.size() - at))) {
      file.fail("POLYGONS: a polygon has an impossible number of corners; the file is damaged");
    }
    polygon.clear();
    for (std::size_t k = 0; k < static_cast<std::size_t>(size); ++k, ++at) {
      if (!(entries[at] >= 0 && entries[at] < static_cast<double>(num_points))) {
        file.fail("POLYGONS: a corner is out of range (there are " + counted(num_points, "point") + ", from 0)");
      }
      polygon.push_back(static_cast<int>(entries[at]));
    }
    append_fan(polygon, corners);
  }
  return corners;
}

}  // namespace

PointCloud read_vtk_points(const InputFile& file) {
  if (!file.bytes.starts_with("# vtk DataFile")) file.fail("does not start with '# vtk DataFile'; the file is damaged");
  Sections sections(file);
  PointCloud cloud;
  std::uint64_t num_points = 0;
  bool on_points = false;
  while (sections.next()) {
    TextReader& line = sections.line();
    const std::string key = lower(line.word());
    if (key == "points") {
      num_points = count_of(line, "POINTS");
      const std::string type = lower(line.word());
      cloud.points = to_points(sections.numbers(3 * num_points, type, "POINTS"), 3);
    } else if (key == "polygons") {
      const std::uint64_t count = count_of(line, "POLYGONS");
      const std::uint64_t entries = count_of(line, "POLYGONS");
      const std::size_t place = file.bytes.size() - line.remaining();
      if (std::string_view(file.bytes).substr(place).starts_with("OFFSETS")) {
        // Version 5: offsets (one more than there are polygons), then the corners.
        sections.next();
        line.word();
        const std::vector<double> ends = sections.numbers(count, lower(sections.line().word()), "OFFSETS");
        if (!sections.next() || lower(sections.line().word()) != "connectivity") {
          file.fail("POLYGONS: CONNECTIVITY is missing; the file is damaged");
        }
        const std::vector<double> all = sections.numbers(entries, lower(sections.line().word()), "CONNECTIVITY");
        std::vector<double> old_style;
        for (std::size_t i = 1; i < ends.size(); ++i) {
          const double first = ends[i - 1];
          const double last = ends[i];
          if (!(first >= 0 && first <= last && last <= static_cast<double>(all.size()))) {
            file.fail("POLYGONS: OFFSETS are out of order; the file is damaged");
          }
          old_style.push_back(last - first);
          old_style.insert(old_style.end(), all.begin() + static_cast<std::ptrdiff_t>(first),
                           all.begin() + static_cast<std::ptrdiff_t>(last));
        }
        cloud.faces = to_faces(fans(file, old_style, num_points));
      } else {
        cloud.faces = to_faces(fans(file, sections.numbers(entries, "int", "POLYGONS"), num_points));
      }
    } else if (key == "point_data") {
      on_points = true;
    } else if (key == "cell_data") {
      on_points = false;
    } else if (key == "normals" && on_points) {
      line.word();  // the name
      cloud.normals = to_points(sections.numbers(3 * num_points, lower(line.word()), "NORMALS"), 3);
    }
  }
  if (num_points == 0) file.fail("has no POINTS; check how it was written");
  return cloud;
}

}  // namespace taut::detail
