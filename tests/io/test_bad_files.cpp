// What is wrong with a file, and the part of the message that must say so.

#include <gtest/gtest.h>

#include <cstdlib>

#include "io/read_text.hpp"

namespace taut {
namespace {

using test::error_of;
using test::raw;

struct BadFile {
  std::string about;
  std::string name;
  std::string bytes;
  std::string message;  ///< a part of it
};

std::string ply(const std::string& rest) { return "ply\nformat ascii 1.0\n" + rest; }
std::string ply_cloud(const std::string& count, const std::string& rows) {
  return ply("element vertex " + count + "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + rows);
}
std::string binary_cloud(const std::string& count, const std::string& rows) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + count +
         "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + rows;
}
std::string triangle(const std::string& face) {
  return ply(
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n" +
      face);
}
std::string pcd(const std::string& fields, const std::string& points, const std::string& data) {
  return "VERSION 0.7\nFIELDS " + fields + "\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + points +
         "\nHEIGHT 1\nPOINTS " + points + "\nDATA " + data;
}
std::string npy(const std::string& dictionary, const std::string& data) {
  return std::string("\x93NUMPY\x01\0", 8) + raw(static_cast<std::uint16_t>(dictionary.size())) + dictionary + data;
}
std::string binary_stl(std::uint32_t count, std::size_t bytes) {
  return std::string(80, ' ') + raw(count) + std::string(bytes, '\0');
}

std::vector<BadFile> bad_files() {
  const std::string garbage = std::string("\x01\x02\xFF\0\xFE\x80\x7F garbage \0\0", 18);
  const std::string nan = raw(std::numeric_limits<float>::quiet_NaN());
  const std::string zero = raw(0.0F);
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  return {
      {"empty", "a.ply", "", "a.ply: the file is empty"},
      {"empty text", "a.xyz", "", "a.xyz: the file is empty"},
      {"only blank lines", "a.xyz", "\n \n", "holds no points"},
      {"only comments", "a.csv", "# nothing\n", "holds no points"},
      {"no extension", "points", "1 2 3\n",
       "the name has no extension; point clouds and meshes are read from .ply .obj"},
      {"unknown extension", "a.docx", "1 2 3\n",
       "unknown extension '.docx'; point clouds and meshes are read from .ply"},
      {"PLY named OBJ", "a.obj", ply_cloud("1", "0 0 0\n"), "the content is a PLY file, not what .obj stands for"},
      {"PNG named PLY", "a.ply", "\x89PNG\r\n", "the content is a PNG image"},
      {"gzip under another name", "a.csv", "\x1F\x8B\x08", "the content is a gzip-compressed file"},
      {"web page", "a.obj", "<!DOCTYPE html><html></html>", "the content is a web page"},
      {"Git LFS pointer", "a.ply", "version https://git-lfs.github.com/spec/v1\n", "Git LFS pointer"},
      {"UTF-16", "a.csv",
       std::string("\xFF\xFE"
                   "1\0,\0",
                   6),
       "UTF-16 text; save it as UTF-8"},
      {"binary garbage as xyz", "a.xyz", garbage, "byte 3: binary data where text is expected"},
      {"binary garbage as ply", "a.ply", garbage, "does not start with 'ply'"},
      {"binary garbage as off", "a.off", garbage, "binary data where text is expected"},
      {"binary garbage as stl", "a.stl", garbage, "is neither text STL"},
      {"binary garbage as pcd", "a.pcd", garbage, "no DATA line"},
      {"binary garbage as npy", "a.npy", garbage, "does not start like a NumPy array"},
      {"prose as obj", "a.obj", "Once upon a time\nthere was\n", "'Once' is no OBJ statement"},
      {"prose as xyz", "a.xyz", "Once upon a time\n",
       "line 1: the header 'Once,upon,a,time' does not name the coordinates"},
      {"prose as csv", "a.csv", "Once upon a time\nthere was\n",
       "line 1: the header 'Once,upon,a,time' does not name the coordinates"},
      {"prose as off", "a.off", "Once upon a time\n", "line 1: starts with 'Once' instead of OFF"},
      {"prose as ply", "a.ply", "Once upon a time\n", "does not start with 'ply'"},
      {"prose as stl", "a.stl", "Once upon a time\n", "is neither text STL"},
      {"unprintable word", "a.xyz", "1 2 \x80\x01\n", "line 1: column 3: '\\x80\\x01' is not a number"},

      {"columns: too few", "a.xyz", "1 2\n3 4\n", "line 1: has 2 columns; x y z are needed"},
      {"columns: one csv column", "a.csv", "1\n2\n", "line 1: has one column"},
      {"columns: short row", "a.xyz", "1 2 3\n4 5\n", "line 2: has 2 columns where line 1 has 3"},
      {"columns: four and no header", "a.csv", "1,2,3,4\n", "line 1: has 4 columns and no header"},
      {"columns: names that say nothing", "a.csv", "a,b,c,d\n1,2,3,4\n",
       "line 1: the header 'a,b,c,d' does not name the coordinates"},
      {"columns: a name twice", "a.csv", "x,y,y\n1,2,3\n", "does not name the coordinates"},
      {"columns: long row", "a.csv", "1,2,3\n\n# note\n4,5,6,7\n", "line 4: has 4 columns where line 1 has 3"},
      {"columns: word", "a.xyz", "1 2 3\n4 five 6\n", "line 2: column 2: 'five' is not a number"},
      {"columns: number with a tail", "a.xyz", "1 2 3x\n", "line 1: column 3: '3x' is not a number"},
      {"columns: decimal comma", "a.xyz", "1,5 2,5 3,5\n", "write decimals with a point"},
      {"columns: empty field", "a.csv", "1,,3\n", "line 1: column 2 is empty"},
      {"columns: nan", "a.xyz", "1 2 3\nnan 5 6\n", "line 2: coordinate x is nan"},
      {"columns: infinite", "a.csv", "1,2,3\n4,5,-inf\n", "line 2: coordinate z is infinite"},
      {"columns: infinite in five dimensions", "a.csv", "x1,x2,x3,x4,x5\n1,2,3,4,inf\n",
       "line 2: coordinate 5 is infinite"},
      {"columns: too large", "a.xyz", "1 2 3\n4 1e999 6\n", "line 2: column 2: '1e999' is too large for a double"},
      {"columns: count too large", "a.pts", "3\n1.00 2.00 3.00\n4.00 5.00 6.00\n",
       "line 1: announces 3 points, but 2 lines follow"},
      {"columns: count too small", "a.pts", "1\n1 2 3\n4 5 6\n", "line 1: announces 1 point, but 2 lines follow"},
      {"columns: gigantic count", "a.pts", "4000000000\n1 2 3\n",
       "line 1: the point count says 4000000000, but only 7 bytes follow"},
      {"columns: count only", "a.pts", "0\n", "holds no points after its count"},
      {"columns: molecule", "a.xyz", "1\nwater\nO 0 0 0\n", "line 2: the header 'water' does not name the coordinates"},
      {"columns: header without coordinates", "a.csv", "nx,ny,nz\n0,0,1\n", "does not name the coordinates"},
      {"columns: header with a gap", "a.csv", "x,z\n0,1\n", "does not name the coordinates"},
      {"columns: header only", "a.csv", "x,y,z\n", "line 1: no points follow the header"},
      {"pwn: neither form", "a.pwn", "1 2 3\n0 0 1\n", "has neither six columns nor a count"},
      {"pwn: normals missing", "a.pwn", "2\n1 2 3\n4 5 6\n0 0 1\n",
       "line 1: announces 2 points and as many normals, but 3 lines follow"},

      {"ply: no end", "a.ply", ply("element vertex 1\n"), "no 'end_header'"},
      {"ply: no format", "a.ply", "ply\nelement vertex 1\nproperty float x\nend_header\n", "no 'format' line"},
      {"ply: unknown format", "a.ply", "ply\nformat binary 1.0\nend_header\n", "line 2: unknown format"},
      {"ply: unknown keyword", "a.ply", ply("elemental vertex 1\nend_header\n"), "line 3: unknown keyword 'elemental'"},
      {"ply: unknown type", "a.ply", ply("element vertex 1\nproperty half x\nend_header\n"),
       "line 4: unknown type 'half'"},
      {"ply: count not a number", "a.ply", ply_cloud("many", ""),
       "line 3: the count of element 'vertex', 'many', is not a whole number"},
      {"ply: negative count", "a.ply", ply_cloud("-1", ""), "is not a whole number"},
      {"ply: count beyond 64 bits", "a.ply", ply_cloud("99999999999999999999", ""), "is not a whole number"},
      {"ply: property first", "a.ply", ply("property float x\nend_header\n"),
       "line 3: a property stands before the first element"},
      {"ply: property twice", "a.ply", ply("element vertex 1\nproperty float x\nproperty float x\nend_header\n0 0\n"),
       "line 5: property 'x' is declared twice"},
      {"ply: no vertices", "a.ply", ply("element depth 1\nproperty float d\nend_header\n1\n"),
       "has no element 'vertex' (its elements: depth)"},
      {"ply: no z", "a.ply", ply("element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"),
       "line 3: element 'vertex' has no property 'z'"},
      {"ply: no points", "a.ply", ply_cloud("0", ""), "holds no points"},
      {"ply: gigantic count", "a.ply", ply_cloud("4000000000", "0 0 0\n"),
       "declares 4000000000 vertices, more than 2^31 - 1"},
      {"ply: large count", "a.ply", ply_cloud("2000000000", "0 0 0\n"),
       "line 3: the count of element 'vertex' says 2000000000, but only 7 bytes follow"},
      {"ply: large binary count", "a.ply", binary_cloud("2000000000", zero + zero + zero),
       "says 2000000000, but only 12 bytes follow"},
      {"ply: large face count", "a.ply",
       ply("element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face "
           "999999999999\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"),
       "the count of element 'face' says 999999999999"},
      {"ply: rows missing", "a.ply", ply_cloud("3", "0.000 0.000 0.000\n1.000 1.000 1.000\n"),
       "the file ends after 2 of 3 rows of element 'vertex'"},
      {"ply: row cut", "a.ply", ply_cloud("2", "0 0 0\n1.00 1.00\n"), "line 9: z is missing; the line is too short"},
      {"ply: row too long", "a.ply", ply_cloud("1", "0 0 0 0\n"),
       "line 8: more numbers than element 'vertex' has properties"},
      {"ply: rows left over", "a.ply", ply_cloud("1", "0 0 0\n1 1 1\n"), "line 9: more rows than the header declares"},
      {"ply: bytes left over", "a.ply", binary_cloud("1", zero + zero + zero + raw(1.0F)),
       "4 bytes left after the last row"},
      {"ply: binary cut", "a.ply", binary_cloud("2", zero + zero + zero + zero), "says 2, but only 16 bytes follow"},
      {"ply: nan", "a.ply", ply_cloud("2", "0 0 0\n0 nan 0\n"), "line 9: coordinate y is nan"},
      {"ply: binary nan", "a.ply", binary_cloud("2", zero + zero + zero + zero + nan + zero),
       "vertex 1 (from 0): coordinate y is nan"},
      {"ply: infinite", "a.ply", ply_cloud("1", "0 0 inf\n"), "line 8: coordinate z is infinite"},
      {"ply: too large", "a.ply", ply_cloud("1", "0 0 1e400\n"), "line 8: z: '1e400' is too large for a double"},
      {"ply: not a number", "a.ply", ply_cloud("1", "0 zero 0\n"), "line 8: y: 'zero' is not a number"},
      {"ply: decimal comma", "a.ply", ply_cloud("1", "0,5 0 0\n"),
       "line 8: x: '0,5' is not a number; write decimals with a point"},
      {"ply: index too large", "a.ply", triangle("3 0 1 3\n"),
       "line 13: vertex index 3 is out of range (there are 3 vertices, counted from 0)"},
      {"ply: negative index", "a.ply", triangle("3 0 1 -1\n"), "line 13: vertex index -1 is out of range"},
      {"ply: index not whole", "a.ply", triangle("3 0 1 1.5\n"), "holds something that is no index"},
      {"ply: list cut", "a.ply", triangle("3 0 1\n"), "line 13: vertex_indices is missing; the line is too short"},
      {"ply: negative list", "a.ply", triangle("-3 0 1 2\n"), "has an impossible length"},
      {"ply: endless list", "a.ply", triangle("900000000 0 1 2\n"), "is longer than the file"},
      {"ply: element twice", "a.ply",
       ply("element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement vertex 1\nproperty float "
           "x\nend_header\n0 0 0\n0\n"),
       "element 'vertex' is declared twice"},
      {"ply: element without properties", "a.ply",
       ply("element vertex 1\nproperty float x\nproperty float y\nproperty float z\nelement face "
           "4000000000\nend_header\n0 0 0\n"),
       "element 'face' has no properties"},

      {"obj: no vertices", "a.obj", "# nothing\no thing\n", "holds no points"},
      {"obj: index too large", "a.obj", obj + "f 1 2 4\n",
       "line 4: vertex index 4 is out of range (the file has 3 vertices)"},
      {"obj: index zero", "a.obj", obj + "f 0 1 2\n", "line 4: face corner '0': OBJ counts from 1"},
      {"obj: negative index too large", "a.obj", obj + "f -4 -1 -2\n", "line 4: vertex index -4 is out of range"},
      {"obj: normal index too large", "a.obj", obj + "vn 0 0 1\nf 1//1 2//1 3//2\n",
       "line 5: normal index 2 is out of range"},
      {"obj: corner not readable", "a.obj", obj + "f 1 2 3a\n", "line 4: face corner '3a' is not readable"},
      {"obj: huge index", "a.obj", obj + "f 1 2 99999999999999999999\n",
       "line 4: face corner '99999999999999999999' is not readable"},
      {"obj: face with two corners", "a.obj", obj + "f 1 2\n", "line 4: a face with 2 corners"},
      {"obj: two coordinates", "a.obj", "v 1 2\n", "line 1: coordinate z is missing; the line is too short"},
      {"obj: nan", "a.obj", "v 1 nan 2\n", "line 1: coordinate y is nan"},
      {"obj: numbers only", "a.obj", "1 2 3\n4 5 6\n", "line 1: '1' is no OBJ statement"},

      {"off: cut in the vertices", "a.off", "OFF\n3 1 0\n0.00 0.00 0.00\n1.00 0.00 0.00\n",
       "the file ends after 2 of 3 vertices"},
      {"off: cut in the faces", "a.off", off, "the file ends after 0 of 1 faces"},
      {"off: faces missing", "a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "the file ends after 1 of 2 faces"},
      {"off: index out of range", "a.off", off + "3 0 1 3\n", "line 6: vertex index 3 is out of range"},
      {"off: too many lines", "a.off", off + "3 0 1 2\n3 0 1 2\n", "line 7: more lines than the counts announce"},
      {"off: gigantic count", "a.off", "OFF\n4000000000 0 0\n0 0 0\n",
       "line 2: the vertex count says 4000000000, but only 7 bytes follow"},
      {"off: negative count", "a.off", "OFF\n-3 0 0\n0 0 0\n", "line 2: the vertex count is negative"},
      {"off: no counts", "a.off", "OFF\n", "the file ends before its counts"},
      {"off: binary", "a.off", "OFF BINARY\n", "binary OFF is not supported"},
      {"off: four dimensions", "a.off", "4OFF\n1 0 0\n0 0 0 1\n", "the OFF variant '4OFF' is not supported"},
      {"off: corner missing", "a.off", off + "3 0 1\n", "line 6: vertex index is missing"},
      {"off: nan", "a.off", "OFF\n1 0 0\n0 nan 0\n", "line 3: coordinate y is nan"},

      {"stl: count and size differ", "a.stl", binary_stl(2, 50),
       "byte 80: announces 2 triangles, 184 bytes in all, but the file has 134"},
      {"stl: gigantic count", "a.stl", binary_stl(4000000000U, 50), "announces 4000000000 triangles"},
      {"stl: no triangles", "a.stl", binary_stl(0, 0), "holds no points"},
      {"stl: text cut", "a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
       "the file ends without 'endsolid'"},
      {"stl: two corners", "a.stl",
       "solid a\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\nendsolid\n",
       "line 6: a facet with 2 vertices instead of three"},
      {"stl: four corners", "a.stl", "solid a\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 1 0 1\n",
       "line 5: a fourth vertex in one facet"},
      {"stl: unknown keyword", "a.stl", "solid a\nfacet\ntriangle 1 2 3\n", "line 3: 'triangle' is no STL keyword"},
      {"stl: nan", "a.stl",
       std::string(80, ' ') + raw<std::uint32_t>(1) + std::string(12, '\0') + nan + std::string(34, '\0'),
       "byte 96: triangle 0 (from 0): coordinate x is nan"},

      {"pcd: no z", "a.pcd", pcd("x y w", "1", "ascii\n0 0 0\n"), "has no field 'z'"},
      {"pcd: rows missing", "a.pcd", pcd("x y z", "3", "ascii\n0.0 0.0 0.0\n1.0 0.0 0.0\n"),
       "the file ends after 2 of 3 points"},
      {"pcd: rows left over", "a.pcd", pcd("x y z", "1", "ascii\n0 0 0\n1 0 0\n"), "more points than POINTS announces"},
      {"pcd: gigantic count", "a.pcd", pcd("x y z", "2000000000", "ascii\n0 0 0\n"),
       "POINTS says 2000000000, but only 7 bytes follow"},
      {"pcd: binary cut", "a.pcd", pcd("x y z", "2", "binary\n") + zero + zero + zero + zero,
       "POINTS says 2, but only 16 bytes follow"},
      {"pcd: binary left over", "a.pcd", pcd("x y z", "1", "binary\n") + zero + zero + zero + zero + zero + zero,
       "12 bytes left after the last point"},
      {"pcd: unknown data", "a.pcd", pcd("x y z", "1", "zipped\n"),
       "DATA 'zipped' is none of ascii, binary, binary_compressed"},
      {"pcd: compressed cut", "a.pcd",
       pcd("x y z", "1", "binary_compressed\n") + raw<std::uint32_t>(100) + raw<std::uint32_t>(12) + "abc",
       "announces 100 packed bytes, but 3 follow"},
      {"pcd: compressed size wrong", "a.pcd",
       pcd("x y z", "1", "binary_compressed\n") + raw<std::uint32_t>(3) + raw<std::uint32_t>(4000000000U) + "abc",
       "unpacks to 4000000000 bytes, which does not fit POINTS"},
      {"pcd: compressed beyond belief", "a.pcd",
       pcd("x y z", "100000000", "binary_compressed\n") + raw<std::uint32_t>(3) + raw<std::uint32_t>(1200000000U) +
           "abc",
       "more unpacked bytes than its data can hold"},
      {"pcd: only nan", "a.pcd", pcd("x y z", "1", "ascii\nnan nan nan\n"), "holds no points"},
      {"pcd: width and points differ", "a.pcd",
       "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 3\nHEIGHT 1\nPOINTS 2\nDATA ascii\n0 0 0\n1 1 1\n",
       "POINTS says 2, but WIDTH x HEIGHT is 3"},
      {"pcd: size missing", "a.pcd", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nWIDTH 1\nDATA ascii\n0 0 0\n",
       "line 2: SIZE has 2 entries where 3 are needed"},
      {"pcd: impossible size", "a.pcd", "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\nWIDTH 1\nDATA ascii\n0 0 0\n",
       "field 'z' has an impossible SIZE of 3"},

      {"npy: one dimension", "a.npy",
       npy("{'descr': '<f8', 'fortran_order': False, 'shape': (3,), }", std::string(24, '\0')),
       "the array has 1 dimension; save one of shape (n, d)"},
      {"npy: structured", "a.npy", npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (3,), }", ""),
       "a structured array"},
      {"npy: objects", "a.npy", npy("{'descr': '|O', 'fortran_order': False, 'shape': (1, 3), }", ""),
       "numbers of type '|O' are not supported"},
      {"npy: complex", "a.npy", npy("{'descr': '<c16', 'fortran_order': False, 'shape': (1, 3), }", ""),
       "numbers of type '<c16' are not supported"},
      {"npy: cut", "a.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }", std::string(40, '\0')),
       "shape (2, 3) of <f8 does not fit the 40 bytes that follow"},
      {"npy: gigantic", "a.npy",
       npy("{'descr': '<f8', 'fortran_order': False, 'shape': (4611686018427387904, 4), }", ""),
       "does not fit the 0 bytes that follow"},
      {"npy: no rows", "a.npy", npy("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 3), }", ""),
       "points need shape (n, d)"},
      {"npy: header cut", "a.npy", std::string("\x93NUMPY\x01\0\xFF\x7F{", 11), "the file ends inside its header"},
      {"npy: shape missing", "a.npy", npy("{'descr': '<f8'}", ""), "no readable 'shape'"},
      {"npy: nan", "a.npy",
       npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2), }", zero + zero + zero + nan),
       "point 1 (from 0): coordinate y is nan"},
  };
}

TEST(BadFiles, EachIsRefusedWithItsReason) {
  for (const BadFile& bad : bad_files()) {
    const std::string message = error_of(bad.name, bad.bytes);
    EXPECT_NE(message.find(bad.message), std::string::npos)
        << bad.about << "\n  says     " << message << "\n  not      " << bad.message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << bad.about << ": " << message;
    EXPECT_TRUE(message.starts_with(bad.name + ": ")) << bad.about << ": " << message;
    EXPECT_LT(message.size(), 240U) << bad.about << ": " << message;
    // What is wrong, then what to do about it.
    EXPECT_NE(message.find("; "), std::string::npos) << bad.about << ": " << message;
  }
}

TEST(BadFiles, EveryProperPrefixOfAFileIsRefusedOrSmaller) {
  const std::string off = "OFF\n3 1 0\n0.5 0.5 0.5\n1.5 0.5 0.5\n0.5 1.5 0.5\n3 0 1 2 \n";
  const std::string text = triangle("3 0 1 2 \n");
  const std::string binary = binary_cloud("2", std::string(24, '\x01'));
  const auto is_refused = [](const std::string& name, const std::string& bytes) {
    return !error_of(name, bytes).empty();
  };
  for (std::size_t n = 0; n + 3 < off.size(); ++n) EXPECT_TRUE(is_refused("a.off", off.substr(0, n))) << n;
  for (std::size_t n = 0; n + 3 < text.size(); ++n) EXPECT_TRUE(is_refused("a.ply", text.substr(0, n))) << n;
  for (std::size_t n = 0; n < binary.size(); ++n) EXPECT_TRUE(is_refused("a.ply", binary.substr(0, n))) << n;
}

TEST(BadFiles, MissingFileFolderAndForbiddenFile) {
  const test::TempFolder folder;
  const auto message = [](const std::filesystem::path& path) -> std::string {
    try {
      static_cast<void>(read_point_cloud(path));
    } catch (const IoError& error) {
      EXPECT_EQ(error.path(), path.string());
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message(folder.path() / "missing.ply").find("no such file"), std::string::npos);
  std::filesystem::create_directory(folder.path() / "folder.ply");
  EXPECT_NE(message(folder.path() / "folder.ply").find("is a folder, not a file"), std::string::npos);
  const auto locked = folder.write("locked.xyz", "1 2 3\n");
  std::filesystem::permissions(locked, std::filesystem::perms::none);
  if (!std::ifstream(locked)) {  // the superuser may read everything
    EXPECT_NE(message(locked).find("no permission to read it"), std::string::npos);
  }
}

TEST(BadFiles, CancellingStopsAReader) {
  const test::TempFolder folder;
  std::string text;
  for (int i = 0; i < 70000; ++i) text += "1 2 3\n";
  const std::atomic<bool> cancel = true;
  Context context;
  context.cancel = &cancel;
  EXPECT_THROW(static_cast<void>(read_point_cloud(folder.write("a.xyz", text), context)), Cancelled);
}

}  // namespace
}  // namespace taut
