// Parallel loops: every index once, exceptions arrive, results independent of the thread count.
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "base/parallel.h"

namespace suite::parallel_test {

TEST(Parallel, EveryIndexOnceForAnyGrainAndThreadCount) {
  for (const int count : {1, 2, 5, 0}) {
    set_threads(count);
    EXPECT_GE(threads(), 1);
    for (const size_t grain : {0, 1, 7, 1000, 100000}) {
      std::vector<std::atomic<int>> hits(1003);
      parallel_for(3, 1003, grain, [&](size_t begin, size_t end) {
        ASSERT_LT(begin, end);
        ASSERT_LE(end - begin, std::max<size_t>(grain, 1));
        for (size_t i = begin; i < end; ++i) ++hits[i];
      });
      for (size_t i = 0; i < hits.size(); ++i) ASSERT_EQ(hits[i], i < 3 ? 0 : 1) << i;
    }
    parallel_for(5, 5, 1, [](size_t, size_t) { FAIL() << "an empty range has no body"; });
  }
  set_threads(0);
}

TEST(Parallel, BlocksDoNotDependOnTheThreadCount) {
  // Floating sums per block are the same bits for any number of threads, because the blocks are.
  std::vector<double> reference;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    std::vector<double> sums(77);
    parallel_for(0, 7654, 100, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) sums[begin / 100] += 1.0 / static_cast<double>(i + 1);
    });
    if (reference.empty()) reference = sums;
    EXPECT_EQ(sums, reference);
  }
  set_threads(0);
}

TEST(Parallel, TheFirstExceptionIsRethrownAndTheNextLoopWorks) {
  EXPECT_THROW(parallel_for(0, 1000, 1,
                            [](size_t begin, size_t) {
                              if (begin == 500) throw std::runtime_error("x");
                            }),
               std::runtime_error);
  std::atomic<int> n{0};
  parallel_for(0, 10, 1, [&](size_t, size_t) { ++n; });
  EXPECT_EQ(n, 10);
}

}  // namespace suite::parallel_test
