// The way of a path without techniques through the kernel stays short enough to be read: lines, comments and blank ones
// included, of the files of the kernel that it goes through. Flights through what fills space, light sampling, how
// paths start and end, and what only some paths come to stand in files of their own (kernel_fill.h, kernel_light.h,
// kernel_start.h, kernel_end.h, kernel_beside.h).
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace suite::test::plain_loop_test {
namespace {

size_t lines(std::istream& in) {
  size_t n = 0;
  for (std::string line; std::getline(in, line);) ++n;
  return n;
}

TEST(PlainLoop, FitsIntoFiveHundredLines) {
  size_t all = 0;
  for (const char* const name : {"kernel", "kernel_fly", "kernel_meet", "kernel_go_on"}) {
    std::ifstream in(std::string(SUITE_SOURCE_DIR) + "/libs/transport/" + name + ".h");
    const size_t n = lines(in);
    EXPECT_GT(n, 50u) << name;
    std::cout << name << ".h: " << n << " lines\n";
    all += n;
  }
  EXPECT_LE(all, 500u);
}

TEST(PlainLoop, LinesAreCounted) {
  std::istringstream in("// a comment\n\nint a;  // one\n  }\n");
  EXPECT_EQ(lines(in), 4u);
}

}  // namespace
}  // namespace suite::test::plain_loop_test
