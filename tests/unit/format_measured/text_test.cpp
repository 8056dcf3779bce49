// Raw sample text, Cornell, CSV, and telling all measured formats apart.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "formats/brdf_csv/brdf_csv.h"
#include "formats/cornell/cornell.h"
#include "formats/measured/measured.h"
#include "formats/samples/samples.h"
#include "support/tensor_file.h"

namespace suite::format_measured_text_test {
namespace {

template <class Parse>
std::string message(Parse parse, std::string_view text) {
  try {
    parse(text, "f.txt");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}
void expect_error(const std::string& got, const std::string& wanted) {
  EXPECT_NE(got.find(wanted), std::string::npos) << "got: " << got;
}

TEST(RawSamples, ReadsViewsDirectionsAndChannels) {
  const auto s =
      parse_samples("RAWBH10A white chalk\n2 0.45 0.65\n2 0 0.5\n0 0 0 1 0.29 0.3\n1 0.6 0.0 0.8 nan 0.2\n", "f.txt");
  EXPECT_EQ(s.info.name, "white chalk");
  EXPECT_EQ(s.info.wavelength_um, (std::vector<double>{0.45, 0.65}));
  ASSERT_EQ(s.in.size(), 2u);
  EXPECT_NEAR(s.out[1].x, std::sin(0.5), 1e-12);
  EXPECT_EQ(s.in[1], (Dir{0.6, 0, 0.8}));
  EXPECT_TRUE(std::isnan(s.value[2]));
  EXPECT_EQ(s.value[3], 0.2);
  EXPECT_EQ(s.info.domain, sqt::Domain::hemisphere);
  EXPECT_TRUE(s.info.isotropic && s.info.bilateral);
}

TEST(RawSamples, SphereAndSymmetry) {
  const std::string head = "RAWBS10A glass\n1 0.5\n1 0.3\n";
  EXPECT_EQ(parse_samples(head + "0 0 0 -1 1\n", "f").info.domain, sqt::Domain::sphere);
  EXPECT_TRUE(parse_samples(head + "0 0.6 0.64 0.48 1\n0 0.6 -0.64 0.48 1\n", "f").info.bilateral);
  EXPECT_FALSE(parse_samples(head + "0 0.6 0.64 0.48 1\n0 0.6 -0.64 0.48 2\n", "f").info.bilateral);
  EXPECT_FALSE(parse_samples(head + "0 0.6 0.64 0.48 1\n0 0.64 -0.6 0.48 1\n", "f").info.bilateral);
}

TEST(RawSamples, RefusesWithPlace) {
  const auto parse = [](std::string_view t, const std::string& f) { return parse_samples(t, f); };
  expect_error(message(parse, "RAWBX10A a\n"), "f.txt:1: error: is not raw sample text");
  expect_error(message(parse, "RAWBH10A a\n2 0.5\n"), "f.txt:2:1: error: the line says 2 wavelengths and has 1");
  expect_error(message(parse, "RAWBH10A a\n1 0.5\n2 0.5 0.4\n"), "f.txt:3:7: error: zeniths are not ascending");
  expect_error(message(parse, "RAWBH10A a\n1 0.5\n1 0\n1 0 0 1 1\n"),
               "f.txt:4:1: error: the view index = 1 is out of range");
  expect_error(message(parse, "RAWBH10A a\n1 0.5\n1 0\n0 0 0 2 1\n"), "the direction has length 2");
  expect_error(message(parse, "RAWBH10A a\n1 0.5\n1 0\n0 0 0 -1 1\n"), "below the surface");
  expect_error(message(parse, "RAWBH10A a\n1 0.5\n1 0\n0 0 0 1 x\n"), "f.txt:4:9: error: 'x' is not a number");
  expect_error(message(parse, "RAWBH10A a\n1 0.5\n1 0\n"), "holds no samples");
  expect_error(message(parse, "RAWBH10A a\n99999999999 0.5\n"), "out of range");
}

TEST(Cornell, ReadsHeadAndRows) {
  const auto s = parse_cornell("# note\n3\n400 500\n600\n0.5 0 0.3 0.7 1 2 3\n0.5 0 0.3 1.5 4 5 6\n", "paint.brdf");
  EXPECT_EQ(s.info.name, "paint");
  ASSERT_EQ(s.info.wavelength_um.size(), 3u);
  EXPECT_NEAR(s.info.wavelength_um[2], 0.6, 1e-12);
  EXPECT_NEAR(s.in[0].x, std::sin(0.5), 1e-12);  // the light comes first
  EXPECT_NEAR(s.out[0].y, std::sin(0.3) * std::sin(0.7), 1e-12);
  EXPECT_EQ(s.value[4], 5);
  EXPECT_TRUE(s.info.isotropic && s.info.bilateral);
  EXPECT_FALSE(parse_cornell("1\n500\n0.5 0 0.3 0.7 1\n0.5 1 0.3 0.7 1\n", "p").info.isotropic);
}

TEST(Cornell, RefusesWithPlace) {
  const auto parse = [](std::string_view t, const std::string& f) { return parse_cornell(t, f); };
  expect_error(message(parse, ""), "is empty");
  expect_error(message(parse, "2\n400\n"), "ends after 1 of 2 wavelengths");
  expect_error(message(parse, "2\n400 500 600\n"), "more than the 2 wavelengths");
  expect_error(message(parse, "1\n400\n0.5 0 0.3 0 1 2\n"), "f.txt:3:1: error: the line has 6 numbers, 5 are wanted");
  expect_error(message(parse, "1\n400\n1.6 0 0.3 0 1\n"), "a polar angle in rad = 1.6 is out of range");
}

// As large as the measurements that are made: 1439 pairs of directions, 31 wavelengths, values from a formula.
TEST(Cornell, AWholeMeasurement) {
  std::string text = "# a paint\n\n# num wls\n31\n";
  for (int k = 0; k < 31; ++k) text += strf("%d ", 400 + 10 * k);
  text += "\n";
  const auto value = [](int n, int k) { return 0.01 * (1 + n % 97) + 0.001 * k; };
  for (int n = 0; n < 1439; ++n) {
    text += strf("%.6f %.6f %.6f %.6f", 0.001 * n, 0.0, 1.5 - 0.001 * n, 0.002 * n);
    for (int k = 0; k < 31; ++k) text += strf(" %.6f", value(n, k));
    text += "\n";
  }
  const auto s = parse_cornell(text, "paint.brdf");
  ASSERT_EQ(s.in.size(), 1439u);
  ASSERT_EQ(s.value.size(), 1439u * 31u);
  EXPECT_NEAR(s.info.wavelength_um.at(30), 0.7, 1e-12);
  EXPECT_TRUE(s.info.isotropic);
  for (int n = 0; n < 1439; n += 7)
    for (int k = 0; k < 31; k += 5)
      ASSERT_NEAR(s.value[static_cast<size_t>(31 * n + k)], value(n, k), 1e-6) << n << ' ' << k;
  EXPECT_NEAR(s.in[700].z, std::cos(0.7), 1e-6);
  EXPECT_NEAR(s.out[700].z, std::cos(0.8), 1e-6);
}

TEST(BrdfCsv, ColumnsInAnyOrderAndDegrees) {
  const auto s = parse_brdf_csv(
      "# name: "
      "chalk\nvalue,wavelength_um,theta_o_deg,phi_o_deg,theta_i_deg,phi_i_deg\n0.3,0.55,30,0,60,180\r\n0.2,0.45,30,0,"
      "60,180\n",
      "f.csv");
  EXPECT_EQ(s.info.name, "chalk");
  EXPECT_EQ(s.info.wavelength_um, (std::vector<double>{0.45, 0.55}));
  ASSERT_EQ(s.in.size(), 1u);
  EXPECT_NEAR(s.out[0].x, 0.5, 1e-12);
  EXPECT_NEAR(s.in[0].z, 0.5, 1e-12);
  EXPECT_EQ(s.value, (std::vector<double>{0.2, 0.3}));
}

TEST(BrdfCsv, WithoutHeaderInRadians) {
  const auto s = parse_brdf_csv("0.1,0,2.5,0.3,0.5,0.1\n0.1,0,0.5,0.3,0.5,inf\n", "f.csv");
  EXPECT_EQ(s.info.domain, sqt::Domain::sphere);  // 2.5 rad is on the other side
  EXPECT_EQ(s.info.quantity, sqt::Quantity::bsdf);
  EXPECT_EQ(std::count_if(s.value.begin(), s.value.end(), [](double v) { return std::isnan(v); }), 1);
  const auto lamp = parse_brdf_csv("# quantity: intensity\n0,0,0.5,0.3,0.5,0.1\n", "f.csv");
  EXPECT_EQ(lamp.info.quantity, sqt::Quantity::intensity);
  EXPECT_EQ(lamp.info.domain, sqt::Domain::sphere);
}

TEST(BrdfCsv, RefusesWithPlace) {
  const auto parse = [](std::string_view t, const std::string& f) { return parse_brdf_csv(t, f); };
  expect_error(message(parse, "theta_o,phi_o,theta_j,phi_i,wavelength_um,value\n"),
               "f.txt:1:15: error: unknown column 'theta_j'; did you mean 'theta_");
  expect_error(message(parse, "theta_o,phi_o,theta_i,phi_i,wavelength_um\n"), "column 'value' is missing");
  expect_error(message(parse, "theta_o,theta_o_deg,phi_o,theta_i,phi_i,wavelength_um\n"), "given twice");
  expect_error(message(parse, "30,0,0.1,0,0.5,1\n"), "f.txt:1:1: error: the angle is 30 rad; angles are rad unless");
  expect_error(message(parse, "1.6,0,0.1,0,0.5,1\n"), "on or below the horizon");
  expect_error(message(parse, "0,0,0.1,0,0.5\n"), "the line has 5 values, 6 are wanted");
  expect_error(message(parse, "# quantity: bdsf\n0,0,0.1,0,0.5,1\n"), "did you mean 'bsdf'?");
  expect_error(message(parse, ""), "holds no samples");
  std::string sparse;
  for (int i = 0; i < 3000; ++i)
    sparse += "0,0," + std::to_string(i * 1e-4) + ",0," + std::to_string(0.4 + i * 1e-3) + ",1\n";
  expect_error(message(parse, sparse), "the table is mostly empty");
}

TEST(Measured, TellsFormatsApart) {
  const std::string folder = testing::TempDir() + "/measured";
  make_folder(folder);
  auto kind = [&](const std::string& name, std::string_view text) -> std::string {
    write_file(folder + "/" + name, text);
    try {
      const Measured m = read_measured(folder + "/" + name);
      return m.index() == 0 ? std::get<0>(m)->info().source : std::get<1>(m).info.source;
    } catch (const Error& e) {
      return e.what();
    }
  };
  const auto rgl = test::small_rgl({0.0f}, 0).build();
  EXPECT_TRUE(kind("any.dat", {reinterpret_cast<const char*>(rgl.data()), rgl.size()}).starts_with("RGL"));
  EXPECT_TRUE(kind("any2.dat", "RAWBH10A a\n1 0.5\n1 0\n0 0 0 1 1\n").starts_with("raw sample text"));
  EXPECT_TRUE(kind("a.brdf", "1\n500\n0 0 0 0 1\n").starts_with("Cornell"));
  EXPECT_TRUE(kind("a.csv", "0,0,0,0,0.5,1\n").starts_with("CSV"));
  expect_error(kind("a.binary", "short"), "ends within the three dimensions");
  expect_error(kind("a.bsdf", "short"), "is not a tensor file");
  expect_error(kind("a.txt", "hello"), "is no measured scattering file that we know");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace suite::format_measured_text_test
