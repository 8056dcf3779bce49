// Impulse responses in a file: there and back in blocks, what is never reached, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/response/response_file.h"
#include "support/message_of.h"
#include "support/response_kit.h"
#include "support/temp_folder.h"

namespace suite::format_response_response_test {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(ResponseFile, ThereAndBackInBlocks) {
  const TempFolder folder;
  const ResponseHead head = response_head(2, 1);
  ResponseWriter writer(folder / "r.h5", head, "made by a test", 20);
  std::vector<ResponseBlock> given;
  for (uint64_t p = 0; p < 10; p += 2) {
    given.push_back(response_block(head, p, 2, 100 + static_cast<double>(p)));
    writer.take(ResponseBlock(given.back()));
  }
  EXPECT_FALSE(file_exists(folder / "r.h5"));  // whole or not at all
  writer.finish();
  const ResponseReader reader(folder / "r.h5");
  EXPECT_EQ(reader.pulses(), uint64_t{10});
  EXPECT_EQ(reader.blocks(), size_t{3});  // of at least 20 entries: 24, 24, 12
  EXPECT_EQ(reader.head().channels, head.channels);
  EXPECT_EQ(reader.head().bin, head.bin);
  EXPECT_EQ(to_iso8601(*reader.head().epoch), "2026-11-28T00:00:00.000Z");
  EXPECT_EQ(reader.head().origin->latitude_deg, 50);
  size_t pulse = 0;
  reader.for_each_block([&](const ResponseBlock& b) {
    for (size_t row = 0; row < b.row_count(); ++row) {
      const ResponseRow r(reader.head(), b, row);
      const ResponseBlock& g = given[r.pulse_number() / 2];
      const ResponseRow w(head, g, row % 2 + 2 * (r.pulse_number() % 2));
      ASSERT_EQ(r.size(), w.size());
      for (size_t k = 0; k < r.size(); ++k)
        for (size_t c = 0; c < head.channels.size(); ++c) {
          EXPECT_EQ(r.value(k, c), w.value(k, c));
          EXPECT_EQ(r.variance(k, c), w.variance(k, c));
        }
      EXPECT_EQ(r.pulse().time, w.pulse().time);
      EXPECT_EQ(r.pulse().emission.translation, w.pulse().emission.translation);
      EXPECT_EQ(r.passive(), 0.01);
    }
    pulse += b.pulses.size();
  });
  EXPECT_EQ(pulse, size_t{10});
}

TEST(ResponseFile, BinsNeverReachedHaveABound) {
  const ResponseHead head = response_head();
  const ResponseBlock b = response_block(head, 0, 1);
  const ResponseRow row(head, b, 0);
  const BinKnown there = row.known(501), not_there = row.known(500);
  EXPECT_TRUE(there.reached);
  EXPECT_DOUBLE_EQ(there.value, 300);
  EXPECT_NEAR(there.error, std::sqrt(1e-4 * (280. * 280 + 20. * 20)), 1e-9);
  EXPECT_FALSE(not_there.reached);
  EXPECT_EQ(not_there.bound, 0.02);
}

// Pulses that nothing came back of have their records.
TEST(ResponseFile, PulsesWithoutLight) {
  const TempFolder folder;
  const ResponseHead head = response_head();
  ResponseBlock dark;
  for (int p = 0; p < 3; ++p) {
    dark.pulses.push_back(response_pulse(p));
    dark.begin.push_back(0), dark.bound.push_back(0.5), dark.paths.push_back(64);
  }
  ResponseWriter writer(folder / "r.h5", head, "a test");
  writer.take(std::move(dark));
  writer.finish();
  const ResponseReader reader(folder / "r.h5");
  const ResponseBlock b = reader.block(0);
  EXPECT_EQ(b.pulses.size(), size_t{3});
  EXPECT_EQ(b.entries(), size_t{0});
  EXPECT_EQ(ResponseRow(head, b, 2).known(7).bound, 0.5);
}

TEST(ResponseFile, WhatIsRefused) {
  const TempFolder folder;
  const ResponseHead head = response_head();
  const ResponseBlock good = response_block(head, 0, 2);
  ResponseBlock bad = good;
  bad.bin[2] = 7;
  EXPECT_THAT(fault_of(head, bad), HasSubstr("pixel 0 of pulse 0 has bin 7 behind bin 101"));
  bad = good, bad.value[3] = -1;
  EXPECT_THAT(fault_of(head, bad), HasSubstr("has -1 photons"));
  bad = good, bad.begin[1] = 1000;
  EXPECT_THAT(fault_of(head, bad), HasSubstr("rows do not follow each other"));
  bad = good, bad.pulses[1].energy = std::nan("");
  EXPECT_THAT(fault_of(head, bad), HasSubstr("pulse 1 has an energy of nan J"));
  EXPECT_EQ(fault_of(head, good), "");
  ResponseHead wrong = head;
  wrong.channels = {"all"};
  EXPECT_THAT(fault_of(wrong), HasSubstr("'single' and 'multiple'"));
  write_file(folder / "t.h5", "text");
  EXPECT_THAT(message_of([&] { ResponseReader r(folder / "t.h5"); }), HasSubstr("is not an HDF5 file"));
  EXPECT_THAT(message_of([&] { ResponseReader r(folder / "none.h5"); }), HasSubstr("none.h5"));
}

}  // namespace
}  // namespace suite::format_response_response_test
