// Shapes of pulses from text.
#include "formats/pulse/pulse.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_pulse_pulse_test {
namespace {

using testing::HasSubstr;

TEST(PulseFile, ColumnsAndFaults) {
  const TempFolder folder;
  const auto read = [&](const std::string& text, const std::string& column = {}) {
    write_file(folder / "p.csv", text);
    return read_pulse_file(folder / "p.csv", column);
  };
  EXPECT_EQ(read("# made up\n0 0\n1 2\n3 0\n").power, (std::vector<double>{0, 2, 0}));
  EXPECT_NEAR(read("0,0\n1,2\n3,0\n").time[2], 3e-9, 1e-20);
  EXPECT_EQ(read("ns,a,b\n0,1,2\n1,3,4\n", "b").power, (std::vector<double>{2, 4}));
  const auto message = [&](const std::string& text, const std::string& column = {}) {
    return message_of([&] { read(text, column); });
  };
  EXPECT_THAT(message("ns,a,b\n0,1,2\n", "c"), HasSubstr("p.csv:1:1: error: no column 'c'"));
  EXPECT_THAT(message("ns,a,b\n0,1,2\n"), HasSubstr("the pulse is one of 2 columns; column: a"));
  EXPECT_THAT(message("0 1\n1\n"), HasSubstr("p.csv:2"));
  EXPECT_THAT(message("0 1\n1 x\n"), HasSubstr("p.csv:2:3"));
  EXPECT_THAT(message("0 1\n"), HasSubstr("1 rows of a pulse"));
}

// A triangle: full width at half maximum 1.5 ns.
TEST(PulseFile, ShapeOfAFile) {
  const TempFolder folder;
  write_file(folder / "p.csv", "0 0\n1 2\n3 0\n");
  PulseTable t = read_pulse_file(folder / "p.csv");
  EXPECT_NEAR(PulseShape::table(t.time, t.power).fwhm(), 1.5e-9, 1e-15);
}

// Transmitted pulses of GEDI (NASA/LP DAAC, public), by beam: 13.5 to 18.0 ns, with tails, so that the standard
// deviation is larger than that of a Gaussian as wide.
TEST(PulseFile, PulsesOfGedi) {
  double narrowest = 1, widest = 0;
  for (const char* beam : {"BEAM0001", "BEAM0010", "BEAM0011", "BEAM0101", "BEAM0110", "BEAM1000", "BEAM1011"}) {
    PulseTable t = read_pulse_file(std::string(SUITE_TEST_DATA) + "/lidar/gedi_tx_pulse.csv", beam);
    ASSERT_EQ(t.time.size(), size_t{128});
    const PulseShape shape = PulseShape::table(t.time, t.power);
    narrowest = std::min(narrowest, shape.fwhm()), widest = std::max(widest, shape.fwhm());
    EXPECT_GT(shape.deviation() * kFwhmOfDeviation, shape.fwhm());
  }
  EXPECT_NEAR(narrowest * 1e9, 13.5, 0.1);
  EXPECT_NEAR(widest * 1e9, 18.0, 0.1);
}

}  // namespace
}  // namespace suite::format_pulse_pulse_test
