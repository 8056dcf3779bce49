// Errors, reports and JSON: text in the promised form, counts, muting, verdicts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "base/json.h"
#include "base/params.h"
#include "base/progress.h"
#include "base/report.h"

namespace suite::report_test {
using testing::HasSubstr;
using testing::Not;

TEST(Error, TextHasPlaceCodeHintAndCaret) {
  const Error e({"s.yaml", 12, 3, "  material: asphlat", -1}, "unknown material 'asphlat'", "did you mean 'asphalt'?",
                "SP104");
  EXPECT_STREQ(
      e.what(),
      "s.yaml:12:3: error: unknown material 'asphlat' [SP104]; did you mean 'asphalt'?\n    material: asphlat\n    ^");
  EXPECT_STREQ(Error("plain").what(), "error: plain");
  EXPECT_STREQ(Error({"b.bin", 0, 0, {}, 16}, "bad").what(), "b.bin: byte 16: error: bad");
  // The caret stands under tabs too, and never far beyond the excerpt.
  EXPECT_STREQ(Error({"f", 1, 3, "\t\tx", -1}, "w").what(), "f:1:3: error: w\n  \t\tx\n  \t\t^");
  EXPECT_LT(std::string(Error({"f", 1, 1000000, std::string(1000, 'x'), -1}, "w").what()).size(), 500u);
}

TEST(Error, NearestNameFindsTyposAndRefusesStrangers) {
  const std::vector<std::string> known{"lambert", "mirror", "ward", "sqt"};
  EXPECT_EQ(nearest_name("lamber", known), "lambert");
  EXPECT_EQ(nearest_name("Ward", known), "ward");
  EXPECT_EQ(nearest_name("wrad", known), "ward");
  EXPECT_EQ(nearest_name("mirorr", known), "mirror");
  EXPECT_EQ(nearest_name("glass", known), "");
  EXPECT_EQ(nearest_name(std::string(1000000, 'x'), known), "");
  EXPECT_EQ(name_hint("glass", known), "known: lambert, mirror, ward, sqt");
  EXPECT_EQ(name_hint("x", {}), "none is known here");
}

TEST(Check, OurOwnMistakesNameTheConditionAndBothValues) {
  try {
    const int two = 2;
    SUITE_CHECK_EQ(two, 3);
    FAIL();
  } catch (const Bug& bug) {
    EXPECT_THAT(bug.what(), HasSubstr("two == 3: 2 against 3"));
  }
}

namespace {
Report report() {
  return Report({{"SP101", Severity::error, "unknown name", "use a known one"},
                 {"SP201", Severity::warning, "odd", ""},
                 {"SP301", Severity::info, "fyi", ""}});
}
}  // namespace

// A scene of 200 objects with one fault each is told in a few lines, by the worst of them; what has to be mended one by
// one is not, and the JSON has all.
TEST(Report, FoldsWhatManyAssetsShare) {
  Report r = report();
  for (int k = 0; k < 200; ++k) {
    const std::string asset = strf("house_%d.obj", k);
    r.add("SP201", asset, {{asset, k + 1, 0, {}, -1}, "a sliver"}, k == 57 ? 9 : 1);
  }
  const std::string text = r.text();
  EXPECT_LT(std::ranges::count(text, '\n'), 6);
  EXPECT_THAT(text, HasSubstr("200 files or objects: warning [SP201] x208: odd\n    most, x9, in house_57.obj:\n"
                              "    house_57.obj:58: a sliver\n"));
  EXPECT_THAT(text, Not(HasSubstr("house_58.obj")));
  EXPECT_THAT(text, HasSubstr("208 warnings of 1 kind"));
  EXPECT_THAT(r.json(), HasSubstr("house_199.obj"));
  r.mute("SP201");
  EXPECT_THAT(r.text(), Not(HasSubstr("SP201")));
  // Three are told one by one, and so are errors.
  Report few = report();
  for (const char* asset : {"a", "b", "c"}) few.add("SP201", asset, {{}, "a sliver"});
  for (int k = 0; k < 10; ++k) few.add("SP101", strf("e%d", k), {{}, "bad"});
  EXPECT_THAT(few.text(), HasSubstr("c: warning [SP201] x1"));
  EXPECT_THAT(few.text(), HasSubstr("e9: error [SP101] x1"));
}

TEST(Report, CountsEverythingAndShowsThreeExamplesPerCodeAndAsset) {
  Report r = report();
  for (int i = 1; i <= 5; ++i) r.add("SP101", "a.obj", {{"a.obj", i, 0, {}, -1}, strf("fault %d", i)}, 10);
  r.add("SP201", "b.obj", {{}, "something"});
  EXPECT_EQ(r.count("SP101"), 50u);
  EXPECT_EQ(r.count(Severity::error), 50u);
  EXPECT_FALSE(r.ok());
  const std::string text = r.text();
  EXPECT_THAT(text, HasSubstr("a.obj: error [SP101] x50: unknown name"));
  EXPECT_THAT(text, HasSubstr("a.obj:3: fault 3"));
  EXPECT_THAT(text, Not(HasSubstr("fault 4")));
  EXPECT_THAT(text, HasSubstr("hint: use a known one"));
  EXPECT_THAT(text, HasSubstr("verdict: refused (50 errors of 1 kind, 1 warnings)"));
}

TEST(Report, MutingStrictnessAndUnknownCodes) {
  Report r = report();
  r.add("SP201", "b", {{}, "odd"});
  EXPECT_TRUE(r.ok());
  r.set_strict(true);
  EXPECT_FALSE(r.ok());
  r.mute("SP201");
  EXPECT_TRUE(r.ok());
  EXPECT_THAT(r.text(), HasSubstr("verdict: accepted (0 errors, 0 warnings, strict)"));
  try {
    r.mute("SP102");
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("unknown issue code 'SP102'; did you mean 'SP101'?"));
  }
  EXPECT_THROW(r.add("SP999", "b", {{}, ""}), Bug);
}

TEST(Report, ErrorsOfReadersAreFiledUnderTheirCodeOrTheFallback) {
  Report r = report();
  r.add(Error({"f", 1, 2, {}, -1}, "what", "hint", "SP201"), "f", "SP101");
  r.add(Error("other"), "f", "SP101");
  EXPECT_EQ(r.count("SP201"), 1u);
  EXPECT_EQ(r.count("SP101"), 1u);
}

TEST(Report, JsonIsReadBackByTheReaderOfJson) {
  Report r = report();
  r.add("SP101", "a \"quoted\"\n\xff name", {{"f.obj", 3, 4, {}, -1}, "tab\there"}, 7);
  r.mute("SP201");
  r.add("SP201", "b", {{}, "odd"});
  const Params p = Params::parse_text(r.json(), "r.json");
  EXPECT_EQ(p.text("schema"), "suite.report/1");
  EXPECT_EQ(p.text("verdict"), "refused");
  EXPECT_EQ(p.at("errors").as_integer(0, 100), 7);
  EXPECT_EQ(p.at("warnings").as_integer(0, 100), 0);
  const Params first = p.at("issues")[0];
  EXPECT_EQ(first.text("code"), "SP101");
  EXPECT_EQ(first.at("examples")[0].at("line").as_integer(0, 9), 3);
  EXPECT_EQ(first.at("examples")[0].text("message"), "tab\there");
  EXPECT_TRUE(p.at("issues")[1].at("muted").as_bool());
}

TEST(Json, KeepsDigitsAndOrderAndTurnsNonsenseIntoNull) {
  Json j = Json::object();
  j.set("z", 0.1);
  j.set("a", 1e-300);
  j.set("n", std::numeric_limits<double>::quiet_NaN());
  j.set("i", std::numeric_limits<long long>::max());
  j.set("b", true);
  Json list = Json::array();
  list.push("x");
  j.set("l", std::move(list));
  EXPECT_EQ(j.text(0),
            "{\n\"z\": 0.1,\n\"a\": 1e-300,\n\"n\": null,\n\"i\": 9223372036854775807,\n\"b\": true,\n\"l\": "
            "[\n\"x\"\n]\n}\n");
}

TEST(Progress, HumanNumbers) {
  EXPECT_EQ(human_seconds(0.5e-3), "500 us");
  EXPECT_EQ(human_seconds(0.25), "250 ms");
  EXPECT_EQ(human_seconds(3.21), "3.2 s");
  EXPECT_EQ(human_seconds(245), "4 min 05 s");
  EXPECT_EQ(human_seconds(2 * 3600 + 13 * 60), "2 h 13 min");
  EXPECT_EQ(human_seconds(INFINITY), "?");
  EXPECT_EQ(human_count(999), "999");
  EXPECT_EQ(human_count(12345), "12.3 k");
  EXPECT_EQ(human_bytes(1.234e6), "1.23 MB");
}

}  // namespace suite::report_test
