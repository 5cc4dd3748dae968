#pragma once

// The commands that a page of the documents shows. A command is a line of a fenced or indented block that begins with
// "$ " or with "taut "; a backslash at its end continues it. What follows, up to the next command or the end of the
// block, is the output that the page shows. A comment before the block says what is not plain:
//   <!-- exits with 4 -->           the exit code of its commands
//   <!-- output not compared -->    abridged in a way that no rule knows
//   <!-- not run: the reason -->    files that are not shipped, or minutes of work

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace taut::test {

struct PageCommand {
  std::string line;                ///< what the shell is given
  std::vector<std::string> shown;  ///< lines of output, without empty ones
  int exit_code = 0;
  bool run = true;
};

class PageReader {
 public:
  explicit PageReader(std::vector<std::string> lines) : lines_(std::move(lines)) {}

  [[nodiscard]] std::vector<PageCommand> commands() {
    bool after_blank = true;
    for (at_ = 0; at_ < lines_.size();) {
      const std::string& line = lines_[at_];
      if (line.starts_with("<!-- ") && line.ends_with(" -->")) {
        marker_ = line.substr(5, line.size() - 9);
        ++at_;
      } else if (line.starts_with("```")) {
        ++at_;
        add_block(fenced());
      } else if (after_blank && line.starts_with(kIndent)) {
        add_block(indented());
        after_blank = true;
      } else {
        after_blank = line.empty();
        if (!line.empty()) marker_.clear();
        ++at_;
      }
    }
    return std::move(commands_);
  }

 private:
  static constexpr std::string_view kIndent = "    ";

  std::vector<std::string> fenced() {
    std::vector<std::string> block;
    for (; at_ < lines_.size() && !lines_[at_].starts_with("```"); ++at_) block.push_back(lines_[at_]);
    ++at_;
    return block;
  }

  std::vector<std::string> indented() {
    std::vector<std::string> block;
    for (; at_ < lines_.size() && (lines_[at_].empty() || lines_[at_].starts_with(kIndent)); ++at_) {
      block.push_back(lines_[at_].empty() ? "" : lines_[at_].substr(kIndent.size()));
    }
    return block;
  }

  void add_block(const std::vector<std::string>& block) {
    bool open = false;  // a command has begun in this block
    for (std::size_t i = 0; i < block.size(); ++i) {
      if (block[i].starts_with("$ ") || block[i].starts_with("taut ")) {
        std::string line = block[i].starts_with("$ ") ? block[i].substr(2) : block[i];
        while (line.ends_with("\\") && i + 1 < block.size()) {
          line.pop_back();
          ++i;
          line += block[i].substr(std::min(block[i].find_first_not_of(' '), block[i].size()));
        }
        commands_.push_back(marked(line));
        open = true;
      } else if (open && !block[i].empty() && marker_ != "output not compared") {
        commands_.back().shown.push_back(block[i]);
      }
    }
    marker_.clear();
  }

  [[nodiscard]] PageCommand marked(const std::string& line) const {
    PageCommand command;
    command.line = line;
    constexpr std::string_view kExits = "exits with ";
    if (marker_.starts_with(kExits)) command.exit_code = std::stoi(marker_.substr(kExits.size()));
    command.run = !marker_.starts_with("not run: ");
    return command;
  }

  std::vector<std::string> lines_;
  std::size_t at_ = 0;
  std::string marker_;
  std::vector<PageCommand> commands_;
};

}  // namespace taut::test
