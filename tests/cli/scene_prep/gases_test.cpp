// Tables of gases from a user's line lists: baked by scene-prep, used by dirsig-render.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "air/air_spec.h"
#include "base/files.h"
#include "formats/air_table/air_table.h"
#include "formats/envi/envi.h"
#include "formats/gas_recipe/gas_recipe.h"
#include "formats/hitran/hitran.h"
#include "support/run_command.h"

namespace suite::gases_test {
namespace {

using testing::HasSubstr;

// A line in HITRAN's columns.
std::string line(int molecule, double wavenumber, double intensity, double width, double energy) {
  std::string text = strf("%2d1%12.6f%10.3E%10.3E%.4f%5.3f%10.4f%4.2f%8.5f\n", molecule, wavenumber, intensity, 1.0,
                          width, 1.2 * width, energy, 0.7, -0.002);
  text.erase(35, 1);  // ".0700", as HITRAN has it
  return text;
}

class BakeGases : public testing::Test {
 protected:
  // Forty made-up lines of carbon dioxide and thirty of ozone, weak and strong ones, around 10.3 um.
  BakeGases() {
    std::string co2, o3;
    for (int i = 0; i < 40; ++i)
      co2 += line(2, 945 + 1.37 * i, 2e-23 * std::pow(10, 0.5 * (i % 5)), 0.07, 300 + 20.0 * i);
    for (int i = 0; i < 30; ++i) o3 += line(3, 941.3 + 1.91 * i, 4e-21 * (1 + i % 7), 0.08, 15.0 * i);
    write_file(folder_ / "co2.par", co2);
    write_file(folder_ / "o3.par", o3);
    write_file(folder_ / "recipe.yaml",
               "gas_table: 1\nsource: made-up lines\nrange_cm: [950, 1000]\nwidth_cm: 5\nstep_cm: 0.002\n"
               "pressures_pa: [100, 300, 1000, 3000, 1e4, 3e4, 6e4, 1.1e5]\ntemperatures_k: [200, 250, 300]\n"
               "gases: {co2: {lines: co2.par}, o3: {lines: o3.par}}\n");
    write_file(
        folder_ / "scene.yaml",
        "scene: 1\nwindows_um: [[8, 14]]\nmaterials: {black: {model: lambert, reflectance: 0, temperature_k: 300}}\n"
        "objects: {ground: {plane: {width: 1000, depth: 1000}, material: black}}\nworld: [{place: ground}]\n");
    write_file(
        folder_ / "sim.yaml",
        "scene: scene.h5\natmosphere: {profile: us_standard, gases: gases.h5, g_points: 16, rayleigh: false, "
        "scattering: single}\nsensors:\n  - {kind: frame_camera, name: a, columns: 2, rows: 2, pitch_um: 10, "
        "focal_length_mm: 100, position_m: [0, 0, 100000], look_at_m: [0, 0, 0], up: [0, 1, 0], paths: 4, bands: "
        "[{name: lines, center_um: 10.25, fwhm_um: 0.4, shape: rectangular}]}\n");
  }
  CommandResult run(const std::string& command) {
    return run_command("cd '" + folder_.path() + "' && PATH='" SUITE_BIN_DIR "':$PATH " + command);
  }
  TempFolder folder_;
};

// Mean transmittance of all air above sea level over a band of wavelengths, from the lines themselves at each level;
// between levels absorption runs exponentially.
double line_by_line(const std::string& list, double low_um, double high_um) {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  const std::vector<AirLevel> levels = air_levels(air);
  constexpr double step = 0.002;
  const double low = 1e4 / high_um;
  const auto count = static_cast<size_t>((1e4 / low_um - low) / step);
  std::vector<double> depth(count, 0.0), below(count, 0.0), here(count);
  const std::vector<LineGas> gases = parse_hitran(list, "lines");
  for (size_t l = 0; l < levels.size(); ++l) {
    std::fill(here.begin(), here.end(), 0.0);
    for (LineGas gas : gases) {
      gas.share = standard_profile("us_standard").levels.front().share(gas.gas);
      const std::vector<double> k =
          line_spectrum(gas, low + step / 2, step, count, levels[l].pressure, levels[l].temperature);
      for (size_t i = 0; i < count; ++i) here[i] += k[i] * levels[l].density() * levels[l].share(gas.gas);
    }
    for (size_t i = 0; l > 0 && i < count; ++i) {
      const double a = below[i], b = here[i];
      const double mean = std::fabs(a - b) < 1e-6 * (a + b) ? 0.5 * (a + b) : (a - b) / std::log(a / b);
      depth[i] += mean * (levels[l].height - levels[l - 1].height);
    }
    std::swap(below, here);
  }
  double sum = 0, weights = 0;
  for (size_t i = 0; i < count; ++i) {
    const double v = low + (static_cast<double>(i) + 0.5) * step, weight = 1 / (v * v);
    sum += weight * std::exp(-depth[i]), weights += weight;
  }
  return sum / weights;
}

// Lists of two ranges that overlap, or one given twice, doubled their lines without a word.
TEST_F(BakeGases, LinesOfTwoListsAreTold) {
  const auto said = [&](const std::string& lines) {
    return run("scene-prep --gases recipe.yaml --set 'gases.co2.lines=" + lines + "' 2>&1").out;
  };
  EXPECT_THAT(said("[co2.par, co2.par]"), HasSubstr("co2: 40 lines stand in more than one of its files"));
  std::string half = read_text(folder_ / "co2.par");
  write_file(folder_ / "low.par", half.substr(0, half.size() / 2));
  write_file(folder_ / "high.par", half.substr(half.size() / 2));
  EXPECT_THAT(said("[low.par, co2.par]"), HasSubstr("co2: 20 lines stand"));
  EXPECT_THAT(said("[low.par, high.par]"), testing::Not(HasSubstr("more than one of its files")));
}

TEST_F(BakeGases, TheTableServesARender) {
  const CommandResult baked = run("scene-prep --gases recipe.yaml -o gases.h5");
  ASSERT_EQ(baked.code, 0) << baked.err;
  EXPECT_THAT(baked.out, HasSubstr("co2   40 lines"));
  EXPECT_THAT(baked.out, HasSubstr("10 bands from 950 to 1000 cm-1"));
  EXPECT_THAT(baked.err, HasSubstr("baking: 480 spectra in"));
  EXPECT_THAT(baked.err, HasSubstr("no partition sum of isotopologue 1"));
  EXPECT_EQ(read_air_table(folder_ / "gases.h5").source, "made-up lines");
  ASSERT_EQ(run("scene-prep scene.yaml -o scene.h5").code, 0);

  const CommandResult told = run("dirsig-render sim.yaml --air");
  ASSERT_EQ(told.code, 0) << told.err;
  double transmittance = 0;
  const size_t row = told.out.find("  lines ");
  ASSERT_NE(row, std::string::npos) << told.out;
  ASSERT_EQ(std::sscanf(told.out.c_str() + row, " lines %*g um %lg", &transmittance), 1);
  const std::string list = read_text(folder_ / "co2.par") + read_text(folder_ / "o3.par");
  const double expected = line_by_line(list, 10.05, 10.45);
  EXPECT_NEAR(transmittance, expected, 0.005);
  EXPECT_GT(expected, 0.2);
  EXPECT_LT(expected, 0.8);
  // Control: either gas alone is not it.
  EXPECT_GT(std::fabs(line_by_line(read_text(folder_ / "o3.par"), 10.05, 10.45) - expected), 0.012);
  EXPECT_GT(std::fabs(line_by_line(read_text(folder_ / "co2.par"), 10.05, 10.45) - expected), 0.012);

  // From above, colder air is seen where it absorbs.
  ASSERT_EQ(run("dirsig-render sim.yaml -o with").code, 0);
  ASSERT_EQ(run("dirsig-render sim.yaml -o without --set atmosphere.gases=none").code, 0);
  const double with = EnviImage(folder_ / "with/a.img").read_lines(0, 1)[0],
               without = EnviImage(folder_ / "without/a.img").read_lines(0, 1)[0];
  EXPECT_LT(with, 0.95 * without);
  EXPECT_GT(with, expected * without);
}

TEST_F(BakeGases, FaultsAreTold) {
  // Only read: what it would be, and no table.
  const CommandResult plan = run("scene-prep --gases recipe.yaml --set step_cm=0.5");
  EXPECT_EQ(plan.code, 0);
  EXPECT_THAT(plan.out, HasSubstr("480 spectra"));
  EXPECT_THAT(plan.err, HasSubstr("a smaller step_cm mends it"));
  EXPECT_FALSE(file_exists(folder_ / "gases.h5"));
  EXPECT_THAT(run("scene-prep --gases recipe.yaml --set range_cm='[3000, 3100]'").err,
              HasSubstr("warning: co2 has no line within reach"));
  EXPECT_EQ(run("scene-prep --gases recipe.yaml scene.yaml").code, 2);
  EXPECT_EQ(run("scene-prep --gases recipe.yaml --strict").code, 2);
  EXPECT_EQ(run("scene-prep --gases recipe.yaml -o o3.par").code, 2);
  const CommandResult wrong = run("scene-prep --gases recipe.yaml --set gases.co2.lines=o3.par -o gases.h5");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("o3.par holds no line of co2"));
  write_file(folder_ / "q.txt", "290 130\n300 140\n");
  const CommandResult cold = run("scene-prep --gases recipe.yaml --set gases.o3.partition_sums='{1: q.txt}' -o g.h5");
  EXPECT_EQ(cold.code, 1);
  EXPECT_THAT(cold.err, HasSubstr("q.txt"));
  EXPECT_THAT(cold.err, HasSubstr("200 K are asked for"));
  write_file(folder_ / "co2.par", " 21  944.000000 1.000x-20\n");
  const CommandResult broken = run("scene-prep --gases recipe.yaml -o gases.h5");
  EXPECT_EQ(broken.code, 1);
  EXPECT_THAT(broken.err, HasSubstr("co2.par:1:"));
}

// The example of USAGE.md, as it stands there.
TEST_F(BakeGases, TheExampleRuns) {
  const std::string usage = read_text(SUITE_SOURCE_DIR "/apps/scene-prep/USAGE.md");
  const size_t from = usage.find("```sh\n"), to = usage.find("```", from + 5);
  ASSERT_NE(to, std::string::npos);
  write_file(folder_ / "example.sh", usage.substr(from + 6, to - from - 6));
  const CommandResult r = run("sh -e example.sh");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(read_air_table(folder_ / "gases.h5").gases, std::vector<Gas>{Gas::co2});
}

}  // namespace
}  // namespace suite::gases_test
