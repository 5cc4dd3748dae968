// README.md and docs/*.md: every command that a page shows runs, ends with the exit code that the page says, and prints
// what the page shows. Files come from examples/data, or from commands further up on the page.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "cli/page_commands.hpp"
#include "cli/run_program.hpp"
#include "cli/shown_output.hpp"
#include "support/temp_folder.hpp"

namespace taut {
namespace {

namespace fs = std::filesystem;
using test::file_bytes;
using test::lines_of;
using test::PageCommand;
using test::PageReader;
using test::ProgramResult;
using test::TempFolder;

const fs::path kSource = TAUT_SOURCE_FOLDER;

std::vector<PageCommand> commands_of(const fs::path& page) { return PageReader(lines_of(file_bytes(page))).commands(); }

/// The pages that show commands, by their path from the source folder.
std::vector<std::string> pages() {
  std::vector<std::string> found = {"README.md"};
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") found.push_back("docs/" + entry.path().filename().string());
  }
  std::erase_if(found, [](const std::string& page) { return commands_of(kSource / page).empty(); });
  std::sort(found.begin(), found.end());
  return found;
}

/// A folder as a reader has it: examples/data is there, and taut is on the PATH.
class Desk {
 public:
  Desk() {
    fs::create_directory(folder_.path() / "bin");
    fs::create_symlink(TAUT_PROGRAM, folder_.path() / "bin" / "taut");
    fs::create_symlink(kSource / "examples", folder_.path() / "examples");
  }

  [[nodiscard]] ProgramResult run(const std::string& command) const {
    folder_.write("command.sh", command + "\n");
    const std::string call = "cd '" + folder_.path().string() + "' && PATH=\"$PWD/bin:$PATH\" LC_ALL=C.UTF-8 " +
                             "timeout 300 sh ./command.sh >out.txt 2>err.txt </dev/null";
    const int status = std::system(call.c_str());
    return {.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .out = file_bytes(folder_.path() / "out.txt"),
            .err = file_bytes(folder_.path() / "err.txt")};
  }

 private:
  TempFolder folder_;
};

class Documents : public testing::TestWithParam<std::string> {};

TEST_P(Documents, CommandsDoWhatThePageSays) {
  const Desk desk;
  for (const PageCommand& command : commands_of(kSource / GetParam())) {
    if (!command.run) continue;
    SCOPED_TRACE(command.line);
    const ProgramResult result = desk.run(command.line);
    EXPECT_EQ(result.exit_code, command.exit_code) << result.err;
    EXPECT_EQ(test::first_missing(command.shown, lines_of(result.out), lines_of(result.err)), "")
        << result.out << result.err;
  }
}

std::string name_of(const testing::TestParamInfo<std::string>& page) {
  std::string name = fs::path(page.param).stem().string();
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pages, Documents, testing::ValuesIn(pages()), name_of);

TEST(ShownOutput, TellsWordsAndNumbersApart) {
  EXPECT_TRUE(test::same_line("length    1.5708 +- 7.7e-13", "length    1.57079632679 +- 2.2e-15"));
  EXPECT_FALSE(test::same_line("length    1.5709 +- 7.7e-13", "length    1.57079632679 +- 2.2e-05"));
  EXPECT_FALSE(test::same_line("length    1.58", "length    1.55"));
  EXPECT_FALSE(test::same_line("status    ok, locally shortest", "status    ok"));
  EXPECT_TRUE(test::same_line("cells     3,016 of size 0.06445", "cells     3,016 of size 0.06445"));
  EXPECT_FALSE(test::same_line("cells     3,016 of size 0.06445", "cells     3,017 of size 0.06445"));
  EXPECT_TRUE(test::same_line("taut: note: the path ...", "taut: note: the path runs over 7 things"));
  EXPECT_TRUE(test::same_line("time      ...", "time      10 ms"));
  EXPECT_EQ(test::first_missing({"a 1", "b"}, {"a 1", "c"}, {"b"}), "");
  EXPECT_EQ(test::first_missing({"b", "a"}, {"a", "b"}, {}), "a");
}

TEST(PageCommands, KnowMarkersAndContinuations) {
  const std::vector<PageCommand> commands = PageReader({"Text", "", "<!-- exits with 4 -->", "", "    $ taut a \\",
                                                        "        b", "    shown", "", "```", "taut c", "```"})
                                                .commands();
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_EQ(commands[0].line, "taut a b");
  EXPECT_EQ(commands[0].shown, std::vector<std::string>{"shown"});
  EXPECT_EQ(commands[0].exit_code, 4);
  EXPECT_EQ(commands[1].line, "taut c");
  EXPECT_EQ(commands[1].exit_code, 0);
}

}  // namespace
}  // namespace taut
