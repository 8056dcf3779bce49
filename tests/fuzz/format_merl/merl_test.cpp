#include "formats/merl/merl.h"
#include "support/fuzz.h"

namespace suite::format_merl_merl_test {

// The table itself is 35 MB of numbers, any of which is legal; what can go wrong is the head and the length.
TEST(FuzzMerl, HeadAndLength) {
  test::Bytes whole(34992012);
  const int32_t dims[3] = {90, 90, 180};
  std::memcpy(whole.data(), dims, 12);
  ASSERT_NO_THROW(parse_merl(whole, "m.binary"));
  test::Mutator mutate(7);
  const test::Bytes head(whole.begin(), whole.begin() + 64);
  const size_t count = test::mutations(test::kMutations);
  for (size_t n = 0; n < count; ++n) {
    try {
      parse_merl(mutate(head), "m.binary");
      FAIL() << "a table of 64 bytes was accepted";
    } catch (const Error& e) {
      ASSERT_EQ(e.where().file, "m.binary");
    }
  }
  std::printf("%zu mutations, %zu refused\n", count, count);
}

}  // namespace suite::format_merl_merl_test
