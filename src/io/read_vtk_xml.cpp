// VTK's XML files (VTK File Formats, "XML File Formats"): the points of PolyData (.vtp) and UnstructuredGrid (.vtu),
// the polygons of the former, and point normals. Arrays stand as text, inline in base64, or appended (raw or base64),
// plain or packed by zlib in blocks.

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <string_view>

#include "io/inflate.hpp"
#include "io/readers.hpp"
#include "io/text_reader.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

/// A start tag, without its angle brackets: `name key="value" ...`.
struct Tag {
  std::string_view name;
  std::string_view attributes;
  std::size_t end = 0;  // the byte after it
  [[nodiscard]] bool is_empty() const { return attributes.ends_with('/'); }

  [[nodiscard]] std::optional<std::string_view> find(std::string_view key) const {
    for (std::size_t at = 0; (at = attributes.find(key, at)) != std::string_view::npos; at += key.size()) {
      const bool begins = at > 0 && is_space(attributes[at - 1]);
      std::size_t p = at + key.size();
      if (!begins || p + 1 >= attributes.size() || attributes[p] != '=') continue;
      const char quote = attributes[++p];
      const std::size_t close = attributes.find(quote, p + 1);
      if ((quote != '"' && quote != '\'') || close == std::string_view::npos) return std::nullopt;
      return attributes.substr(p + 1, close - p - 1);
    }
    return std::nullopt;
  }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
};

/// The next start tag at or after byte `from`; none before the appended data, or when there is no more.
std::optional<Tag> next_tag(std::string_view text, std::size_t from) {
  while (true) {
    const std::size_t open = text.find('<', from);
    if (open == std::string_view::npos) return std::nullopt;
    const std::size_t close = text.find('>', open);
    if (close == std::string_view::npos) return std::nullopt;
    from = close + 1;
    const char first = text[open + 1];
    if (first == '/' || first == '?' || first == '!') continue;
    std::string_view inside = text.substr(open + 1, close - open - 1);
    std::size_t length = 0;
    while (length < inside.size() && !Tag::is_space(inside[length]) && inside[length] != '/') ++length;
    return Tag{inside.substr(0, length), inside.substr(length), close + 1};
  }
}

/// Up to `most` bytes of base64 text; stops at the first byte that is none, and at padding.
std::string decode_base64(std::string_view text, std::size_t most) {
  std::string bytes;
  std::uint32_t group = 0;
  int filled = 0;
  for (const char c : text) {
    if (bytes.size() >= most) break;
    if (Tag::is_space(c)) continue;
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z') {
      digit = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      digit = static_cast<std::uint32_t>(c - 'a') + 26;
    } else if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0') + 52;
    } else if (c == '+' || c == '/') {
      digit = c == '+' ? 62 : 63;
    } else {
      break;
    }
    group = group << 6 | digit;
    filled += 6;
    if (filled >= 8) {
      filled -= 8;
      bytes += static_cast<char>(group >> filled & 0xFFU);
    }
  }
  return bytes;
}

/// Bytes of text that hold `n` bytes in base64, padded.
std::size_t base64_size(std::size_t n) { return (n + 2) / 3 * 4; }

class VtkXml {
 public:
  explicit VtkXml(const InputFile& file) : file_(file), text_(file.bytes) {
    const std::size_t start = text_.find("<VTKFile");
    const std::optional<Tag> root = start == std::string_view::npos ? std::nullopt : next_tag(text_, start);
    if (!root) file.fail("has no VTKFile element; the file is damaged or of another kind");
    kind_ = root->find("type").value_or("");
    if (kind_ != "PolyData" && kind_ != "UnstructuredGrid") {
      file.fail("its type is " + quote(kind_) + "; points are read from PolyData (.vtp) and UnstructuredGrid (.vtu)");
    }
    order_ = root->find("byte_order").value_or("LittleEndian") == "BigEndian" ? std::endian::big : std::endian::little;
    wide_ = root->find("header_type").value_or("UInt32") == "UInt64";
    const std::string_view compressor = root->find("compressor").value_or("");
    packed_ = !compressor.empty();
    if (packed_ && compressor != "vtkZLibDataCompressor") {
      file.fail("is packed by " + quote(compressor) + "; save it plain or with zlib");
    }
    begin_ = root->end;
    const std::size_t appended = text_.find("<AppendedData");
    if (appended != std::string_view::npos) {
      const std::optional<Tag> tag = next_tag(text_, appended);
      if (!tag) file.fail("the file ends inside AppendedData; it is cut short");
      appended_is_raw_ = tag->find("encoding").value_or("base64") == "raw";
      const std::size_t mark = text_.find('_', tag->end);
      if (mark == std::string_view::npos) file.fail("AppendedData has no '_'; the file is damaged");
      appended_ = mark + 1;
      end_ = appended;
    } else {
      end_ = text_.size();
    }
  }

  [[nodiscard]] PointCloud cloud() {
    PointCloud cloud;
    std::vector<double> points;
    std::vector<double> normals;
    std::vector<int> corners;
    std::uint64_t piece_points = 0;
    std::uint64_t piece_polygons = 0;
    std::string_view section;
    std::string_view normals_name;
    std::vector<double> connectivity;
    const std::string_view head = text_.substr(0, end_);
    std::size_t at = begin_;
    while (const std::optional<Tag> tag = next_tag(head, at)) {
      at = tag->end;
      if (tag->name == "Piece") {
        piece_points = count_of(*tag, "NumberOfPoints");
        piece_polygons = tag->find("NumberOfPolys") ? count_of(*tag, "NumberOfPolys") : 0;
        piece_begin_ = points.size() / 3;
      } else if (tag->name != "DataArray") {
        section = tag->name;
        if (section == "PointData") normals_name = tag->find("Normals").value_or("Normals");
      } else if (section == "Points") {
        append(points, array(*tag, 3 * piece_points, "Points"));
      } else if (section == "PointData" && tag->find("Name") == normals_name &&
                 tag->find("NumberOfComponents") == "3") {
        append(normals, array(*tag, 3 * piece_points, "Normals"));
      } else if (section == "Polys" && tag->find("Name") == "connectivity" && piece_polygons > 0) {
        connectivity = array(*tag, std::nullopt, "connectivity");
      } else if (section == "Polys" && tag->find("Name") == "offsets" && piece_polygons > 0) {
        append_polygons(connectivity, array(*tag, piece_polygons, "offsets"), piece_points, corners);
      }
    }
    cloud.points = to_points(points, 3);
    if (normals.size() == points.size()) cloud.normals = to_points(normals, 3);
    cloud.faces = to_faces(corners);
    return cloud;
  }

 private:
  static void append(std::vector<double>& all, const std::vector<double>& more) {
    all.insert(all.end(), more.begin(), more.end());
  }

  [[nodiscard]] std::uint64_t count_of(const Tag& tag, std::string_view key) const {
    const std::optional<std::uint64_t> count = whole(tag.find(key).value_or(""));
    if (!count || *count > kMostPoints) file_.fail("Piece has an impossible " + std::string(key) + "; correct it");
    return *count;
  }
  static std::optional<std::uint64_t> whole(std::string_view text) {
    if (text.empty() || text.size() > 18) return std::nullopt;
    std::uint64_t value = 0;
    for (const char c : text) {
      if (c < '0' || c > '9') return std::nullopt;
      value = 10 * value + static_cast<std::uint64_t>(c - '0');
    }
    return value;
  }

  [[nodiscard]] std::uint64_t header_entry(std::string_view bytes, std::size_t i) const {
    return wide_ ? load_number<std::uint64_t>(bytes.data() + 8 * i, order_)
                 : load_number<std::uint32_t>(bytes.data() + 4 * i, order_);
  }

  /// The bytes of an array whose header starts at byte `at`; `raw` or base64.
  [[nodiscard]] std::string bytes_at(std::size_t at, bool raw, const std::string& what) const {
    const std::string_view rest = text_.substr(std::min(at, text_.size()));
    const std::size_t entry = wide_ ? 8 : 4;
    const auto cut_short = [&]() { file_.fail(what + ": the file ends inside its data; it is cut short"); };
    const auto take = [&](std::size_t from, std::size_t size) {
      if (raw) return std::string(rest.substr(std::min(from, rest.size()), size));
      return decode_base64(rest.substr(std::min(from, rest.size())), size);
    };
    if (!packed_) {
      const std::string head = take(0, entry);
      if (head.size() < entry) cut_short();
      const std::uint64_t size = header_entry(head, 0);
      if (size > rest.size()) cut_short();
      // Size and data are one stream in base64.
      std::string bytes = take(0, entry + size);
      if (bytes.size() < entry + size) cut_short();
      return bytes.substr(entry);
    }
    const std::string count = take(0, entry);
    if (count.size() < entry) cut_short();
    const std::uint64_t num_blocks = header_entry(count, 0);
    if (num_blocks > rest.size() / entry) cut_short();
    const std::size_t head_size = (3 + num_blocks) * entry;
    const std::string head = take(0, head_size);
    if (head.size() < head_size) cut_short();
    const std::uint64_t block_size = header_entry(head, 1);
    const std::uint64_t last_size = header_entry(head, 2);
    const std::size_t first = raw ? head_size : base64_size(head_size);
    std::uint64_t packed_size = 0;
    for (std::size_t b = 0; b < num_blocks; ++b) {
      const std::uint64_t size = header_entry(head, 3 + b);
      if (size > rest.size()) cut_short();
      packed_size += size;
    }
    if (packed_size > rest.size()) cut_short();
    const std::string packed = take(first, packed_size);
    if (packed.size() < packed_size) cut_short();
    std::string bytes;
    std::size_t from = 0;
    for (std::size_t b = 0; b < num_blocks; ++b) {
      const std::uint64_t size = header_entry(head, 3 + b);
      const bool partial = b + 1 == num_blocks && last_size > 0;
      const std::uint64_t wanted = partial ? last_size : block_size;
      const std::string block = inflate(file_, std::string_view(packed).substr(from, size), wanted);
      if (block.size() != wanted) file_.fail(what + ": a packed block is damaged; write the file again");
      bytes += block;
      from += size;
    }
    return bytes;
  }

  [[nodiscard]] std::vector<double> array(const Tag& tag, std::optional<std::uint64_t> wanted,
                                          const std::string& what) const {
    const std::string_view format = tag.find("format").value_or("ascii");
    std::vector<double> values;
    if (format == "ascii") {
      values = from_text(tag, what);
    } else if (format == "binary") {
      std::size_t at = tag.end;
      while (at < text_.size() && Tag::is_space(text_[at])) ++at;
      values = from_bytes(bytes_at(at, false, what), tag.find("type").value_or(""), what);
    } else {
      const std::optional<std::uint64_t> offset = whole(tag.find("offset").value_or(""));
      if (format != "appended" || !offset || appended_ == 0 || *offset > text_.size()) {
        file_.fail(what + ": its data are not where the file says; it is damaged");
      }
      values = from_bytes(bytes_at(appended_ + *offset, appended_is_raw_, what), tag.find("type").value_or(""), what);
    }
    if (wanted && values.size() != *wanted) {
      file_.fail(what + " has " + counted(values.size(), "number") + " where " + std::to_string(*wanted) +
                 " are needed; the file is cut short or its counts are wrong");
    }
    return values;
  }

  [[nodiscard]] std::vector<double> from_text(const Tag& tag, const std::string& what) const {
    const std::size_t close = text_.find('<', tag.end);
    if (close == std::string_view::npos) file_.fail(what + ": the file ends inside its data; it is cut short");
    const char* p = text_.data() + tag.end;
    const char* const end = text_.data() + close;
    std::vector<double> values;
    while (true) {
      while (p < end && (is_blank(*p) || *p == '\n')) ++p;
      if (p >= end) return values;
      double value = 0;
      if (parse_number(p, end, value) != NumberProblem::none) file_.fail(what + " holds what is no number; correct it");
      values.push_back(value);
    }
  }

  template <class T>
  [[nodiscard]] std::vector<double> convert(std::string_view bytes) const {
    std::vector<double> values(bytes.size() / sizeof(T));
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<double>(load_number<T>(bytes.data() + i * sizeof(T), order_));
    }
    return values;
  }
  [[nodiscard]] std::vector<double> from_bytes(std::string_view bytes, std::string_view type,
                                               const std::string& what) const {
    if (type == "Float32") return convert<float>(bytes);
    if (type == "Float64") return convert<double>(bytes);
    if (type == "Int64") return convert<std::int64_t>(bytes);
    if (type == "UInt64") return convert<std::uint64_t>(bytes);
    if (type == "Int32") return convert<std::int32_t>(bytes);
    if (type == "UInt32") return convert<std::uint32_t>(bytes);
    if (type == "Int16") return convert<std::int16_t>(bytes);
    if (type == "UInt16") return convert<std::uint16_t>(bytes);
    if (type == "Int8") return convert<std::int8_t>(bytes);
    if (type == "UInt8") return convert<std::uint8_t>(bytes);
    file_.fail(what + " of type " + quote(type) + " are not read; save Float32 or Float64");
  }

  void append_polygons(const std::vector<double>& connectivity, const std::vector<double>& ends,
                       std::uint64_t num_points, std::vector<int>& corners) const {
    std::vector<int> polygon;
    double begin = 0;
    for (const double end : ends) {
      if (!(end >= begin && end <= static_cast<double>(connectivity.size()))) {
        file_.fail("Polys: the offsets are out of order; the file is damaged");
      }
      polygon.clear();
      for (auto at = static_cast<std::size_t>(begin); at < static_cast<std::size_t>(end); ++at) {
        if (!(connectivity[at] >= 0 && connectivity[at] < static_cast<double>(num_points))) {
          file_.fail("Polys: a corner is out of range (there are " + counted(num_points, "point") + ", from 0)");
        }
        polygon.push_back(static_cast<int>(connectivity[at] + static_cast<double>(piece_begin_)));
      }
      append_fan(polygon, corners);
      begin = end;
    }
  }

  const InputFile& file_;
  std::string_view text_;
  std::string_view kind_;
  std::endian order_ = std::endian::little;
  bool wide_ = false;    // headers of arrays are 64-bit numbers
  bool packed_ = false;  // by zlib
  std::size_t begin_ = 0;
  std::size_t end_ = 0;       // of the elements
  std::size_t appended_ = 0;  // first byte behind '_', 0 = there are none
  bool appended_is_raw_ = false;
  std::size_t piece_begin_ = 0;  // points before this piece
};

}  // namespace

PointCloud read_vtk_xml(const InputFile& file) { return VtkXml(file).cloud(); }

}  // namespace taut::detail
