// Damaged shapes of pulses: a shape, or one Error.
#include "formats/pulse/pulse.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_pulse_pulse_test {

TEST(FuzzPulse, Columns) {
  const TempFolder folder;
  const std::string path = folder / "p.csv";
  test::fuzz(test::bytes_of("# a pulse\nns,a,b\n0,0.001,0.5\n1,0.02,0.25\n2.5,1,0\n3,0.5,-0.1\n"),
             [&](std::span<const std::byte> bytes) {
               test::put_file(path, bytes);
               PulseTable t = read_pulse_file(path, "b");
               PulseShape::table(std::move(t.time), std::move(t.power), Where{path, 0, 0, {}, -1}).through(1e-9);
             },
             1, 500, {"nan", "1e308", "-", ",,", "ns"});
}

}  // namespace suite::format_pulse_pulse_test
