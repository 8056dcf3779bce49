// Damaged cities: findings or one Error, never anything else.
#include "formats/city/city.h"

#include "scene/issues.h"
#include "support/city_kit.h"
#include "support/fuzz.h"

namespace suite::format_city_city_test {
namespace {

void read_and_check(std::span<const std::byte> bytes) {
  Report report(scene_issues());
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const CityModel city = parse_city(text, "fuzz.city", std::nullopt, report);
  const SourceMesh mesh = mesh_of(
      city, [](Vec3 v) { return v; }, report);
  for (const uint32_t v : mesh.indices)
    if (v >= mesh.positions.size()) throw std::runtime_error("an index that is not there came out");
  for (const auto& polygon : mesh.holed)
    for (const uint32_t v : polygon.corners)
      if (v >= mesh.positions.size()) throw std::runtime_error("a corner that is not there came out");
}

const std::vector<std::string> kJson{"null",
                                     "[[[[0]]]]",
                                     "-1",
                                     "1e99",
                                     "99999999999",
                                     "{}",
                                     "[]",
                                     "\"Solid\"",
                                     "\"MultiSolid\"",
                                     "\"GeometryInstance\"",
                                     "\"parents\":[\"house\"],"};
const std::vector<std::string> kXml{"<gml:Polygon>",   "</gml:Polygon>",     " nan ",
                                    " 1e999 ",         "srsDimension=\"2\"", "xlink:href=\"#p1\"",
                                    "<gml:interior/>", "lod4Solid",          "&#0;"};

TEST(FuzzCity, Json) { test::fuzz(test::bytes_of(test::small_city()), read_and_check, 1, test::kMutations, kJson); }
TEST(FuzzCity, Gml) { test::fuzz(test::bytes_of(test::small_gml()), read_and_check, 2, test::kMutations, kXml); }

}  // namespace
}  // namespace suite::format_city_city_test
