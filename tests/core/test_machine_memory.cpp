#include "core/machine_memory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include "support/temp_folder.hpp"

namespace taut {
namespace {

constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text << "\n";
}

std::size_t limit(const std::string& membership, const std::filesystem::path& root) {
  std::istringstream lines(membership);
  return detail::control_group_limit(lines, root);
}

TEST(ControlGroupLimit, IsTheLeastOfTheGroupAndThoseAroundIt) {
  const test::TempFolder folder;
  write(folder.path() / "memory.max", "max");
  write(folder.path() / "batch/memory.max", "3000000");
  write(folder.path() / "batch/job/memory.max", "max");
  write(folder.path() / "batch/job/step/memory.max", "5000000");
  EXPECT_EQ(limit("0::/batch/job/step\n", folder.path()), 3000000U);
  EXPECT_EQ(limit("0::/\n", folder.path()), kNoLimit);
}

TEST(ControlGroupLimit, IsSeenFromWithinAContainer) {
  const test::TempFolder folder;
  write(folder.path() / "memory.max", "7000000");
  EXPECT_EQ(limit("0::/\n", folder.path()), 7000000U);
  write(folder.path() / "memory/memory.limit_in_bytes", "6000000");
  EXPECT_EQ(limit("5:cpu,cpuacct:/docker/1f\n4:memory:/docker/1f\n", folder.path()), 6000000U);
}

TEST(ControlGroupLimit, IsNoneWhereNothingIsSaid) {
  const test::TempFolder folder;
  EXPECT_EQ(limit("", folder.path()), kNoLimit);
  EXPECT_EQ(limit("what\n:\n3:cpu:/a\n0::/gone\n", folder.path()), kNoLimit);
}

TEST(MachineMemory, IsThatOfThisMachine) {
  EXPECT_GT(detail::machine_memory(), std::size_t{1} << 26);
  EXPECT_EQ(detail::machine_memory(), detail::machine_memory());
}

}  // namespace
}  // namespace taut
