// Ctrl-C ends the program soon, with exit code 130 and one line on stderr; what a batch has answered stays, in whole
// lines.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::ProgramResult;
using test::run_taut;
using test::RunningProgram;
using test::TempFolder;
using namespace std::chrono_literals;

constexpr int kInterrupted = 130;
/// Far less in practice: a hundredth of a second. Sanitizers and a busy machine are slow.
constexpr auto kSoon = 10s;

/// Waits until `ready`, half a minute at most; false when the program has ended or the time is over.
bool wait_until(RunningProgram& program, const std::function<bool()>& ready) {
  const auto deadline = std::chrono::steady_clock::now() + 30s;
  while (!ready()) {
    if (program.ended() || std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(2ms);
  }
  return true;
}

/// SIGINT, and then the end that the contract promises.
ProgramResult interrupt(RunningProgram& program) {
  program.send(SIGINT);
  ProgramResult result = program.wait(kSoon);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, kInterrupted) << "signal " << result.signal;
  EXPECT_NE(result.err.find("taut: interrupted\n"), std::string::npos) << result.err;
  return result;
}

/// Great circles between the pairs below.
const std::array<double, 4> kSphereLengths = {std::acos(0.0), std::acos(-0.48), std::acos(-0.6), std::acos(0.0)};

/// `count` lines of the same few pairs of points of the unit sphere, over and over.
std::string sphere_pairs(int count) {
  const char* const pairs[] = {"1,0,0,0,1,0", "0.6,0.8,0,0,-0.6,0.8", "0,0,1,0.8,0,-0.6", "-1,0,0,0,0.8,0.6"};
  std::string lines;
  for (int i = 0; i < count; ++i) lines.append(pairs[i % 4]).append(1, '\n');
  return lines;
}

TEST(Interrupt, LeavesTheWholeLinesOfABatch) {
  const TempFolder folder;
  constexpr int kEndless = 1000000;
  const std::string pairs = folder.write("pairs.csv", sphere_pairs(kEndless)).string();
  const std::string sphere = "x^2+y^2+z^2=1";
  RunningProgram program({"path", sphere, "--pairs", pairs});
  ASSERT_TRUE(wait_until(program, [&] { return !program.out().empty(); })) << program.err();
  const ProgramResult result = interrupt(program);
  EXPECT_EQ(result.err, "taut: interrupted\n");

  ASSERT_FALSE(result.out.empty());
  EXPECT_EQ(result.out.back(), '\n') << result.out.substr(result.out.rfind('\n') + 1);
  const auto answered = static_cast<int>(std::count(result.out.begin(), result.out.end(), '\n'));
  EXPECT_LT(answered, kEndless);
  // They are right: all four pairs are a known part of a great circle apart.
  std::istringstream lines(result.out);
  for (int i = 0; i < answered; ++i) {
    double length = 0;
    std::string rest;
    lines >> length;
    std::getline(lines, rest);
    ASSERT_NEAR(length, kSphereLengths[i % 4], 1e-9) << "line " << i + 1;
    ASSERT_TRUE(rest.ends_with(",ok")) << rest;
  }
}

TEST(Interrupt, AKilledBatchGoesOnWhereItWas) {
  const TempFolder folder;
  const std::string pairs = folder.write("pairs.csv", sphere_pairs(6000)).string();
  const auto out = folder.path() / "lengths.csv";
  const auto partial = folder.path() / "lengths.csv.partial";
  const std::vector<std::string> command = {"path", "x^2+y^2+z^2=1", "--pairs", pairs, "--out", out.string()};
  {
    RunningProgram program(command);
    // The first lines and part of the next.
    ASSERT_TRUE(wait_until(program, [&] { return test::file_bytes(partial).size() > 5000; })) << program.err();
    program.send(SIGKILL);
    program.wait(kSoon);
  }
  ASSERT_FALSE(std::filesystem::exists(out));
  const std::string kept = test::file_bytes(partial);
  std::ofstream(partial, std::ios::app) << "1.2345,1e-";  // a line that was being written
  const ProgramResult rest = run_taut(command);
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_NE(rest.err.find("going on after"), std::string::npos) << rest.err;
  EXPECT_FALSE(std::filesystem::exists(partial));
  const std::string resumed = test::file_bytes(out);
  const std::string earlier = kept.substr(kept.find('\n') + 1);
  EXPECT_TRUE(resumed.starts_with(earlier.substr(0, earlier.rfind('\n') + 1)));
  // The same as in one go.
  const ProgramResult whole = run_taut({"path", "x^2+y^2+z^2=1", "--pairs", pairs});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(resumed, whole.out);
}

TEST(Interrupt, AnotherRequestStartsAnew) {
  const TempFolder folder;
  const std::string pairs = folder.write("pairs.csv", sphere_pairs(40)).string();
  const auto out = folder.path() / "lengths.csv";
  folder.write("lengths.csv.partial", "# taut path something else\n0.5,0,1,1,ok\n");
  const ProgramResult result = run_taut({"path", "x^2+y^2+z^2=1", "--pairs", pairs, "--out", out.string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string lines = test::file_bytes(out);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 40);
  EXPECT_EQ(lines.find("0.5,0,1,1,ok"), std::string::npos);
}

TEST(Interrupt, ReachesTheMiddleOfALongStage) {
  const TempFolder folder;
  const std::string out = (folder.path() / "path.json").string();
  // Some ten million cells: seconds of work before the first answer.
  RunningProgram program({"path", "x^4-5x^2+y^4-5y^2+z^4-5z^2+11.8=0", "--from", "1.769,0.83,0.83", "--to",
                          "-1.769,-0.83,-0.83", "--cell", "0.005", "--grid", "subdivide", "--progress", "--out", out});
  ASSERT_TRUE(wait_until(program, [&] { return !program.err().empty(); })) << "no progress before the end";
  const ProgramResult result = interrupt(program);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(folder.num_entries(), 0U) << "half-written output";
}

TEST(Interrupt, AnImpatientSecondOneEndsItToo) {
  const TempFolder folder;
  const std::string pairs = folder.write("pairs.csv", sphere_pairs(100000)).string();
  RunningProgram program({"path", "x^2+y^2+z^2=1", "--pairs", pairs});
  ASSERT_TRUE(wait_until(program, [&] { return !program.out().empty(); })) << program.err();
  program.send(SIGINT);
  program.send(SIGINT);
  const ProgramResult result = program.wait(kSoon);
  EXPECT_FALSE(result.timed_out);
  EXPECT_EQ(result.exit_code, kInterrupted);
}

}  // namespace
}  // namespace taut
