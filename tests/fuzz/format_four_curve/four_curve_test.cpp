// Damaged FourCurve atmospheres: HDF5 of another program.
#include "formats/four_curve/four_curve.h"
#include "formats/hdf5/h5.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_four_curve_four_curve_test {
namespace {

TEST(FuzzFourCurve, File) {
  const TempFolder folder;
  const std::string good = folder / "good.hdf", damaged = folder / "damaged.hdf";
  h5::Writer writer(good, good);
  writer.put("/SpectralSamples", std::vector<float>{0.4f, 0.5f, 0.6f}, "1", 3);
  writer.put("/SolarDeclinationSamples", std::vector<float>{10, 70}, "1");
  writer.put("/Conditions/clear",
             std::vector<float>{0.1f,  0.11f, 0.12f, 1e-9f, 2e-9f, 3e-9f, 1e-4f, 2e-4f, 0, 0.02f, 0.02f, 0.02f,
                                0.03f, 0.04f, 0.05f, 4e-9f, 5e-9f, 6e-9f, 1e-4f, 2e-4f, 0, 0.01f, 0.01f, 0.01f},
             "1", 3);
  writer.close();
  test::fuzz(read_bytes(good), [&](std::span<const std::byte> bytes) {
    test::put_file(damaged, bytes);
    for (const FourCurve& curve : read_four_curve(damaged)) four_curve_paths(curve, 20e3);
  });
}

}  // namespace
}  // namespace suite::format_four_curve_four_curve_test
