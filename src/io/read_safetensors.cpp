// .safetensors: the length of a header in eight bytes, little-endian, the header in JSON, then the numbers. The header
// is an object of objects, {"name": {"dtype": "F32", "shape": [2, 3], "data_offsets": [0, 24]}, ...}, and under
// "__metadata__" texts by name; it holds no deeper structure, so that a reader of just this suffices.

#include <algorithm>
#include <bit>
#include <charconv>

#include "io/named_arrays.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

class HeaderReader {
 public:
  HeaderReader(const InputFile& file, std::string_view text) : file_(file), rest_(text) {}

  /// Is `c` next, blanks aside? Then it is taken.
  bool take(char c) {
    skip();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void require(char c) {
    if (!take(c)) fail();
  }
  std::string text() {
    require('"');
    std::string out;
    while (!rest_.starts_with('"')) {
      if (rest_.starts_with('\\')) rest_.remove_prefix(1);
      if (rest_.empty()) fail();
      out += rest_.front();
      rest_.remove_prefix(1);
    }
    rest_.remove_prefix(1);
    return out;
  }
  std::uint64_t number() {
    skip();
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) fail();
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value;
  }
  std::vector<std::uint64_t> numbers() {
    require('[');
    std::vector<std::uint64_t> list;
    if (take(']')) return list;
    do list.push_back(number());
    while (take(','));
    require(']');
    return list;
  }
  [[noreturn]] void fail() const { file_.fail("the header of the tensors is damaged"); }

 private:
  void skip() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\n' || rest_.front() == '\t'))
      rest_.remove_prefix(1);
  }
  const InputFile& file_;
  std::string_view rest_;
};

std::size_t width_of(const InputFile& file, const std::string& type) {
  if (type == "F64") return 8;
  if (type == "F32") return 4;
  if (type == "F16" || type == "BF16") return 2;
  file.fail("tensors of type " + quote(type) + " are not read; save F32 or F64");
}

double load(const std::string& type, const char* p) {
  constexpr std::endian kOrder = std::endian::little;
  if (type == "F64") return load_number<double>(p, kOrder);
  if (type == "F32") return load_number<float>(p, kOrder);
  const auto bits = load_number<std::uint16_t>(p, kOrder);
  return type == "F16" ? half_to_double(bits) : bfloat_to_double(bits);
}

void read_tensor(const InputFile& file, HeaderReader& header, const std::string& name, std::string_view data,
                 NamedArrays& out) {
  std::string type;
  NamedArrays::Array array{name, {}, {}};
  std::vector<std::uint64_t> offsets;
  header.require('{');
  do {
    const std::string key = header.text();
    header.require(':');
    if (key == "dtype") {
      type = header.text();
    } else if (key == "shape") {
      array.shape = header.numbers();
    } else if (key == "data_offsets") {
      offsets = header.numbers();
    } else {
      header.fail();
    }
  } while (header.take(','));
  header.require('}');
  const std::size_t width = width_of(file, type);
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > data.size()) {
    file.fail("the tensor " + quote(name) + " does not lie within the file; it is cut short");
  }
  const std::uint64_t count = (offsets[1] - offsets[0]) / width;
  std::uint64_t wanted = 1;
  for (const std::uint64_t extent : array.shape) wanted = extent == 0 || wanted > count / extent ? 0 : wanted * extent;
  if (wanted != count || count == 0) file.fail("the shape of the tensor " + quote(name) + " does not fit its bytes");
  array.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) array.values[i] = load(type, data.data() + offsets[0] + i * width);
  if (count == 1) out.remarks.push_back({name, std::to_string(array.values.front())});
  out.arrays.push_back(std::move(array));
}

void read_metadata(HeaderReader& header, NamedArrays& out) {
  header.require('{');
  if (header.take('}')) return;
  do {
    const std::string key = header.text();
    header.require(':');
    out.remarks.push_back({key, header.text()});
  } while (header.take(','));
  header.require('}');
}

}  // namespace

NamedArrays read_safetensors(const InputFile& file) {
  constexpr std::size_t kLength = 8;
  if (file.bytes.size() < kLength) file.fail("is cut short");
  const auto length = load_number<std::uint64_t>(file.bytes.data(), std::endian::little);
  if (length > file.bytes.size() - kLength) file.fail("is no file of tensors, or is cut short");
  HeaderReader header(file, std::string_view(file.bytes).substr(kLength, length));
  const std::string_view data = std::string_view(file.bytes).substr(kLength + length);
  NamedArrays out;
  header.require('{');
  if (header.take('}')) return out;
  do {
    const std::string name = header.text();
    header.require(':');
    if (name == "__metadata__") {
      read_metadata(header, out);
    } else {
      read_tensor(file, header, name, data, out);
    }
  } while (header.take(','));
  header.require('}');
  return out;
}

}  // namespace taut::detail
