// Numbers in few bytes: exact where they can be, as near as is said where not, with the loss measured.
#include "page/packed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <tuple>

#include "page/live_page.h"
#include "page/steps.h"

namespace suite::packed_test {
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
    ASSERT_EQ(p.codes.size(), values.size());
    EXPECT_LE(p.loss, 0x1p-11);
    EXPECT_GT(p.loss, 0x1p-13);  // the control: it is measured, not assumed
    EXPECT_EQ(p.codes[0] & 0x8000, 0);
    EXPECT_EQ(p.codes[0] >> 10 & 31, 14 + 15);  // the largest is between 2^14 and 2^15
  }
}

TEST(PackedLog8, KeepsZeroAndNothingAndStepsEvenly) {
  const Packed p = packed_log8(std::vector<float>{NAN, 0, -1, 1e-3f, 1, 1e3f, INFINITY});
  const int wanted[] = {0, 1, 0, 2, 128, 255, 0};
  for (size_t i = 0; i < 7; ++i) EXPECT_NEAR(p.codes[i], wanted[i], i == 4 ? 1 : 0) << i;
  EXPECT_NEAR(p.first * std::pow(p.second, 253), 1e3, 1e-3);
  EXPECT_LE(p.loss, 0.5 * (p.second - 1) * 1.01);
  EXPECT_EQ(packed_log8(std::vector<float>{2, 2}).loss, 0);
}

// A reader of its own, written from steps.h.
std::vector<uint16_t> out_of_steps(const std::vector<std::byte>& bytes, size_t count, std::vector<uint16_t> base) {
  const size_t blocks = (count + 63) / 64;
  base.resize(blocks * 64, base.empty() ? uint16_t{0} : base.back());
  std::vector<uint16_t> out;
  size_t bit = 24 * blocks;
  const auto number = [&](size_t from, unsigned bits) {
    unsigned n = 0;
    for (unsigned i = 0; i < bits; ++i, ++from)
      n |= (std::to_integer<unsigned>(bytes.at(from / 8)) >> from % 8 & 1) << i;
    return n;
  };
  for (size_t b = 0; b < blocks; ++b) {
    const unsigned first = number(24 * b, 16), width = number(24 * b + 16, 5), way = number(24 * b + 21, 2);
    unsigned last = first;
    for (size_t i = 0; i < 64; ++i, bit += width) {
      const unsigned f = number(bit, width), step = f % 2 ? ~(f / 2) : f / 2;
      last = way & 2 ? first + step : last + step;
      out.push_back(static_cast<uint16_t>(last + (way & 1 ? base[out.size()] : 0)));
    }
  }
  EXPECT_EQ(bit, 8 * bytes.size());
  out.resize(count);
  return out;
}

TEST(Steps, LoseNothingAndTakeTheShortestWay) {
  uint32_t seed = 1;
  const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) >> 8; };
  for (const size_t count : {1u, 63u, 64u, 65u, 1000u}) {
    std::vector<uint16_t> wild(count), smooth(count), similar(count), none(count, 7);
    for (size_t i = 0; i < count; ++i) {
      wild[i] = static_cast<uint16_t>(random());
      smooth[i] = static_cast<uint16_t>(65000 + 3 * i + random() % 4);  // beyond 2^16
      similar[i] = static_cast<uint16_t>(wild[i] + 5 + random() % 2);
    }
    const size_t blocks = (count + 63) / 64;
    for (const auto& [codes, base, most_bits] :
         std::vector<std::tuple<std::vector<uint16_t>, std::vector<uint16_t>, size_t>>{
             {wild, {}, 16}, {smooth, {}, 4}, {similar, wild, 2}, {smooth, wild, 4}, {none, {}, 0}}) {
      const std::vector<std::byte> bytes = in_steps(codes, base);
      EXPECT_LE(bytes.size(), blocks * (3 + 8 * most_bits)) << count;
      EXPECT_EQ(out_of_steps(bytes, count, base), codes) << count;
    }
    // The control: steps taken off another picture are not those codes.
    if (count > 1) {
      EXPECT_NE(out_of_steps(in_steps(similar, wild), count, smooth), similar);
    }
  }
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
}  // namespace suite::packed_test
