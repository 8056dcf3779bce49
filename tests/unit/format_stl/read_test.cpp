// STL as programs write it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstring>

#include "formats/stl/stl.h"
#include "scene/issues.h"

namespace suite::format_stl_read_test {
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

// Some programs append colours or padding to binary files.
TEST(Stl, BytesBehindTheLastFacetAreTold) {
  std::string text(84, ' ');
  const uint32_t count = 1;
  std::memcpy(text.data() + 80, &count, sizeof count);
  const float facet[12] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 1, 0};
  text.append(reinterpret_cast<const char*>(facet), sizeof facet);
  text.append(2, '\0');
  const auto read = [](const std::string& bytes) {
    Report report(scene_issues());
    const SourceMesh m = parse_stl(std::as_bytes(std::span(bytes.data(), bytes.size())), "t.stl", report);
    EXPECT_EQ(m.indices.size(), 3u);
    return report.text();
  };
  EXPECT_EQ(read(text).find("not read"), std::string::npos);
  EXPECT_NE(read(text + "COLOR=x").find("7 bytes behind the last facet are not read"), std::string::npos);
  EXPECT_THROW(parse(text.substr(0, 133)), Error);
}

}  // namespace
}  // namespace suite::format_stl_read_test
