// LAS out, read back by the reader that shares nothing with the writer, and byte by byte where that does not look.
#include "formats/las_write/las_write.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "base/files.h"
#include "formats/las/las.h"
#include "scene/issues.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_las_write_las_write_test {
namespace {

using testing::HasSubstr;

LasSpec spec_of(LasPackets packets) {
  LasSpec s;
  s.offset = {500000, 5600000, 100};
  s.wkt = wkt_of_epsg(25832);
  s.extra = {{"amplitude", "", LasExtra::Type::f32}, {"tag", "", LasExtra::Type::u16}};
  s.packets = packets;
  if (packets != LasPackets::none) s.waves = {{16, 8, 1000, 0.5, -50}};
  return s;
}
LasReturn point_of(double x) {
  LasReturn p;
  p.place = {500000 + x, 5600000 - x, 100 + x / 2};
  p.intensity = 700, p.number = 2, p.of = 3, p.kind = 5, p.scan_angle = -0.2, p.gps_time = 479859218.25;
  p.extra = {12.5, 7};
  return p;
}
template <class T>
T at(const std::vector<std::byte>& bytes, size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

TEST(LasWrite, ReadBack) {
  const TempFolder folder;
  for (const LasPackets packets : {LasPackets::none, LasPackets::external, LasPackets::internal}) {
    const std::string path = folder / "a.las";
    LasWriter writer(path, spec_of(packets));
    uint64_t packet = 0;
    const uint16_t samples[8] = {100, 101, 400, 900, 400, 101, 100, 99};
    for (int k = 0; k < 1000; ++k) {
      LasReturn p = point_of(k * 0.1234);
      if (packets != LasPackets::none && k % 2 == 0) {
        p.descriptor = 1, p.packet = packet = writer.packet(1, samples), p.location = 3210,
        p.direction = {0, 0, 1.5e-4};
      }
      writer.add(p);
    }
    writer.finish();
    Report report(scene_issues());
    const PointCloud cloud = read_las(path, report);
    EXPECT_EQ(report.count(Severity::warning) + report.count(Severity::info), size_t{0}) << report.text();
    ASSERT_EQ(cloud.places.size(), size_t{1000});
    EXPECT_EQ(cloud.system, "EPSG:25832");
    EXPECT_EQ(cloud.kind[3], 5);
    for (size_t k = 0; k < 1000; ++k)
      EXPECT_LE(length(cloud.places[k] - point_of(static_cast<double>(k) * 0.1234).place),
                0.5e-3 * std::sqrt(3.0) + 1e-9);
    const std::vector<std::byte> bytes = read_bytes(path);
    const size_t first = at<uint32_t>(bytes, 96), size = at<uint16_t>(bytes, 105);
    EXPECT_EQ(at<uint16_t>(bytes, 6), packets == LasPackets::none ? 17 : packets == LasPackets::external ? 21 : 19);
    EXPECT_EQ(size, (packets == LasPackets::none ? 30u : 59u) + 6);
    EXPECT_EQ(at<double>(bytes, first + 22), 479859218.25);
    EXPECT_EQ(at<int16_t>(bytes, first + 18), std::lround(-0.2 / kDegree / 0.006));
    EXPECT_EQ(at<uint8_t>(bytes, first + 14), 2 | 3 << 4);
    EXPECT_EQ(at<float>(bytes, first + size - 6), 12.5f);
    EXPECT_EQ(at<uint16_t>(bytes, first + size - 2), 7);
    EXPECT_EQ(at<uint64_t>(bytes, 255 + 8), uint64_t{1000});  // second returns
    if (packets == LasPackets::none) continue;
    EXPECT_EQ(packet, 60u + 499 * 16);
    EXPECT_EQ(at<uint64_t>(bytes, first + 31), uint64_t{60});
    EXPECT_EQ(at<uint32_t>(bytes, first + 39), 16u);
    EXPECT_EQ(at<float>(bytes, first + 43), 3210.0f);
    EXPECT_EQ(at<uint8_t>(bytes, first + size + 30), 0);  // every other has none
    const bool internal = packets == LasPackets::internal;
    const std::vector<std::byte> packed = internal ? bytes : read_bytes(folder / "a.wdp");
    const size_t record = internal ? at<uint64_t>(bytes, 227) : 0;
    EXPECT_EQ(at<uint16_t>(packed, record + 18), 65535);
    EXPECT_EQ(at<uint64_t>(packed, record + 20), uint64_t{500 * 16});
    EXPECT_EQ(packed.size(), record + 60 + 500 * 16);
    EXPECT_EQ(at<uint16_t>(packed, record + packet + 6), 900);
    if (!internal) std::remove((folder / "a.wdp").c_str());
    EXPECT_EQ(folder.entries(), size_t{1});
  }
}

TEST(LasWrite, NoPoints) {
  const TempFolder folder;
  LasWriter writer(folder / "a.las", spec_of(LasPackets::none));
  writer.finish();
  Report report(scene_issues());
  EXPECT_TRUE(read_las(folder / "a.las", report).places.empty());
}

// A scale of 0.1 mm spans +-214 km about the offset.
TEST(LasWrite, OverflowIsRefused) {
  const TempFolder folder;
  LasSpec spec = spec_of(LasPackets::none);
  spec.scale = {1e-4, 1e-4, 1e-4};
  LasWriter writer(folder / "a.las", spec);
  LasReturn p = point_of(0);
  p.place.x += 214748;
  writer.add(p);
  p.place.x += 1;
  EXPECT_THAT(message_of([&] { writer.add(p); }),
              testing::AllOf(HasSubstr("point 1: x = 714749 is beyond"),
                             HasSubstr("a coarser scale, or an offset near the points")));
  EXPECT_EQ(folder.entries(), size_t{1});  // the temporary one
}

TEST(LasWrite, OtherFaults) {
  const TempFolder folder;
  LasSpec spec = spec_of(LasPackets::none);
  spec.scale.y = 0;
  EXPECT_THAT(message_of([&] { LasWriter w(folder / "a.las", spec); }), HasSubstr("a scale of 0"));
  LasWriter writer(folder / "a.las", spec_of(LasPackets::none));
  LasReturn p = point_of(0);
  p.extra[1] = 65536;
  EXPECT_THAT(message_of([&] { writer.add(p); }), HasSubstr("'tag' is 65536, 0 to 65535"));
  p = point_of(0), p.place.z = std::nan("");
  EXPECT_THAT(message_of([&] { writer.add(p); }), HasSubstr("point 0 has no place"));
}

TEST(LasWrite, ReferenceSystems) {
  for (const int epsg : {32601, 32760, 25833, 32632})
    EXPECT_THAT(wkt_of_epsg(epsg), HasSubstr(strf("AUTHORITY[\"EPSG\",\"%d\"]]", epsg)));
  EXPECT_THAT(wkt_of_epsg(32760), testing::AllOf(HasSubstr("zone 60S"), HasSubstr("\"central_meridian\",177"),
                                                 HasSubstr("\"false_northing\",10000000")));
  EXPECT_EQ(wkt_of_epsg(2056), "");
}

}  // namespace
}  // namespace suite::format_las_write_las_write_test
