// Cities: levels of detail, kinds of surfaces, templates, sequences, CityGML, and faults with their places.
#include "formats/city/city.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "scene/issues.h"
#include "support/city_kit.h"
#include "support/message_of.h"

namespace suite::format_city_city_test {
namespace {

using test::small_city;
using test::small_gml;
using testing::HasSubstr;

CityModel parse(const std::string& text, Report& report, const std::optional<std::string>& lod = std::nullopt) {
  return parse_city(text, "c.city.json", lod, report);
}

// Sum of the rings' areas (Newell), holes taken off, by kind.
std::map<std::string, double> areas(const CityModel& city) {
  std::map<std::string, double> of;
  for (const auto& object : city.objects)
    for (const auto& surface : object.surfaces)
      for (size_t r = 0; r < surface.rings.size(); ++r) {
        const auto& ring = surface.rings[r];
        Vec3 sum;
        for (size_t k = 0; k < ring.size(); ++k) sum += cross(ring[k] - ring[0], ring[(k + 1) % ring.size()] - ring[0]);
        of[surface.kind] += (r == 0 ? 1 : -1) * length(sum) / 2;
      }
  return of;
}

TEST(CityJson, TheHighestLevelOfEachObject) {
  for (const char* version : {"1.0", "1.1", "2.0"}) {
    Report report(scene_issues());
    const CityModel city = parse(small_city(version), report);
    EXPECT_EQ(city.system, "https://www.opengis.net/def/crs/EPSG/0/25832");
    ASSERT_EQ(city.objects.size(), size_t{4});
    auto of = areas(city);
    EXPECT_NEAR(of["GroundSurface"], 60, 1e-9);
    EXPECT_NEAR(of["RoofSurface"], 60, 1e-9);
    EXPECT_NEAR(of["WallSurface"], 40 - 4 + 24 + 40, 1e-9);
    EXPECT_NEAR(of["Building"], 24, 1e-9);  // the wall without a value
    EXPECT_NEAR(of["GenericCityObject"], 60, 1e-9);
    EXPECT_NEAR(of["CityObjectGroup"], 2 + 0.5, 1e-9);
    EXPECT_EQ(report.count("SP205"), size_t{1});
    // The larger tree: turned and scaled by the matrix, then put at its vertex.
    const Vec3 p = city.objects[2].surfaces[0].rings[0][1];
    EXPECT_NEAR(p.x, 500000 + 1 + 2, 1e-9);
    EXPECT_NEAR(p.z, 104, 1e-9);
  }
}

TEST(CityJson, AChosenLevel) {
  Report report(scene_issues());
  EXPECT_NEAR(areas(parse(small_city(), report, "0"))["Building"], 60, 1e-9);
  EXPECT_NEAR(areas(parse(small_city(), report, "2"))["RoofSurface"], 60, 1e-9);  // 2.2 is a 2
  EXPECT_EQ(areas(parse(small_city(), report, "2.1")).count("RoofSurface"), size_t{0});
  EXPECT_GT(report.count("SP705"), size_t{0});
}

TEST(CityJson, ASequenceOfFeatures) {
  const std::string head =
      R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[10,20,30]},"CityObjects":{},"vertices":[]})";
  const auto feature = [](const std::string& id, int x) {
    return R"({"type":"CityJSONFeature","id":")" + id + R"(","CityObjects":{")" + id +
           R"(":{"type":"Road","geometry":[{"type":"CompositeSurface","lod":"1","boundaries":[[[0,1,2]]]}]}},"vertices":[[)" +
           std::to_string(x) + R"(,0,0],[1,0,0],[0,1,0]]})";
  };
  Report report(scene_issues());
  const CityModel city = parse(head + "\n" + feature("a", 0) + "\n" + feature("b", -1) + "\n", report);
  ASSERT_EQ(city.objects.size(), size_t{2});
  EXPECT_EQ(city.objects[1].id, "b");
  EXPECT_EQ(city.objects[1].surfaces[0].line, 3);
  EXPECT_EQ(city.objects[1].surfaces[0].rings[0][0], (Vec3{9, 20, 30}));
  EXPECT_NEAR(areas(city)["Road"], 0.5 + 1, 1e-12);
  EXPECT_THAT(message_of([&] { parse(head + "\n" + feature("a", 0).substr(0, 60) + "\n", report); }),
              HasSubstr("c.city.json:2"));
}

TEST(CityJson, ParentsAreLeftToTheirParts) {
  Report report(scene_issues());
  const CityModel city = parse(
      R"({"type":"CityJSON","version":"1.1","transform":{"scale":[1,1,1],"translate":[0,0,0]},"CityObjects":{
"b":{"type":"Building","children":["p"],"geometry":[{"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2]]]}]},
"p":{"type":"BuildingPart","parents":["b"],"geometry":[{"type":"MultiSurface","lod":"1.2","boundaries":[[[0,1,2]]]}]}},
"vertices":[[0,0,0],[1,0,0],[0,1,0]]})",
      report);
  EXPECT_EQ(areas(city).count("Building"), size_t{0});
  EXPECT_EQ(areas(city).count("BuildingPart"), size_t{1});
  EXPECT_EQ(report.count("SP706"), size_t{1});
}

TEST(CityJson, FaultsHaveTheirPlace) {
  const auto said = [](std::string from, const std::string& to) {
    std::string text = small_city();
    const size_t at = text.find(from);
    EXPECT_NE(at, text.npos);
    text.replace(at, from.size(), to);
    Report report(scene_issues());
    return message_of([&] { parse(text, report); });
  };
  EXPECT_THAT(said("[[4,5,6,7]]", "[[4,5,6,77]]"),
              HasSubstr("CityObjects/house/geometry[1]/boundaries[0][1]: vertex 77 of 12"));
  EXPECT_THAT(said("\"Solid\"", "\"Sold\""), HasSubstr("'Sold' is no type of geometry"));
  EXPECT_THAT(said("[0,1,2,2,2,null]", "[0,1,2,2,2]"), HasSubstr("6 boundaries and 5 semantic values"));
  EXPECT_THAT(said("[0,1,2,2,2,null]", "[0,1,2,2,3,null]"), HasSubstr("c.city.json"));
  EXPECT_THAT(said("\"version\":\"1.1\"", "\"version\":\"3.1\""), HasSubstr("'3.1' is not read here"));
  EXPECT_THAT(said("\"template\":0", "\"template\":1"), HasSubstr("c.city.json"));
}

// A small file may not ask for endless copies.
TEST(CityJson, CopiesAreCounted) {
  std::string ring = "0", instances;
  for (int k = 1; k < 30000; ++k) ring += k % 2 ? ",1" : ",2";
  for (int k = 0; k < 700; ++k)
    instances +=
        std::string(k ? "," : "") +
        R"({"type":"GeometryInstance","template":0,"transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],"boundaries":[0]})";
  Report report(scene_issues());
  EXPECT_THAT(
      message_of([&] {
        parse(
            R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[0,0,0]},"CityObjects":{"a":{"type":"Plant","geometry":[)" +
                instances +
                R"(]}},"geometry-templates":{"templates":[{"type":"MultiSurface","lod":"1","boundaries":[[[)" + ring +
                R"(]]]}],"vertices-templates":[[0,0,0],[1,0,0],[0,1,0]]},"vertices":[[0,0,0]]})",
            report);
      }),
      HasSubstr("copies of templates have more than 2e7 corners"));
}

TEST(CityGml, SolidsReferToTheirSurfaces) {
  Report report(scene_issues());
  const CityModel city = parse_city(small_gml(), "c.gml", std::nullopt, report);
  ASSERT_EQ(city.objects.size(), size_t{3});
  EXPECT_EQ(city.objects[0].id, "b1");
  auto of = areas(city);
  EXPECT_NEAR(of["RoofSurface"], 100 - 2, 1e-12);
  EXPECT_NEAR(of["WallSurface"], 30, 1e-12);
  EXPECT_NEAR(of["SolitaryVegetationObject"], 2 + 0.5, 1e-12);
  EXPECT_EQ(city.objects[1].surfaces.at(0).rings[0][1], (Vec3{102, 200, 4}));
  EXPECT_EQ(city.objects[2].surfaces.at(0).rings[0][1], (Vec3{2, 1, 1}));
  EXPECT_EQ(of.size(), size_t{3});  // the solid of level 1 is left out
  // The orientable surface turns its base round: the wall looks south.
  for (const auto& s : city.objects[0].surfaces)
    if (s.kind == "WallSurface") {
      const auto& r = s.rings[0];
      EXPECT_LT(cross(r[1] - r[0], r[2] - r[0]).y, 0);
    }
  EXPECT_NEAR(areas(parse_city(small_gml(), "c.gml", "1", report))["Building"], 0.5, 1e-12);
  std::string bad = small_gml();
  bad.replace(bad.find("0 0 3 10"), 8, "0 0 x 10");
  EXPECT_THAT(message_of([&] { parse_city(bad, "c.gml", std::nullopt, report); }), HasSubstr("'x' is no number"));
}

// Two boxes of 10 m that share a wall: the second has it by reference, turned round.
TEST(CityGml, SurfacesOfOtherObjectsByReference) {
  const auto face = [](const char* id, const char* places) {
    return "<surfaceMember><Polygon id=\"" + std::string(id) + "\"><exterior><LinearRing><posList>" + places +
           "</posList></LinearRing></exterior></Polygon></surfaceMember>";
  };
  const auto solid = [](const char* id, const std::string& faces) {
    return "<cityObjectMember><Building id=\"" + std::string(id) + "\"><lod1Solid><Solid><exterior><CompositeSurface>" +
           faces + "</CompositeSurface></exterior></Solid></lod1Solid></Building></cityObjectMember>";
  };
  const auto parse = [&](const std::string& wall, Report& report) {
    const std::string text = "<CityModel>" + solid("A", face("east", "10 0 0 10 10 0 10 10 10 10 0 10 10 0 0")) +
                             solid("B", face("top", "10 0 10 20 0 10 20 10 10 10 10 10 10 0 10") + wall) +
                             "</CityModel>";
    return parse_city(text, "c.gml", std::nullopt, report);
  };
  Report report(scene_issues());
  const CityModel city = parse(
      "<surfaceMember><OrientableSurface orientation=\"-\"><baseSurface "
      "href=\"#east\"/></OrientableSurface></surfaceMember>",
      report);
  ASSERT_EQ(city.objects.size(), size_t{2});
  EXPECT_EQ(city.objects[0].surfaces.size(), size_t{1});
  ASSERT_EQ(city.objects[1].surfaces.size(), size_t{2});
  const auto& r = city.objects[1].surfaces[1].rings.at(0);
  EXPECT_LT(cross(r[1] - r[0], r[2] - r[0]).x, 0);  // looks west, out of B
  EXPECT_EQ(report.count("SP705"), size_t{0});
  parse("<surfaceMember href=\"#nowhere\"/>", report);
  EXPECT_EQ(report.count("SP705"), size_t{1});
  // References that go round in a circle end.
  const std::string loop = "<CityModel>" +
                           solid("A",
                                 "<surfaceMember><CompositeSurface id=\"a\"><surfaceMember "
                                 "href=\"#b\"/></CompositeSurface></surfaceMember>") +
                           solid("B",
                                 "<surfaceMember><CompositeSurface id=\"b\"><surfaceMember "
                                 "href=\"#a\"/></CompositeSurface></surfaceMember>") +
                           "</CityModel>";
  parse_city(loop, "c.gml", std::nullopt, report);
}

TEST(City, FormatsAreKnownByNameAndContent) {
  EXPECT_EQ(city_format("a/b.city.json", small_city().substr(0, 100)), "cityjson");
  EXPECT_EQ(city_format("a.json", "{\"scene\": 1}"), "");
  EXPECT_EQ(city_format("a.GML", small_gml().substr(0, 300)), "citygml");
  EXPECT_EQ(city_format("a.xml", "<document><scene/></document>"), "");
}

}  // namespace
}  // namespace suite::format_city_city_test
