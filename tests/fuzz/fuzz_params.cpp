// Damaged YAML: a tree or one located Error, never a crash, a hang or a foreign exception.
#include "base/params.h"
#include "support/fuzz.h"

namespace suite {
namespace {

// Asks everything of a node that a reader could ask.
size_t visit(const Params& p, int depth) {
  size_t n = 1;
  if (depth > 6) return n;
  switch (p.kind()) {
    case Params::Kind::map:
      for (const std::string& key : p.keys()) n += visit(p.at(key), depth + 1);
      break;
    case Params::Kind::list:
      for (const Params& item : p.items()) n += visit(item, depth + 1);
      break;
    default:
      try {
        n += static_cast<size_t>(p.as_integer(0, 1000)) % 2;
      } catch (const Error&) {
        ++n;
      }
  }
  return n;
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
    EXPECT_GE(visit(p, 0), 1u);
    ++accepted;
  };
  test::fuzz(test::bytes_of(valid), read, 1, 20000, 6, words);
  EXPECT_GT(accepted, 100u);  // the loop gets past the first check
}

}  // namespace suite
