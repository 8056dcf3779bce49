// Damaged ENVI headers: a header or one Error, never anything else.
#include <gtest/gtest.h>

#include "formats/envi/envi.h"
#include "support/mutate.h"

using namespace suite;

TEST(Fuzz, EnviHeader) {
  const std::string valid =
      "ENVI\ndescription = {two\nlines}\nsamples = 50\nlines = 49\nbands = 3\nheader offset = 0\nfile type = ENVI "
      "Standard\n"
      "data type = 1\ninterleave = bip\nbyte order = 0\nwavelength units = nm\nwavelength = {450, 550, 650}\n"
      "band names = {\nBand 1,\nBand 2,\nBand 3}\ndata ignore value = -9999\ndefault bands = {3, 2, 1}\n";
  const std::vector<std::string> words = {"=",
                                          "{",
                                          "}",
                                          "\n",
                                          ",",
                                          "-1",
                                          "0",
                                          "1e999",
                                          "nan",
                                          "2147483647",
                                          "99999999999999999999",
                                          "samples",
                                          "bands = 2",
                                          "wavelength = {}",
                                          "default bands",
                                          std::string(1, '\0'),
                                          "\xff\xfe",
                                          "\r\n",
                                          ";"};
  size_t accepted = 0;
  for (uint64_t seed = 0; seed < 20000; ++seed) {
    Pcg32 rng(seed);
    const std::string text = mutated(valid, words, rng);
    try {
      const EnviHeader h = parse_envi_header(text, "fuzz.hdr");
      ++accepted;
      ASSERT_GE(h.samples * h.lines * h.bands, 1u);
      ASSERT_TRUE(h.wavelength_um.empty() || h.wavelength_um.size() == h.bands);
      ASSERT_TRUE(h.band_names.empty() || h.band_names.size() == h.bands);
    } catch (const Error& e) {
      ASSERT_NE(std::string(e.what()).find("fuzz.hdr"), std::string::npos) << e.what();
    }
  }
  // Both outcomes occur, so the loop exercised the reader and not only its first check.
  EXPECT_GT(accepted, 500u);
  EXPECT_LT(accepted, 19500u);
}
