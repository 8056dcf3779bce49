#include "formats/gas_recipe/gas_recipe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_gas_recipe_read_test {
namespace {

using testing::HasSubstr;

class Recipe : public testing::Test {
 protected:
  Recipe() {
    for (const char* name : {"co2.par", "h2o.par", "q7.txt", "mt.csv"}) write_file(folder_ / name, "x\n");
  }
  GasRecipe read(const std::string& text) { return parse_gas_recipe(text, folder_ / "r.yaml"); }
  std::string message(const std::string& text) {
    return message_of([&] { read(text); });
  }
  TempFolder folder_;
};

TEST_F(Recipe, EverythingIsRead) {
  const GasRecipe r = read(
      "{gas_table: 1, source: mine, range_cm: [900, 1000], width_cm: 15, step_cm: 0.01, g_points: 8, pressures_pa: "
      "[1e3, "
      "1e5], temperatures_k: [200, 300], continuum: mt.csv, gases: {co2: {lines: [co2.par, h2o.par], partition_sums: "
      "{1: "
      "q7.txt}, masses_g_mol: {1: 43.98983, 2: 44.993185}, share_ppm: 400}, h2o: {lines: h2o.par}}}");
  ASSERT_EQ(r.gases.size(), 2u);
  EXPECT_EQ(r.gases[0].gas, Gas::co2);
  EXPECT_EQ(r.gases[0].lines.size(), 2u);
  EXPECT_EQ(r.gases[0].partition_sum.at(1), folder_ / "q7.txt");
  EXPECT_NEAR(r.gases[0].mass.at(2), 0.044993185, 1e-12);
  EXPECT_NEAR(r.gases[0].share, 4e-4, 1e-12);
  EXPECT_NEAR(r.gases[1].share, 7.75e-3, 1e-4);  // AFGL's U.S. Standard at sea level
  EXPECT_EQ(r.bake.edges_cm.size(), 8u);         // seven bands of 14.3 cm-1
  EXPECT_EQ(r.bake.edges_cm.front(), 900);
  EXPECT_EQ(r.bake.edges_cm.back(), 1000);
  EXPECT_EQ(r.bake.points, 8u);
  EXPECT_EQ(r.bake.step_cm, 0.01);
  EXPECT_EQ(r.bake.source, "mine");
  EXPECT_EQ(r.continuum, GasRecipe::Continuum::file);
}

TEST_F(Recipe, Defaults) {
  const GasRecipe r = read("{gas_table: 1, range_um: [10, 11], width_nm: 100, gases: {co2: {lines: co2.par}}}");
  ASSERT_EQ(r.bake.edges_cm.size(), 11u);
  EXPECT_NEAR(1e4 / r.bake.edges_cm[5], 10.5, 1e-9);  // even in wavelength
  EXPECT_EQ(r.bake.points, 16u);
  EXPECT_EQ(r.bake.source, "line by line from co2.par");
  EXPECT_EQ(r.continuum, GasRecipe::Continuum::none);
  EXPECT_EQ(read("{gas_table: 1, range_um: [10, 11], gases: {h2o: {lines: h2o.par}}}").continuum,
            GasRecipe::Continuum::builtin);
}

TEST_F(Recipe, FaultsAreToldAtTheirPlace) {
  const std::string gases = ", gases: {co2: {lines: co2.par}}}", range = "{gas_table: 1, range_um: [10, 11], ";
  EXPECT_THAT(message("{gas_table: 2" + gases), HasSubstr("r.yaml:1:13"));
  EXPECT_THAT(message("{gas_table: 1" + gases), HasSubstr("either `range_um` or `range_cm`"));
  EXPECT_THAT(message("{gas_table: 1, range_um: [11, 10]" + gases), HasSubstr("r.yaml:1:26: error: not a range"));
  EXPECT_THAT(message("{gas_table: 1, range_cm: [1, 9e4], width_cm: 0.001" + gases), HasSubstr("bands"));
  EXPECT_THAT(message(range + "width_cm: 1, width_nm: 1" + gases), HasSubstr("drop one"));
  EXPECT_THAT(message(range + "g_points: 5" + gases), HasSubstr("'5' is none of the choices"));
  EXPECT_THAT(message(range + "pressures_pa: [2, 1]" + gases), HasSubstr("not ascending"));
  EXPECT_THAT(message(range + "continuum: builtin" + gases), HasSubstr("without water"));
  EXPECT_THAT(message(range + "widht_cm: 3" + gases), HasSubstr("width_cm"));
  EXPECT_THAT(message(range + "gases: {co3: {lines: co2.par}}}"), HasSubstr("unknown gas 'co3'"));
  EXPECT_THAT(message(range + "gases: {co2: {lines: gone.par}}}"), HasSubstr("gone.par"));
  EXPECT_THAT(message(range + "gases: {co2: {lines: []}}}"), HasSubstr("no list of lines"));
  EXPECT_THAT(message(range + "gases: {}}"), HasSubstr("no gas"));
  EXPECT_THAT(message(range + "gases: {co2: {lines: co2.par, masses_g_mol: {x: 44}}}}"), HasSubstr("no isotopologue"));
  EXPECT_THAT(message(range + "gases: {co2: {lines: co2.par, share_ppm: 2e6}}}"), HasSubstr("2e+06"));
}

}  // namespace
}  // namespace suite::format_gas_recipe_read_test
