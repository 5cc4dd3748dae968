#include "io/inflate.hpp"

#ifdef TAUT_ZLIB
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <utility>
#endif

namespace taut::detail {

#ifdef TAUT_ZLIB
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 22;
constexpr int kGzipOrZlib = 15 + 32;
constexpr int kRaw = -15;

struct Stream : z_stream {
  Stream() : z_stream() {}
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() { inflateEnd(this); }
};

struct Unpacked {
  std::string bytes;
  bool complete = false;  // the data's own end was met
};

Unpacked unpack(const InputFile& file, std::string_view packed, std::size_t most, int format = kGzipOrZlib) {
  Stream stream;
  if (inflateInit2(&stream, format) != Z_OK) file.fail("zlib cannot start; free some memory");
  Unpacked result;
  std::string& bytes = result.bytes;
  std::size_t filled = 0;
  std::size_t used = 0;
  while (filled < most) {
    file.context.check_cancelled();
    if (filled == bytes.size()) bytes.resize(std::min(most, std::max(2 * filled, kPiece)));
    const std::size_t in = std::min(packed.size() - used, kPiece);
    const std::size_t out = std::min(bytes.size() - filled, kPiece);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + filled);
    stream.avail_out = static_cast<uInt>(out);
    const int state = ::inflate(&stream, Z_NO_FLUSH);
    const bool moved = stream.avail_in < in || stream.avail_out < out;
    if (!moved && (state == Z_OK || state == Z_BUF_ERROR)) break;  // there is no more
    used += in - stream.avail_in;
    filled += out - stream.avail_out;
    result.complete = state == Z_STREAM_END;
    if (state == Z_STREAM_END) {
      // gzip files may be several, one after the other; anything else behind the first is no concern here.
      if (used == packed.size() || static_cast<unsigned char>(packed[used]) != 0x1F) break;
      if (inflateReset(&stream) != Z_OK) break;
    } else if (state != Z_OK && state != Z_BUF_ERROR) {
      file.fail("the compressed data are damaged after " + counted(filled, "unpacked byte") + "; get the file again");
    }
  }
  bytes.resize(filled);
  return result;
}

}  // namespace

std::string inflate(const InputFile& file, std::string_view packed, std::size_t most) {
  return unpack(file, packed, most).bytes;
}

std::string inflate_raw(const InputFile& file, std::string_view packed, std::size_t size) {
  std::string bytes = unpack(file, packed, size, kRaw).bytes;
  if (bytes.size() != size) file.fail("the compressed data end too early; the file is cut short");
  return bytes;
}

void gunzip(InputFile& file) {
  Unpacked unpacked = unpack(file, file.bytes, std::numeric_limits<std::size_t>::max());
  if (!unpacked.complete) file.fail("the compressed data end too early; the file is cut short");
  if (unpacked.bytes.empty()) file.fail("is empty once unpacked; check how it was written");
  file.bytes = std::move(unpacked.bytes);
}
#else
std::string inflate(const InputFile& file, std::string_view, std::size_t) {
  file.fail("is compressed, and this Taut was built without zlib; unpack it first");
}
std::string inflate_raw(const InputFile& file, std::string_view packed, std::size_t size) {
  return inflate(file, packed, size);
}
void gunzip(InputFile& file) { file.bytes = inflate(file, file.bytes, 0); }
#endif

}  // namespace taut::detail
