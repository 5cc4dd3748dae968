// Small volumes written byte by byte, each format with what makes it its own.

#include "taut/io/read_surface.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <vector>

#include "io/read_text.hpp"
#include "support/temp_folder.hpp"

namespace taut {
namespace {

using test::raw;
using test::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string packed(const std::string& bytes, bool as_gzip = true) {
  z_stream stream = {};
  deflateInit2(&stream, 6, Z_DEFLATED, as_gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string out(bytes.size() + 1024, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// Entries 0 .. 23 as numbers of type T: a volume of 2 x 3 x 4 voxels.
template <class T>
std::string counting(bool big_endian = false) {
  std::string bytes;
  for (int i = 0; i < 24; ++i) bytes += raw(static_cast<T>(i), big_endian);
  return bytes;
}

void expect_counting(const VoxelVolume& volume) {
  EXPECT_THAT(volume.size, ElementsAre(2, 3, 4));
  ASSERT_EQ(volume.values.size(), 24U);
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(volume.values[i], static_cast<float>(i));
}

VoxelVolume read_as(std::string_view name, std::string_view bytes, std::vector<std::string>* notes = nullptr) {
  const TempFolder folder;
  Context context;
  if (notes != nullptr) context.note = [notes](std::string_view note) { notes->emplace_back(note); };
  return read_volume(folder.write(name, bytes), {}, context);
}

std::string error_of(std::string_view name, std::string_view bytes) {
  try {
    static_cast<void>(read_as(name, bytes));
  } catch (const IoError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

/// A NIfTI-1 header with the fields the tests vary, as a file with the data behind it.
struct Nifti {
  bool big_endian = false;
  std::int16_t datatype = 4;
  std::array<std::int16_t, 8> dim = {3, 2, 3, 4, 1, 1, 1, 1};
  std::array<float, 8> pixdim = {1, 2, 3, 4, 0, 0, 0, 0};
  float slope = 0;
  float inter = 0;
  std::int16_t qform_code = 0;
  std::int16_t sform_code = 0;
  std::array<float, 6> quatern_and_offset = {};
  std::array<float, 12> srow = {};
  std::string magic = std::string("n+1\0", 4);

  [[nodiscard]] std::string header() const {
    std::string bytes(352, '\0');
    const auto put = [&](std::size_t at, const auto& value) {
      bytes.replace(at, sizeof value, raw(value, big_endian));
    };
    put(0, std::int32_t{348});
    for (std::size_t i = 0; i < 8; ++i) put(40 + 2 * i, dim[i]);
    put(70, datatype);
    for (std::size_t i = 0; i < 8; ++i) put(76 + 4 * i, pixdim[i]);
    put(108, 352.0F);
    put(112, slope);
    put(116, inter);
    put(252, qform_code);
    put(254, sform_code);
    for (std::size_t i = 0; i < 6; ++i) put(256 + 4 * i, quatern_and_offset[i]);
    for (std::size_t i = 0; i < 12; ++i) put(280 + 4 * i, srow[i]);
    bytes.replace(344, 4, magic);
    return bytes;
  }
};

TEST(ReadVolume, NiftiWithSpacingAlone) {
  for (const bool big : {false, true}) {
    const VoxelVolume volume = read_as("a.nii", Nifti{.big_endian = big}.header() + counting<std::int16_t>(big));
    expect_counting(volume);
    EXPECT_EQ(volume.axes, Eigen::Matrix3d(Eigen::Vector3d(2, 3, 4).asDiagonal()));
    EXPECT_EQ(volume.origin, Eigen::Vector3d::Zero());
  }
}

TEST(ReadVolume, NiftiPackedAndScaled) {
  Nifti header{.datatype = 16, .slope = 2, .inter = -1};
  const VoxelVolume volume = read_as("a.NII.GZ", packed(header.header() + counting<float>()));
  for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(volume.values[i], 2 * static_cast<float>(i) - 1);
}

TEST(ReadVolume, NiftiSformIsAnAffineMap) {
  Nifti header;
  header.qform_code = 1;  // the sform goes before it
  header.sform_code = 2;
  header.srow = {0, -2, 0, 10, 3, 0, 0, 20, 0, 0.5F, 4, 30};
  const VoxelVolume volume = read_as("a.nii", header.header() + counting<std::int16_t>());
  EXPECT_EQ(volume.origin, Eigen::Vector3d(10, 20, 30));
  EXPECT_EQ(volume.axes.col(0), Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(volume.axes.col(1), Eigen::Vector3d(-2, 0, 0.5));
  EXPECT_EQ(volume.axes.col(2), Eigen::Vector3d(0, 0, 4));
}

TEST(ReadVolume, NiftiQformTurnsAndMirrors) {
  Nifti header;
  header.qform_code = 1;
  header.pixdim[0] = -1;
  // A quarter turn about z: quaternion (sqrt 1/2, 0, 0, sqrt 1/2).
  header.quatern_and_offset = {0, 0, std::sqrt(0.5F), 1, 2, 3};
  const VoxelVolume volume = read_as("a.nii", header.header() + counting<std::int16_t>());
  EXPECT_TRUE(volume.axes.col(0).isApprox(Eigen::Vector3d(0, 2, 0), 1e-6));
  EXPECT_TRUE(volume.axes.col(1).isApprox(Eigen::Vector3d(-3, 0, 0), 1e-6));
  EXPECT_TRUE(volume.axes.col(2).isApprox(Eigen::Vector3d(0, 0, -4), 1e-6));
  EXPECT_EQ(volume.origin, Eigen::Vector3d(1, 2, 3));
}

TEST(ReadVolume, NiftiTakesTheFirstOfSeveral) {
  Nifti header;
  header.dim = {4, 2, 3, 4, 2, 1, 1, 1};
  std::vector<std::string> notes;
  expect_counting(read_as("a.nii", header.header() + counting<std::int16_t>() + counting<std::int16_t>(), &notes));
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("the first is taken"));
}

TEST(ReadVolume, Nifti2) {
  std::string bytes(544, '\0');
  const auto put = [&](std::size_t at, const auto& value) { bytes.replace(at, sizeof value, raw(value)); };
  put(0, std::int32_t{540});
  bytes.replace(4, 4, std::string("n+2\0", 4));
  put(12, std::int16_t{64});
  for (std::size_t i = 0; i < 4; ++i) put(16 + 8 * i, std::array<std::int64_t, 4>{3, 2, 3, 4}[i]);
  for (std::size_t i = 0; i < 4; ++i) put(104 + 8 * i, std::array<double, 4>{1, 0.1, 0.2, 0.3}[i]);
  put(168, std::int64_t{544});
  const VoxelVolume volume = read_as("a.nii", bytes + counting<double>());
  expect_counting(volume);
  EXPECT_EQ(volume.axes(2, 2), 0.3);
}

std::string nrrd(const std::string& fields, const std::string& data) {
  return "NRRD0004\n# a comment\ndimension: 3\nsizes: 2 3 4\n" + fields + "meta:=data\n\n" + data;
}

TEST(ReadVolume, NrrdEncodingsAndTypes) {
  expect_counting(read_as("a.nrrd", nrrd("type: uchar\nencoding: raw\n", counting<std::uint8_t>())));
  expect_counting(
      read_as("a.nrrd", nrrd("type: short int\nencoding: raw\nendian: big\n", counting<std::int16_t>(true))));
  expect_counting(
      read_as("a.nrrd", nrrd("type: double\nencoding: gzip\nendian: little\n", packed(counting<double>()))));
  expect_counting(read_as("a.nrrd", nrrd("type: uint64\nencoding: raw\nendian: little\n", counting<std::uint64_t>())));
  expect_counting(
      read_as("a.nrrd", nrrd("type: int\nencoding: raw\nbyte skip: 5\n", "12345" + counting<std::int32_t>())));
  expect_counting(read_as("a.nrrd", nrrd("type: float\nencoding: ascii\n",
                                         "0 1 2 3 4 5 6 7\n8 9 10 11 12 13 14 15 16 17 18 19 20 21\n22\n\n23\n")));
}

TEST(ReadVolume, NrrdPlaces) {
  const std::string data = counting<std::uint8_t>();
  const VoxelVolume oblique =
      read_as("a.nrrd", nrrd("type: uint8\nencoding: raw\nspace: left-posterior-superior\n"
                             "space directions: (1,2,0) (-2,1,0.5) (0,0,3)\nspace origin: (7,8,-9)\n",
                             data));
  EXPECT_EQ(oblique.axes.col(0), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(oblique.axes.col(1), Eigen::Vector3d(-2, 1, 0.5));
  EXPECT_EQ(oblique.axes.col(2), Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(oblique.origin, Eigen::Vector3d(7, 8, -9));
  const VoxelVolume cells = read_as(
      "a.nrrd",
      nrrd("type: uint8\nencoding: raw\nspacings: 2 2 4\naxis mins: 0 10 20\ncenterings: cell cell cell\n", data));
  EXPECT_EQ(cells.origin, Eigen::Vector3d(1, 11, 22));
  EXPECT_EQ(cells.axes(2, 2), 4);
}

TEST(ReadVolume, NrrdWithDetachedData) {
  const TempFolder folder;
  static_cast<void>(folder.write("voxels.raw", counting<float>()));
  const auto header = folder.write("a.nhdr",
                                   "NRRD0004\ndimension: 3\nsizes: 2 3 4\ntype: float\nencoding: raw\n"
                                   "endian: little\ndata file: voxels.raw\n");
  expect_counting(read_volume(header));
  const auto lost = folder.write("b.nhdr",
                                 "NRRD0004\ndimension: 3\nsizes: 2 3 4\ntype: float\nencoding: raw\n"
                                 "data file: nowhere.raw\n");
  try {
    static_cast<void>(read_volume(lost));
    FAIL();
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("b.nhdr: its data:"));
    EXPECT_THAT(error.what(), HasSubstr("nowhere.raw: no such file"));
  }
}

std::string meta(const std::string& entries, const std::string& data) {
  return "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\n" + entries + "ElementDataFile = LOCAL\n" + data;
}

TEST(ReadVolume, MetaImage) {
  const VoxelVolume volume =
      read_as("a.mha", meta("ElementType = MET_USHORT\nElementSpacing = 2 3 5\nOffset = 1 2 3\n"
                            "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nBinaryDataByteOrderMSB = True\n",
                            counting<std::uint16_t>(true)));
  expect_counting(volume);
  EXPECT_EQ(volume.origin, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(volume.axes.col(0), Eigen::Vector3d(0, 2, 0));  // the first three entries are the first axis
  EXPECT_EQ(volume.axes.col(1), Eigen::Vector3d(-3, 0, 0));
  EXPECT_EQ(volume.axes.col(2), Eigen::Vector3d(0, 0, 5));
  // zlib without a gzip header, and bytes behind the data that do not belong to them.
  expect_counting(read_as("a.mha", meta("ElementType = MET_FLOAT\nCompressedData = True\nCompressedDataSize = 99\n",
                                        packed(counting<float>(), false) + "junk")));
  expect_counting(
      read_as("a.mha", meta("ElementType = MET_INT\nHeaderSize = -1\n", "junk" + counting<std::int32_t>())));
  std::string text;
  for (int i = 0; i < 24; ++i) text += std::to_string(i) + (i % 5 == 0 ? "\n" : " ");
  expect_counting(read_as("a.mha", meta("ElementType = MET_DOUBLE\nBinaryData = False\n", text)));
}

TEST(ReadVolume, MetaImageWithDetachedData) {
  const TempFolder folder;
  static_cast<void>(folder.write("a.raw", counting<std::int8_t>()));
  expect_counting(read_volume(
      folder.write("a.mhd", "NDims = 3\r\nDimSize = 2 3 4\r\nElementType = MET_CHAR\r\nElementDataFile = a.raw\r\n")));
}

std::string inr(const std::string& entries, const std::string& data) {
  std::string header = "#INRIMAGE-4#{\nXDIM=2\nYDIM=3\nZDIM=4\nVDIM=1\n" + entries;
  return header + std::string(256 - 4 - header.size(), '\n') + "##}\n" + data;
}

TEST(ReadVolume, Inrimage) {
  const VoxelVolume volume =
      read_as("a.inr", inr("TYPE=float\nPIXSIZE=32 bits\nCPU=decm\nVX=0.5\nVY=2\nVZ=3\nTX=1\n", counting<float>()));
  expect_counting(volume);
  EXPECT_EQ(volume.axes.diagonal(), Eigen::Vector3d(0.5, 2, 3));
  EXPECT_EQ(volume.origin, Eigen::Vector3d(1, 0, 0));
  expect_counting(read_as(
      "a.inr.gz", packed(inr("TYPE=unsigned fixed\nPIXSIZE=16 bits\nCPU=sun\n", counting<std::uint16_t>(true)))));
}

std::string vtk(const std::string& kind, const std::string& type, const std::string& data) {
  return "# vtk DataFile Version 3.0\na title\n" + kind +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 3 4\nSPACING 1 2 3\nORIGIN 4 5 6\nPOINT_DATA 24\nSCALARS s " +
         type + "\nLOOKUP_TABLE default\n" + data;
}

TEST(ReadVolume, LegacyVtk) {
  const VoxelVolume volume = read_as("a.vtk", vtk("BINARY", "short 1", counting<std::int16_t>(true)));
  expect_counting(volume);
  EXPECT_EQ(volume.axes.diagonal(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(volume.origin, Eigen::Vector3d(4, 5, 6));
  std::string text;
  for (int i = 0; i < 24; ++i) text += std::to_string(i) + " ";
  expect_counting(read_as("a.vtk", vtk("ASCII", "float", text)));
}

std::string npy(const std::string& dictionary, const std::string& data) {
  return std::string("\x93NUMPY\x01\0", 8) + raw(static_cast<std::uint16_t>(dictionary.size())) + dictionary + data;
}

TEST(ReadVolume, NumpyIndicesAreCoordinates) {
  // Entry [i, j, k] of shape (4, 3, 2) in C order: the volume's fastest axis is z.
  const VoxelVolume c_order =
      read_as("a.npy", npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3, 2), }", counting<float>()));
  expect_counting(c_order);
  EXPECT_EQ(c_order.axes.col(0), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(c_order.axes.col(2), Eigen::Vector3d(1, 0, 0));
  const VoxelVolume fortran_order = read_as(
      "a.npy", npy("{'descr': '>i2', 'fortran_order': True, 'shape': (2, 3, 4), }", counting<std::int16_t>(true)));
  expect_counting(fortran_order);
  EXPECT_EQ(fortran_order.axes, Eigen::Matrix3d::Identity());
}

TEST(ReadVolume, KnowsItsFiles) {
  const TempFolder folder;
  EXPECT_TRUE(is_volume_file("anything.nii.gz"));
  EXPECT_TRUE(is_volume_file("anything.NRRD"));
  EXPECT_TRUE(is_volume_file("anything.vdb"));
  EXPECT_FALSE(is_volume_file("anything.ply"));
  EXPECT_FALSE(is_volume_file("anything.gz"));
  EXPECT_FALSE(is_volume_file("missing.npy"));
  EXPECT_TRUE(
      is_volume_file(folder.write("a.npy", npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3, 2), }", ""))));
  EXPECT_FALSE(
      is_volume_file(folder.write("b.npy", npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3), }", ""))));
  EXPECT_TRUE(is_volume_file(folder.write("a.vtk", vtk("ASCII", "float", ""))));
  EXPECT_FALSE(is_volume_file(folder.write("b.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n")));
}

TEST(ReadVolume, BadFilesSayWhatIsWrong) {
  struct Bad {
    std::string about;
    std::string name;
    std::string bytes;
    std::string message;
  };
  const std::string shorts = counting<std::int16_t>();
  const std::string bytes8 = counting<std::uint8_t>();
  const auto nifti = [](Nifti header) { return header.header(); };
  Nifti negative;
  negative.dim[2] = -3;
  Nifti huge;
  huge.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1};
  const std::string raw8 = "type: uint8\nencoding: raw\n";
  const std::vector<Bad> files = {
      {"empty", "a.nii", "", "the file is empty"},
      {"unknown extension", "a.img", "1", "unknown extension '.img'; volumes are read from .nii.gz .nii .nrrd"},
      {"cut header", "a.nii", nifti({}).substr(0, 200), "ends inside its header"},
      {"no magic", "a.nii", nifti({.magic = "xxxx"}), "no NIfTI mark"},
      {"pair", "a.nii", nifti({.magic = std::string("ni1\0", 4)}), ".img file"},
      {"garbage", "a.nii", std::string(400, 'x'), "does not start like a NIfTI file"},
      {"cut data", "a.nii", nifti({}) + shorts.substr(1), "announces 24 voxels of 2 bytes, but 47 bytes follow"},
      {"negative size", "a.nii", nifti(negative) + shorts, "2 x -3 x 4 voxels; sizes must be at least 1"},
      {"huge size", "a.nii", nifti(huge) + shorts, "32767 x 32767 x 32767 voxels are more than any file holds"},
      {"huge size, packed", "a.nii.gz", packed(nifti(huge) + shorts), "voxels"},
      {"colours", "a.nii", nifti({.datatype = 128}) + shorts, "datatype 128 is not read"},
      {"no gzip file", "a.nii.gz", std::string(1000, 'x'), "the content is of no known kind"},
      {"another format", "a.nii", nrrd(raw8, bytes8), "the content is an NRRD volume, not what .nii stands for"},
      {"cut gzip", "a.nii.gz", packed(nifti({}) + shorts).substr(0, 60), "cut short"},
      {"nrrd: cut", "a.nrrd", nrrd(raw8, bytes8.substr(2)), "24 voxels of 1 byte, but 22 bytes follow"},
      {"nrrd: bzip2", "a.nrrd", nrrd("type: uint8\nencoding: bz2\n", "BZh9"),
       "'bz2' is not read; save it as raw, gzip"},
      {"nrrd: no type", "a.nrrd", nrrd("encoding: raw\n", bytes8), "no entry 'type'"},
      {"nrrd: odd type", "a.nrrd", nrrd("type: block\nencoding: raw\n", bytes8), "'block' is not read"},
      {"nrrd: vectors", "a.nrrd", "NRRD0004\ndimension: 4\nsizes: 3 2 3 4\n\n", "one number a voxel"},
      {"nrrd: sizes", "a.nrrd", "NRRD0004\ndimension: 3\nsizes: 2 3\n\n", "2 numbers where 3 are needed"},
      {"nrrd: no whole size", "a.nrrd", "NRRD0004\ndimension: 3\nsizes: 2 3 4.5\n\n", "not whole"},
      {"nrrd: directions", "a.nrrd", nrrd(raw8 + "space directions: (1,0,0) none (0,0,1)\n", bytes8),
       "not all numbers"},
      {"nrrd: skip", "a.nrrd", nrrd(raw8 + "byte skip: 100\n", bytes8), "skips more than there is"},
      {"nrrd: text", "a.nrrd",
       nrrd("type: float\nencoding: ascii\n", "1 2 3 x 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25"),
       "a voxel: 'x' is not a number"},
      {"meta: no data", "a.mha", "NDims = 3\nDimSize = 2 3 4\n", "no ElementDataFile"},
      {"meta: type", "a.mha", meta("ElementType = MET_OTHER\n", bytes8), "'MET_OTHER' is not read"},
      {"meta: channels", "a.mha", meta("ElementType = MET_UCHAR\nElementNumberOfChannels = 3\n", bytes8),
       "one channel"},
      {"meta: damaged zlib", "a.mha", meta("ElementType = MET_UCHAR\nCompressedData = True\n", std::string(40, 'x')),
       "the compressed data are damaged"},
      {"meta: slices", "a.mhd", "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nElementDataFile = LIST\n",
       "several files"},
      {"meta: zeros", "a.mha", "NDims = 3\nDimSize = 0 3 4\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n",
       "0 x 3 x 4 voxels; sizes must be at least 1"},
      {"inr: header", "a.inr", "#INRIMAGE-4#{\nXDIM=2\n", "##}"},
      {"inr: type", "a.inr", inr("TYPE=packed\nPIXSIZE=8 bits\n", bytes8), "is not read"},
      {"vtk: other data", "a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n",
       "'polydata' is no volume"},
      {"vtk: cut", "a.vtk", vtk("BINARY", "float", "1234"), "24 voxels of 4 bytes, but 4 bytes follow"},
      {"vtk: colours", "a.vtk", vtk("BINARY", "float 3", "1234"), "several numbers a voxel"},
      {"npy: points", "a.npy", npy("{'descr': '<f4', 'fortran_order': False, 'shape': (4, 3), }", bytes8),
       "has 2 dimensions; a volume has shape (nx, ny, nz)"},
      {"npy: complex", "a.npy", npy("{'descr': '<c8', 'fortran_order': False, 'shape': (4, 3, 2), }", bytes8), "'<c8'"},
      {"npy: cut", "a.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3, 2), }", bytes8),
       "24 voxels of 8 bytes, but 24 bytes follow"},
      {"vdb: garbage", "a.vdb", std::string(100, 'x'), "OpenVDB"},
  };
  for (const Bad& file : files) EXPECT_THAT(error_of(file.name, file.bytes), HasSubstr(file.message)) << file.about;
}

TEST(ReadVolume, CutsAreRefused) {
  constexpr std::size_t kStep = 7;
  const auto refused = [](const std::string& name, const std::string& bytes) {
    return error_of(name, bytes) != "nothing was thrown";
  };
  const std::string mha = meta("ElementType = MET_SHORT\n", counting<std::int16_t>());
  for (std::size_t n = 0; n < mha.size(); n += kStep) EXPECT_TRUE(refused("a.mha", mha.substr(0, n))) << n;
  const std::string nii = packed(Nifti{}.header() + counting<std::int16_t>());
  for (std::size_t n = 0; n + 20 < nii.size(); n += kStep) EXPECT_TRUE(refused("a.nii.gz", nii.substr(0, n))) << n;
  const std::string image = inr("TYPE=float\nPIXSIZE=32 bits\n", counting<float>());
  for (std::size_t n = 0; n < image.size(); n += kStep) EXPECT_TRUE(refused("a.inr", image.substr(0, n))) << n;
}

}  // namespace
}  // namespace taut
