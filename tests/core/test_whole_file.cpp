#include "core/whole_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "taut/core/error.hpp"

namespace taut {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("taut_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::string read(const fs::path& path) {
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
  }
  [[nodiscard]] std::ptrdiff_t num_files() const { return std::distance(fs::directory_iterator(folder_), {}); }

  fs::path folder_;
};

TEST_F(WholeFile, ReplacesWhatWasThereAndLeavesNothingElse) {
  const fs::path path = folder_ / "a.bin";
  detail::write_whole_file(path.string(), std::string("old\0one", 7));
  detail::write_whole_file(path.string(), std::string("new\0\xff", 5));
  EXPECT_EQ(read(path), std::string("new\0\xff", 5));
  EXPECT_EQ(num_files(), 1);
}

TEST_F(WholeFile, SaysWhyItCannotWrite) {
  EXPECT_THROW(detail::write_whole_file(folder_.string(), "x"), IoError);
  EXPECT_THROW(detail::write_whole_file((folder_ / "missing" / "a").string(), "x"), IoError);
  EXPECT_EQ(num_files(), 0);
}

TEST_F(WholeFile, FollowsASymbolicLink) {
  detail::write_whole_file((folder_ / "target").string(), "old");
  fs::create_symlink("target", folder_ / "link");
  detail::write_whole_file((folder_ / "link").string(), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read(folder_ / "target"), "new");
}

TEST_F(WholeFile, WritesToWhatIsNoRegularFile) { EXPECT_NO_THROW(detail::write_whole_file("/dev/null", "x")); }

}  // namespace
}  // namespace taut
