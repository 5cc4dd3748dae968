// A mesh is fitted through its vertices: where that is far from its faces, the user is told.

#include <gtest/gtest.h>

#include "cli/run_program.hpp"

namespace taut::test {
namespace {

const char* const kCube =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

TEST(IgnoredFaces, OfACubeAreToldOf) {
  const TempFolder folder;
  const std::string cube = folder.write("cube.obj", kCube).string();
  const ProgramResult result = run_taut({"path", cube, "--from", "@0", "--to", "@6"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("faces are ignored"), std::string::npos) << result.err;
}

TEST(IgnoredFaces, AreToldOfOnceForManyPairs) {
  const TempFolder folder;
  const std::string cube = folder.write("cube.obj", kCube).string();
  const std::string pairs = folder.write("pairs.csv", "-1,-1,-1,1,1,1\n-1,-1,1,1,1,-1\n").string();
  const ProgramResult result = run_taut({"path", cube, "--pairs", pairs});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto at = result.err.find("faces are ignored");
  ASSERT_NE(at, std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("faces are ignored", at + 1), std::string::npos) << result.err;
}

TEST(IgnoredFaces, OfAFineMeshAreNotWorthAWord) {
  const TempFolder folder;
  // A fine mesh of a sphere: its faces stand 1e-3 off the ball.
  const std::string mesh = (folder.path() / "ball.ply").string();
  ASSERT_EQ(run_taut({"mesh", "x^2+y^2+z^2=1", "--cell", "0.2", "--out", mesh}).exit_code, 0);
  const ProgramResult result = run_taut({"path", mesh, "--from", "1,0,0", "--to", "0,0,1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("faces are ignored"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace taut::test
