// Point clouds of every version and format, reference systems, and faults with their bytes.
#include "formats/las/las.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/issues.h"
#include "support/fuzz.h"
#include "support/las_kit.h"
#include "support/message_of.h"

namespace suite::format_las_las_test {
namespace {

using testing::HasSubstr;

PointCloud parse(const std::string& bytes, Report& report) { return parse_las(test::bytes_of(bytes), "a.las", report); }

const std::vector<test::LasPoint> kPoints{
    {500001.25, 5600002.5, 3.75, 2}, {499999, 5599999, -1, 5}, {500000, 5600000, 9, 6, true}};

TEST(Las, EveryVersionAndFormat) {
  for (int minor = 0; minor <= 4; ++minor)
    for (int format = 0; format <= 10; ++format) {
      Report report(scene_issues());
      const PointCloud cloud = parse(test::las(kPoints, minor, format), report);
      ASSERT_EQ(cloud.places.size(), size_t{2}) << minor << " " << format;  // one is withheld
      EXPECT_NEAR(length(cloud.places[0] - Vec3{500001.25, 5600002.5, 3.75}), 0, 1e-9);
      EXPECT_NEAR(length(cloud.places[1] - Vec3{499999, 5599999, -1}), 0, 1e-9);
      EXPECT_EQ(cloud.kind, (std::vector<uint8_t>{2, 5}));
      EXPECT_EQ(cloud.system, "EPSG:25832");
      EXPECT_EQ(report.count("SP706"), size_t{1});
    }
}

TEST(Las, TheReferenceSystemAsText) {
  // The keys of a file are written over with a text of the same room, as record 2112.
  const std::string text =
      "COMPD_CS[\"x\",PROJCS[\"UTM\",GEOGCS[\"ETRS89\",AUTHORITY[\"EPSG\",\"4258\"]],AUTHORITY[\"EPSG\",\"25833\"]],"
      "VERT_CS[\"h\",AUTHORITY[\"EPSG\",\"5783\"]]]";
  std::string bytes = test::las(kPoints);
  const uint16_t id = 2112, size = static_cast<uint16_t>(text.size());
  const uint32_t first = static_cast<uint32_t>(227 + 54 + text.size());
  std::memcpy(bytes.data() + 227 + 18, &id, 2);
  std::memcpy(bytes.data() + 227 + 20, &size, 2);
  std::memcpy(bytes.data() + 96, &first, 4);
  bytes.replace(227 + 54, 16, text);
  Report report(scene_issues());
  EXPECT_EQ(parse(bytes, report).system, "EPSG:25833");
}

// Texts as programs write them, made into record 2112 of a file.
std::string system_of(const std::string& text) {
  std::string bytes = test::las(kPoints);
  const uint16_t id = 2112, size = static_cast<uint16_t>(text.size());
  const uint32_t first = static_cast<uint32_t>(227 + 54 + text.size());
  std::memcpy(bytes.data() + 227 + 18, &id, 2);
  std::memcpy(bytes.data() + 227 + 20, &size, 2);
  std::memcpy(bytes.data() + 96, &first, 4);
  bytes.replace(227 + 54, 16, text);
  Report report(scene_issues());
  return parse(bytes, report).system;
}

TEST(Las, OnlyTheCodeOfTheSystemItself) {
  const std::string below =
      "GEOGCS[\"WGS 84\",DATUM[\"W\",SPHEROID[\"W\",6378137,298.25,AUTHORITY[\"EPSG\",\"7030\"]],AUTHORITY[\"EPSG\","
      "\"6326\"]],AUTHORITY[\"EPSG\",\"4326\"]],UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]]";
  EXPECT_EQ(system_of("PROJCS[\"UTM 10N\"," + below + ",AUTHORITY[\"EPSG\",\"32610\"]]"), "EPSG:32610");
  EXPECT_EQ(system_of("PROJCS[\"Conus Albers\"," + below + "]"), "Conus Albers without a code");
  EXPECT_EQ(system_of("COMPD_CS[\"x\", PROJCS [ \"UTM_10N\", " + below + " ] ]"), "UTM_10N without a code");
  EXPECT_EQ(system_of(below), "EPSG:4326");
  EXPECT_EQ(system_of("PROJCRS[\"UTM [10N]\",BASEGEOGCRS[\"W\",ID[\"EPSG\",4326]],ID[\"EPSG\",32610]]"), "EPSG:32610");
  // Codes without quotes.
  EXPECT_EQ(system_of("PROJCS[\"x\"," + below + ",AUTHORITY[\"EPSG\",25832]]"), "EPSG:25832");
}

TEST(Las, HeadersThatDisagreeWithThePoints) {
  const auto found = [](size_t at, auto value, const std::string& more = "") {
    std::string bytes = test::las(kPoints) + more;
    std::memcpy(bytes.data() + at, &value, sizeof value);
    Report report(scene_issues());
    parse(bytes, report);
    return report.count("SP709") ? report.text() : std::string();
  };
  EXPECT_EQ(found(0, 'L'), "");
  EXPECT_THAT(found(107, uint32_t{2}), HasSubstr("the header counts 2 points, the file has room for 3"));
  EXPECT_THAT(found(0, 'L', std::string(28, '\0')), HasSubstr("the header counts 3 points, the file has room for 4"));
  EXPECT_THAT(found(179, 500009.0),
              HasSubstr("the header says x from 499999 to 500009, the points are from 499999 to"));
  EXPECT_THAT(found(219, -4.0), HasSubstr("the header says z from -4 to 9"));
}

TEST(Las, FaultsHaveTheirByte) {
  const auto said = [](size_t at, const std::string& bytes, size_t cut = 0) {
    std::string all = test::las(kPoints);
    all.replace(at, bytes.size(), bytes);
    all.resize(all.size() - cut);
    Report report(scene_issues());
    return message_of([&] { parse(all, report); });
  };
  EXPECT_THAT(said(0, "LASX"), HasSubstr("is no LAS file"));
  EXPECT_THAT(said(104, std::string(1, '\x81')), HasSubstr("byte 104: error: the points are compressed (LAZ)"));
  EXPECT_THAT(said(104, "\x0b"), HasSubstr("point format 11"));
  EXPECT_THAT(said(25, "\x05"), HasSubstr("version 1.5"));
  EXPECT_THAT(said(107, "\xff\xff\xff\x7f"), HasSubstr("cannot be in"));
  EXPECT_THAT(said(0, "LASF", 30), HasSubstr("cannot be in"));
  EXPECT_THAT(said(100, "\x02"), HasSubstr("lies beyond the first point"));
}

}  // namespace
}  // namespace suite::format_las_las_test
