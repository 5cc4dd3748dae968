#include "io/inflate.hpp"

#include <algorithm>

#ifdef TAUT_ZLIB
#include <zlib.h>
#endif

namespace taut::detail {

#ifdef TAUT_ZLIB
namespace {

/// Deflate packs no better than 1032 to 1.
constexpr std::size_t kMostRatio = 1032;
constexpr std::size_t kPiece = std::size_t{1} << 22;
constexpr int kGzipOrZlib = 15 + 32;

struct Stream : z_stream {
  Stream() : z_stream() {}
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  ~Stream() { inflateEnd(this); }
};

}  // namespace

std::string inflate(const InputFile& file, std::string_view packed, std::size_t most) {
  Stream stream;
  if (inflateInit2(&stream, kGzipOrZlib) != Z_OK) file.fail("zlib cannot start; free some memory");
  std::string bytes;
  bytes.resize(packed.size() < most / kMostRatio ? packed.size() * kMostRatio : most);
  std::size_t filled = 0;
  std::size_t used = 0;
  while (filled < bytes.size() && used < packed.size()) {
    file.context.check_cancelled();
    const std::size_t in = std::min(packed.size() - used, kPiece);
    const std::size_t out = std::min(bytes.size() - filled, kPiece);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + used));
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data() + filled);
    stream.avail_out = static_cast<uInt>(out);
    const int state = ::inflate(&stream, Z_NO_FLUSH);
    if (stream.avail_in == in && stream.avail_out == out) break;  // nothing moves any more
    used += in - stream.avail_in;
    filled += out - stream.avail_out;
    if (state == Z_STREAM_END) {
      // gzip files may be several, one after the other; anything else behind the first is no concern here.
      if (used == packed.size() || static_cast<unsigned char>(packed[used]) != 0x1F) break;
      if (inflateReset(&stream) != Z_OK) break;
    } else if (state != Z_OK && state != Z_BUF_ERROR) {
      file.fail("the compressed data are damaged after " + counted(filled, "unpacked byte") + "; get the file again");
    }
  }
  bytes.resize(filled);
  return bytes;
}
#else
std::string inflate(const InputFile& file, std::string_view, std::size_t) {
  file.fail("is compressed, and this Taut was built without zlib; unpack it first");
}
#endif

}  // namespace taut::detail
