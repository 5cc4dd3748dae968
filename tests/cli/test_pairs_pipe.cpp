// Pairs that come through a pipe are answered as those in a file, and nothing is left behind.
#include <gtest/gtest.h>
#include <stdlib.h>  // setenv
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "run_program.hpp"

namespace taut {
namespace {

using test::run_taut;
using test::TempFolder;

TEST(PairsPipe, AnswersAsFromAFile) {
  const std::string sphere = "x^2+y^2+z^2=1";
  const std::string lines = "1,0,0,0,1,0\n0.6,0.8,0,0,-0.6,0.8\n1,2\n0,0,1,0.8,0,-0.6\n";
  const TempFolder folder;
  const std::string file = folder.write("pairs.csv", lines).string();
  const std::string pipe = (folder.path() / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::filesystem::path temporary = folder.path() / "tmp";
  std::filesystem::create_directory(temporary);
  ASSERT_EQ(setenv("TMPDIR", temporary.c_str(), 1), 0);
  std::thread writer([&] { std::ofstream(pipe) << lines; });
  const test::ProgramResult by_pipe = run_taut({"path", sphere, "--pairs", pipe});
  writer.join();
  unsetenv("TMPDIR");
  const test::ProgramResult by_file = run_taut({"path", sphere, "--pairs", file});
  EXPECT_EQ(by_pipe.out, by_file.out);
  EXPECT_EQ(by_pipe.exit_code, 1);
  EXPECT_TRUE(by_pipe.out.starts_with("1.57079632679")) << by_pipe.out << by_pipe.err;
  EXPECT_NE(by_pipe.err.find("pipe line 3: "), std::string::npos) << by_pipe.err;
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
}

TEST(PairsPipe, NothingOnStandardInputIsSaid) {
  const test::ProgramResult result = run_taut({"path", "x^2+y^2+z^2=1", "--pairs", "-"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.err.find("standard input: the file is empty"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace taut
