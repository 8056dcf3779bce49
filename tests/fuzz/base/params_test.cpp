// Damaged YAML: a tree or one located Error, never a crash, a hang or a foreign exception.
#include "base/params.h"
#include "support/fuzz.h"

namespace suite::params_test {
namespace {

// Asks everything of a node that a reader could ask.
void visit(const Params& p, int depth) {
  if (depth > 6) return;
  switch (p.kind()) {
    case Params::Kind::map:
      for (const std::string& key : p.keys()) visit(p.at(key), depth + 1);
      break;
    case Params::Kind::list:
      for (const Params& item : p.items()) visit(item, depth + 1);
      break;
    default:
      try {
        p.as_integer(0, 1000);
      } catch (const Error&) {
      }
  }
}

}  // namespace

TEST(Fuzz, Params) {
  const std::string valid =
      "# scene\nname: range\norigin: {latitude_deg: 48.2, longitude_deg: 11.5, height: ellipsoid}\nmaterials:\n"
      "  - {name: panel, model: lambert, reflectance: 0.5}\n  - name: \"satin: purple\"\n    model: sqt\n    file: "
      "'satin.sqt'\n"
      "shared: &s [1, 2.5e-3, .5]\nuses: *s\ntext: |\n  two\n  lines\nfolded: >-\n  a\n  b\n? odd\n: value\n";
  const std::vector<std::string> words = {"\n",
                                          "\n  ",
                                          "\n- ",
                                          "- - - - ",
                                          "? ? ",
                                          ": ",
                                          "{",
                                          "}",
                                          "[",
                                          "]",
                                          "[[[[[[[[[[[[[[[[",
                                          "&a ",
                                          "*a",
                                          "*s",
                                          "!!map ",
                                          "!",
                                          "|",
                                          ">",
                                          "---\n",
                                          "...\n",
                                          "%YAML 1.2\n",
                                          "\"",
                                          "'",
                                          "\t",
                                          "#",
                                          "\\x",
                                          "\"\\u12",
                                          "1e999",
                                          "~",
                                          ",",
                                          std::string(1, '\0'),
                                          "\xef\xbb\xbf",
                                          "\xff\xfe",
                                          "\xc3",
                                          "<<: *s",
                                          "@",
                                          "`",
                                          std::string(300, ' '),
                                          std::string(200, '[')};
  size_t accepted = 0;
  const auto read = [&](std::span<const std::byte> b) {
    const Params p = Params::parse_text({reinterpret_cast<const char*>(b.data()), b.size()}, "fuzz.yaml");
    visit(p, 0);
    ++accepted;
  };
  test::fuzz(test::bytes_of(valid), read, 1, test::kMutations, words);
  EXPECT_GT(100 * accepted, test::mutations(test::kMutations));  // the loop gets past the first check
}

// What programs write into other files as JSON.
TEST(Fuzz, ParamsJson) {
  size_t accepted = 0;
  const auto read = [&](std::span<const std::byte> b) {
    const Params p = Params::parse_json({reinterpret_cast<const char*>(b.data()), b.size()}, "fuzz.json");
    visit(p, 0);
    ++accepted;
  };
  test::fuzz(test::bytes_of("{\"a\": [1, -2.5e3, {\"b\": \"t\\u00e9xt\", \"c\": null}], \"d\": true, \"e\": \"\"}"),
             read, 2, test::kMutations,
             {"{", "}", "[", "]", ",", ":", "\"", "\\u12", "1e999", "-", "[[[[[[[[", "\xff", "null"});
  EXPECT_GT(100 * accepted, test::mutations(test::kMutations));
}

// Whatever bytes a message holds, what is shown is UTF-8 without control characters.
TEST(Fuzz, PrintableText) {
  test::Mutator mutate(3, {"\x1b[31m", "\xe2\x80\xae", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xc0\xaf", "\r", "\n"});
  const test::Bytes seed = test::bytes_of("material 'h\xc3\xa4user' \xe2\x82\xac \xf0\x9f\x8c\x8d is unknown");
  for (size_t n = 0; n < test::mutations(test::kMutations); ++n) {
    const test::Bytes b = mutate(seed);
    const std::string shown = printable({reinterpret_cast<const char*>(b.data()), b.size()});
    ASSERT_EQ(utf8_bytes(shown), shown.size()) << n;
    for (const char c : shown) ASSERT_FALSE((c >= 0 && c < 0x20) || c == 0x7f) << n;
    const Error e({"f", 1, static_cast<int>(n % 60) + 1, std::string(shown.begin(), shown.end()), -1}, shown);
    ASSERT_EQ(utf8_bytes(e.what()), std::strlen(e.what())) << n;
  }
}

}  // namespace suite::params_test
