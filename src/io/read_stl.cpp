// STL, text or binary: triangles without shared corners, which are welded here.

#include <array>
#include <bit>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "io/readers.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

/// Gives corners with the very same coordinates one index.
class Welder {
 public:
  explicit Welder(const InputFile& file, std::size_t expected = 0) : file_(file) { indices_.reserve(expected); }

  int index_of(const std::array<double, 3>& corner) {
    Key key;
    for (std::size_t i = 0; i < 3; ++i) key[i] = std::bit_cast<std::uint64_t>(corner[i] + 0.0);  // -0 becomes 0
    const auto [entry, is_new] = indices_.try_emplace(key, static_cast<int>(indices_.size()));
    if (is_new) coordinates_.insert(coordinates_.end(), corner.begin(), corner.end());
    return entry->second;
  }

  void add_triangle(const std::array<std::array<double, 3>, 3>& triangle) {
    const std::array<int, 3> t = {index_of(triangle[0]), index_of(triangle[1]), index_of(triangle[2])};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++degenerate_;
    } else {
      corners_.insert(corners_.end(), t.begin(), t.end());
    }
  }

  [[nodiscard]] PointCloud cloud() const {
    if (degenerate_ > 0) file_.note(counted(degenerate_, "triangle") + " with two equal corners left out");
    PointCloud result;
    result.points = to_points(coordinates_, 3);
    result.faces = to_faces(corners_);
    return result;
  }

 private:
  using Key = std::array<std::uint64_t, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      std::uint64_t h = 0;
      for (const std::uint64_t k : key) {
        h = (h ^ k) * 0x9E3779B97F4A7C15ULL;
        h ^= h >> 29;
      }
      return h;
    }
  };

  const InputFile& file_;
  std::unordered_map<Key, int, Hash> indices_;
  std::vector<double> coordinates_;
  std::vector<int> corners_;
  std::size_t degenerate_ = 0;
};

constexpr std::size_t kBinaryHeader = 84;
constexpr std::size_t kBinaryTriangle = 50;

std::uint32_t load_u32(const char* p) {
  std::uint32_t v = 0;
  for (int i = 3; i >= 0; --i) v = v << 8 | static_cast<unsigned char>(p[i]);
  return v;
}

PointCloud read_binary(const InputFile& file) {
  const std::uint32_t count = load_u32(file.bytes.data() + 80);
  Welder welder(file, count / 2);  // a closed mesh has half as many vertices as triangles
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t offset = kBinaryHeader + t * kBinaryTriangle + 12;  // after the facet normal
    std::array<std::array<double, 3>, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = offset + 12 * c + 4 * i;
        const float value = std::bit_cast<float>(load_u32(file.bytes.data() + at));
        if (!std::isfinite(value)) {
          file.fail_at_byte(at, "triangle " + std::to_string(t) +
                                    " (from 0): " + coordinate_name(static_cast<Index>(i)) + " is " +
                                    (std::isnan(value) ? "nan" : "infinite") + "; remove the triangle");
        }
        triangle[c][i] = static_cast<double>(value);
      }
    }
    welder.add_triangle(triangle);
  }
  return welder.cloud();
}

PointCloud read_ascii(InputFile file) {
  normalise_text(file);
  TextReader reader(file, 0);
  Welder welder(file);
  std::array<std::array<double, 3>, 3> triangle = {};
  std::size_t corners = 0;
  bool inside = false;  // a solid
  while (reader.next_line()) {
    std::string keyword = lower(reader.word());
    if (keyword == "end") keyword += lower(reader.word());  // some write "end loop"
    if (keyword == "vertex") {
      if (corners == 3) reader.fail("a fourth vertex in one facet; STL holds triangles only, triangulate the mesh");
      for (std::size_t i = 0; i < 3; ++i)
        triangle[corners][i] = reader.coordinate(coordinate_name(static_cast<Index>(i)));
      ++corners;
    } else if (keyword == "endloop" || keyword == "endfacet") {
      if (keyword == "endloop" && corners != 3) {
        reader.fail("a facet with " + counted(corners, "vertex") + " instead of three; correct it");
      }
      if (corners == 3) welder.add_triangle(triangle);
      corners = 0;
    } else if (keyword == "solid" || keyword == "endsolid") {
      inside = keyword == "solid";
    } else if (keyword != "facet" && keyword != "outer") {
      reader.fail(quote(keyword) + " is no STL keyword; the file is damaged or no STL file");
    }
  }
  if (inside) file.fail("the file ends without 'endsolid'; it is cut short");
  return welder.cloud();
}

}  // namespace

PointCloud read_stl(const InputFile& file) {
  const std::string_view bytes = file.bytes;
  const bool has_header = bytes.size() >= kBinaryHeader;
  const std::uint64_t count = has_header ? load_u32(bytes.data() + 80) : 0;
  // Many binary files begin with "solid" too, so the size decides.
  if (has_header && bytes.size() == kBinaryHeader + count * kBinaryTriangle) return read_binary(file);
  const auto first = bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (first != std::string_view::npos && lower(bytes.substr(first, 5)) == "solid" &&
      bytes.find('\0') == std::string_view::npos) {
    return read_ascii(file);
  }
  if (!has_header) file.fail("is neither text STL ('solid ...') nor long enough for a binary one; check the file");
  file.fail_at_byte(80, "announces " + counted(count, "triangle") + ", " +
                            std::to_string(kBinaryHeader + count * kBinaryTriangle) +
                            " bytes in all, but the file has " + std::to_string(bytes.size()) +
                            "; it is cut short, damaged or no STL file");
}

}  // namespace taut::detail
