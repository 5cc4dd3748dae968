// --help: fits a terminal, and shows examples of the command that was asked about.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

using test::lines_of;
using test::ProgramResult;
using test::run_taut;

/// The names under "Subcommands:".
std::vector<std::string> commands() {
  std::vector<std::string> names;
  bool listed = false;
  for (const std::string& line : lines_of(run_taut({"--help"}).out)) {
    if (listed && line.starts_with("  ") && line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
    if (listed && line.empty()) break;
    listed = listed || line == "Subcommands:";
  }
  return names;
}

void expect_narrow(const std::string& help) {
  constexpr std::size_t kColumns = 80;
  for (const std::string& line : lines_of(help)) EXPECT_LE(line.size(), kColumns) << line;
}

TEST(Help, FitsEightyColumns) {
  expect_narrow(run_taut({"--help"}).out);
  const auto names = commands();
  EXPECT_GE(names.size(), 14U);
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const ProgramResult help = run_taut({name, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    expect_narrow(help.out);
    EXPECT_NE(help.out.find("Examples:\n  taut " + name + " "), std::string::npos) << help.out;
  }
}

}  // namespace
}  // namespace taut
