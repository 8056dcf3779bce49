// Located key-values: places, spelling help, duplicates, kinds, ranges, hostile documents.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "base/params.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::params_test {
using testing::HasSubstr;
using testing::StartsWith;

namespace {
Params parse(const std::string& text) { return Params::parse_text(text, "s.yaml"); }
}  // namespace

TEST(Params, ReadsScalarsOfEveryKindWithDefaults) {
  const Params p = parse(
      "name: 'a: b'\nsize: 2.5e-3\ncount: 7\non: yes\nvector: [1, 2, 3]\nnested:\n  deep: {x: +4}\nempty:\nquoted: "
      "\"null\"\n");
  EXPECT_EQ(p.text("name"), "a: b");
  EXPECT_EQ(p.number("size"), 2.5e-3);
  EXPECT_EQ(p.integer("count", 0, 10), 7);
  EXPECT_TRUE(p.at("on").as_bool());
  EXPECT_EQ(p.at("vector").as_vec3(), (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(p.at("nested").at("deep").number("x"), 4);
  EXPECT_EQ(p.at("empty").kind(), Params::Kind::null);
  EXPECT_EQ(p.text("quoted"), "null");
  EXPECT_EQ(p.text("absent", "x"), "x");
  EXPECT_EQ(p.number("absent", 3.0), 3.0);
  EXPECT_FALSE(p.boolean("absent", false));
  p.reject_unread();
}

TEST(Params, JsonIsAcceptedAsItIs) {
  const Params p = parse("{\"a\": [1.5, -2e3, \"t\\u00e9xt\"], \"b\": {\"c\": true, \"d\": null}, \"e\":\"no space\"}");
  EXPECT_EQ(p.at("a")[1].as_number(), -2000);
  EXPECT_EQ(p.at("a")[2].as_text(), "t\xc3\xa9xt");
  EXPECT_TRUE(p.at("b").at("c").as_bool());
  EXPECT_EQ(p.at("b").at("d").kind(), Params::Kind::null);
  EXPECT_EQ(p.text("e"), "no space");
  p.reject_unread();
}

TEST(Params, StrictJsonReadsTheSameAndNamesTheFile) {
  const std::string text =
      R"({"a": [1, -2.50, 1e-7, 12345678901234567], "b": {"c": "x\n\u00e9", "d": true, "e": null}})";
  const Params fast = Params::parse_json(text, "s.sqt"), slow = Params::parse_text(text, "s.sqt");
  EXPECT_EQ(fast.at("a").as_numbers(), slow.at("a").as_numbers());
  EXPECT_EQ(fast.at("a")[1].as_text(), slow.at("a")[1].as_text());
  EXPECT_EQ(fast.at("b").text("c"), slow.at("b").text("c"));
  EXPECT_EQ(fast.at("b").at("d").as_bool(), true);
  EXPECT_EQ(fast.at("b").at("e").kind(), Params::Kind::null);
  for (const char* bad : {"", "{", "{\"a\": 1,}", "{\"a\": 1, \"a\": 2}", "{\"a\": 1} x", "{a: 1}", "[nan]"}) try {
      Params::parse_json(bad, "s.sqt");
      ADD_FAILURE() << bad << " was accepted";
    } catch (const Error& e) {
      EXPECT_EQ(e.where().file, "s.sqt") << bad;
    }
  std::string deep(100000, '[');
  EXPECT_THROW(Params::parse_json(deep, "s.sqt"), Error);
}

TEST(Params, FaultsCarryPlaceSourceLineAndCaret) {
  const Params p = parse("camera:\n  width: wide\n");
  EXPECT_EQ(message_of([&] { p.at("camera").number("width"); }),
            "s.yaml:2:10: error: expected a finite number, found 'wide'\n    width: wide\n           ^");
  EXPECT_THAT(message_of([&] { parse("a: [1, 2\n"); }), StartsWith("s.yaml:2:1: error: malformed YAML"));
  EXPECT_THAT(message_of([&] { parse("a: 1\n\tb: 2\n"); }), StartsWith("s.yaml:2:"));
  EXPECT_THAT(message_of([&] { parse(""); }), HasSubstr("is empty"));
  EXPECT_THAT(message_of([&] { parse("# only a comment\n"); }), HasSubstr("is empty"));
  EXPECT_THAT(message_of([&] { parse(std::string("a: 1\0b", 6)); }),
              HasSubstr("s.yaml: byte 4: error: is not a text file"));
}

TEST(Params, AMissingKeyNamesTheNearMissThatIsThere) {
  const Params p = parse("camera:\n  widht: 640\n");
  EXPECT_THAT(message_of([&] { p.at("camera").at("width"); }),
              StartsWith("s.yaml:2:3: error: unknown key 'widht'; did you mean 'width', which is missing?"));
}

TEST(Params, AKeyNobodyReadIsAnErrorWithTheNearestNameAskedFor) {
  const Params p = parse("width: 640\nhieght: 360\nzebra: 1\n");
  EXPECT_EQ(p.integer("width", 1, 1000), 640);
  EXPECT_EQ(p.integer("height", 1, 1000, 480), 480);
  const std::vector<Error> unread = p.unread();
  ASSERT_EQ(unread.size(), 2u);
  EXPECT_THAT(unread[0].what(),
              StartsWith("s.yaml:2:1: error: unknown key 'hieght'; did you mean 'height'?\n  hieght: 360\n  ^"));
  EXPECT_THAT(unread[1].what(), StartsWith("s.yaml:3:1: error: unknown key 'zebra'; known: height, width"));
  EXPECT_THROW(p.reject_unread(), Error);
}

TEST(Params, AskingWhetherAKeyIsThereDoesNotReadIt) {
  const Params p = parse("a: 1\n");
  EXPECT_TRUE(p.has("a"));
  EXPECT_EQ(p.unread().size(), 1u);
  p.mark_read();
  p.reject_unread();
}

TEST(Params, UnreadKeysAreFoundDeepInsideListsAndMapsThatWereRead) {
  const Params p = parse("objects:\n - {name: a, sise: 1}\n - {name: b}\n");
  for (const Params& o : p.at("objects").items()) {
    o.text("name");
    o.number("size", 1.0);
  }
  const std::vector<Error> unread = p.unread();
  ASSERT_EQ(unread.size(), 1u);
  EXPECT_THAT(unread[0].what(), StartsWith("s.yaml:2:14: error: unknown key 'sise'; did you mean 'size'?"));
}

TEST(Params, DuplicateKeysAreRefusedWithBothLines) {
  EXPECT_THAT(message_of([&] { parse("a: 1\nb: 2\na: 3\n"); }),
              StartsWith("s.yaml:3:1: error: duplicate key 'a'; first given in line 1; keep one"));
  EXPECT_THAT(message_of([&] { parse("{\"x\": {\"a\": 1, \"a\": 1}}"); }), HasSubstr("duplicate key 'a'"));
}

TEST(Params, AliasesShareTheValueAndItsReading) {
  const Params p = parse("base: &b {r: 0.5, s: 1}\nfirst: *b\nsecond: *b\n");
  EXPECT_EQ(p.at("first").number("r"), 0.5);
  EXPECT_EQ(p.at("second").number("s"), 1);
  EXPECT_EQ(p.at("base").kind(), Params::Kind::map);
  p.reject_unread();
}

TEST(Params, AnAliasInsideItsOwnValueIsRefused) {
  EXPECT_THAT(message_of([&] { parse("a: &x [1, *x]\n"); }), HasSubstr("alias to a value that is not complete yet"));
  EXPECT_THAT(message_of([&] { parse("a: *nowhere\n"); }), HasSubstr("s.yaml:1:"));
}

TEST(Params, ManyAliasesOfAliasesCostNoMemory) {
  // The "billion laughs" document: ten levels, ten references each.
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) {
    text += strf("a%d: &a%d [", i, i);
    for (int k = 0; k < 10; ++k) text += strf("%s*a%d", k ? ", " : "", i - 1);
    text += "]\n";
  }
  const Params p = parse(text);
  p.mark_read();
  EXPECT_TRUE(p.unread().empty());
}

TEST(Params, DeepNestingIsRefusedNotRecursedInto) {
  for (const auto& [open, close] : {std::pair{"[", "]"}, std::pair{"{a: ", "}"}}) {
    std::string text = "x: ";
    for (int i = 0; i < 100000; ++i) text += open;
    for (int i = 0; i < 100000; ++i) text += close;
    EXPECT_THAT(message_of([&] { parse(text); }), HasSubstr("nested deeper than 200"));
  }
  std::string block, dashes;
  for (int i = 0; i < 2000; ++i) block += std::string(i, ' ') + "k:\n", dashes += "- ";
  EXPECT_THAT(message_of([&] { parse(block + std::string(2000, ' ') + "v: 1\n"); }),
              HasSubstr("nested deeper than 200"));
  EXPECT_THAT(message_of([&] { parse(dashes + "1\n"); }), HasSubstr("nested deeper than 200"));
  std::string fine = "x: ";
  for (int i = 0; i < 150; ++i) fine += "[";
  for (int i = 0; i < 150; ++i) fine += "]";
  EXPECT_EQ(parse(fine).at("x").kind(), Params::Kind::list);
}

TEST(Params, BracketsInTextsAndCommentsDoNotCountAsNesting) {
  std::string many(500, '[');
  EXPECT_EQ(parse("a: '" + many + "'\n").text("a"), many);
  EXPECT_EQ(parse("a: \"" + many + "\"\n").text("a"), many);
  EXPECT_EQ(parse("a: 1  # " + many + "\n").number("a"), 1);
  EXPECT_EQ(parse("a: it's " + std::string(3, '(') + "\nb: [1]\n").text("a"), "it's (((");
}

TEST(Params, RangesKindsAndChoicesSayWhatWouldBeRight) {
  const Params p =
      parse("n: 12\nf: 1.5\nl: [1, x]\nc: noon\nb: maybe\ni: .inf\nm: {}\nbig: 1e400\nhex: 0x10\nspace: '1 2'\n");
  EXPECT_THAT(message_of([&] { p.at("n").as_number_in(0, 10, "m"); }),
              HasSubstr("12 is outside the valid range; give a value from 0 to 10 m"));
  EXPECT_THAT(message_of([&] { p.at("n").as_integer(0, 10); }), HasSubstr("give a whole number from 0 to 10"));
  EXPECT_THAT(message_of([&] { p.at("f").as_integer(0, 10); }), HasSubstr("expected a whole number, found 1.5"));
  EXPECT_THAT(message_of([&] { p.at("l").as_numbers(); }),
              StartsWith("s.yaml:3:8: error: expected a finite number, found 'x'"));
  EXPECT_THAT(message_of([&] { p.at("l").as_vec3(); }), HasSubstr("s.yaml:3:"));
  EXPECT_THAT(message_of([&] { p.at("l").as_text(); }), HasSubstr("expected a text, found a list"));
  EXPECT_THAT(message_of([&] {
                p.at("c").as_choice({"moon", "sun"});
              }),
              HasSubstr("'noon' is none of the choices here; did you mean 'moon'?"));
  EXPECT_THAT(message_of([&] { p.at("b").as_bool(); }), HasSubstr("expected true or false"));
  EXPECT_THAT(message_of([&] { p.at("m").as_number(); }), HasSubstr("found a map of keys"));
  EXPECT_THAT(message_of([&] { p.at("n").at("x"); }),
              HasSubstr("expected a map with the key 'x', found a single value"));
  EXPECT_THAT(message_of([&] { p.at("l")[5]; }), HasSubstr("expected at least 6 items, found 2"));
  for (const char* key : {"i", "big", "hex", "space"}) EXPECT_THROW(p.number(key), Error) << key;
  EXPECT_EQ(p.at("c").as_choice({"dawn", "noon"}), 1u);
}

TEST(Params, WholeNumbersBeyondTheDoubleMantissaAreExactOrRefused) {
  const Params p = parse("seed: 9007199254740993\nhuge: 9223372036854775807\nover: 9223372036854775808\n");
  EXPECT_EQ(p.at("seed").as_integer(0, std::numeric_limits<long long>::max()), 9007199254740993LL);
  EXPECT_EQ(p.at("huge").as_integer(0, std::numeric_limits<long long>::max()), 9223372036854775807LL);
  EXPECT_THROW(p.at("over").as_integer(0, std::numeric_limits<long long>::max()), Error);
}

TEST(Params, PathsAreRelativeToTheNamingFile) {
  const TempFolder folder;
  write_file(folder / "s.yaml", std::string("a: mesh/x.obj\nb: /abs/y.obj\n"));
  const Params p = Params::parse_file(folder / "s.yaml");
  EXPECT_EQ(p.at("a").as_path(), folder / "mesh/x.obj");
  EXPECT_EQ(p.at("b").as_path(), "/abs/y.obj");
  EXPECT_THAT(message_of([&] { Params::parse_file(folder / "none.yaml"); }),
              HasSubstr("none.yaml: error: no such file"));
  EXPECT_THAT(message_of([&] { Params::parse_file(folder.path()); }), HasSubstr("is a directory"));
}

TEST(Params, OnlyOneDocumentAFile) {
  EXPECT_THAT(message_of([&] { parse("a: 1\n---\nb: 2\n"); }),
              HasSubstr("a second document starts here; one document a file"));
  EXPECT_EQ(parse("---\na: 1\n").number("a"), 1);
  EXPECT_EQ(parse("a: 1\n...\n").number("a"), 1);
}

namespace {
const char* const kText =
    "seed: 1\nsun: {irradiance: 1, direction: {zenith_deg: 30}}\nsensors:\n  - {name: eye, paths: 4}\n"
    "  - {name: b0.55, paths: 8}\nshared: &s {x: 1}\nalias: *s\n";

Params with(const TempFolder& folder, const std::vector<std::string>& settings) {
  write_file(folder / "s.yaml", std::string_view(kText));
  return Params::parse_file(folder / "s.yaml", settings);
}
TEST(Params, MadeTextsPointIntoWhatTheyWereMadeOf) {
  const Params made = Params::parse_made("a: x\nb: 2\n", "dir/of.scene",
                                         {Where{"one.mat", 7, 3, {}, -1}, Where{"two.odb", 9, 1, {}, -1}},
                                         std::vector<std::string>{"b=3"});
  EXPECT_EQ(made.at("a").where().file, "one.mat");
  EXPECT_EQ(made.at("a").where().line, 7);
  EXPECT_EQ(made.at("a").as_path(), "dir/x");
  EXPECT_EQ(made.number("b"), 3);
  EXPECT_EQ(made.at("b").where().file, "--set b");
}

}  // namespace

TEST(Settings, ReplaceAddAndTakeOutValues) {
  const TempFolder folder;
  const Params p =
      with(folder, {"sensors.0.paths=64", "sensors.b0.55.paths=65", "sun.direction={zenith_deg: 60}", "sky=[1, 2]",
                    "sun.half_angle_deg=3", "seed=null", "sun.direction.zenith_deg=61", "alias.x=2"});
  EXPECT_EQ(p.at("sensors")[0].integer("paths", 0, 100), 64);
  EXPECT_EQ(p.at("sensors")[0].text("name"), "eye") << "its neighbours stay";
  EXPECT_EQ(p.at("sensors")[1].integer("paths", 0, 100), 65) << "by name, which has a dot";
  EXPECT_EQ(p.at("sun").at("direction").number("zenith_deg"), 61) << "in turn";
  EXPECT_EQ(p.at("sun").number("half_angle_deg"), 3);
  EXPECT_EQ(p.at("sky").as_numbers(), (std::vector<double>{1, 2}));
  EXPECT_FALSE(p.has("seed"));
  EXPECT_EQ(p.at("alias").number("x"), 2);
  EXPECT_EQ(p.at("shared").number("x"), 1) << "a node shared by an alias is not changed with it";
  EXPECT_EQ(p.at("sky").file(), folder / "s.yaml") << "files named in a setting are found as the text's";
}

TEST(Settings, FaultsAreToldAtTheirPlace) {
  const TempFolder folder;
  const struct {
    const char *setting, *told;
  } table[] = {
      {"sensros.0.paths=1", "--set sensros.0.paths: error: there is no 'sensros' here; did you mean 'sensors'?"},
      {"output.also=[geotiff]", "no 'output' here; write --set 'output={also: [geotiff]}'"},
      {"sun.glare.inner.deg=2", "no 'glare' here; write --set 'sun.glare={inner: {deg: 2}}'"},
      {"sensors.7.paths=1", "no item '7' in this list; its items are 0 to 1, or by name; known: eye, b0.55"},
      {"sensors.eya.paths=1", "did you mean 'eye'"},
      {"seed.deeper=1", "'seed' is a single value"},
      {"sun.=1", "ends with a dot"},
      {"sed=null", "no 'sed' to take out; did you mean 'seed'?"},
      {"sensors.0=null", "cannot be taken out of a list"},
      {"seed", "without a path and a value"},
      {"=3", "without a path and a value"},
      {"seed= ", "--set seed: error: a setting without a value; null takes a key out"},
      {"seed=[1", "--set seed: error: "},
      {"seed={a: 1, a: 2}", "duplicate key 'a'"},
  };
  for (const auto& row : table)
    EXPECT_THAT(message_of([&] { with(folder, {row.setting}); }), HasSubstr(row.told)) << row.setting;
  // A value that is read later is located in the setting, with a caret under it.
  const Params p = with(folder, {"sensors.eye.paths={a: few}", "sensors.eye.pahts=3"});
  EXPECT_THAT(message_of([&] { p.at("sensors")[0].at("paths").number("a"); }),
              HasSubstr("--set sensors.eye.paths: error: expected a finite number, found 'few'\n"
                        "  sensors.eye.paths={a: few}\n                        ^"));
  for (const Params& sensor : p.at("sensors").items()) sensor.find("name");
  EXPECT_THAT(message_of([&] { p.at("sensors")[0].reject_unread(); }),
              HasSubstr("unknown key 'pahts'; did you mean 'paths'?"));
}

}  // namespace suite::params_test
