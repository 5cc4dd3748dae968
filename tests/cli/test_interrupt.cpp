// Ctrl-C ends the program soon, with exit code 130 and one line on stderr; what a batch has answered stays, in whole
// lines.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
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
  // They are the answers of a run that nobody interrupts.
  const std::string fewer = folder.write("fewer.csv", sphere_pairs(answered)).string();
  const ProgramResult whole = run_taut({"path", sphere, "--pairs", fewer});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(result.out, whole.out);
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
