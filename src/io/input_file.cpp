#include "io/input_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <system_error>

namespace taut::detail {
namespace {

struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error) { return std::generic_category().message(error); }

/// Appends everything that is left in `handle`. A pipe has no size, so it arrives in chunks.
void read_all(std::FILE* handle, std::size_t expected, InputFile& file) {
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  std::string& bytes = file.bytes;
  std::size_t filled = 0;
  bytes.resize(expected > 0 ? expected + 1 : kChunk);  // one byte more: the read that meets the end
  while (true) {
    file.context.check_cancelled();
    const std::size_t got = std::fread(bytes.data() + filled, 1, bytes.size() - filled, handle);
    filled += got;
    if (std::ferror(handle) != 0) file.fail("cannot be read (" + reason(errno) + "); check the disk or copy the file");
    if (filled < bytes.size()) break;
    bytes.resize(bytes.size() * 2);
  }
  bytes.resize(filled);
}

}  // namespace

void fail_to_open(const std::string& path, int error) {
  if (error == ENOENT) throw IoError(path, "no such file; check the name and the folder");
  if (error == EACCES) throw IoError(path, "no permission to read it; change its mode or copy it");
  throw IoError(path, "cannot be opened (" + reason(error) + "); check the name");
}

InputFile read_file(const std::filesystem::path& path, const Context& context) {
  InputFile file{path.string(), {}, context};
  if (file.path.empty()) throw IoError("''", "the file name is empty; give a file");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) file.fail("is a folder, not a file; name a file inside it");

  errno = 0;
  const FileHandle handle(std::fopen(file.path.c_str(), "rb"));
  if (!handle) fail_to_open(file.path, errno);
  std::size_t expected = 0;
  if (std::filesystem::is_regular_file(path, ignored)) {
    const auto size = std::filesystem::file_size(path, ignored);
    if (!ignored) expected = static_cast<std::size_t>(size);
  }
  try {
    read_all(handle.get(), expected, file);
  } catch (const std::bad_alloc&) {
    file.fail("does not fit into memory; split it or thin it");
  }
  if (file.bytes.empty()) file.fail("the file is empty; check how it was written");
  return file;
}

void normalise_text(InputFile& file) {
  std::string& text = file.bytes;
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    file.fail("UTF-16 text; save it as UTF-8 or plain ASCII");
  }
  if (const auto zero = text.find('\0'); zero != std::string::npos) {
    file.fail_at_byte(zero, "binary data where text is expected; check that the extension fits the format");
  }
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
}

std::string_view recognise(std::string_view bytes) {
  struct Magic {
    std::string_view start;
    std::string_view kind;
  };
  using namespace std::string_view_literals;
  static constexpr std::array kMagics = {
      Magic{"ply\n"sv, "a PLY file"},
      Magic{"ply\r"sv, "a PLY file"},
      Magic{"\x93NUMPY"sv, "a NumPy array"},
      Magic{"# .PCD"sv, "a PCD file"},
      Magic{"LASF"sv, "a LAS file"},
      Magic{"OFF\n"sv, "an OFF file"},
      Magic{"OFF\r"sv, "an OFF file"},
      Magic{"OFF "sv, "an OFF file"},
      Magic{"solid "sv, "an STL file"},
      Magic{"# vtk DataFile"sv, "a legacy VTK file"},
      Magic{"NRRD000"sv, "an NRRD volume"},
      Magic{"#INRIMAGE"sv, "an INRIMAGE volume"},
      Magic{"\x1F\x8B"sv, "a gzip-compressed file"},
      Magic{"BZh"sv, "a bzip2-compressed file"},
      Magic{"\xFD"
            "7zXZ"sv,
            "an xz-compressed file"},
      Magic{"PK\x03\x04"sv, "a ZIP archive"},
      Magic{"\x89PNG"sv, "a PNG image"},
      Magic{"\xFF\xD8\xFF"sv, "a JPEG image"},
      Magic{"%PDF"sv, "a PDF document"},
      Magic{"glTF"sv, "a binary glTF file"},
      Magic{"\x89HDF"sv, "an HDF5 file"},
      Magic{"\x7F"
            "ELF"sv,
            "a program"},
      Magic{"<?xml"sv, "an XML file"},
      Magic{"<!DOCTYPE"sv, "a web page"},
      Magic{"<html"sv, "a web page"},
      Magic{"version https://git-lfs"sv, "a Git LFS pointer, not the file itself"},
  };
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  for (const Magic& magic : kMagics) {
    if (bytes.starts_with(magic.start)) return magic.kind;
  }
  return {};
}

std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "'";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      out += c;
    } else {
      out += "\\x";
      out += kHex[byte >> 4];
      out += kHex[byte & 15];
    }
  }
  if (text.size() > kLongest) out += "...";
  return out + "'";
}

std::string counted(std::size_t n, std::string_view noun) {
  std::string out = std::to_string(n) + " ";
  if (n == 1) return out.append(noun);
  if (noun == "vertex") return out + "vertices";
  if (noun.ends_with("y")) return out.append(noun.substr(0, noun.size() - 1)) + "ies";
  return out.append(noun) + "s";
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::string lower_extension(const std::filesystem::path& path) { return lower(path.extension().string()); }

}  // namespace taut::detail
