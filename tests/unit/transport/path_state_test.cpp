// All that is remembered of a path stands in docs/develop/path_state.md: every member of every struct that there is one
// of for each path, read from the headers, with its bytes and those of the whole. And the kernel keeps few members.
#include <gtest/gtest.h>

#include <cctype>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "transport/media/live_path.h"
#include "transport/refracted/search.h"

namespace suite::test::path_state_test {
namespace {

std::string text_of(const std::string& file) {
  std::ifstream in(std::string(SUITE_SOURCE_DIR) + "/" + file);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

// The names that a declaration gives, such as "a, b" of `double a = 0, b[2];`
std::vector<std::string> names_in(std::string statement) {
  statement = std::regex_replace(statement, std::regex(R"(\b(public|private|protected)\s*:)"), "");
  std::vector<std::string> names;
  if (std::regex_search(statement, std::regex(R"(^\s*(using|static|friend|template|struct|class)\b)"))) return names;
  if (std::regex_search(statement, std::regex(R"(^\s*enum\b)")) && statement.find('=') == std::string::npos)
    return names;
  int angle = 0;
  std::string part;
  const auto take = [&] {
    part = part.substr(0, part.find_first_of("=["));
    part = std::regex_replace(part, std::regex(R"(\s*:\s*\d+\s*$)"), "");  // a bit field's width
    std::smatch name;
    if (std::regex_search(part, name, std::regex(R"((\w+)\s*$)"))) names.push_back(name[1]);
    part.clear();
  };
  for (const char c : statement) {
    angle += c == '<' ? 1 : c == '>' ? -1 : 0;
    if (c == ',' && angle == 0)
      take();
    else
      part += c;
  }
  take();
  return names;
}

// Data members of a struct or class in a header, in their order; of nested ones none.
std::vector<std::string> members_of(const std::string& header, const std::string& name) {
  const std::string all = std::regex_replace(text_of("libs/transport/" + header), std::regex("//[^\n]*"), "");
  std::smatch head;
  EXPECT_TRUE(std::regex_search(all, head, std::regex("(struct|class) " + name + R"(\b[^;{]*\{)"))) << name;
  std::vector<std::string> members;
  std::string statement;
  int braces = 1, brackets = 0;
  bool function = false;
  for (size_t i = static_cast<size_t>(head.position() + head.length()); i < all.size() && braces > 0; ++i) {
    const char c = all[i];
    if (c == '{') ++braces;
    if (c == '}' && --braces == 1 && function) statement.clear(), function = false;
    if (braces > 1 || c == '}') continue;
    brackets += c == '(' ? 1 : c == ')' ? -1 : 0;
    const bool initialised =
        statement.find('=') != std::string::npos && statement.find("operator") == std::string::npos;
    function = function || (c == '(' && !initialised);
    if (c != ';' || brackets > 0) {
      statement += c;
      continue;
    }
    if (!function)
      for (const std::string& member : names_in(statement)) members.push_back(member);
    statement.clear(), function = false;
  }
  return members;
}

// Of the page: by struct, members and their bytes (0: none said), in their order.
struct Row {
  std::string name;
  size_t bytes;
};
std::map<std::string, std::vector<Row>> page() {
  std::map<std::string, std::vector<Row>> all;
  std::istringstream lines(text_of("docs/develop/path_state.md"));
  std::string at;
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_match(line, m, std::regex(R"(## `(\w+)`.*)"))) at = m[1];
    if (line.starts_with("## ") && line[3] != '`') at.clear();
    if (!at.empty() && std::regex_match(line, m, std::regex(R"(\| `(\w+)` \| *(\d*) *\|.*)")))
      all[at].push_back({m[1], m[2].length() > 0 ? std::stoul(m[2]) : 0});
  }
  return all;
}

constexpr struct {
  const char *header, *name;
} kStructs[] = {{"lane.h", "Lane"},
                {"path/claims.h", "PathClaims"},
                {"path/claims.h", "Claim"},
                {"path/suffix.h", "Suffix"},
                {"path/hero.h", "HeroDensities"},
                {"lane.h", "PathRecord"},
                {"lane.h", "LastAsked"},
                {"lane.h", "FirstMeeting"},
                {"throughput.h", "Chain"},
                {"surfaces_matte.h", "Place"},
                {"media/space_field.h", "Way"},
                {"media/space_field.h", "ScatterPlace"},
                {"media/medium_stack.h", "MediumStack"},
                {"media/space_lit_field.h", "OfPath"},
                {"air_places.h", "At"},
                {"techniques/air_residual.h", "Passed"},
                {"techniques/splitting.h", "Kept"},
                {"techniques/splitting.h", "Branches"},
                {"techniques/equiangular.h", "Flying"},
                {"techniques/side_vertex.h", "Side"},
                {"techniques/manifold.h", "Asking"},
                {"techniques/volume_chains.h", "Held"},
                {"techniques/volume_chains.h", "Settling"},
                {"refracted/search.h", "RefractedSearch"},
                {"refracted/search.h", "TracedWay"},
                {"refracted/search.h", "StraightLeg"},
                {"refracted/search.h", "InterfaceChain"},
                {"refracted/way.h", "WayStart"},
                {"refracted/way.h", "WayEnd"},
                {"refracted/way.h", "RefractedWay"},
                {"refracted/way.h", "RefractedEvent"},
                {"refracted/unfound.h", "Line"}};

TEST(PathState, ThePageListsEveryMember) {
  auto listed = page();
  for (const auto& s : kStructs) {
    std::vector<std::string> names;
    for (const Row& row : listed[s.name]) names.push_back(row.name);
    EXPECT_EQ(names, members_of(s.header, s.name)) << s.name << " in " << s.header;
    listed.erase(s.name);
  }
  for (const auto& [name, rows] : listed) ADD_FAILURE() << "the page tells of " << name << ", which nothing checks";
}

// What the page says of a struct, its table left out.
std::string section(const std::string& name) {
  std::istringstream lines(text_of("docs/develop/path_state.md"));
  std::string text;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("## ")) inside = line == "## `" + name + "`";
    if (inside && !line.starts_with("|")) text += line + "\n";
  }
  return text;
}

// As the page writes it: 14,296.
std::string written(size_t n) {
  std::string digits = std::to_string(n);
  for (size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, ",");
  return digits;
}

// Whether a text has a number, followed by words.
bool says(const std::string& text, size_t n, const std::string& words) {
  return std::regex_search(text, std::regex("(^|[^0-9,])" + written(n) + words));
}

// Structured bindings fail to compile for another number of members.
template <class... T>
std::vector<size_t> sizes(const T&... x) {
  return {sizeof(x)...};
}
void expect_bytes(const char* name, size_t whole, const std::vector<size_t>& bytes) {
  static const std::map<std::string, std::vector<Row>> all = page();
  const std::vector<Row>& rows = all.at(name);
  ASSERT_EQ(rows.size(), bytes.size()) << name;
  size_t sum = 0;
  for (size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].bytes, bytes[i]) << name << "::" << rows[i].name;
    sum += bytes[i];
  }
  EXPECT_TRUE(says(section(name), whole, "( bytes)? with gaps")) << name << ": " << whole;
  std::cout << name << ": " << rows.size() << " members, " << sum << " bytes, " << whole << " with gaps\n";
}

TEST(PathState, ThePageTellsTheirBytes) {
  const LivePath l{};
  const auto& [a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, c0, c1, c2, c3, c4, c5,
               c6, c7, c8] = l;
  EXPECT_TRUE(says(section("Lane"), sizeof(Lane<1>), " at one")) << sizeof(Lane<1>);
  EXPECT_TRUE(says(section("PathClaims"), sizeof(PathClaims), " bytes")) << sizeof(PathClaims);
  expect_bytes("Lane", sizeof l,
               sizes(a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, c0, c1, c2, c3, c4,
                     c5, c6, c7, c8));
  const Claim claim{};
  const auto& [d0, d1, d2, d3, d4, d5, d6] = claim;
  expect_bytes("Claim", sizeof claim, sizes(d0, d1, d2, d3, d4, d5, d6));
  const Suffix suffix{};
  const auto& [e0, e1, e2, e3, e4] = suffix;
  expect_bytes("Suffix", sizeof suffix, sizes(e0, e1, e2, e3, e4));
  const PathRecord record{};
  const auto& [f0, f1, f2, f3, f4, f5, f6, f7, f8] = record;
  expect_bytes("PathRecord", sizeof record, sizes(f0, f1, f2, f3, f4, f5, f6, f7, f8));
  const LastAsked last{};
  const auto& [g0, g1, g2] = last;
  expect_bytes("LastAsked", sizeof last, sizes(g0, g1, g2));
  const FirstMeeting first{};
  const auto& [h0, h1, h2, h3, h4] = first;
  expect_bytes("FirstMeeting", sizeof first, sizes(h0, h1, h2, h3, h4));
}

TEST(PathState, ThePageTellsTheBytesOfSearches) {
  const RefractedSearch search{};
  const auto& [a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, c0, c1, c2, c3, c4, c5,
               c6, c7, c8, c9, d0, d1, d2] = search;
  expect_bytes("RefractedSearch", sizeof search,
               sizes(a0, a1, a2, a3, a4, a5, a6, a7, a8, a9, b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, c0, c1, c2, c3, c4,
                     c5, c6, c7, c8, c9, d0, d1, d2));
  const TracedWay traced{};
  const auto& [e0, e1, e2, e3, e4, e5, e6, e7, e8] = traced;
  expect_bytes("TracedWay", sizeof traced, sizes(e0, e1, e2, e3, e4, e5, e6, e7, e8));
  const StraightLeg leg{};
  const auto& [f0, f1, f2] = leg;
  expect_bytes("StraightLeg", sizeof leg, sizes(f0, f1, f2));
  const InterfaceChain chain{};
  const auto& [g0, g1, g2] = chain;
  expect_bytes("InterfaceChain", sizeof chain, sizes(g0, g1, g2));
  const WayStart start{};
  const auto& [h0, h1, h2, h3, h4] = start;
  expect_bytes("WayStart", sizeof start, sizes(h0, h1, h2, h3, h4));
  const WayEnd end{};
  const auto& [i0, i1, i2, i3] = end;
  expect_bytes("WayEnd", sizeof end, sizes(i0, i1, i2, i3));
  const RefractedWay way{};
  const auto& [j0, j1, j2, j3, j4, j5, j6, j7, j8, j9, k0] = way;
  expect_bytes("RefractedWay", sizeof way, sizes(j0, j1, j2, j3, j4, j5, j6, j7, j8, j9, k0));
  const RefractedEvent event{};
  const auto& [l0, l1, l2, l3, l4, l5, l6, l7] = event;
  expect_bytes("RefractedEvent", sizeof event, sizes(l0, l1, l2, l3, l4, l5, l6, l7));
  // Copies take the events that there are: one of each way.
  const size_t ways = search.traced.size() + search.way.size();
  const size_t unused = ways * (RefractedWay::kMostEvents - 1) * sizeof event;
  EXPECT_TRUE(says(section("RefractedSearch"), sizeof search - unused, "")) << sizeof search - unused;
}

TEST(PathState, MembersAreRead) {
  // Negative control: a member more is one name more.
  EXPECT_EQ(names_in("double sum = 0, weight = 0"), (std::vector<std::string>{"sum", "weight"}));
  EXPECT_EQ(names_in("std::array<double, 4> u, v"), (std::vector<std::string>{"u", "v"}));
  EXPECT_EQ(names_in("uint32_t times : 30, side : 1"), (std::vector<std::string>{"times", "side"}));
  EXPECT_TRUE(names_in("static constexpr int kKnots = K").empty());
  EXPECT_GT(members_of("lane.h", "Lane").size(), 20u);
  // And other bytes are not found.
  EXPECT_TRUE(says(section("RefractedSearch"), sizeof(RefractedSearch), " bytes with gaps"));
  EXPECT_FALSE(says(section("RefractedSearch"), sizeof(RefractedSearch) + 8, " bytes with gaps"));
  EXPECT_FALSE(says(section("RefractedSearch"), sizeof(RefractedSearch) % 1000, " bytes with gaps"));
}

TEST(PathState, TheKernelKeepsFewMembers) {
  constexpr size_t kMost = 25;
  for (const auto& [header, name] : {std::pair{"kernel.h", "PathKernel"}, std::pair{"wave.h", "Wave"},
                                     std::pair{"techniques/set.h", "Techniques"}}) {
    const std::vector<std::string> members = members_of(header, name);
    std::cout << name << ": " << members.size() << " data members\n";
    EXPECT_LE(members.size(), kMost) << name;
    EXPECT_GT(members.size(), 5u) << name;
  }
}

}  // namespace
}  // namespace suite::test::path_state_test
