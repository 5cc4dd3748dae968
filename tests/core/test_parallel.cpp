#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace taut {
namespace {

TEST(ParallelFor, VisitsEveryIndexOnceInTheSameBlocks) {
  for (const int threads : {0, 1, 3}) {
    for (const Index n : {0, 1, 7, 8, 1000}) {
      std::vector<int> visits(static_cast<std::size_t>(n), 0);
      detail::parallel_for({.threads = threads}, 0, n, 8, [&](Index first, Index last) {
        EXPECT_EQ(first % 8, 0);
        EXPECT_LE(last - first, 8);
        for (Index i = first; i < last; ++i) ++visits[static_cast<std::size_t>(i)];
      });
      for (const int count : visits) EXPECT_EQ(count, 1);
    }
  }
}

TEST(ParallelFor, HandsOnWhatABodyThrows) {
  const auto body = [](Index first, Index) {
    if (first == 40) throw std::runtime_error("block 40");
  };
  EXPECT_THROW(detail::parallel_for({}, 0, 100, 10, body), std::runtime_error);
  EXPECT_THROW(detail::parallel_for({.threads = 1}, 0, 100, 10, body), std::runtime_error);
}

TEST(ParallelFor, StopsWhenCancelled) {
  const std::atomic<bool> cancel = true;
  int calls = 0;
  EXPECT_THROW(detail::parallel_for({.threads = 1, .cancel = &cancel}, 0, 100, 10, [&](Index, Index) { ++calls; }),
               Cancelled);
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace taut
