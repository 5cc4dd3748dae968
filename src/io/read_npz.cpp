// NumPy's .npz: a ZIP archive of .npy files, stored or deflated. The central directory at the end of the file lists
// them; archives beyond 4 GB (ZIP64) are refused.

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/inflate.hpp"
#include "io/named_arrays.hpp"
#include "io/npy_header.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 32;  // of one array, unpacked

/// Little-endian numbers at a place of the file, which must be within it.
class ZipBytes {
 public:
  explicit ZipBytes(const InputFile& file) : file_(file) {}
  [[nodiscard]] std::uint32_t u16(std::size_t at) const { return number(at, 2); }
  [[nodiscard]] std::uint32_t u32(std::size_t at) const { return number(at, 4); }
  [[nodiscard]] std::string_view part(std::size_t at, std::size_t size) const {
    if (at > file_.bytes.size() || size > file_.bytes.size() - at) file_.fail("the archive is cut short or damaged");
    return std::string_view(file_.bytes).substr(at, size);
  }

 private:
  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    const std::string_view bytes = part(at, size);
    for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
    return value;
  }
  const InputFile& file_;
};

double load_any(const InputFile& file, std::string_view code, const char* p, std::endian order) {
  if (code == "f8") return load_number<double>(p, order);
  if (code == "f4") return load_number<float>(p, order);
  if (code == "f2") return half_to_double(load_number<std::uint16_t>(p, order));
  if (code == "i8") return static_cast<double>(load_number<std::int64_t>(p, order));
  if (code == "i4") return load_number<std::int32_t>(p, order);
  file.fail("numbers of type " + quote(code) + " are not read; save float32 or float64");
}

/// NumPy's text: code points of four bytes.
std::string text_of(std::string_view bytes, std::endian order) {
  std::string text;
  for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
    const auto code = load_number<std::uint32_t>(bytes.data() + at, order);
    if (code > 0 && code < 128) text += static_cast<char>(code);
  }
  return text;
}

void read_member(const InputFile& member, const std::string& name, NamedArrays& out) {
  const NpyHeader header = parse_npy_header(member);
  const std::endian order = header.descr.starts_with('>') ? std::endian::big : std::endian::little;
  const std::string_view code = std::string_view(header.descr).substr(std::min<std::size_t>(1, header.descr.size()));
  const std::string_view data = std::string_view(member.bytes).substr(header.data_offset);
  if (code.starts_with('U')) {
    out.remarks.push_back({name, text_of(data, order)});
    return;
  }
  constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
  std::uint64_t count = 1;
  for (const std::uint64_t extent : header.shape) {
    if (extent == 0 || extent > kMost / count) member.fail("an array has an impossible shape; the file is damaged");
    count *= extent;
  }
  const std::size_t width =
      code.size() == 2 && code[1] >= '1' && code[1] <= '9' ? static_cast<std::size_t>(code[1] - '0') : 8;
  if (count > data.size() / width) member.fail("an array is cut short; get the file again");
  NamedArrays::Array array{name, header.shape, std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) array.values[i] = load_any(member, code, data.data() + i * width, order);
  if (header.fortran_order && header.shape.size() == 2) {
    const std::vector<double> columns = array.values;
    const std::size_t rows = header.shape[0];
    for (std::size_t i = 0; i < count; ++i) {
      array.values[(i % rows) * header.shape[1] + i / rows] = columns[i];
    }
  }
  if (count == 1) out.remarks.push_back({name, std::to_string(array.values.front())});
  out.arrays.push_back(std::move(array));
}

}  // namespace

double half_to_double(std::uint16_t bits) {
  const int exponent = bits >> 10 & 0x1F;
  const int fraction = bits & 0x3FF;
  double size = 0;
  if (exponent == 0x1F) {
    size = fraction == 0 ? HUGE_VAL : std::nan("");
  } else {
    size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  }
  return (bits & 0x8000) != 0 ? -size : size;
}

double bfloat_to_double(std::uint16_t bits) { return std::bit_cast<float>(std::uint32_t{bits} << 16); }

NamedArrays read_npz(const InputFile& file) {
  constexpr std::size_t kEndSize = 22;
  constexpr std::size_t kLongestRemark = 65535;
  constexpr std::string_view kEnd = "PK\x05\x06";
  constexpr std::string_view kEntry = "PK\x01\x02";
  const ZipBytes zip(file);
  const std::string_view bytes = file.bytes;
  const std::size_t from = bytes.size() > kEndSize + kLongestRemark ? bytes.size() - kEndSize - kLongestRemark : 0;
  const std::size_t end = bytes.rfind(kEnd);
  if (!bytes.starts_with("PK") || end == bytes.npos || end < from) {
    file.fail("is no ZIP archive, or is cut short; write it with numpy.savez");
  }
  const std::uint32_t count = zip.u16(end + 10);
  std::size_t at = zip.u32(end + 16);
  NamedArrays out;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (zip.part(at, kEntry.size()) != kEntry) file.fail("the archive's list of files is damaged");
    const std::uint32_t method = zip.u16(at + 10);
    const std::size_t packed = zip.u32(at + 20);
    const std::size_t size = zip.u32(at + 24);
    const std::size_t name_size = zip.u16(at + 28);
    const std::size_t local = zip.u32(at + 42);
    std::string name(zip.part(at + 46, name_size));
    at += 46 + name_size + zip.u16(at + 30) + zip.u16(at + 32);
    if (!name.ends_with(".npy")) continue;
    name.resize(name.size() - 4);
    if (packed == 0xFFFFFFFF || size == 0xFFFFFFFF || local == 0xFFFFFFFF || size > kMostBytes) {
      file.fail("the array " + quote(name) + " is larger than 4 GB");
    }
    const std::size_t data = local + 30 + zip.u16(local + 26) + zip.u16(local + 28);
    const std::string_view stored = zip.part(data, packed);
    if (method != 0 && method != 8) file.fail("the array " + quote(name) + " is packed in a way that is not read");
    InputFile member{file.path + ": " + name, {}, file.context};
    member.bytes = method == 0 ? std::string(stored) : inflate_raw(file, stored, size);
    read_member(member, name, out);
  }
  return out;
}

}  // namespace taut::detail
