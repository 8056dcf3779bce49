// ENVI images: what is written is read back, other programs agree, and every fault is told with its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "base/files.h"
#include "formats/envi/envi.h"
#include "support/message_of.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

namespace suite::format_envi_image_test {
using testing::HasSubstr;

namespace {

const char* const kHeader =
    "ENVI\n; a comment\nsamples = 3\nLines   = 2\nbands = 2\ndata type = 12\ninterleave = bip\nbyte order = 1\n"
    "wavelength units = Nanometers\nwavelength = {\n 450.5,\n 560 }\nfwhm = {20, 30}\nband names = {blue, green}\n"
    "data units = DN\nreflectance scale factor = 10000\nmap info = {UTM, 1, 1, 500000, 5400000, 2, 2, 32, North, "
    "WGS-84}\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

EnviHeader cube(size_t samples, size_t lines, size_t bands, EnviType type, Interleave interleave) {
  EnviHeader h;
  h.samples = samples, h.lines = lines, h.bands = bands, h.type = type, h.interleave = interleave;
  return h;
}

}  // namespace

TEST(EnviHeader, ReadsEveryKeyWithUnits) {
  const EnviHeader h = parse_envi_header(kHeader, "a.hdr");
  EXPECT_EQ(h.samples, 3u);
  EXPECT_EQ(h.lines, 2u);
  EXPECT_EQ(h.bands, 2u);
  EXPECT_EQ(h.type, EnviType::uint16);
  EXPECT_EQ(h.interleave, Interleave::bip);
  EXPECT_TRUE(h.big_endian);
  ASSERT_EQ(h.wavelength_um.size(), 2u);
  EXPECT_NEAR(h.wavelength_um[0], 0.4505, 1e-15);
  EXPECT_NEAR(h.fwhm_um[1], 0.030, 1e-15);
  EXPECT_EQ(h.band_names[1], "green");
  EXPECT_EQ(h.data_units, "DN");
  EXPECT_EQ(h.map_info.size(), 10u);
  ASSERT_EQ(h.extra.size(), 1u);
  EXPECT_EQ(h.extra[0].first, "reflectance scale factor");
}

// A stored 10000 is a reflectance of 1; gains multiply, one a band; a band whose `bbl` is 0 is bad.
TEST(EnviNumbers, SayWhatStoredNumbersStandFor) {
  const EnviNumbers scaled = numbers_of(parse_envi_header(kHeader, "a.hdr"), "a.hdr");
  ASSERT_EQ(scaled.gain.size(), 2u);
  for (const double gain : scaled.gain) EXPECT_DOUBLE_EQ(gain, 1e-4);
  EXPECT_TRUE(scaled.offset.empty());
  const std::string text = replaced(kHeader, "reflectance scale factor = 10000",
                                    "data gain values = {2, 3}\ndata offset values = {0, -1}\nbbl = {1, 0}");
  const EnviNumbers given = numbers_of(parse_envi_header(text, "a.hdr"), "a.hdr");
  EXPECT_EQ(given.gain, (std::vector<double>{2, 3}));
  EXPECT_EQ(given.offset, (std::vector<double>{0, -1}));
  EXPECT_EQ(given.bad, (std::vector<bool>{false, true}));
}

TEST(EnviHeader, FaultsAreLocatedAndExplained) {
  const struct {
    const char *from, *to, *expected;
  } cases[] = {
      {"ENVI\n", "ENVY\n", "a.hdr:1:1: error: is not an ENVI header"},
      {"samples = 3", "sample = 3", "the key 'samples' is missing; is 'sample' meant to be it?"},
      {"samples = 3", "samples = 0",
       "a.hdr:3:1: error: 'samples': '0' is not a valid value; give a whole number from 1 to 2147483647"},
      {"samples = 3", "samples = 3.5", "a.hdr:3:1: error: 'samples': '3.5' is not a valid value"},
      {"samples = 3", "samples = 99999999999999999999", "a.hdr:3:1"},
      {"samples = 3", "samples 3", "a.hdr:3:1: error: expected 'key = value'"},
      {"data type = 12", "data type = 6", "a.hdr:6:1: error: data type 6 is not supported; known: 1 uint8"},
      {"interleave = bip", "interleave = bpi", "a.hdr:7:1: error: unknown interleave 'bpi'; did you mean"},
      {"byte order = 1", "byte order = 2", "a.hdr:8:1"},
      {"wavelength units = Nanometers\n", "", "'wavelength' is given without 'wavelength units'"},
      {"Nanometers", "Furlongs", "a.hdr:9:1: error: unknown wavelength unit 'Furlongs'"},
      {" 560 }", " 560, 600 }", "a.hdr:10:1: error: 'wavelength' has 3 values for 2 bands"},
      {" 560 }", " x60 }", "'wavelength': 'x60' is not a number"},
      {" 560 }", " -5 }", "'wavelength': -5 is not positive"},
      {" 560 }", " 560 } trailing", "text after the closing brace"},
      {"WGS-84}", "WGS-84", "a.hdr:17:1: error: the brace opened here is never closed"},
      {"data units = DN", "classes = 2\nclass names = {a, b, c}",
       "a.hdr:16:1: error: 'class names' has 3 names for 2 classes"},
      {"data units = DN", "class names = {a, b}\nclass lookup = {1, 2, 3}",
       "a.hdr:16:1: error: 'class lookup' has 3 numbers for 2 classes; red, green and blue of each class"},
      {"data units = DN", "class names = {a}\nclass lookup = {1, 2, 256}",
       "'class lookup': '256' is not a valid value; give a whole number from 0 to 255"},
      {"data units = DN", "sun azimuth = north", "'sun azimuth': 'north' is not a number"},
      {"band names = {blue, green}", "bands = 2", "a.hdr:14:1: error: duplicate key 'bands'; first given in line 5"},
  };
  for (const auto& c : cases)
    EXPECT_THAT(message_of([&] { parse_envi_header(replaced(kHeader, c.from, c.to), "a.hdr"); }),
                HasSubstr(c.expected));
}

TEST(EnviHeader, SizesBeyondAnyFileAreRefusedBeforeAllocating) {
  std::string text = replaced(kHeader, "samples = 3", "samples = 2147483647");
  text = replaced(text, "Lines   = 2", "lines = 2147483647");
  EXPECT_THAT(message_of([&] { parse_envi_header(text, "a.hdr"); }), HasSubstr("more than any file holds"));
}

TEST(Envi, EveryTypeAndInterleaveReadsBackWhatWasWritten) {
  const TempFolder folder;
  for (const EnviType type : {EnviType::uint8, EnviType::int16, EnviType::int32, EnviType::float32, EnviType::float64,
                              EnviType::uint16, EnviType::uint32, EnviType::int64, EnviType::uint64})
    for (const Interleave interleave : {Interleave::bsq, Interleave::bil, Interleave::bip}) {
      const EnviHeader h = cube(5, 7, 3, type, interleave);
      std::vector<double> values(h.values());
      for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
      // In two unequal pieces, as a streaming renderer writes.
      EnviWriter writer(folder / "x.img", h);
      writer.append(std::span(values).first(2 * 15));
      writer.append(std::span(values).subspan(2 * 15));
      writer.commit();
      const EnviImage image(folder / "x.img");
      EXPECT_EQ(image.read_all(), values);
      EXPECT_EQ(image.read_lines(3, 2), std::vector<double>(values.begin() + 45, values.begin() + 75));
      EXPECT_EQ(EnviImage(folder / "x.img.hdr").read_all(), values);
    }
}

TEST(Envi, BigEndianAndOffsetAreUnderstood) {
  const TempFolder folder;
  write_file(folder / "b.hdr", std::string(kHeader) + "header offset = 2\n");
  std::string bytes = "xx";
  for (int i = 0; i < 12; ++i) bytes += {static_cast<char>(1), static_cast<char>(i)};
  write_file(folder / "b.img", bytes);
  const std::vector<double> values = EnviImage(folder / "b.img").read_all();
  for (int i = 0; i < 12; ++i) EXPECT_EQ(values[i], 256 + i);
}

TEST(Envi, MetadataSurvivesTheRoundTrip) {
  const TempFolder folder;
  EnviHeader h = cube(1, 1, 2, EnviType::float64, Interleave::bsq);
  h.description = "radiance {of} a frame";
  h.band_names = {"blue, deep", "green"};
  h.wavelength_um = {0.475, 0.123456789};
  h.fwhm_um = {0.02, 0.03};
  h.data_units = "W/(m2 sr um)";
  h.map_info = {"UTM", "1", "1", "500000", "5400000", "2", "2", "32", "North", "WGS-84"};
  h.coordinate_system = "PROJCS[\"x\",UNIT[\"m\",1]]";
  h.ignore_value = -1e300;
  h.default_bands = {2};
  h.extra = {{"sensor type", "camera"}};
  h.acquisition_time = "2026-06-21T10:30:00.000000Z";
  h.sun_azimuth_deg = 149.5, h.sun_elevation_deg = -0.25;
  h.classes = {{"nothing", {0, 0, 0}}, {"grass", {10, 200, 30}}};
  write_envi(folder / "m.img", h, std::vector<double>{std::numeric_limits<double>::quiet_NaN(), 2});
  const EnviImage image(folder / "m.img");
  const EnviHeader& r = image.header();
  EXPECT_THAT(r.description, HasSubstr("radiance (of) a frame\nsuite "));
  EXPECT_EQ(r.band_names, (std::vector<std::string>{"blue; deep", "green"}));
  EXPECT_EQ(r.wavelength_um, h.wavelength_um);
  EXPECT_EQ(r.fwhm_um, h.fwhm_um);
  EXPECT_EQ(r.map_info, h.map_info);
  EXPECT_EQ(r.coordinate_system, h.coordinate_system);
  EXPECT_EQ(r.ignore_value, h.ignore_value);
  EXPECT_EQ(r.default_bands, h.default_bands);
  EXPECT_EQ(r.extra, h.extra);
  EXPECT_EQ(r.acquisition_time, h.acquisition_time);
  EXPECT_EQ(r.sun_azimuth_deg, h.sun_azimuth_deg);
  EXPECT_EQ(r.sun_elevation_deg, h.sun_elevation_deg);
  EXPECT_EQ(r.classes, h.classes);
  EXPECT_TRUE(std::isnan(image.read_all()[0]));
  image.require_units("W/(m2 sr um)");
  EXPECT_THAT(message_of([&] { image.require_units("K"); }),
              HasSubstr("data units are 'W/(m2 sr um)'; expected 'data units = K'"));
}

TEST(Envi, WholeOrNotAtAll) {
  const TempFolder folder;
  const EnviHeader h = cube(2, 2, 1, EnviType::float32, Interleave::bsq);
  {
    EnviWriter writer(folder / "w.img", h);
    writer.append(std::vector<double>{1, 2});
  }
  EXPECT_EQ(folder.entries(), 0u);
  {
    EnviWriter writer(folder / "w.img", h);
    writer.append(std::vector<double>{1, 2});
    EXPECT_THROW(writer.commit(), Bug);  // a line is missing
  }
  EXPECT_EQ(folder.entries(), 0u);
  write_envi(folder / "w.img", h, std::vector<double>{1, 2, 3, 4});
  EXPECT_EQ(folder.entries(), 2u);
}

TEST(Envi, ImpossibleRequestsAreToldBeforeAnythingIsWritten) {
  const TempFolder folder;
  EnviHeader h = cube(2, 1, 1, EnviType::uint8, Interleave::bsq);
  for (const double bad : {256.0, -1.0, 0.5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT(message_of([&] {
                  write_envi(folder / "i.img", h, std::vector<double>{1, bad});
                }),
                HasSubstr("does not fit the integer type"));
  h.wavelength_um = {0.5, 0.6};
  EXPECT_THAT(message_of([&] {
                write_envi(folder / "i.img", h, std::vector<double>{1, 2});
              }),
              HasSubstr("2 wavelengths for 1 bands"));
  EXPECT_THAT(message_of([&] {
                write_envi(folder / "no/such/i.img", cube(1, 1, 1, EnviType::uint8, Interleave::bsq),
                           std::vector<double>{1});
              }),
              HasSubstr("cannot be written"));
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(Envi, AWrongSizeIsRefused) {
  const TempFolder folder;
  const EnviHeader h = cube(2, 2, 2, EnviType::float32, Interleave::bil);
  write_envi(folder / "s.img", h, std::vector<double>(8, 1.0));
  for (const size_t size : {0, 31, 33}) {
    write_file(folder / "s.img", std::string(size, 'x'));
    EXPECT_THAT(message_of([&] { EnviImage(folder / "s.img"); }),
                HasSubstr(strf("has %zu bytes, its header describes 32", size)));
  }
  EXPECT_THAT(message_of([&] { EnviImage(folder / "none.img"); }), HasSubstr("no such file"));
  EXPECT_THAT(message_of([&] { EnviImage(folder.path()); }), HasSubstr("is a directory"));
  write_file(folder / "alone.img", std::string("x"));
  EXPECT_THAT(message_of([&] { EnviImage(folder / "alone.img"); }), HasSubstr("has no ENVI header beside it"));
}

TEST(Envi, GdalSeesTheSameBandsWavelengthsAndSizes) {
  if (std::system("command -v gdalinfo >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  const TempFolder folder;
  EnviHeader h = cube(6, 4, 2, EnviType::float32, Interleave::bip);
  h.band_names = {"blue", "green"};
  h.wavelength_um = {0.475, 0.56};
  h.fwhm_um = {0.02, 0.03};
  h.data_units = "W/(m2 sr um)";
  h.map_info = {"UTM", "1", "1", "500000", "5400000", "2", "2", "32", "North", "WGS-84"};
  std::vector<double> values(h.values(), 0.25);
  values[1] = 7;
  write_envi(folder / "g.img", h, values);
  std::string out;
  FILE* pipe = ::popen(("gdalinfo -mm " + folder.path() + "/g.img 2>&1").c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  char buffer[4096];
  while (const size_t n = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, n);
  EXPECT_EQ(::pclose(pipe), 0);
  EXPECT_THAT(out, HasSubstr("Driver: ENVI"));
  EXPECT_THAT(out, HasSubstr("Size is 6, 4"));
  EXPECT_THAT(out, HasSubstr("INTERLEAVE=PIXEL"));
  EXPECT_THAT(out, HasSubstr("Band 2 Block=6x1 Type=Float32"));
  EXPECT_THAT(out, HasSubstr("wavelength=0.475"));
  EXPECT_THAT(out, HasSubstr("wavelength=0.56"));
  EXPECT_THAT(out, HasSubstr("wavelength_units=Micrometers"));
  EXPECT_THAT(out, HasSubstr("Origin = (500000.000000000000000,5400000.000000000000000)"));
  EXPECT_THAT(out, HasSubstr("Computed Min/Max=0.250,7.000"));
}

// What only the end of a rendering knows may be told then.
TEST(Envi, AHeaderIsCompletedUntilItIsWritten) {
  const TempFolder folder;
  EnviWriter writer(folder / "c.img", cube(1, 1, 1, EnviType::float32, Interleave::bsq));
  writer.append(std::vector<double>{1});
  writer.header().acquisition_time = "2026-06-21T10:30:00Z";
  writer.header().default_bands = {2};
  EXPECT_THAT(message_of([&] { writer.commit(); }), HasSubstr("default band 2 of 1 bands"));
  writer.header().default_bands = {1};
  writer.commit();
  EXPECT_EQ(read_envi_header(folder / "c.img").acquisition_time, "2026-06-21T10:30:00Z");
}

TEST(Envi, GdalSeesClassesAndColours) {
  if (std::system("command -v gdalinfo >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "gdalinfo (Debian package gdal-bin) is not installed";
  const TempFolder folder;
  EnviHeader h = cube(2, 1, 1, EnviType::uint8, Interleave::bsq);
  h.classes = {{"nothing", {0, 0, 0}}, {"grass, wet", {10, 200, 30}}};
  h.ignore_value = 0;
  write_envi(folder / "k.img", h, std::vector<double>{0, 1});
  const std::string out = run_command("gdalinfo '" + (folder / "k.img") + "'").out;
  EXPECT_THAT(out,
              HasSubstr("ColorInterp=Palette\n  NoData Value=0\n  Categories:\n      0: nothing\n      1: grass; wet"));
  EXPECT_THAT(out, HasSubstr("1: 10,200,30,255"));
}

}  // namespace suite::format_envi_image_test
