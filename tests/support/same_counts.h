// Counts of two runs that must be equal, whoever ran them.
#pragma once
#include <gtest/gtest.h>

#include "estimate/statistics.h"

namespace suite::test {

inline void expect_same_counts(const RunStatistics& a, const RunStatistics& b) {
  EXPECT_EQ(a.paths, b.paths);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.failures, b.failures);
  EXPECT_EQ(a.truncated, b.truncated);
  EXPECT_EQ(a.trace.rays, b.trace.rays);
}

}  // namespace suite::test
