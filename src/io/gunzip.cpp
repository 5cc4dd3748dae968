#include "io/gunzip.hpp"

#ifdef TAUT_ZLIB
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>
#include <string>
#include <utility>
#endif

namespace taut::detail {

#ifdef TAUT_ZLIB

namespace {

/// An inflating stream that is closed in the end.
class Inflater {
 public:
  Inflater() {
    constexpr int kGzipOnly = 16;
    ok_ = inflateInit2(&stream, kGzipOnly + MAX_WBITS) == Z_OK;
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream); }
  [[nodiscard]] bool ok() const { return ok_; }

  z_stream stream = {};

 private:
  bool ok_ = false;
};

}  // namespace

void gunzip(InputFile& file) {
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  Inflater inflater;
  if (!inflater.ok()) throw std::bad_alloc();
  z_stream& stream = inflater.stream;
  std::string unpacked;
  std::size_t filled = 0;
  std::size_t given = 0;  // bytes of the file handed to zlib, which counts in 32 bits
  while (true) {
    if (stream.avail_in == 0 && given < file.bytes.size()) {
      const std::size_t next = std::min<std::size_t>(file.bytes.size() - given, std::numeric_limits<int>::max());
      stream.next_in = reinterpret_cast<Bytef*>(file.bytes.data() + given);
      stream.avail_in = static_cast<uInt>(next);
      given += next;
    }
    if (unpacked.size() - filled < kChunk) unpacked.resize(std::max(2 * unpacked.size(), kChunk));
    const std::size_t room = std::min<std::size_t>(unpacked.size() - filled, kChunk);
    stream.next_out = reinterpret_cast<Bytef*>(unpacked.data() + filled);
    stream.avail_out = static_cast<uInt>(room);
    const int code = inflate(&stream, Z_NO_FLUSH);
    filled += room - stream.avail_out;
    file.context.check_cancelled();
    const bool more = stream.avail_in > 0 || given < file.bytes.size();
    if (code == Z_STREAM_END) {
      if (!more) break;
      inflateReset(&stream);  // what follows is another member
    } else if (code == Z_BUF_ERROR && !more) {
      file.fail("the compressed data end too early; the file is cut short");
    } else if (code != Z_OK && code != Z_BUF_ERROR) {
      file.fail("is no gzip file, or a damaged one; unpack it with gunzip to see");
    }
  }
  unpacked.resize(filled);
  if (unpacked.empty()) file.fail("is empty once unpacked; check how it was written");
  file.bytes = std::move(unpacked);
}

#else

void gunzip(InputFile& file) { file.fail("compressed files are not read by this build; unpack it first"); }

#endif

}  // namespace taut::detail
