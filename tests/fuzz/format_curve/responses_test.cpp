// Damaged tables of responses: text, and netCDF-4 as the netCDF library writes it.
#include "formats/curve/curve.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_curve_responses_test {
namespace {

class FuzzResponses : public ::testing::Test {
 protected:
  void fuzz_file(const test::Bytes& input, uint64_t seed, const std::vector<std::string>& words = {}) {
    test::fuzz(
        input,
        [&](std::span<const std::byte> bytes) {
          test::put_file(folder_ / "r.nc", bytes);
          for (const NamedCurve& band : read_responses(folder_ / "r.nc"))
            if (!(band.curve.low_um() > 0)) throw std::runtime_error("a wavelength of 0 came out");
        },
        seed, test::kMutations, words);
  }
  TempFolder folder_;
};

TEST_F(FuzzResponses, Table) {
  fuzz_file(test::bytes_of("wavelength_nm,B1,B2\n440,0,0\n445,0.8,0\n450,0,0.4\n455,0,0\n"), 1,
            {",", ";", "\t", "nan", "1e308", "-1", "\n", "um", "#"});
}

TEST_F(FuzzResponses, NetCdf) {
  for (const char* name : {"own_wavelengths.nc", "shared_wavelengths.nc", "variable_a_band.nc"})
    fuzz_file(read_bytes(std::string(SUITE_SOURCE_DIR "/tests/data/responses/") + name), 2);
}

}  // namespace
}  // namespace suite::format_curve_responses_test
