// STL as programs write it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "formats/stl/stl.h"
#include "scene/issues.h"

namespace suite {
namespace {

SourceMesh parse(const std::string& text) {
  Report report(scene_issues());
  return parse_stl(std::as_bytes(std::span(text.data(), text.size())), "t.stl", report);
}

// CAD programs write its keywords in capitals, and numbers with a capital exponent.
TEST(Stl, KeywordsComeInEitherCase) {
  std::string text =
      "solid Part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2e0 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\nendsolid "
      "Part\n";
  EXPECT_EQ(parse(text).indices.size(), 3u);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const SourceMesh m = parse(text);
  ASSERT_EQ(m.indices.size(), 3u);
  EXPECT_DOUBLE_EQ(m.positions.at(1).x, 2);
}

}  // namespace
}  // namespace suite
