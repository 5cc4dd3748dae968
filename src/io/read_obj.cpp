// Wavefront OBJ: `v`, `vn` and `f` lines; what else the format has (texture, groups, materials, curves) is skipped.

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

#include "io/readers.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

/// One corner of a face: places counted from 0; no normal = -1.
struct Corner {
  std::int64_t vertex = 0;
  std::int64_t normal = -1;
};

/// The largest index a face used, and where, since a vertex may be defined after the face that needs it.
struct LargestIndex {
  std::int64_t index = -1;
  std::size_t line = 0;

  void see(std::int64_t i, std::size_t at_line) {
    if (i <= index) return;
    index = i;
    line = at_line;
  }
};

class ObjReader {
 public:
  explicit ObjReader(const InputFile& file) : file_(file), reader_(file, '#') {}

  PointCloud read() {
    while (reader_.next_line()) read_statement(reader_.word());
    if (num_vertices() == 0 && unknown_ > 0) refuse_unknown();
    check_largest(largest_vertex_, num_vertices(), "vertex");
    check_largest(largest_normal_, num_normals(), "normal");
    PointCloud cloud;
    cloud.points = to_points(coordinates_, 3);
    cloud.normals = vertex_normals();
    cloud.faces = to_faces(corners_);
    if (unknown_ > 0) file_.note(counted(unknown_, "line") + " with unknown keywords skipped");
    return cloud;
  }

 private:
  [[nodiscard]] std::int64_t num_vertices() const { return static_cast<std::int64_t>(coordinates_.size() / 3); }
  [[nodiscard]] std::int64_t num_normals() const { return static_cast<std::int64_t>(normals_.size() / 3); }

  void read_statement(std::string_view keyword) {
    if (keyword == "v") {
      for (Index i = 0; i < 3; ++i) coordinates_.push_back(reader_.coordinate(coordinate_name(i)));
      while (!reader_.line_is_done()) reader_.number("weight or colour");
    } else if (keyword == "vn") {
      for (int i = 0; i < 3; ++i) normals_.push_back(reader_.number("normal"));
    } else if (keyword == "f" || keyword == "fo") {
      read_face();
    } else if (!is_known(keyword)) {
      refuse_or_skip(keyword);
    }
    if (keyword != "v" && keyword != "vn" && keyword != "f") skip_continuation();
  }

  static bool is_known(std::string_view keyword) {
    constexpr std::array<std::string_view, 34> kSkipped = {
        "vt",     "vp",     "g",      "o",        "s",        "l",          "p",        "mg",   "mtllib",
        "usemtl", "usemap", "maplib", "lod",      "bevel",    "cstype",     "deg",      "bmat", "step",
        "curv",   "curv2",  "surf",   "parm",     "trim",     "hole",       "scrv",     "sp",   "end",
        "con",    "ctech",  "stech",  "c_interp", "d_interp", "shadow_obj", "trace_obj"};
    return std::find(kSkipped.begin(), kSkipped.end(), keyword) != kSkipped.end();
  }

  /// A word may be some program's own extension; anything else means that this is no OBJ file.
  void refuse_or_skip(std::string_view keyword) {
    const bool is_word = std::all_of(keyword.begin(), keyword.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    });
    if (unknown_ == 0) {
      first_unknown_line_ = reader_.line_number();
      first_unknown_ = keyword;
    }
    ++unknown_;
    if (!is_word) refuse_unknown();
  }

  [[noreturn]] void refuse_unknown() const {
    file_.fail_at_line(first_unknown_line_,
                       quote(first_unknown_) + " is no OBJ statement; check that the extension fits the format");
  }

  void skip_continuation() {
    while (reader_.rest().ends_with('\\') && reader_.next_line()) {
    }
  }

  void read_face() {
    polygon_.clear();
    std::vector<std::int64_t> normals;
    while (true) {
      if (reader_.line_is_done()) break;
      const std::string_view word = reader_.word();
      if (word == "\\") {
        if (!reader_.next_line()) break;
        continue;
      }
      const Corner corner = parse_corner(word);
      polygon_.push_back(static_cast<int>(corner.vertex));
      normals.push_back(corner.normal);
    }
    if (polygon_.size() < 3) {
      reader_.fail("a face with " + counted(polygon_.size(), "corner") +
                   "; it needs three at least, correct or remove it");
    }
    append_fan(polygon_, corners_);
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      if (normals[i] < 0) continue;
      normal_uses_.push_back({polygon_[i], normals[i]});
    }
  }

  /// "7", "7/1", "7//3", "7/1/3"; negative numbers count back from the last one defined.
  Corner parse_corner(std::string_view word) {
    const std::array<std::string_view, 3> parts = split_corner(word);
    Corner corner;
    corner.vertex = resolve(parts[0], num_vertices(), word, "vertex");
    largest_vertex_.see(corner.vertex, reader_.line_number());
    if (!parts[2].empty()) {
      corner.normal = resolve(parts[2], num_normals(), word, "normal");
      largest_normal_.see(corner.normal, reader_.line_number());
    }
    return corner;
  }

  static std::array<std::string_view, 3> split_corner(std::string_view word) {
    std::array<std::string_view, 3> parts;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto slash = i < 2 ? word.find('/') : std::string_view::npos;
      parts[i] = word.substr(0, slash);
      if (slash == std::string_view::npos) break;
      word.remove_prefix(slash + 1);
    }
    return parts;
  }

  std::int64_t resolve(std::string_view number, std::int64_t defined, std::string_view word,
                       std::string_view what) const {
    std::int64_t index = 0;
    const char* end = number.data() + number.size();
    const auto [stop, error] = std::from_chars(number.data(), end, index);
    if (error != std::errc{} || stop != end) {
      reader_.fail("face corner " + quote(word) + " is not readable; write 7, 7/1, 7//3 or 7/1/3");
    }
    if (index == 0) reader_.fail("face corner " + quote(word) + ": OBJ counts from 1; correct the face");
    if (index < -defined || index > static_cast<std::int64_t>(kMostPoints)) {
      reader_.fail(std::string(what) + " index " + std::to_string(index) + " is out of range (" +
                   counted(static_cast<std::size_t>(defined), what) + " so far); correct the face");
    }
    return index > 0 ? index - 1 : defined + index;
  }

  void check_largest(const LargestIndex& largest, std::int64_t defined, std::string_view what) const {
    if (largest.index < defined) return;
    file_.fail_at_line(largest.line, std::string(what) + " index " + std::to_string(largest.index + 1) +
                                         " is out of range (the file has " +
                                         counted(static_cast<std::size_t>(defined), what) +
                                         "); the file is cut short or the face is wrong");
  }

  /// A vertex's normal: the mean direction of those its corners name; or the vn line of the same number where no face
  /// names any, as point clouds have them. 3 x 0 if neither holds.
  [[nodiscard]] Points vertex_normals() const {
    const Points given = to_points(normals_, 3);
    if (normal_uses_.empty()) {
      if (given.cols() == num_vertices()) return given;
      if (given.cols() > 0) {
        file_.note(counted(static_cast<std::size_t>(given.cols()), "normal") + " for " +
                   std::to_string(num_vertices()) + " vertices, and no face tells which is whose: not used");
      }
      return Points(3, 0);
    }
    Points sum = Points::Zero(3, num_vertices());
    for (const NormalUse& use : normal_uses_) {
      const double length = given.col(use.normal).norm();
      if (length > 0) sum.col(use.vertex) += given.col(use.normal) / length;
    }
    for (Index j = 0; j < sum.cols(); ++j) {
      const double length = sum.col(j).norm();
      if (length > 0) sum.col(j) /= length;
    }
    return sum;
  }

  struct NormalUse {
    int vertex;
    std::int64_t normal;
  };

  const InputFile& file_;
  TextReader reader_;
  std::vector<double> coordinates_;
  std::vector<double> normals_;
  std::vector<int> corners_;
  std::vector<NormalUse> normal_uses_;
  std::vector<int> polygon_;
  LargestIndex largest_vertex_;
  LargestIndex largest_normal_;
  std::size_t unknown_ = 0;
  std::size_t first_unknown_line_ = 0;
  std::string_view first_unknown_;
};

}  // namespace

PointCloud read_obj(const InputFile& file) { return ObjReader(file).read(); }

}  // namespace taut::detail
