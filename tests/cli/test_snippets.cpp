// The snippets of C++ that README.md and docs/*.md show stand in examples/, where they are compiled and run. Blanks,
// line ends and remarks do not count; the order of #include lines does not either.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cli/run_program.hpp"

namespace taut {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = TAUT_SOURCE_FOLDER;

/// C++ without what does not count.
struct Code {
  std::vector<std::string> includes;  ///< "taut/query/path.hpp"
  std::string text;                   ///< the rest, without blanks and remarks
};

Code code_of(const std::vector<std::string>& lines) {
  Code code;
  for (std::string line : lines) {
    constexpr std::string_view kInclude = "#include ";
    if (line.starts_with(kInclude)) {
      code.includes.push_back(line.substr(kInclude.size()));
      continue;
    }
    line.resize(std::min(line.find("// "), line.size()));  // no snippet has one within quotes
    std::erase_if(line, [](unsigned char c) { return std::isspace(c) != 0; });
    code.text += line;
  }
  return code;
}

/// The fenced blocks of C++ on a page.
std::vector<Code> snippets_of(const fs::path& page) {
  std::vector<Code> found;
  std::vector<std::string> block;
  bool inside = false;
  for (const std::string& line : test::lines_of(test::file_bytes(page))) {
    if (!inside) {
      inside = line == "```cpp";
    } else if (line == "```") {
      found.push_back(code_of(block));
      block.clear();
      inside = false;
    } else {
      block.push_back(line);
    }
  }
  return found;
}

bool holds(const Code& example, const Code& snippet) {
  return example.text.find(snippet.text) != std::string::npos &&
         std::ranges::all_of(snippet.includes, [&](const std::string& header) {
           return std::ranges::find(example.includes, header) != example.includes.end();
         });
}

TEST(Snippets, OfThePagesStandInTheExamples) {
  std::vector<Code> examples;
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "examples")) {
    if (entry.path().extension() == ".cpp") examples.push_back(code_of(test::lines_of(test::file_bytes(entry))));
  }
  std::vector<fs::path> pages = {kSource / "README.md"};
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  std::size_t count = 0;
  for (const fs::path& page : pages) {
    for (const Code& snippet : snippets_of(page)) {
      ++count;
      EXPECT_TRUE(std::ranges::any_of(examples, [&](const Code& example) { return holds(example, snippet); }))
          << page << ": is not in examples/, or not its includes: " << snippet.text;
    }
  }
  EXPECT_GE(count, 25U) << "are fences of another kind used now?";
}

TEST(Snippets, RemarksAndBlanksDoNotCount) {
  const Code example = code_of({"#include <b>", "#include <a>", "int f() {", "  const int x = 1;  // one", "}"});
  EXPECT_TRUE(holds(example, code_of({"#include <a>", "", "const int x =", "    1; // a remark"})));
  EXPECT_FALSE(holds(example, code_of({"const int x = 2;"})));
  EXPECT_FALSE(holds(example, code_of({"#include <c>", "const int x = 1;"})));
}

/// Lines of the pages but tables and blocks, which may be wider.
TEST(Pages, LinesHaveAtMost120Characters) {
  std::vector<fs::path> pages = {kSource / "README.md", kSource / "CONTRIBUTING.md"};
  for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  for (const fs::path& page : pages) {
    for (const std::string& line : test::lines_of(test::file_bytes(page))) {
      const auto letters = std::ranges::count_if(line, [](unsigned char c) { return (c & 0xC0U) != 0x80; });
      EXPECT_LE(letters, 120) << page << ": " << line;
    }
  }
}

}  // namespace
}  // namespace taut
