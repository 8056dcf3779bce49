// Damaged STL files: findings or one Error, never anything else.
#include "formats/stl/stl.h"
#include "scene/issues.h"
#include "support/fuzz.h"

namespace suite::format_stl_stl_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const SourceMesh m = parse_stl(bytes, "fuzz.stl", report);
  for (const uint32_t v : m.indices)
    if (v >= m.positions.size()) throw std::runtime_error("an index that is not there came out");
  if (!m.normals.empty() && m.normals.size() != m.positions.size()) throw std::runtime_error("a normal is missing");
  if (m.indices.size() % 3) throw std::runtime_error("a corner is missing");
}

std::string binary() {
  std::string all(80, 'h');
  const auto put = [&](auto value) { all.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(uint32_t{3});
  for (int facet = 0; facet < 3; ++facet) {
    for (int c = 0; c < 12; ++c) put(static_cast<float>((facet >> (c % 2)) + c));
    put(uint16_t{0});
  }
  return all;
}

const char* const kText =
    "solid a b\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 1 1 0\n  endloop\n "
    "endfacet\n"
    "endsolid a b\nsolid c\nfacet normal 0 0 -1 outer loop vertex 0 0 0 vertex 1e0 0 0 vertex 1 1 0 endloop endfacet\n"
    "endsolid c\n";
const std::vector<std::string> kWords{"vertex", " nan", " 1e999", "endsolid", "facet", "solid\n", "\n", "-0", "1e-999"};

TEST(FuzzStl, Text) { test::fuzz(test::bytes_of(kText), read_and_check, 1, test::kMutations, kWords); }
TEST(FuzzStl, Binary) { test::fuzz(test::bytes_of(binary()), read_and_check, 2, test::kMutations); }

}  // namespace
}  // namespace suite::format_stl_stl_test
