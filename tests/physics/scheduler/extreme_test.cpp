// Every extreme case holds; and each deliberate fault is noticed by at least one of them.
#include <gtest/gtest.h>

#include "extreme/case.h"

namespace suite::extreme::extreme_test {
namespace {

TEST(Extreme, EveryCaseHolds) {
  size_t rows = 0;
  for (const Case& c : all_cases()) {
    ++rows;
    if (!c.open.empty()) continue;
    const Outcome o = measure(c, production());
    EXPECT_TRUE(o.held) << c.group << ", " << c.name << ": error " << o.error << " " << c.unit << ", bound " << c.bound;
  }
  EXPECT_GE(rows, 60u);
}

// Groups that take long and that no fault reaches are left out.
TEST(Extreme, EveryFaultIsNoticed) {
  const std::vector<Case> cases = all_cases();
  for (const Fault& fault : faults()) {
    std::string noticed;
    for (const Case& c : cases) {
      const bool slow = c.group == "open furnace" || c.group == "SQT" || c.group == "views" || c.group == "Ward";
      if (!c.open.empty() || slow || !noticed.empty()) continue;
      if (!measure(c, fault.numerics).held) noticed = c.group + ", " + c.name;
    }
    EXPECT_FALSE(noticed.empty()) << fault.name << " went unnoticed";
    std::printf("%-36s noticed by: %s\n", fault.name.c_str(), noticed.c_str());
  }
}

}  // namespace
}  // namespace suite::extreme::extreme_test
