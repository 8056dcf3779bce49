// Recipes after which tables of gas absorption are baked from line lists. See FORMAT.md.
#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "air/lines.h"
#include "base/error.h"

namespace suite {

struct GasRecipe {
  struct Source {
    Gas gas = Gas::h2o;
    std::vector<std::string> lines;            // files (formats/hitran)
    std::map<int, std::string> partition_sum;  // files by isotopologue
    std::map<int, double> mass;                // kg/mol, by isotopologue
    double share = 0;                          // of all air, mol/mol
    Where where = {};                          // of its lines
  };
  std::vector<Source> gases;
  LineBake bake;
  enum class Continuum { none, builtin, file } continuum = Continuum::none;
  std::string continuum_file;
};

// Files that are named are there, and are not read. settings: as Params::parse_file has them. Error, located: a key
// that is unknown or missing, a value out of range, no such file, a gas that is unknown, more than 200000 bands, a
// continuum without water.
GasRecipe read_gas_recipe(const std::string& path, std::span<const std::string> settings = {});
GasRecipe parse_gas_recipe(std::string_view text, const std::string& file_name);

}  // namespace suite
