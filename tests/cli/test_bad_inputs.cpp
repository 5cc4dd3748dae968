// Whatever is wrong with a request, the program says so in one line, ends with the contract's exit code, and leaves no
// half-written file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::lines_of;
using test::run_taut;
using test::TempFolder;

constexpr int kWrongUsage = 2;
constexpr int kBadInput = 3;
constexpr int kNoPath = 4;

struct BadInput {
  std::string about;
  std::vector<std::string> arguments;  ///< "{}" is the test's folder
  int exit_code;
  std::string says;  ///< a part of the message
};

std::string repeated(const std::string& text, int n) {
  std::string all;
  for (int i = 0; i < n; ++i) all += text;
  return all;
}

/// A little of everything that may lie in a folder.
void write_files(const TempFolder& folder) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  folder.write("empty.ply", "");
  folder.write("points.docx", "1 2 3\n");
  folder.write("cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + xyz + "0.00 0.00 0.00\n1.00 0.00 0.00\n");
  folder.write("huge.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\n" + xyz + "abcdefghijkl");
  folder.write("cut_binary.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + xyz + "abcdefghijkl");
  folder.write("depth.ply", "ply\nformat ascii 1.0\nelement depth 1\nproperty float d\nend_header\n1\n");
  folder.write("image.ply", "\x89PNG\r\n\x1A\n");
  folder.write("nan.xyz", "0 0 0\n1 nan 0\n");
  folder.write("infinite.xyz", "0 0 0\n1 inf 0\n");
  folder.write("overflow.xyz", "0 0 0\n1 1e999 0\n");
  folder.write("ragged.csv", "0,0,0\n1,0\n");
  folder.write("words.csv", "0,0,0\n1,one,0\n");
  folder.write("comma.xyz", "0,5 1,5 2,5\n");
  folder.write("utf16.csv", std::string("\xFF\xFE"
                                        "0\0,\0",
                                        6));
  folder.write("garbage.xyz", std::string("\x01\x02\0\xFF\xFE\0", 6));
  folder.write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
  folder.write("counts.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("count.stl", std::string(80, ' ') + std::string("\x02\0\0\0", 4) + std::string(50, '\0'));
  folder.write("cut.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 9\nHEIGHT 1\nPOINTS 9\nDATA binary\nabcd");
  folder.write("flat.npy", std::string("\x93NUMPY\x01\0\x3A\0", 10) +
                               "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), } \n" + std::string(8, '\0'));
  folder.write("few.xyz", "0 0 0\n1 0 0\n");
  folder.write("line.xyz", [] {
    std::string text;
    for (int i = 0; i < 50; ++i) text += std::to_string(i) + " " + std::to_string(2 * i) + " 0\n";
    return text;
  }());
  folder.write("one_point.xyz", repeated("1 2 3\n", 50));
  folder.write("bad.taut", "this is no model\n");
  folder.write("empty.taut", "");
  folder.write("sphere.xyz", [] {  // 26 directions: enough to fit, quick to fit
    std::string text;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const double r = std::sqrt(x * x + y * y + z * z);
          if (r > 0)
            text += std::to_string(x / r) + " " + std::to_string(y / r) + " " + std::to_string(z / r) + " " +
                    std::to_string(x / r) + " " + std::to_string(y / r) + " " + std::to_string(z / r) + "\n";
        }
      }
    }
    return text;
  }());
  folder.write("empty.csv", "");
  folder.write("four.csv", "1,0,0,0\n");
  folder.write("image.csv", "\x89PNG\r\n\x1A\n");
  std::filesystem::create_directory(folder.path() / "folder.ply");
}

std::vector<std::string> path(const std::string& surface, const std::string& from = "@0",
                              const std::string& to = "@1") {
  return {"path", surface, "--from", from, "--to", to, "--out", "{}/result/path.json"};
}

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<BadInput> bad_inputs() {
  const std::string sphere = "x^2+y^2+z^2=1";
  const std::vector<std::string> good = path(sphere, "1,0,0", "0,1,0");
  const std::string result = "{}/result/path.json";
  return {
      // Files
      {"missing file", path("{}/missing.ply"), kBadInput, "missing.ply: no such file"},
      {"folder", path("{}/folder.ply"), kBadInput, "folder.ply: is a folder, not a file"},
      {"empty file", path("{}/empty.ply"), kBadInput, "empty.ply: the file is empty"},
      {"unknown extension", path("{}/points.docx"), kBadInput, "unknown extension '.docx'"},
      {"folder without extension", path("{}"), kBadInput, "is a folder, not a file"},
      {"CAD file", path("{}/part.step"), kBadInput, "part.step: STEP is not read; export a mesh"},
      {"missing network", with(path("{}/missing.safetensors"), {"--iso", "0"}), kBadInput,
       "missing.safetensors: no such file"},
      {"text file cut short", path("{}/cut.ply"), kBadInput, "the file ends after 2 of 3 rows"},
      {"gigantic count", path("{}/huge.ply"), kBadInput, "says 2000000000, but only 12 bytes follow"},
      {"binary file cut short", path("{}/cut_binary.ply"), kBadInput, "says 2, but only 12 bytes follow"},
      {"depth frame", path("{}/depth.ply"), kBadInput, "has no element 'vertex'"},
      {"image", path("{}/image.ply"), kBadInput, "the content is a PNG image"},
      {"nan in a file", path("{}/nan.xyz"), kBadInput, "line 2: coordinate y is nan"},
      {"infinity in a file", path("{}/infinite.xyz"), kBadInput, "line 2: coordinate y is infinite"},
      {"overflow in a file", path("{}/overflow.xyz"), kBadInput, "line 2: column 2: '1e999' is too large"},
      {"ragged table", path("{}/ragged.csv"), kBadInput, "line 2: has 2 columns where line 1 has 3"},
      {"word in a table", path("{}/words.csv"), kBadInput, "line 2: column 2: 'one' is not a number"},
      {"decimal comma", path("{}/comma.xyz"), kBadInput, "write decimals with a point"},
      {"UTF-16", path("{}/utf16.csv"), kBadInput, "UTF-16 text"},
      {"binary garbage", path("{}/garbage.xyz"), kBadInput, "binary data where text is expected"},
      {"face index", path("{}/index.obj"), kBadInput, "line 4: vertex index 4 is out of range"},
      {"wrong counts", path("{}/counts.off"), kBadInput, "the file ends after 1 of 2 faces"},
      {"wrong STL count", path("{}/count.stl"), kBadInput, "announces 2 triangles"},
      {"cut PCD", path("{}/cut.pcd"), kBadInput, "POINTS says 9, but only 4 bytes follow"},
      {"one-dimensional array", path("{}/flat.npy"), kBadInput, "the array has 1 dimension"},
      {"too few points", path("{}/few.xyz"), kBadInput, "few.xyz: 2 different points"},
      {"points on a line", path("{}/line.xyz"), kBadInput, "line.xyz: 50 different points"},
      {"one point many times", path("{}/one_point.xyz"), kBadInput, "one_point.xyz: "},
      {"damaged model", path("{}/bad.taut"), kBadInput, "bad.taut: "},
      {"empty model", path("{}/empty.taut"), kBadInput, "empty.taut: "},
      {"missing model", path("{}/missing.taut"), kBadInput, "missing.taut: no such file"},
      {"missing list of ends",
       {"path", sphere, "--from", "1,0,0", "--to-file", "{}/missing.csv", "--out", result},
       kBadInput,
       "missing.csv: no such file"},
      {"empty list of pairs",
       {"path", sphere, "--pairs", "{}/empty.csv", "--out", "{}/result/lengths.csv"},
       kBadInput,
       "empty.csv: the file is empty"},
      {"image as a list of pairs",
       {"path", sphere, "--pairs", "{}/image.csv", "--out", "{}/result/lengths.csv"},
       kBadInput,
       "image.csv: the content is a PNG image"},
      {"points of another dimension",
       {"field", sphere, "--from", "1,0,0", "--at", "{}/four.csv"},
       kBadInput,
       "has 4 columns where 3 coordinates are needed"},
      {"folder of the result missing",
       with({"path", sphere, "--from", "1,0,0", "--to", "0,1,0"}, {"--out", "{}/none/path.json"}), kBadInput, "folder"},
      {"two files in one word",
       with({"path", sphere, "--from", "1,0,0", "--to", "0,1,0"}, {"--out", "{}/a.json,b.csv"}), kWrongUsage,
       "one file a time"},
      {"folder as the result", with({"path", sphere, "--from", "1,0,0", "--to", "0,1,0"}, {"--out", "{}/folder.ply"}),
       kBadInput, "is a folder"},
      {"folder of the model missing", {"fit", "{}/sphere.xyz", "--out", "{}/none/s.taut"}, kBadInput, "folder"},

      // Formulas
      {"unknown function", path("foo(x)+y^2+z^2=1", "1,0,0", "0,1,0"), kBadInput, "foo"},
      {"word for a parameter", with(path("x^2+y^2+z^2=R^2", "1,0,0", "0,1,0"), {"--set", "R=abc"}), kWrongUsage,
       "--set R: 'abc' is no number; write one number"},
      {"unknown parameter", path("x^2+y^2+z^2=R^2", "1,0,0", "0,1,0"), kBadInput, "--set R=1"},
      {"value forgotten", path("x^2+y^2+4z^2", "1,0,0", "0,0,0.5"), kBadInput, "has no '='"},
      {"inequality among the equations", path("x^2+y^2+z^2=1; z>0", "1,0,0", "0,1,0"), kBadInput, "--domain 'z>0'"},
      {"formula file missing", path("@{}/none.txt", "1,0,0", "0,1,0"), kBadInput, "none.txt: no such file"},
      {"formula file empty", path("@{}/empty.csv", "1,0,0", "0,1,0"), kBadInput, "holds no formula"},
      {"open parenthesis", path("(x^2+y^2+z^2=1", "1,0,0", "0,1,0"), kBadInput, "never closed"},
      {"operand missing", path("x^2+*y^2=1", "1,0,0", "0,1,0"), kBadInput, "*"},
      {"empty formula", path("", "1,0,0", "0,1,0"), kBadInput, "empty"},
      {"two equals", path("x=y=1", "1,0,0", "0,1,0"), kBadInput, "="},
      {"constant formula", path("1=0", "1,0,0", "0,1,0"), kBadInput, ""},
      {"number too large", path("x^2+y^2+z^2=1e999", "1,0,0", "0,1,0"), kBadInput, "1e999"},
      {"parentheses without end", path(repeated("(", 100000) + "x", "1,0,0", "0,1,0"), kBadInput, ""},
      {"unreadable domain", with(good, {"--domain", "z >>= 0"}), kBadInput, ">"},
      {"domain without comparison", with(good, {"--domain", "z"}), kBadInput, ""},
      {"empty surface", path("x^2+y^2+z^2=-1", "1,0,0", "0,1,0"), kBadInput, ""},
      {"box beside the surface", with(good, {"--box", "5,6"}), kBadInput, ""},

      // Points
      {"two coordinates", path(sphere, "1,0", "0,1,0"), kBadInput, "--from 1,0: has 2 coordinates"},
      {"point of space on a curve", path("x^2+y^2=1", "1,0,0", "0,1,0"), kBadInput, "--dim 3"},
      {"nan point", path(sphere, "nan,0,0", "0,1,0"), kBadInput, "finite"},
      {"infinite point", path(sphere, "1,0,0", "0,inf,0"), kBadInput, "finite"},
      {"sample of a formula", path(sphere, "@5", "0,1,0"), kBadInput, "no samples"},
      {"sample out of range", path("{}/sphere.xyz", "@0", "@99999"), kBadInput, "samples go from @0 to @25"},
      {"point far off", path(sphere, "100,0,0", "0,1,0"), kBadInput, ""},
      {"point at the centre", path(sphere, "0,0,0", "0,1,0"), kBadInput, ""},
      {"apex of a cone", path("x^2+y^2=z^2", "0,0,0", "0.6,0.8,1"), kBadInput, ""},
      {"two components", path("((x-2)^2+y^2+z^2-1)*((x+2)^2+y^2+z^2-1)=0", "3,0,0", "-3,0,0"), kNoPath, ""},
      {"cells too small for memory", with(good, {"--cell", "1e-9"}), kBadInput, "take larger cells (--cell)"},
      {"too many cells for memory", with(good, {"--cell", "3e-5"}), kBadInput, "larger cells"},
      {"field in four dimensions",
       {"field", "x^2+y^2+z^2+w^2=1", "--from", "1,0,0,0", "--out", "{}/result/f.ply"},
       kBadInput,
       "3 dimensions"},
      {"mesh in four dimensions", {"mesh", "x^2+y^2+z^2+w^2=1", "--out", "{}/result/m.ply"}, kBadInput, "3"},

      // Usage
      {"no command", {}, kWrongUsage, "give a command; the commands are path, field"},
      {"unknown command", {"fly", sphere}, kWrongUsage, "there is no command 'fly'"},
      {"no surface", {"path"}, kWrongUsage, "SURFACE"},
      {"unknown option", with(good, {"--sideways"}), kWrongUsage, "there is no option --sideways"},
      {"mistyped option", with(good, {"--formm", "1,0,0"}), kWrongUsage, "did you mean --from?"},
      {"longer option", with(good, {"--output", "a.csv"}), kWrongUsage, "did you mean --out?"},
      {"mistyped command", {"paht", sphere}, kWrongUsage, "did you mean path?"},
      {"option twice", with(good, {"--to", "1,0,0"}), kWrongUsage, "--to is given more than once"},
      {"option without a value", with(good, {"--dim"}), kWrongUsage, "--dim needs a value"},
      {"point in three words", {"path", sphere, "--from", "1", "0", "0"}, kWrongUsage, "'0' stands alone"},
      {"formula in three words", {"path", "x^2", "+", "y^2"}, kWrongUsage, "into quotes"},
      {"surface from a pipe", {"info", "-"}, kWrongUsage, "standard input"},
      {"parameter that is not used", with(good, {"--set", "S=2"}), kWrongUsage, "the formula has no S"},
      {"smoothing of a formula", with(good, {"--smooth", "2"}), kWrongUsage, "--smooth is for point files"},
      {"variables of a file", with(path("{}/sphere.xyz"), {"--vars", "a,b"}), kWrongUsage, "--vars is for formulas"},
      {"results over their pairs",
       {"path", sphere, "--pairs", "{}/four.csv", "--out", "{}/four.csv"},
       kWrongUsage,
       "is read as input"},
      {"header of one path", with(good, {"--header"}), kWrongUsage, "--header"},
      {"tolerance of a marched field",
       {"field", sphere, "--from", "1,0,0", "--tol", "1e-6", "--grid-only", "--out", "{}/result/f.ply"},
       kWrongUsage,
       "--tol"},
      {"half a thread", with(good, {"--threads", "2.5"}), kWrongUsage, "'2.5' is not a whole number"},
      {"pairs as JSON", {"path", sphere, "--pairs", "{}/four.csv", "--json"}, kWrongUsage, "--json"},
      {"pairs with an end", {"path", sphere, "--pairs", "{}/four.csv", "--to", "1,0,0"}, kWrongUsage, "--pairs"},
      {"end missing", {"path", sphere, "--from", "1,0,0"}, kWrongUsage, "--to"},
      {"word as a coordinate", path(sphere, "1,up,0", "0,1,0"), kWrongUsage, "'up'"},
      {"coordinate missing", path(sphere, "1,,0", "0,1,0"), kWrongUsage, "''"},
      {"coordinate too large", path(sphere, "1e999,0,0", "0,1,0"), kWrongUsage, "1e999"},
      {"sample without number", path("{}/sphere.xyz", "@x", "@1"), kWrongUsage, "@x"},
      {"negative cell", with(good, {"--cell=-1"}), kWrongUsage, "--cell"},
      {"cell is no number", with(good, {"--cell", "small"}), kWrongUsage, "--cell"},
      {"nan cell", with(good, {"--cell", "nan"}), kWrongUsage, "'nan' is not a positive number"},
      {"tolerance out of range", with(good, {"--tol", "5"}), kWrongUsage, "'5' is not a number from 1e-13 to 0.001"},
      {"unknown method", with(good, {"--method", "magic"}), kWrongUsage, "'magic' is none of newton, flow, grid"},
      {"unknown march", with(good, {"--march", "quick"}), kWrongUsage, "--march"},
      {"negative threads", with(good, {"--threads=-1"}), kWrongUsage, "--threads"},
      {"result of unknown kind",
       {"path", sphere, "--from", "1,0,0", "--to", "0,1,0", "--out", "{}/result/path.docx"},
       kWrongUsage,
       ".json .csv"},
      {"result without extension",
       {"path", sphere, "--from", "1,0,0", "--to", "0,1,0", "--out", "{}/result/path"},
       kWrongUsage,
       ".json .csv"},
      {"box turned round", with(good, {"--box", "1,0"}), kWrongUsage, "--box"},
      {"box of three numbers", with(good, {"--box", "0,1,2"}), kWrongUsage, "--box"},
      {"parameter without value", with(good, {"--set", "R"}), kWrongUsage, "--set"},
      {"parameter of a file", with(path("{}/sphere.xyz"), {"--set", "R=1"}), kWrongUsage, "--set"},
      {"field without result", {"field", sphere, "--from", "1,0,0"}, kWrongUsage, "--out"},
      {"model of another kind", {"fit", "{}/sphere.xyz", "--out", "{}/result/s.ply"}, kWrongUsage, ".taut"},
  };
}

/// One line beside notes; a formula's error is followed by the formula and a caret under the column.
bool is_one_message(std::vector<std::string> lines) {
  std::erase_if(lines, [](const std::string& line) { return line.starts_with("taut: note: "); });
  if (lines.empty() || !lines[0].starts_with("taut: ")) return false;
  return lines.size() == 1 ||
         (lines.size() == 3 && lines[2].find_first_not_of(' ') == lines[2].size() - 1 && lines[2].ends_with('^'));
}

TEST(BadInputs, EachEndsWithItsCodeAndOneLine) {
  constexpr std::size_t kLongest = 300;  // bytes of a message, without the folder's name
  const TempFolder folder;
  write_files(folder);
  const auto results = folder.path() / "result";
  std::filesystem::create_directory(results);
  const std::size_t entries = folder.num_entries();
  for (const BadInput& bad : bad_inputs()) {
    SCOPED_TRACE(bad.about);
    std::vector<std::string> arguments = bad.arguments;
    for (std::string& argument : arguments) {
      if (const auto at = argument.find("{}"); at != std::string::npos) argument.replace(at, 2, folder.path().string());
    }
    const test::ProgramResult result = run_taut(arguments);
    EXPECT_EQ(result.signal, 0) << (result.timed_out ? "no answer in a minute" : "crashed") << "\n" << result.err;
    EXPECT_EQ(result.exit_code, bad.exit_code) << result.err;
    EXPECT_TRUE(is_one_message(lines_of(result.err))) << result.err.substr(0, 2000);
    EXPECT_LE(result.err.size(), kLongest + folder.path().string().size()) << result.err.substr(0, 2000);
    EXPECT_NE(result.err.find(bad.says), std::string::npos) << "says     " << result.err << "not      " << bad.says;
    EXPECT_TRUE(result.out.empty() || bad.exit_code == kNoPath) << result.out;
    EXPECT_TRUE(std::filesystem::is_empty(results)) << "something was written";
    std::filesystem::remove_all(results);
    std::filesystem::create_directory(results);
    EXPECT_EQ(folder.num_entries(), entries) << "something was left behind";
  }
}

TEST(BadInputs, AFullDiskIsNoticed) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const std::vector<std::string> question = {"path", "x^2+y^2+z^2=1", "--from", "1,0,0", "--to", "0,1,0"};
  const test::ProgramResult to_stdout = run_taut(with(question, {"--json"}), "/dev/full");
  EXPECT_EQ(to_stdout.exit_code, kBadInput);
  EXPECT_NE(to_stdout.err.find("taut: stdout cannot be written"), std::string::npos) << to_stdout.err;
  const TempFolder folder;
  std::filesystem::create_symlink("/dev/full", folder.path() / "path.json");
  const test::ProgramResult to_file = run_taut(with(question, {"--out", (folder.path() / "path.json").string()}));
  EXPECT_EQ(to_file.exit_code, kBadInput);
  EXPECT_NE(to_file.err.find("make room on the disk"), std::string::npos) << to_file.err;
}

TEST(BadInputs, BadLinesOfABatchAreAnsweredInPlace) {
  const TempFolder folder;
  const auto pairs = folder.write("pairs.csv",
                                  "# start, end\n1,0,0,0,1,0\n1,0,0,zero,1,0\n\n1,0,0\nnan,0,0,0,1,0\n50,0,0,0,1,0\n"
                                  "0,0,0,0,1,0\n0,0,1,0,1,0");
  const test::ProgramResult result = run_taut({"path", "x^2+y^2+z^2=1", "--pairs", pairs.string()});
  EXPECT_EQ(result.exit_code, 1);
  const std::vector<std::string> answers = lines_of(result.out);
  ASSERT_EQ(answers.size(), 7U) << result.out;
  for (const std::size_t good : {0U, 6U}) {
    EXPECT_TRUE(answers[good].starts_with("1.57079632679")) << answers[good];
    EXPECT_TRUE(answers[good].ends_with(",1,1,ok")) << answers[good];
  }
  for (std::size_t bad = 1; bad < 6; ++bad) EXPECT_TRUE(answers[bad].starts_with("nan,inf,0,0,")) << answers[bad];
  for (std::size_t bad = 1; bad < 4; ++bad) EXPECT_EQ(answers[bad], "nan,inf,0,0,bad_input");
  const std::vector<std::string> reasons = lines_of(result.err);
  ASSERT_EQ(reasons.size(), 5U) << result.err;
  for (std::size_t i = 0; i < 5; ++i) {
    const std::string place = "pairs.csv line " + std::to_string(std::vector<int>{3, 5, 6, 7, 8}[i]) + ": ";
    EXPECT_NE(reasons[i].find(place), std::string::npos) << reasons[i];
  }
}

TEST(BadInputs, ABadDestinationIsToldOnceByItsLine) {
  const TempFolder folder;
  const auto ends = folder.write("ends.csv", "# ends\n0,1,0\n0,up,0\n0,1\n0,0,0.5\n");
  const test::ProgramResult result =
      run_taut({"path", "x^2+y^2+4z^2=1", "--from", "1,0,0", "--to-file", ends.string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(lines_of(result.out).size(), 4U) << result.out;
  const auto told = lines_of(result.err);
  ASSERT_EQ(told.size(), 2U) << result.err;
  EXPECT_NE(told[0].find("ends.csv line 3: column 2: 'up'"), std::string::npos) << told[0];
  EXPECT_NE(told[1].find("ends.csv line 4: 2 numbers; a point takes 3"), std::string::npos) << told[1];
}

TEST(BadInputs, APointWithoutADistanceSaysWhy) {
  const TempFolder folder;
  const auto points = folder.write("points.csv", "0,1,0\n9,9,9\n");
  const test::ProgramResult result = run_taut({"field", "x^2+y^2+4z^2=1", "--from", "1,0,0", "--at", points.string()});
  EXPECT_EQ(result.exit_code, 1);
  ASSERT_EQ(lines_of(result.out).size(), 2U) << result.out;
  EXPECT_EQ(lines_of(result.out)[1], "nan,inf");
  EXPECT_NE(result.err.find("point 2: "), std::string::npos) << result.err;
}

TEST(BadInputs, BatchesOfWhichNoLineIsGoodInManyDimensions) {
  const TempFolder folder;
  const auto pairs = folder.write("pairs.csv", "1,2\n3,4\n");
  const test::ProgramResult result =
      run_taut({"path", "x1^2+x2^2+x3^2+x4^2+x5^2+x6^2+x7^2+x8^2=1", "--pairs", pairs.string()});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(lines_of(result.out).size(), 2U) << result.out;
}

}  // namespace
}  // namespace taut
