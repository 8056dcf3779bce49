// Numbers that the library reads wrongly (measured: 0 for 35 characters in FBX, 0.127763 for
// 123456789012345678901.5e-20 and 0 for 0.00000000000000000000015e22 in Collada) are refused, others are not.
#include "formats/assimp/long_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/fuzz.h"
#include "support/message_of.h"

namespace suite::format_assimp_long_numbers_test {
namespace {

using testing::HasSubstr;

std::string said(const std::string& text, const std::string& extension) {
  return message_of([&] { check_long_numbers(test::bytes_of(text), "a." + extension, extension); });
}

TEST(LongNumbers, Collada) {
  const auto of = [](const std::string& number) { return said("<a>\n<f>0 1 " + number + " 2</f></a>", "dae"); };
  for (const char* fine :
       {"1.5", "1.12345678901234567890123456", "1234567890123456789.5e-18", "1.5000000000000000000000",
        "0000000000000000000000001.5", "-0.00000000000000000000000000", "0.10000000000000000555112e1"})
    EXPECT_EQ(of(fine), "no error") << fine;
  EXPECT_THAT(of("123456789012345678901.5e-20"),
              HasSubstr("a.dae:2:8: error: a number with 21 digits before its point"));
  EXPECT_THAT(of("0.00000000000000000000015e22"), HasSubstr("a number with 23 decimals, of which 15 are read"));
  EXPECT_EQ(said("<a id=\"123456789012345678901234\"/>", "dae"), "no error");
}

TEST(LongNumbers, Fbx) {
  const auto of = [](const std::string& number) {
    return said("; FBX 7.3 project 123456789012345678901234567890123456\nVertices: *3 {\n a: " + number + ",0,0\n}",
                "fbx");
  };
  EXPECT_EQ(
      of("1.234567890123456789012345678901"),
      "a.fbx:3:5: error: a number of 32 characters, which is read as 0 by the "
      "library for this format (assimp): '1.234567890123456789012345678901'; write it with at most 17 digits, as its "
      "value is");
  EXPECT_EQ(of("1.23456789012345678901234567890"), "no error");
  EXPECT_EQ(of("\"1.234567890123456789012345678901234\""), "no error");
  EXPECT_EQ(said("Kaydara FBX Binary  1234567890123456789012345678901234567890", "fbx"), "no error");
}

}  // namespace
}  // namespace suite::format_assimp_long_numbers_test
