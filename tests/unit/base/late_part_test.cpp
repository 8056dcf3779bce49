// Parts that are loaded when they are needed: found beside the program, or refused with what would be right.
#include "base/late_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/version.h"
#include "support/message_of.h"

namespace suite::late_part_test {
namespace {
using testing::AllOf;
using testing::HasSubstr;

TEST(LatePart, IsLoadedOnceAndStays) {
  const void* const answer = late_symbol("toy", "toy_answer");
  EXPECT_EQ(*static_cast<const int*>(answer), 42);
  EXPECT_EQ(late_symbol("toy", "toy_answer"), answer);
}

TEST(LatePart, ThatIsNotThereIsToldWithItsPlace) {
  EXPECT_THAT(message_of([] { late_symbol("nowhere", "toy_answer"); }),
              AllOf(HasSubstr("the part 'nowhere' cannot be loaded"), HasSubstr("lib/suite/nowhere.so"),
                    HasSubstr("lib/suite beside the folder of this program")));
}

TEST(LatePart, OfAnotherVersionIsRefused) {
  EXPECT_THAT(message_of([] { late_symbol("toy_of_old", "toy_answer"); }),
              HasSubstr(std::string("the part 'toy_of_old' is of version 0.0.1, the program of ") + kVersion));
}

TEST(LatePart, WithoutTheSymbolIsRefused) {
  EXPECT_THAT(message_of([] { late_symbol("toy", "toy_question"); }),
              HasSubstr("the part 'toy' exports no 'toy_question'"));
}

}  // namespace
}  // namespace suite::late_part_test
