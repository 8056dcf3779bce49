// What texts and files may ask for: lines of any length, sizes of numbers, names, copies, waves, unpacked bytes; and
// that a program never replaces what it has read.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/inputs.h"
#include "base/memory.h"
#include "base/params.h"
#include "base/run_app.h"
#include "base/text_lines.h"
#include "formats/hdf5/h5.h"
#include "scene/bake.h"
#include "scene/issues.h"
#include "scene/primitives.h"
#include "scene/unfolded.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::limits_test {
namespace {

using testing::HasSubstr;

Params parse(const std::string& text) { return Params::parse_text(text, "s.yaml"); }

// Every located value once kept a copy of its whole line: 4000 placements on one line took 4.1 GB.
TEST(Limits, PlacesOfOneLineShareItsText) {
  std::string text = "{\"list\": [0";
  for (int i = 1; i < 4000; ++i)
    text += ", {\"place\": \"tree\", \"translate\": [1, 2, 3], \"number\": " + std::to_string(i) + "}";
  text += "]}";
  const Params p = parse(text);
  std::vector<Where> places;
  for (const Params& item : p.at("list").items()) places.push_back(item.where());
  ASSERT_EQ(places.size(), 4000u);
  for (const Where& w : places) EXPECT_EQ(w.source_line.view().data(), places[0].source_line.view().data());
  const std::string shown = excerpt(places[2000]);
  EXPECT_LT(shown.size(), 500u);
  // The caret stands under the brace that opens the item.
  const size_t line = shown.find('\n', 1);
  EXPECT_EQ(shown[shown.find('^') - line], '{') << shown;
  EXPECT_THAT(shown, HasSubstr("\"number\": 2000}"));
  // The same for tables of plain numbers.
  const std::string row(100000, '1');
  TextLines lines(row, "t.txt");
  ASSERT_TRUE(lines.next());
  EXPECT_EQ(lines.where(0).source_line.view().data(), lines.where(0).source_line.view().data());
}

TEST(Limits, NumbersAreOfThisWorld) {
  EXPECT_EQ(parse("a: 1e30").number("a"), 1e30);
  EXPECT_THAT(message_of([] { parse("a: [0, 1e300]").at("a").as_numbers(); }),
              HasSubstr("s.yaml:1:8: error: 1e+300 is too large; give a number of at most 1e+30 in size"));
  TextLines lines("1e31", "t.txt");
  ASSERT_TRUE(lines.next());
  EXPECT_THAT(message_of([&] { lines.number(0, "height"); }),
              HasSubstr("t.txt:1:1: error: height = 1e+31 is too large"));
}

// A view direction of [0, 1e300, -1] ended in the ray tracer's abort: its length overflowed.
TEST(Limits, DirectionsHaveALength) {
  const auto d = parse("d: [0, 1e30, -1]").at("d").as_direction();
  EXPECT_DOUBLE_EQ(d[1], 1);
  EXPECT_NEAR(parse("d: [1e-20, 0, 1e-20]").at("d").as_direction()[0], std::sqrt(0.5), 1e-15);
  for (const char* none : {"d: [0, 0, 0]", "d: [1e-200, 0, 0]"})
    EXPECT_THAT(message_of([&] { parse(none).at("d").as_direction(); }),
                HasSubstr("s.yaml:1:4: error: a direction of no length"));
}

TEST(Limits, NamesDoNotLeadOutOfTheFolder) {
  EXPECT_EQ(parse("n: 'red edge \xc3\xa4'").at("n").as_name(), "red edge \xc3\xa4");
  const std::string overlong(49, 'x');
  for (const std::string& bad : {std::string("../evil"), std::string("a/b"), std::string(), std::string("."),
                                 std::string(".."), overlong, std::string("a\\tb"), std::string("\\e[31m")})
    EXPECT_THAT(message_of([&] { parse("n: \"" + bad + "\"").at("n").as_name(); }), HasSubstr("s.yaml:1:4: error: "))
        << bad;
}

TEST(Limits, TextsAreUtf8AndMessagesHideNothing) {
  EXPECT_THAT(message_of([] { parse("a: 1\nb: \xe4 2\n"); }), HasSubstr("s.yaml:2:4: error: this is not UTF-8"));
  EXPECT_THAT(message_of([] { parse("a: \"\\e[31m\"").text("a"); }), HasSubstr("control character \\x1b"));
  const Error e({"f\x1b", 1, 3, "\x1b[31mred", -1}, "unknown '\x1b]0;x\x07'", "or \xff");
  EXPECT_STREQ(e.what(), "f\\x1b:1:3: error: unknown '\\x1b]0;x\\x07'; or \\xff\n  \\x1b[31mred\n       ^");
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b\n"),
            "a\\u{202e}b\\n");
}

TEST(Limits, WavesOfASinusoidAreCounted) {
  // A ray along a surface of 1e18 waves never came back.
  Primitive p;
  p.kind = PrimitiveKind::sinusoid;
  p.parameters = {10, 10, 1, 1e18, 0, 0};
  EXPECT_THAT(
      message_of([&] {
        check_primitive(p, {"s.yaml", 3, 4, {}, -1});
      }),
      HasSubstr("s.yaml:3:4: error: sinusoid '', term 1: 1.59e+18 waves fit across the surface; at most 100000"));
  p.parameters[3] = 6e4;
  EXPECT_EQ(message_of([&] { check_primitive(p, {}); }), "no error");
}

TEST(Limits, CopiesOfCopiesAreCountedFirst) {
  // Twelve levels of ten copies: a text of a hundred lines asked for 1e12 instances.
  Draft draft;
  draft.file = "s.yaml";
  draft.geometry.resize(1);
  draft.geometry[0].name = "ball";
  draft.geometry[0].kind = DraftGeometry::Kind::primitive;
  draft.geometry[0].primitive.kind = PrimitiveKind::sphere;
  draft.geometry[0].primitive.parameters = {1};
  for (int level = 0; level < 12; ++level) {
    DraftGroup g;
    g.name = level ? strf("g%d", level) : "world";
    g.where = {"s.yaml", 10 + level, 1, {}, -1};
    DraftPlacement place;
    place.where = {"s.yaml", 10 + level, 3, {}, -1};
    place.target.name = level == 11 ? "ball" : strf("g%d", level + 1);
    g.placements.assign(10, place);
    draft.groups.push_back(g);
  }
  Report report(scene_issues());
  bake_scene(draft, report);
  EXPECT_EQ(report.count("SP411"), 1u);
  EXPECT_THAT(report.text(), HasSubstr("s.yaml:12:3: 'g2' unfolds into 1e+10 instances, the scene into 1e+12"));
}

// A megabyte of deflated zeros may unpack to a gigabyte: what is declared is compared with the memory there is.
TEST(Limits, PackedDataMustFitIntoMemory) {
  const TempFolder folder;
  const std::string path = folder / "bomb.h5";
  {
    h5::Writer w(path, path, [](const std::string&) { return 9; });
    auto column = w.column("/zeros", h5::native<uint8_t>(), size_t{64} << 20, "1");
    const std::vector<uint8_t> some(size_t{1} << 20, 0);
    for (int i = 0; i < 64; ++i) column.append(std::span<const uint8_t>(some));
    w.close();
  }
  EXPECT_LT(file_size(path), size_t{2} << 20);
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer needs all address space";
#endif
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_AS, &before), 0);
  std::ifstream statm("/proc/self/statm");
  double pages = 0;
  statm >> pages;
  const struct rlimit tight {
    static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (32u << 20), before.rlim_max
  };
  ASSERT_EQ(::setrlimit(RLIMIT_AS, &tight), 0);
  const std::string said = message_of([&] { h5::Reader(path).get<uint8_t>("/zeros", "1"); });
  ::setrlimit(RLIMIT_AS, &before);
  EXPECT_THAT(said, HasSubstr("dataset '/zeros' unpacks to 67.1 MB"));
  EXPECT_EQ(h5::Reader(path).get<uint8_t>("/zeros", "1").size(), size_t{64} << 20);
}

// The library crashed in its exit handler, with what it could not write.
TEST(Limits, AFileThatCannotGrowIsAnErrorAndNothingElse) {
  const TempFolder folder;
  const std::string path = folder / "full.h5";
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit tight { 64 << 10, before.rlim_max };
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  for (const size_t values : {size_t{1000}, size_t{100000}}) {
    const std::string said = message_of([&] {
      h5::Writer w(path, path);
      for (int i = 0; i < 40; ++i) w.put(strf("/many/%d", i), std::vector<double>(values, 1.0), "m");
      w.close();
    });
    EXPECT_THAT(said, HasSubstr("full.h5: error: cannot be written: ")) << values;
  }
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  // The library is as good as new.
  h5::Writer w(path, path);
  w.put("/x", std::vector<double>{1, 2}, "m");
  w.close();
  EXPECT_EQ(h5::Reader(path).get<double>("/x", "m"), (std::vector<double>{1, 2}));
}

// Last: from here on this process keeps track of what it reads.
TEST(LimitsOfOutputs, InputsAreNotReplaced) {
  const TempFolder folder;
  write_file(folder / "in.obj", "v 0 0 0\n");
  track_inputs();
  std::filesystem::create_hard_link(folder / "in.obj", folder / "hard.obj");
  std::filesystem::create_symlink(folder / "in.obj", folder / "soft.obj");
  {
    const OwnResults own;
    read_text(folder / "in.obj");
  }
  EXPECT_EQ(input_at(folder / "in.obj"), "");
  read_text(folder / "in.obj");
  for (const char* name : {"in.obj", "./in.obj", "hard.obj", "soft.obj"}) {
    EXPECT_EQ(input_at(folder / name), folder / "in.obj") << name;
    EXPECT_THAT(message_of([&] { write_file(folder / name, "x"); }), HasSubstr("would replace an input of this run"))
        << name;
    EXPECT_THROW(check_outputs({folder / "new", folder / name}), UsageError) << name;
  }
  EXPECT_EQ(read_text(folder / "in.obj"), "v 0 0 0\n");
  // What another library opens, and what is read while an output of its name is being written.
  write_file(folder / "sky.png", "pixels");
  EXPECT_EQ(input_size(folder / "sky.png"), 6u);
  EXPECT_EQ(input_at(folder / "sky.png"), folder / "sky.png");
  write_file(folder / "late", "in");
  AtomicFile late(folder / "late");
  read_text(folder / "late");
  EXPECT_THAT(message_of([&] { late.commit(); }), HasSubstr("would replace an input of this run"));
  EXPECT_EQ(read_text(folder / "late"), "in");
  EXPECT_NO_THROW(check_outputs({"", "-", "-", folder / "new", folder / "other"}));
  EXPECT_THROW(check_outputs({folder / "new", folder.path() + "/./new"}), UsageError);
}

}  // namespace
}  // namespace suite::limits_test
