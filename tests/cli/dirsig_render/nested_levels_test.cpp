// A wood of 1e9 leaves from three levels of groups: prepared and rendered within 1 GB. The placements of the levels are
// added up, not multiplied.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "formats/envi/envi.h"
#include "support/programs_kit.h"

namespace suite::nested_levels_test {
namespace {

using testing::HasSubstr;

// n rows on a square grid, z by a rule that fills [0, high).
std::string table(int n, double step, double high) {
  std::string rows = "x,y,z,heading_deg\n";
  const int side = static_cast<int>(std::ceil(std::sqrt(n)));
  for (int i = 0; i < n; ++i)
    rows += strf("%g,%g,%g,%d\n", (i % side - side / 2) * step, (i / side - side / 2) * step,
                 high * std::fmod(0.618034 * i, 1.0), 90 * (i % 4));
  return rows;
}

class NestedLevels : public ProgramsTest<NestedLevels> {
 protected:
  static void SetUpTestSuite() {
    make_folder();
    write_file(*folder_ / "leaf.obj",
               std::string_view("v -.1 -.1 0\nv .1 -.1 0\nv .1 .1 .03\nv -.1 .1 0\nf 1 2 3 4\n"));
    write_file(*folder_ / "leaves.csv", std::string_view(table(1000, 0.1, 3)));
    write_file(*folder_ / "trees.csv", std::string_view(table(1000, 4, 0)));
    write_file(*folder_ / "forests.csv", std::string_view(table(1000, 128, 0)));
    write_file(*folder_ / "five.csv", std::string_view(table(5, 5000, 0)));
  }
  static std::string text(const std::string& world) {
    return "scene: 1\nmaterials: {leaf: {model: lambert, reflectance: 0.3}}\n"
           "objects: {leaf: {obj: leaf.obj, material: leaf}}\n"
           "groups:\n  tree: [{place: leaf, table: leaves.csv}]\n  forest: [{place: tree, table: trees.csv}]\n"
           "  land: [{place: forest, table: forests.csv}]\nworld: [" +
           world + "]\n";
  }
};

// Tiles come and go while the groups in them stay: their structures call those of the leaf, which other tiles place,
// too.
TEST_F(NestedLevels, UnderALimitOfMemoryGiveTheSame) {
  prepare(text("{place: land}, {place: leaf, table: five.csv, translate: [0, 0, 40]}, {place: leaf, table: leaves.csv, "
               "scale: 2000}"),
          "mixed");
  const std::string sim =
      "scene: mixed.h5\nsun: {direction: {zenith_deg: 30, azimuth_deg: 120}, irradiance: 1000}\n"
      "sensors:\n  - {kind: orthographic, name: eye, columns: 48, rows: 48, gsd_m: 400, center_m: [0, 0], paths: 4,\n"
      "     truth: [instance, range], bands: [{name: b, center_um: 0.55, fwhm_um: 0.01}]}\n";
  ASSERT_EQ(render(sim, "free").code, 0);
  const CommandResult r = run("dirsig-render free.yaml -o limited --memory 1MiB");
  ASSERT_EQ(r.code, 0) << r.err;
  unsigned built = 0, at_once = 0;
  const size_t told = r.err.find("tiles: ");
  ASSERT_NE(told, std::string::npos) << r.err;
  ASSERT_EQ(std::sscanf(r.err.c_str() + told, "tiles: %u buildings, %u at once", &built, &at_once), 2) << r.err;
  EXPECT_GT(built, at_once) << "some were given up";
  for (const char* file : {"eye.img", "eye_truth.img"})
    EXPECT_EQ(read_bytes(*folder_ / (std::string("free/") + file)),
              read_bytes(*folder_ / (std::string("limited/") + file)))
        << file;
}

TEST_F(NestedLevels, AThousandMillionLeavesFitIntoAGigabyte) {
  prepare(text("{place: land}"));
  const CommandResult r = render(
      "scene: scene.h5\nsun: {direction: {zenith_deg: 30, azimuth_deg: 120}, irradiance: 1000}\n"
      "sensors:\n  - {kind: orthographic, name: eye, columns: 64, rows: 64, gsd_m: 60, center_m: [0, 0], paths: 2,\n"
      "     truth: [instance, material], bands: [{name: b, center_um: 0.55, fwhm_um: 0.01}]}\n",
      "out");
  ASSERT_EQ(r.code, 0) << r.err;
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  const double peak = 1024.0 * static_cast<double>(used.ru_maxrss);
  EXPECT_GT(peak, 1e8);  // it was measured
  EXPECT_LT(peak, 1e9);
  // Numbers of instances are whole ones from one end to the other.
  const EnviImage truth(*folder_ / "out/eye_truth.img");
  const std::vector<std::string>& names = truth.header().band_names;
  const auto column = static_cast<size_t>(std::find(names.begin(), names.end(), "instance") - names.begin());
  ASSERT_LT(column, names.size());
  const std::vector<double> all = truth.read_all();
  size_t met = 0;
  double most = 0;
  for (size_t at = column; at < all.size(); at += names.size())
    if (std::isfinite(all[at])) {
      ++met, most = std::max(most, all[at]);
      EXPECT_EQ(all[at], std::floor(all[at]));
    }
  EXPECT_GT(met, 1000u);
  EXPECT_GT(most, 9e8);
  EXPECT_LT(most, 1e9);
}

TEST_F(NestedLevels, MoreThanCanBeNumberedAreRefused) {
  write_file(*folder_ / "five.yaml", std::string_view(text("{place: land, table: five.csv}")));
  const CommandResult r = run("scene-prep five.yaml -o five.h5");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.out + r.err, HasSubstr("'world' unfolds into 5e+09 instances"));
}

}  // namespace
}  // namespace suite::nested_levels_test
