// The way of a path without techniques through the kernel stays short enough to be read: lines of code, comments and
// blank lines apart, of the files of the kernel that it goes through. Flights through what fills space, light sampling
// and what only some paths come to stand in files of their own (kernel_fill.h, kernel_light.h, kernel_beside.h).
#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <sstream>
#include <string>

namespace suite::test {
namespace {

size_t lines_of_code(std::istream& in) {
  size_t n = 0;
  for (std::string line; std::getline(in, line);) {
    line = line.substr(0, line.find("//"));
    n += line.find_first_not_of(" \t") != std::string::npos;
  }
  return n;
}

TEST(PlainLoop, FitsIntoFiveHundredLines) {
  size_t all = 0;
  for (const char* const name : {"kernel", "kernel_fly", "kernel_meet", "kernel_go_on"}) {
    std::ifstream in(std::string(SUITE_SOURCE_DIR) + "/libs/transport/" + name + ".h");
    const size_t n = lines_of_code(in);
    EXPECT_GT(n, 50u) << name;
    std::cout << name << ".h: " << n << " lines of code\n";
    all += n;
  }
  EXPECT_LE(all, 500u);
}

TEST(PlainLoop, LinesAreCounted) {
  std::istringstream in("// a comment\n\nint a;  // one\n  }\n");
  EXPECT_EQ(lines_of_code(in), 2u);
}

}  // namespace
}  // namespace suite::test
