#include "base/files.h"
#include "formats/gas_recipe/gas_recipe.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_gas_recipe_recipe_test {

TEST(FuzzGasRecipe, Recipe) {
  const TempFolder folder;
  for (const char* name : {"co2.par", "h2o.par", "q.txt"}) write_file(folder / name, "x\n");
  test::fuzz(test::bytes_of("gas_table: 1\nsource: mine\nrange_um: [10, 11]\nwidth_cm: 5\nstep_cm: 0.01\ng_points: 8\n"
                            "pressures_pa: [100, 1e5]\ntemperatures_k: [200, 300]\ncontinuum: builtin\ngases:\n"
                            "  co2: {lines: co2.par, partition_sums: {1: q.txt}, masses_g_mol: {1: 44, 2: 45}}\n"
                            "  h2o: {lines: [h2o.par], share_ppm: 5000}\n"),
             [&](std::span<const std::byte> b) {
               parse_gas_recipe({reinterpret_cast<const char*>(b.data()), b.size()}, folder / "r.yaml");
             },
             41, test::kMutations,
             {"nan", "1e999", "-1", "0", "[", "]", "{", "}", ": ", ", ", "\n", "none", "range_cm", "99999"});
}

}  // namespace suite::format_gas_recipe_recipe_test
