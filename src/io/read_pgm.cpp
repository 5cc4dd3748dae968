// Netpbm's grey pictures: "P5" with raw numbers of one byte, or two (the greater first) where the largest value needs
// them; "P2" with numbers as text. The header is words with remarks from # to the end of a line, and one blank.

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "io/height_readers.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

constexpr std::int64_t kMostPixels = std::int64_t{1} << 31;
constexpr std::int64_t kLargestValue = 65535;

class PgmHeader {
 public:
  explicit PgmHeader(const InputFile& file) : file_(file) {}

  /// The next whole number; `what` stands in the error.
  std::int64_t number(std::string_view what) {
    skip_blanks();
    const char* const begin = file_.bytes.data() + at_;
    const char* const end = file_.bytes.data() + file_.bytes.size();
    std::int64_t value = 0;
    const auto [next, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || value < 0) {
      file_.fail_at_byte(at_, "the " + std::string(what) + " of a PGM picture must stand here; the file is damaged");
    }
    at_ += static_cast<std::size_t>(next - begin);
    return value;
  }
  void skip(std::size_t bytes) { at_ += bytes; }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] bool at_end() {
    skip_blanks();
    return at_ >= file_.bytes.size();
  }

 private:
  void skip_blanks() {
    for (; at_ < file_.bytes.size(); ++at_) {
      const char c = file_.bytes[at_];
      if (c == '#') {
        while (at_ + 1 < file_.bytes.size() && file_.bytes[at_ + 1] != '\n') ++at_;
      } else if (!is_blank(c) && c != '\n') {
        return;
      }
    }
  }

  const InputFile& file_;
  std::size_t at_ = 0;
};

}  // namespace

HeightField read_pgm(const InputFile& file) {
  const bool raw = file.bytes.starts_with("P5");
  if (!raw && !file.bytes.starts_with("P2")) {
    file.fail("is no grey PGM picture (it begins with neither P5 nor P2); convert it, with 16 bits where it has them");
  }
  PgmHeader header(file);
  header.skip(2);
  HeightField field;
  field.columns = static_cast<Index>(header.number("width"));
  field.rows = static_cast<Index>(header.number("height"));
  const std::int64_t largest = header.number("largest value");
  if (field.columns < 1 || field.rows < 1 || field.columns > kMostPixels / field.rows) {
    file.fail("the picture is " + std::to_string(field.columns) + " x " + std::to_string(field.rows) + " pixels");
  }
  if (largest < 1 || largest > kLargestValue) {
    file.fail("its largest value is " + std::to_string(largest) + "; PGM pictures have 1 to 65535");
  }
  const auto count = static_cast<std::size_t>(field.columns * field.rows);
  const std::size_t width = raw && largest > 255 ? 2 : 1;
  const std::size_t begin = header.at() + 1;  // one blank
  const std::size_t available = file.bytes.size() > begin ? file.bytes.size() - begin : 0;
  if (available / width < count) {  // a number as text takes more than one byte
    file.fail("holds " + counted(available, "byte") + " after its header, too few for " + counted(count, "pixel") +
              "; it is cut short");
  }
  field.heights.resize(count);
  if (!raw) {
    for (double& height : field.heights) height = static_cast<double>(header.number("pixels"));
  } else {
    const auto* p = reinterpret_cast<const unsigned char*>(file.bytes.data() + begin);
    for (std::size_t i = 0; i < count; ++i) {
      field.heights[i] = width == 1 ? p[i] : 256.0 * p[2 * i] + p[2 * i + 1];
    }
  }
  const auto beyond = std::ranges::find_if(field.heights, [&](double h) { return h > static_cast<double>(largest); });
  if (beyond != field.heights.end()) {
    file.fail("pixel " + std::to_string(beyond - field.heights.begin()) + " is " +
              std::to_string(static_cast<std::int64_t>(*beyond)) + ", but the header says that the largest value is " +
              std::to_string(largest) + "; the file is damaged");
  }
  turn_rows(field);
  return field;
}

}  // namespace taut::detail
