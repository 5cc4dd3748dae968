#include "taut/io/output_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/temp_folder.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using test::TempFolder;

std::string error_of(const std::filesystem::path& path) {
  try {
    write_text(path, std::string(3 << 20, 'x'));
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST(OutputFile, AppearsOnlyWhenCommitted) {
  const TempFolder folder;
  const auto path = folder.path() / "a.txt";
  {
    OutputFile file(path);
    file.write("hello ");
    file.write_number(0.1);
    file.write(" ");
    file.write_number(std::ptrdiff_t{-3});
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
  }
  EXPECT_EQ(test::file_bytes(path), "hello 0.1 -3");
  EXPECT_EQ(folder.num_entries(), 1U);
}

TEST(OutputFile, LeavesNothingBehindWhenAbandoned) {
  const TempFolder folder;
  const auto path = folder.write("a.txt", "older");
  try {
    OutputFile file(path);
    file.write(std::string(5 << 20, 'x'));
    throw InvalidArgument("on the way");
  } catch (const InvalidArgument&) {
  }
  EXPECT_EQ(test::file_bytes(path), "older");
  EXPECT_EQ(folder.num_entries(), 1U);
}

TEST(OutputFile, KeepsTheModeOfWhatItReplaces) {
  namespace fs = std::filesystem;
  const TempFolder folder;
  const auto path = folder.write("a.txt", "older");
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  write_text(path, "newer");
  EXPECT_EQ(test::file_bytes(path), "newer");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST(OutputFile, FollowsSymbolicLinks) {
  const TempFolder folder;
  const auto path = folder.write("a.txt", "older");
  std::filesystem::create_symlink("a.txt", folder.path() / "link.txt");
  write_text(folder.path() / "link.txt", "newer");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.path() / "link.txt"));
  EXPECT_EQ(test::file_bytes(path), "newer");
}

TEST(OutputFile, SaysWhyItCannotBeWritten) {
  const TempFolder folder;
  EXPECT_NE(error_of(folder.path() / "none" / "a.txt").find("does not exist; create it first"), std::string::npos);
  EXPECT_NE(error_of(folder.path()).find("is a folder; name a file to write"), std::string::npos);
  EXPECT_NE(error_of("").find("the name of the output file is empty"), std::string::npos);
  EXPECT_NO_THROW(write_text("/dev/null", "gone"));
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_NE(error_of("/dev/full").find("make room on the disk"), std::string::npos);
  }
  EXPECT_NE(error_of(folder.path() / std::string(300, 'a')), "");
  EXPECT_EQ(folder.num_entries(), 0U);
}

}  // namespace
}  // namespace taut
