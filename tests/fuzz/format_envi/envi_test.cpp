// Damaged ENVI headers: a header or one Error, never anything else.
#include "formats/envi/envi.h"
#include "base/files.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_envi_envi_test {

TEST(Fuzz, EnviHeader) {
  const std::string valid =
      "ENVI\ndescription = {two\nlines}\nsamples = 50\nlines = 49\nbands = 3\nheader offset = 0\nfile type = ENVI "
      "Standard\n"
      "data type = 1\ninterleave = bip\nbyte order = 0\nwavelength units = nm\nwavelength = {450, 550, 650}\n"
      "band names = {\nBand 1,\nBand 2,\nBand 3}\ndata ignore value = -9999\ndefault bands = {3, 2, 1}\n"
      "classes = 2\nclass lookup = {0, 0, 0, 1, 2, 3}\nclass names = {none, grass}\nacquisition time = "
      "2026-06-21T10:30:00Z\nsun azimuth = 120.5\nsun elevation = 45\n";
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
                                          "class names = {a, b, c}",
                                          "class lookup = {",
                                          std::string(1, '\0'),
                                          "\xff\xfe",
                                          "\r\n",
                                          ";"};
  size_t accepted = 0;
  const auto read = [&](std::span<const std::byte> b) {
    const EnviHeader h = parse_envi_header({reinterpret_cast<const char*>(b.data()), b.size()}, "fuzz.hdr");
    ++accepted;
    EXPECT_GE(h.samples * h.lines * h.bands, 1u);
    EXPECT_TRUE(h.wavelength_um.empty() || h.wavelength_um.size() == h.bands);
    EXPECT_TRUE(h.band_names.empty() || h.band_names.size() == h.bands);
  };
  test::fuzz(test::bytes_of(valid), read, 1, test::kMutations, words);
  EXPECT_GT(100 * accepted, test::mutations(test::kMutations));  // the loop gets past the first check
}

// An image and its header together: values or one Error.
TEST(Fuzz, EnviImage) {
  const TempFolder folder;
  EnviHeader header;
  header.samples = 7, header.lines = 5, header.bands = 3, header.type = EnviType::float32;
  std::vector<double> values(105);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  write_envi(folder / "a.img", header, values);
  test::fuzz(read_bytes(folder / "a.img.hdr"),
             [&](std::span<const std::byte> b) {
               test::put_file(folder / "a.img.hdr", b);
               const EnviImage image(folder / "a.img");
               EXPECT_EQ(image.read_all().size(), image.header().values());
             },
             2, test::kMutations,
             {"=", "{", "}", "-1", "999999999", "bsq", "bip", "data type = 5", "header offset = 8"});
}

}  // namespace suite::format_envi_envi_test
