// Damaged PLY files: findings or one Error, never anything else.
#include "formats/ply/ply.h"
#include "scene/issues.h"
#include "support/fuzz.h"

namespace suite::format_ply_ply_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const SourceMesh m = parse_ply(bytes, "fuzz.ply", report);
  for (const uint32_t v : m.indices)
    if (v >= m.positions.size()) throw std::runtime_error("an index that is not there came out");
  if (!m.normals.empty() && m.normals.size() != m.positions.size()) throw std::runtime_error("a normal is missing");
  if (m.indices.size() % 3) throw std::runtime_error("a corner is missing");
}

std::string header(const char* format) {
  return strf(
      "ply\nformat %s 1.0\ncomment made here\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float s\nproperty float t\nelement face 2\n"
      "property list uchar int vertex_indices\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n",
      format);
}

std::string text() {
  return header("ascii") +
         "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n2 1 0 0 0 1 0 1\n"
         "4 0 1 2 3\n3 1 4 2\n7 0 1 2 -1 1 4 2\n";
}

std::string binary() {
  std::string all = header("binary_little_endian");
  const auto put = [&](auto value) { all.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (int v = 0; v < 5; ++v)
    for (int c = 0; c < 8; ++c) put(static_cast<float>((v >> (c % 3)) & 1));
  put(uint8_t{4});
  for (const int32_t i : {0, 1, 2, 3}) put(i);
  put(uint8_t{3});
  for (const int32_t i : {1, 4, 2}) put(i);
  put(int32_t{7});
  for (const int32_t i : {0, 1, 2, -1, 1, 4, 2}) put(i);
  return all;
}

const std::vector<std::string> kWords{"\n",
                                      " -1",
                                      " 99999999999",
                                      " nan",
                                      " 1e999",
                                      "element face 4000000000\n",
                                      "property list uint uint z\n",
                                      "end_header\n",
                                      "binary_big_endian",
                                      "int8"};

TEST(FuzzPly, Text) { test::fuzz(test::bytes_of(text()), read_and_check, 1, test::kMutations, kWords); }
TEST(FuzzPly, Binary) { test::fuzz(test::bytes_of(binary()), read_and_check, 2, test::kMutations, kWords); }

}  // namespace
}  // namespace suite::format_ply_ply_test
