// NIfTI-1 (nifti1.h) and NIfTI-2 (nifti2.h): a binary header of 348 or 540 bytes, then the data. The number that tells
// the header's size tells the byte order too.

#include <cmath>

#include "io/inflate.hpp"
#include "io/volume_readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

constexpr std::size_t kHeader1 = 348;
constexpr std::size_t kHeader2 = 540;

/// What both versions say, under their common names.
struct NiftiHeader {
  std::endian order = std::endian::little;
  std::array<std::int64_t, 8> dim = {};
  std::int64_t datatype = 0;
  std::array<double, 8> pixdim = {};
  double vox_offset = 0;
  double scl_slope = 0;
  double scl_inter = 0;
  std::int64_t qform_code = 0;
  std::int64_t sform_code = 0;
  std::array<double, 3> quatern = {};  // b, c, d
  std::array<double, 3> qoffset = {};
  std::array<double, 12> srow = {};
};

/// Reads fields one after the other.
class Cursor {
 public:
  Cursor(const char* p, std::endian order) : begin_(p), p_(p), order_(order) {}
  template <class T>
  T next() {
    const T value = load_number<T>(p_, order_);
    p_ += sizeof(T);
    return value;
  }
  template <class T, class To, std::size_t N>
  void next(std::array<To, N>& values) {
    for (To& value : values) value = static_cast<To>(next<T>());
  }
  void go_to(std::size_t offset) { p_ = begin_ + offset; }

 private:
  const char* begin_;
  const char* p_;
  std::endian order_;
};

NiftiHeader parse_version_1(const char* bytes, std::endian order) {
  NiftiHeader h{.order = order};
  Cursor at(bytes, order);
  at.go_to(40);
  at.next<std::int16_t>(h.dim);
  at.go_to(70);
  h.datatype = at.next<std::int16_t>();
  at.go_to(76);
  at.next<float>(h.pixdim);
  h.vox_offset = at.next<float>();
  h.scl_slope = at.next<float>();
  h.scl_inter = at.next<float>();
  at.go_to(252);
  h.qform_code = at.next<std::int16_t>();
  h.sform_code = at.next<std::int16_t>();
  at.next<float>(h.quatern);
  at.next<float>(h.qoffset);
  at.next<float>(h.srow);
  return h;
}

NiftiHeader parse_version_2(const char* bytes, std::endian order) {
  NiftiHeader h{.order = order};
  Cursor at(bytes, order);
  at.go_to(12);
  h.datatype = at.next<std::int16_t>();
  at.go_to(16);
  at.next<std::int64_t>(h.dim);
  at.go_to(104);
  at.next<double>(h.pixdim);
  h.vox_offset = static_cast<double>(at.next<std::int64_t>());
  h.scl_slope = at.next<double>();
  h.scl_inter = at.next<double>();
  at.go_to(344);
  h.qform_code = at.next<std::int32_t>();
  h.sform_code = at.next<std::int32_t>();
  at.next<double>(h.quatern);
  at.next<double>(h.qoffset);
  at.next<double>(h.srow);
  return h;
}

NiftiHeader parse_header(const InputFile& file, std::string_view bytes) {
  if (bytes.size() < kHeader1) file.fail("the file ends inside its header; it is cut short");
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto size = static_cast<std::size_t>(load_number<std::uint32_t>(bytes.data(), order));
    const bool second = size == kHeader2;
    if (size != kHeader1 && !second) continue;
    if (bytes.size() < size) file.fail("the file ends inside its header; it is cut short");
    const std::string_view magic = bytes.substr(second ? 4 : 344, 3);
    if (magic == "ni1" || magic == "ni2") file.fail("the data lie in an .img file; convert the pair to one .nii file");
    if (magic != "n+1" && magic != "n+2") {
      file.fail("no NIfTI mark in the header; an Analyze file must be converted to NIfTI");
    }
    return second ? parse_version_2(bytes.data(), order) : parse_version_1(bytes.data(), order);
  }
  file.fail("does not start like a NIfTI file; it is damaged or of another format");
}

VoxelType voxel_type(const InputFile& file, std::int64_t datatype) {
  switch (datatype) {
    case 2: return VoxelType::uint8;
    case 4: return VoxelType::int16;
    case 8: return VoxelType::int32;
    case 16: return VoxelType::float32;
    case 64: return VoxelType::float64;
    case 256: return VoxelType::int8;
    case 512: return VoxelType::uint16;
    case 768: return VoxelType::uint32;
    case 1024: return VoxelType::int64;
    case 1280: return VoxelType::uint64;
    default:
      file.fail("datatype " + std::to_string(datatype) +
                " is not read; save whole or real numbers of up to 64 bits, one a voxel");
  }
}

/// Method 3 (sform) where there is one, else method 2 (qform, a rotation by the unit quaternion a + bi + cj + dk), else
/// the spacing alone.
void place(const NiftiHeader& h, VoxelVolume& volume) {
  if (h.sform_code > 0) {
    for (Index r = 0; r < 3; ++r) {
      for (Index c = 0; c < 3; ++c) volume.axes(r, c) = h.srow[static_cast<std::size_t>(4 * r + c)];
      volume.origin(r) = h.srow[static_cast<std::size_t>(4 * r + 3)];
    }
    return;
  }
  if (h.qform_code > 0) {
    double b = h.quatern[0];
    double c = h.quatern[1];
    double d = h.quatern[2];
    double a = 1 - (b * b + c * c + d * d);
    if (a < 1e-7) {  // the standard's own rule for a half turn
      const double length = std::sqrt(b * b + c * c + d * d);
      a = 0;
      b /= length;
      c /= length;
      d /= length;
    } else {
      a = std::sqrt(a);
    }
    volume.axes << a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c),  //
        2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b),             //
        2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c;
    for (Index r = 0; r < 3; ++r) volume.origin(r) = h.qoffset[static_cast<std::size_t>(r)];
    if (h.pixdim[0] < 0) volume.axes.col(2) *= -1;
  }
  for (Index axis = 0; axis < 3; ++axis) volume.axes.col(axis) *= h.pixdim[static_cast<std::size_t>(axis) + 1];
}

}  // namespace

VoxelVolume read_nifti(const InputFile& file) {
  const bool packed = file.bytes.starts_with("\x1F\x8B");
  const std::string start = packed ? inflate(file, file.bytes, kHeader2) : file.bytes.substr(0, kHeader2);
  const NiftiHeader h = parse_header(file, start);
  if (h.dim[0] < 3 || h.dim[0] > 7) {
    file.fail("has " + std::to_string(h.dim[0]) + " dimensions; a volume has 3");
  }
  const std::array<std::int64_t, 3> size = {h.dim[1], h.dim[2], h.dim[3]};
  const std::uint64_t count = count_voxels(file, size, "dim");
  std::int64_t num_volumes = 1;
  for (std::int64_t i = 4; i <= h.dim[0]; ++i) {
    const std::int64_t extent = h.dim[static_cast<std::size_t>(i)];
    if (extent > 1) num_volumes = extent;
  }
  if (num_volumes > 1) file.note("holds several volumes (" + std::to_string(num_volumes) + "); the first is taken");

  const VoxelType type = voxel_type(file, h.datatype);
  if (!(h.vox_offset >= 0) || h.vox_offset > static_cast<double>(std::uint64_t{1} << 40)) {
    file.fail("vox_offset is no place in the file; the header is wrong");
  }
  const auto offset = static_cast<std::size_t>(h.vox_offset);
  VoxelVolume volume;
  volume.size = to_index(size);
  place(h, volume);
  const auto decode = [&](std::string_view bytes) {
    if (offset > bytes.size()) file.fail("the file ends before its data; it is cut short");
    return decode_voxels(file, bytes.substr(offset), count, type, h.order);
  };
  if (packed) {
    constexpr std::uint64_t kMostRatio = 1032;  // of deflate
    require_bytes(file, count, type, file.bytes.size() * kMostRatio);
    volume.values = decode(inflate(file, file.bytes, offset + count * size_of(type)));
  } else {
    volume.values = decode(file.bytes);
  }
  const bool scaled = std::isfinite(h.scl_slope) && std::isfinite(h.scl_inter) && h.scl_slope != 0;
  if (scaled && (h.scl_slope != 1 || h.scl_inter != 0)) rescale(volume.values, h.scl_slope, h.scl_inter);
  return volume;
}

}  // namespace taut::detail
