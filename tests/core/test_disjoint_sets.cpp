#include "core/disjoint_sets.hpp"

#include <gtest/gtest.h>

namespace taut {
namespace {

TEST(DisjointSets, AreKnownByTheirLeastMember) {
  detail::DisjointSets sets(6);
  EXPECT_TRUE(sets.unite(5, 3));
  EXPECT_TRUE(sets.unite(4, 5));
  EXPECT_FALSE(sets.unite(3, 4));
  EXPECT_EQ(sets.find(4), 3U);
  EXPECT_EQ(sets.find(2), 2U);
  EXPECT_TRUE(sets.unite(4, 1));
  for (const std::uint32_t i : {1U, 3U, 4U, 5U}) EXPECT_EQ(sets.find(i), 1U);
  EXPECT_EQ(sets.find(0), 0U);
}

}  // namespace
}  // namespace taut
