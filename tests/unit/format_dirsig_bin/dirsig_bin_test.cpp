// Lidar photons of DIRSIG: files written after the public readers, there and back, faults with their bytes.
#include "formats/dirsig_bin/dirsig_bin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_dirsig_bin_dirsig_bin_test {
namespace {

using testing::HasSubstr;

// 3 x 2 pixels, 4 bins and passive light, two pulses (plain, zlib): photons 0, 1, 2, ... and half of that.
TEST(DirsigBin, BothOrdersOfBytes) {
  for (const char* order : {"le", "be"}) {
    const LidarBin bin = read_lidar_bin(std::string(SUITE_TEST_DATA) + "/lidar/synthetic_rev2_" + order + ".bin");
    EXPECT_EQ(bin.head.columns, 3u);
    EXPECT_EQ(bin.head.rows, 2u);
    ASSERT_EQ(bin.tasks.size(), size_t{1});
    ASSERT_EQ(bin.tasks[0].pulses.size(), size_t{2});
    for (size_t p = 0; p < 2; ++p) {
      const LidarBinPulse& pulse = bin.tasks[0].pulses[p];
      EXPECT_EQ(pulse.bins, 4u);
      EXPECT_EQ(pulse.packed, p == 1);
      ASSERT_EQ(pulse.photons.size(), size_t{30});
      for (size_t k = 0; k < 30; ++k) EXPECT_EQ(pulse.photons[k], static_cast<double>(k) * (p ? 0.5 : 1));
    }
  }
}

LidarBinPulse pulse_of(double number, bool packed) {
  LidarBinPulse p;
  p.time = number, p.gate_start = 1e-6, p.gate_stop = 2e-6, p.bins = 9, p.packed = packed;
  p.platform = {1, 2, 3}, p.euler = {0.1, 0.2, 0.3};
  p.receiver.to_mount[3] = 0.5;
  for (int k = 0; k < 40; ++k) p.photons.push_back(k % 7 ? 0 : number + k);
  return p;
}
void write(const std::string& path) {
  LidarBinHead head;
  head.columns = 2, head.rows = 2, head.latitude = 50, head.date = "202611280000.00", head.text = "a test";
  LidarBinTask task;
  task.rate_hz = 1e4, task.energy = 1e-3, task.centre_um = 1.064, task.pulse_count = 2, task.start = head.date;
  LidarBinWriter writer(path, head, task);
  writer.add(pulse_of(5, false)), writer.add(pulse_of(6, true));
  writer.finish();
}

TEST(DirsigBin, ThereAndBack) {
  const TempFolder folder;
  write(folder / "a.bin");
  const LidarBin bin = read_lidar_bin(folder / "a.bin");
  EXPECT_EQ(bin.head.text, "a test");
  EXPECT_EQ(bin.head.latitude, 50);
  EXPECT_EQ(bin.tasks[0].start, "202611280000.00");
  EXPECT_EQ(bin.tasks[0].centre_um, 1.064);
  for (size_t p = 0; p < 2; ++p) {
    const LidarBinPulse a = pulse_of(5 + static_cast<double>(p), p == 1), b = bin.tasks[0].pulses[p];
    EXPECT_EQ(a.photons, b.photons);
    EXPECT_EQ(a.euler, b.euler);
    EXPECT_EQ(a.receiver.to_mount, b.receiver.to_mount);
    EXPECT_EQ(a.gate_stop, b.gate_stop);
  }
}

// Revisions 0 and 1 byte by byte, by the page's table: an offset and an order of angles in place of matrices.
TEST(DirsigBin, OlderRevisions) {
  for (const int revision : {0, 1}) {
    std::string b = "DIRSIGPROTO";
    const auto put = [&](auto value) { b.append(reinterpret_cast<const char*>(&value), sizeof value); };
    const auto numbers = [&](std::initializer_list<double> values) {
      for (const double v : values) put(v);
    };
    const auto space = [&](size_t n) { b.append(n, '\0'); };
    put(static_cast<uint8_t>(revision)), put(uint8_t{1});
    space(15 + 32 + 256), numbers({50, 8, 100}), space(32);
    put(2u), put(1u), numbers({50, 50});
    if (revision == 1) numbers({1, 2, 0, 0});
    put(1u);
    space(64 + 15 + 15), numbers({400, 1e4, 2e-9, 1e-3, 1.064, 1e-4}), put(1u);
    numbers({0.5, 1e-6, 2e-6}), put(3u);
    if (revision == 1) put(1u);
    numbers({1, 2, 3}), b += "XYZ", numbers({0.1, 0.2, 0.3});
    for (int end = 0; end < 2; ++end) numbers({0.5, 0.6, 0.7}), b += "XYZ", numbers({0, 0, 0});
    put(int32_t{5}), put(uint8_t{0}), put(uint8_t{0}), put(uint64_t{8 * 8});
    numbers({0, 1, 2, 3, 4, 5, 6, 7});
    const LidarBin bin = parse_lidar_bin(std::as_bytes(std::span(b)), "old.bin");
    const LidarBinPulse& p = bin.tasks.at(0).pulses.at(0);
    EXPECT_EQ(bin.head.offset_y_um, revision ? 2 : 0);
    EXPECT_EQ(p.euler, (Vec3{0.1, 0.2, 0.3}));
    EXPECT_EQ(p.receiver.to_mount[7], 0.6);
    EXPECT_EQ(p.photons, (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7}));
  }
}

TEST(DirsigBin, WhatIsRefused) {
  const TempFolder folder;
  write(folder / "a.bin");
  const std::vector<std::byte> good = read_bytes(folder / "a.bin");
  const auto message = [&](size_t at, uint8_t value) {
    std::vector<std::byte> bad = good;
    bad[at] = std::byte(value);
    return message_of([&] { parse_lidar_bin(bad, "a.bin"); });
  };
  EXPECT_THAT(message(0, 'X'), HasSubstr("it begins with DIRSIGPROTO"));
  EXPECT_THAT(message(11, 3), HasSubstr("newer ones are not public"));
  EXPECT_THAT(message(12, 7), HasSubstr("the order of bytes 7"));
  EXPECT_THAT(message(434 + 145, 255), HasSubstr("pulses cannot be in"));
  EXPECT_THAT(message(434 + 146 + 27, 64), HasSubstr("a.bin: byte "));
  EXPECT_THAT(message_of([&] { parse_lidar_bin(std::span(good).first(good.size() - 3), "a.bin"); }),
              HasSubstr("the file ends within the photons"));
  EXPECT_THAT(message(good.size() - 5, 77), HasSubstr("the photons of a pulse are damaged"));
}

}  // namespace
}  // namespace suite::format_dirsig_bin_dirsig_bin_test
