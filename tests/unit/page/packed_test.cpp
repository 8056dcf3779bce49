// Numbers in few bytes: exact where they can be, as near as is said where not, with the loss measured.
#include "page/packed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "page/live_page.h"

namespace suite {
namespace {

TEST(HalfBits, AreThoseOfIeee754) {
  // Table of the format: sign, 5 bits of exponent, 10 of mantissa.
  for (const auto& [x, bits] : std::vector<std::pair<float, int>>{{0.0f, 0},
                                                                  {-0.0f, 0x8000},
                                                                  {1.0f, 0x3c00},
                                                                  {-2.0f, 0xc000},
                                                                  {65504.0f, 0x7bff},
                                                                  {65520.0f, 0x7c00},
                                                                  {0x1p-14f, 0x0400},
                                                                  {0x1p-24f, 1},
                                                                  {0x1p-26f, 0},
                                                                  {1.0f / 3, 0x3555},
                                                                  {INFINITY, 0x7c00}})
    EXPECT_EQ(half_bits(x), bits) << x;
  EXPECT_EQ(half_bits(NAN) & 0x7e00, 0x7e00);
  EXPECT_EQ(half_bits(1 + 0x1p-11f), 0x3c00);  // a tie goes to the even one
  EXPECT_EQ(half_bits(1 + 0x3p-11f), 0x3c02);
}

TEST(PackedHalf, KeepsNumbersOfAnySizeWithinItsPromise) {
  for (const double scale : {1e-30, 1.0, 1e30}) {
    std::vector<float> values;
    for (int i = 0; i < 2000; ++i)
      values.push_back(static_cast<float>(scale * std::exp(-0.009 * i) * (i % 2 ? -1 : 1)));
    values.push_back(NAN);
    const Packed p = packed_half(values);
    ASSERT_EQ(p.bytes.size(), 2 * values.size());
    EXPECT_LE(p.loss, 0x1p-11);
    EXPECT_GT(p.loss, 0x1p-13);  // the control: it is measured, not assumed
    uint16_t first = 0;
    std::memcpy(&first, p.bytes.data(), 2);
    EXPECT_EQ(first & 0x8000, 0);
    EXPECT_EQ(first >> 10 & 31, 14 + 15);  // the largest is between 2^14 and 2^15
  }
}

TEST(PackedLog8, KeepsZeroAndNothingAndStepsEvenly) {
  const Packed p = packed_log8(std::vector<float>{NAN, 0, -1, 1e-3f, 1, 1e3f, INFINITY});
  const int wanted[] = {0, 1, 0, 2, 128, 255, 0};
  for (size_t i = 0; i < 7; ++i) EXPECT_NEAR(std::to_integer<int>(p.bytes[i]), wanted[i], i == 4 ? 1 : 0) << i;
  EXPECT_NEAR(p.first * std::pow(p.second, 253), 1e3, 1e-3);
  EXPECT_LE(p.loss, 0.5 * (p.second - 1) * 1.01);
  EXPECT_EQ(packed_log8(std::vector<float>{2, 2}).loss, 0);
}

TEST(Base64, IsThatOfRfc4648) {
  // Section 10 of the RFC.
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors)
    EXPECT_EQ(base64(std::as_bytes(std::span(plain, std::strlen(plain)))), coded);
}

}  // namespace
}  // namespace suite
