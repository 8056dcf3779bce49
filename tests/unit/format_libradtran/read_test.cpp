// Outputs of uvspec read by their inputs: layouts, units, angles, and what is wrong with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "formats/libradtran/libradtran.h"
#include "math/vec.h"
#include "tests/support/message_of.h"

namespace suite::format_libradtran_read_test {
namespace {

using testing::HasSubstr;

LibradtranRun parse(const std::string& input, const std::string& output) {
  return parse_libradtran(input, "r.inp", output, "r.out");
}
std::string told(const std::string& input, const std::string& output) {
  return message_of([&] { parse(input, output); });
}

TEST(Libradtran, UserColumnsAndLevels) {
  const LibradtranRun run = parse(
      "# a run\nsource solar atlas_plus_modtran\nsza 60\nzout 0 5 TOA # km\noutput_user zout lambda edir eglo\nquiet\n",
      "0 400.0 500 700\n5 400.0 600 720\n120 400.0 800 800\n0 401.0 510 701\n5 401.0 610 721\n120 401.0 810 810\n");
  ASSERT_EQ(run.levels, 3u);
  EXPECT_NEAR(run.wavelength_um[1], 0.401, 1e-15);
  const LibradtranColumn& direct = run.column("edir");
  EXPECT_EQ(direct.unit, "W/(m2 um)");  // mW/(m2 nm) is the same
  EXPECT_NEAR(direct.values[0], 500, 1e-9);
  EXPECT_NEAR(direct.values[1], 510, 1e-9);
  EXPECT_NEAR(direct.values[2 * 2 + 1], 810, 1e-9);
  EXPECT_EQ(run.column("zout").values[2], 5);
  EXPECT_NEAR(*run.solar_zenith, kPi / 3, 1e-15);
  EXPECT_THAT(message_of([&] { run.column("edn"); }), HasSubstr("no column 'edn'"));
}

TEST(Libradtran, UnitsOfSourceAndProcess) {
  const std::string output = "1000.0 2.0\n1250.0 3.0\n";
  const auto first = [&](const std::string& options, LibradtranPower power = LibradtranPower::milliwatt) {
    return parse_libradtran(options + "output_user wavenumber edn\n", "i", output, "o", power).column("edn");
  };
  // Rows ascend in wavenumber, so the last one, 8 um, comes first: 156.25 wavenumbers in a micron.
  EXPECT_NEAR(first("source thermal\n").values[0], 3 * 156.25, 1e-9);
  EXPECT_NEAR(first("source thermal\n").values[1], 2 * 100, 1e-9);
  EXPECT_NEAR(first("source thermal\noutput_process per_nm\n").values[0], 3000, 1e-9);
  EXPECT_NEAR(first("source solar f.dat per_nm\n").values[0], 3, 1e-12);
  EXPECT_NEAR(first("source solar f.dat per_nm\n", LibradtranPower::watt).values[0], 3000, 1e-9);
  EXPECT_NEAR(first("source solar f.dat per_cm-1\n").values[0], 3 * 0.15625, 1e-12);
  EXPECT_EQ(first("source thermal\noutput_quantity brightness\n").unit, "K");
  EXPECT_EQ(first("source thermal\noutput_quantity brightness\n").values[0], 3);
  EXPECT_EQ(first("output_quantity transmittance\n").unit, "1");
}

// The layout without output_user, as printed by uvspec in libRadtran's examples/UVSPEC_BRDF_HAPKE.OUT (numbers of its
// last lines).
TEST(Libradtran, DefaultLayoutWithRadiances) {
  const LibradtranRun run =
      parse("rte_solver disort\nsza 30\nphi0 0\numu 0.1 0.2\nphi 0 90 180\n",
            "  400.000  8.660254e-01   2.392274e-09  1.809978e-01  7.957747e-02  2.564050e-10  2.973384e-02 \n"
            "                                  0.000            90.000           180.000 \n"
            " 0.1000  6.442097574e-02   5.192517117e-02   6.404609978e-02   7.774765790e-02 \n"
            " 0.2000  6.309980154e-02   5.171730742e-02   6.267738342e-02   7.544256747e-02 \n");
  EXPECT_NEAR(run.column("eup").values[0], 0.1809978, 1e-12);
  PathSpectra path;
  const PathTable table = libradtran_sky(run, 0, false);
  table.at(std::array{std::acos(-0.2), kPi / 2}, path);
  EXPECT_NEAR(path.radiance[0], 6.267738342e-02, 1e-12);
  EXPECT_NEAR(path.irradiance[0], 1, 1e-6);  // 0.866 over cos 30
  EXPECT_THAT(message_of([&] { libradtran_sky(run, 0, true); }), HasSubstr("no radiances that look up"));
  EXPECT_THAT(message_of([&] { libradtran_sky(run, 1, false); }), HasSubstr("1 altitudes"));
}

TEST(Libradtran, SkyOfUserColumns) {
  // uu: the values of phi run fastest.
  const LibradtranRun run = parse("umu -1 -0.5\nphi 10 100 190\nphi0 10\noutput_user lambda uu\n",
                                  "500 1 2 3 4 5 6\n600 10 20 30 40 50 60\n");
  const PathTable sky = libradtran_sky(run, 0, true);
  PathSpectra path;
  sky.at(std::array{60 * kDegree, kPi / 2}, path);
  EXPECT_NEAR(path.radiance[0], 5, 1e-12);
  EXPECT_NEAR(path.radiance[1], 50, 1e-12);
  sky.at(std::array{30 * kDegree, kPi}, path);
  EXPECT_NEAR(path.radiance[0], 4.5, 1e-9);
  EXPECT_TRUE(path.irradiance.empty());
  EXPECT_THAT(message_of([&] { sky.at(std::array{70 * kDegree, 0.0}, path); }), HasSubstr("covers 0 to 60 degrees"));
  const LibradtranRun brightness =
      parse("umu -1\nphi 0\nsource thermal\noutput_quantity brightness\noutput_user lambda uu\n", "9000 280\n");
  EXPECT_THAT(message_of([&] { libradtran_sky(brightness, 0, true); }), HasSubstr("radiances are in 'K'"));
}

TEST(Libradtran, Faults) {
  EXPECT_THAT(told("output_user edir\n", "1\n"), HasSubstr("asks for no wavelength"));
  EXPECT_THAT(told("a 1\noutput_process integrate\n", ""),
              HasSubstr("r.inp:2:16: error: 'output_process integrate' makes no"));
  EXPECT_THAT(told("source solar x per_band\n", ""), HasSubstr("'output_process per_band' makes no spectrum"));
  EXPECT_THAT(told("mol_abs_param kato2\n", ""), HasSubstr("sums over bands"));
  EXPECT_THAT(told("output_format netCDF\n", ""), HasSubstr("format 'netCDF' is not read"));
  EXPECT_THAT(told("include other.inp\n", ""), HasSubstr("r.inp:1:9: error: the input includes another file"));
  EXPECT_THAT(told("rte_solver polradtran\n", ""), HasSubstr("polradtran is not read"));
  EXPECT_THAT(told("umu 2\n", ""), HasSubstr("r.inp:1:5"));
  EXPECT_THAT(told("umu\n", ""), HasSubstr("without its value"));
  EXPECT_THAT(told("output_user lambda edir\n", "400 1\n401 1 2\n"),
              HasSubstr("r.out:2:7: error: 3 numbers, the input asks for 2"));
  EXPECT_THAT(told("output_user lambda edir\n", "400 x\n"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(told("output_user lambda edir\n", "400 1\n402 1\n401 1\n"),
              HasSubstr("r.out:3:1: error: wavelengths are not in order"));
  EXPECT_THAT(told("zout 0 1\noutput_user lambda edir\n", "400 1\n401 1\n"),
              HasSubstr("1 rows of a wavelength for 2 altitudes"));
  EXPECT_THAT(told("zout 0 1\noutput_user lambda edir\n", "400 1\n400 2\n401 1\n"),
              HasSubstr("cut within a wavelength"));
  EXPECT_THAT(told("umu 0.1\nphi 0\n", "400 1 1 1 1 1 1\n 0\n"), HasSubstr("cut within a wavelength"));
  EXPECT_THAT(told("umu 0.1\nphi 0\n", "400 1 1 1 1 1 1\n 10\n"),
              HasSubstr("r.out:2:2: error: phi is 10, that of the input 0"));
  EXPECT_THAT(told("output_user lambda edir\n", ""), HasSubstr("no spectrum"));
}

}  // namespace
}  // namespace suite::format_libradtran_read_test
