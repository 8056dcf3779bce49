#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "base/params.h"
#include "formats/gas_recipe/gas_recipe.h"

namespace suite {

namespace {

std::string existing(const Params& p, const char* hint) {
  const std::string path = p.as_path();
  if (!file_exists(path)) throw p.error("there is no file '" + path + "'", hint);
  return path;
}

// A map whose keys are numbers of isotopologues, each handed to use(isotopologue, value).
template <class Use>
void each_isotopologue(const Params& gas, const char* key, const Use& use) {
  const auto map = gas.find(key);
  if (!map) return;
  for (const std::string& name : map->keys()) {
    int number = 0;
    for (const char c : name) number = c >= '0' && c <= '9' && number < 100 ? 10 * number + (c - '0') : 1000;
    if (number < 1 || number > 36)
      throw map->at(name).error("'" + name + "' is no isotopologue", "1 to 36, as HITRAN numbers them");
    use(number, map->at(name));
  }
}

GasRecipe::Source read_source(const Params& p, Gas gas) {
  GasRecipe::Source s;
  s.gas = gas;
  const Params lines = p.at("lines");
  s.where = lines.where();
  for (const Params& file : lines.items()) s.lines.push_back(existing(file, "a line list (formats/hitran)"));
  if (s.lines.empty()) throw lines.error("no list of lines", "one file or several");
  each_isotopologue(p, "partition_sums", [&](int isotopologue, const Params& file) {
    s.partition_sum[isotopologue] = existing(file, "rows of temperature and sum (formats/hitran)");
  });
  each_isotopologue(p, "masses_g_mol", [&](int isotopologue, const Params& mass) {
    s.mass[isotopologue] = 1e-3 * mass.as_number_in(1, 1000, "g/mol");
  });
  s.share = standard_profile("us_standard").levels.front().share(gas);
  if (p.has("share_ppm")) s.share = 1e-6 * p.number_in("share_ppm", 0, 1e6, "ppm");
  return s;
}

void read_gases(const Params& gases, GasRecipe& recipe) {
  for (const std::string& name : gases.keys()) {
    const auto gas = gas_of(name);
    if (!gas) {
      std::vector<std::string> known;
      for (int g = 0; g < kGases; ++g) known.emplace_back(gas_name(static_cast<Gas>(g)));
      throw gases.at(name).error("unknown gas '" + name + "'", name_hint(name, known));
    }
    recipe.gases.push_back(read_source(gases.at(name), *gas));
  }
  if (recipe.gases.empty()) throw gases.error("no gas", "{h2o: {lines: FILE}, ...}");
}

// Edges of bands from a range and the most that one is wide: even in wavenumber or in wavelength.
std::vector<double> read_edges(const Params& p) {
  const auto um = p.find("range_um"), cm = p.find("range_cm"), nm_wide = p.find("width_nm"),
             cm_wide = p.find("width_cm");
  if (!um == !cm) throw p.error("either `range_um` or `range_cm`", "such as range_um: [8, 14]");
  if (nm_wide && cm_wide) throw nm_wide->error("both `width_nm` and `width_cm`", "drop one of the two");
  const Params& range = um ? *um : *cm;
  const std::vector<double> ends = range.as_numbers();
  if (ends.size() != 2 || !(ends[0] > 0 && ends[1] > ends[0] && ends[1] <= 1e5))
    throw range.error("not a range", "two positive numbers, the smaller first");
  const double low = um ? 1e4 / ends[1] : ends[0], high = um ? 1e4 / ends[0] : ends[1];
  const double width = nm_wide   ? 1e-3 * nm_wide->as_number_in(1e-4, 1e6, "nm")
                       : cm_wide ? cm_wide->as_number_in(1e-3, 1e5, "cm-1")
                                 : 10;
  const double from = nm_wide ? 1e4 / high : low, to = nm_wide ? 1e4 / low : high;
  const double count = std::max(1.0, std::ceil((to - from) / width * (1 - 1e-12)));
  if (!(count <= static_cast<double>(kTableBands)))
    throw range.error(strf("%.0f bands", count), strf("%zu at most: wider ones or a smaller range", kTableBands));
  std::vector<double> edges;
  for (double i = 0; i <= count; ++i) {
    const double at = from + (to - from) * i / count;
    edges.push_back(nm_wide ? 1e4 / at : at);
  }
  if (nm_wide) std::reverse(edges.begin(), edges.end());
  edges.front() = low, edges.back() = high;
  return edges;
}

std::vector<double> read_axis(const Params& p, const char* key, double least, double most, const char* unit,
                              size_t count, std::vector<double> otherwise) {
  const auto given = p.find(key);
  if (!given) return otherwise;
  std::vector<double> axis;
  for (const Params& value : given->items()) {
    axis.push_back(value.as_number_in(least, most, unit));
    if (axis.size() > 1 && !(axis.back() > axis[axis.size() - 2])) throw value.error("not ascending");
  }
  if (axis.empty() || axis.size() > count) throw given->error(strf("%zu values", axis.size()), strf("1 to %zu", count));
  return axis;
}

void read_continuum(const Params& p, GasRecipe& recipe) {
  const bool water = std::any_of(recipe.gases.begin(), recipe.gases.end(),
                                 [](const GasRecipe::Source& s) { return s.gas == Gas::h2o; });
  using Continuum = GasRecipe::Continuum;
  recipe.continuum = water ? Continuum::builtin : Continuum::none;
  const auto given = p.find("continuum");
  if (!given) return;
  const std::string name = given->as_text();
  recipe.continuum = name == "none" ? Continuum::none : name == "builtin" ? Continuum::builtin : Continuum::file;
  if (!water && recipe.continuum != Continuum::none)
    throw given->error("a continuum of water without water among the gases");
  if (recipe.continuum == Continuum::file)
    recipe.continuum_file = existing(*given, "builtin, none, or a CSV (formats/hitran)");
}

GasRecipe read(const Params& p) {
  GasRecipe recipe;
  p.integer("gas_table", 1, 1);
  read_gases(p.at("gases"), recipe);
  LineBake& bake = recipe.bake;
  bake.edges_cm = read_edges(p);
  bake.step_cm = p.number_in("step_cm", 1e-6, 10, "cm-1", bake.step_cm);
  if (const auto points = p.find("g_points")) bake.points = size_t{16} >> points->as_choice({"16", "8", "4"});
  bake.pressure = read_axis(p, "pressures_pa", 1e-3, 1e7, "Pa", kTablePressures,
                            {10, 30, 100, 300, 1e3, 2e3, 5e3, 1e4, 2e4, 3e4, 5e4, 7e4, 1.1e5});
  bake.temperature = read_axis(p, "temperatures_k", 50, 3000, "K", kTableTemperatures, {180, 210, 240, 270, 300, 330});
  read_continuum(p, recipe);
  std::string lists;
  for (const GasRecipe::Source& s : recipe.gases)
    for (const std::string& file : s.lines)
      lists += (lists.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  bake.source = p.text("source", "line by line from " + lists);
  p.reject_unread();
  return recipe;
}

}  // namespace

GasRecipe parse_gas_recipe(std::string_view text, const std::string& file_name) {
  return read(Params::parse_text(text, file_name));
}

GasRecipe read_gas_recipe(const std::string& path, std::span<const std::string> settings) {
  return read(Params::parse_file(path, settings));
}

}  // namespace suite
