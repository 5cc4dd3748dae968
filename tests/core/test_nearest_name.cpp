#include "taut/core/error.hpp"

#include <gtest/gtest.h>

namespace taut {
namespace {

TEST(NearestName, ForgivesOneSlipInShortNamesAndTwoInLong) {
  const std::vector<std::string_view> known = {"from", "to", "tolerance", "samples", "sin"};
  EXPECT_EQ(nearest_name("form", known), "from");  // letters swapped
  EXPECT_EQ(nearest_name("fom", known), "from");   // one left out
  EXPECT_EQ(nearest_name("tolerence", known), "tolerance");
  EXPECT_EQ(nearest_name("smaplse", known), "samples");
  EXPECT_EQ(nearest_name("Sin", known), "sin");
  EXPECT_EQ(nearest_name("fxyz", known), "");
  EXPECT_EQ(nearest_name("smaplee5", known), "");
  EXPECT_EQ(nearest_name("", {}), "");
}

}  // namespace
}  // namespace taut
