// The stack of media: priorities, order of entering, counting, any depth, copies that take no memory.
#include "transport/media/medium_stack.h"

#include <gtest/gtest.h>

#include <random>

namespace suite::medium_stack_test {
namespace {

// What the comment says, without any cleverness.
struct Plain {
  struct Entry {
    uint32_t object, medium;
    int priority, times;
    bool side;
  };
  std::vector<Entry> entries;
  void enter(uint32_t object, bool side, uint32_t medium, int priority) {
    for (Entry& e : entries)
      if (e.object == object && e.side == side && e.medium == medium) {
        ++e.times;
        return;
      }
    entries.push_back({object, medium, priority, 1, side});
  }
  void leave(uint32_t object, bool side) {
    for (size_t i = entries.size(); i-- > 0;)
      if (entries[i].object == object && entries[i].side == side) {
        if (--entries[i].times == 0) entries.erase(entries.begin() + static_cast<long>(i));
        return;
      }
  }
  uint32_t medium() const {
    const Entry* best = nullptr;
    for (const Entry& e : entries)
      if (!best || e.priority >= best->priority) best = &e;
    return best ? best->medium : 99999;
  }
};

TEST(MediumStack, HoldsWhatThePlainListHolds) {
  std::mt19937 random(3);
  for (const uint32_t bodies : {3u, 12u, 13u, 200u}) {
    MediumStack stack;
    Plain plain;
    size_t deepest = 0;
    for (int i = 0; i < 20000; ++i) {
      const auto object = static_cast<uint32_t>(random() % bodies);
      const bool side = random() % 4 == 0;
      if (random() % 100 < (i % 2000 < 1000 ? 65 : 35)) {
        stack.enter(object, side, object * 2 + side, static_cast<int>(object % 3) - 1);
        plain.enter(object, side, object * 2 + side, static_cast<int>(object % 3) - 1);
      } else {
        stack.leave(object, side, object * 2 + side);
        plain.leave(object, side);
      }
      deepest = std::max(deepest, stack.size());
      ASSERT_EQ(stack.medium(99999), plain.medium()) << i;
      ASSERT_EQ(stack.size(), plain.entries.size());
      const MediumStack copy(stack);
      ASSERT_EQ(copy.medium(99999), plain.medium());
    }
    EXPECT_GT(deepest, bodies / 2);
    EXPECT_LE(deepest, 2 * bodies);
    stack.filter([](uint32_t object) { return object == 1; });
    EXPECT_LE(stack.size(), 2u);
  }
}

TEST(MediumStack, GrowsWithBodiesAndNotWithCrossings) {
  MediumStack stack;
  for (int i = 0; i < 100000; ++i) stack.enter(7, true, 1, 0);  // an open surface that a path goes round
  EXPECT_EQ(stack.size(), 1u);
  for (int i = 0; i < 100000; ++i) stack.leave(7, true, 1);
  EXPECT_TRUE(stack.empty());
  stack.enter(7, true, MediumStack::kNothing, 0);
  EXPECT_TRUE(stack.empty());
}

TEST(MediumStack, CopiesOfDeepAndShallowOnes) {
  MediumStack deep, shallow, to;
  for (uint32_t i = 0; i < 300; ++i) deep.enter(i, true, i, 0);
  shallow.enter(5, true, 55, 0);
  to = deep;
  EXPECT_EQ(to.medium(0), 299u);
  to = shallow;
  EXPECT_EQ(to.medium(0), 55u);
  EXPECT_TRUE(to.holds(5, true));
  EXPECT_FALSE(to.holds(6, true));
  to = deep;
  for (uint32_t i = 300; i-- > 1;) to.leave(i, true, i);
  EXPECT_EQ(to.medium(9), 0u);
  EXPECT_EQ(deep.size(), 300u);
}

}  // namespace
}  // namespace suite::medium_stack_test
