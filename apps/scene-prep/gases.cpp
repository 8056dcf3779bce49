#include "gases.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <tuple>

#include "base/inputs.h"
#include "base/outputs.h"
#include "base/progress.h"
#include "formats/air_table/air_table.h"
#include "formats/gas_recipe/gas_recipe.h"
#include "formats/hitran/hitran.h"

namespace suite {

namespace {

constexpr double kReach = 25;  // cm-1, of a line: air/lines.h

// The same transition of a list: its place and strength as they are written.
using Transition = std::tuple<int, double, double, double>;
Transition transition_of(const SpectralLine& l) {
  return {l.isotopologue, l.wavenumber_cm, l.intensity, l.lower_energy_cm};
}

// The lines of a gas in its files. lists: what has been read, by file. Within one file lines may be alike (levels that
// coincide); what two files have is told.
std::vector<SpectralLine> lines_of(const GasRecipe::Source& source,
                                   std::map<std::string, std::vector<LineGas>>& lists) {
  std::vector<SpectralLine> lines;
  std::set<Transition> known;
  size_t twice = 0;
  for (const std::string& file : source.lines) {
    auto list = lists.find(file);
    if (list == lists.end()) list = lists.emplace(file, read_hitran(file)).first;
    const auto mine =
        std::find_if(list->second.begin(), list->second.end(), [&](const LineGas& g) { return g.gas == source.gas; });
    if (mine == list->second.end())
      throw Error(source.where, file + " holds no line of " + std::string(gas_name(source.gas)));
    for (const SpectralLine& line : mine->lines) twice += known.contains(transition_of(line));
    lines.insert(lines.end(), mine->lines.begin(), mine->lines.end());
    if (&file != &source.lines.back())
      for (const SpectralLine& line : mine->lines) known.insert(transition_of(line));
  }
  if (twice)
    warn(strf("%s: %zu lines stand in more than one of its files, and count as often: lists that overlap are to be cut",
              std::string(gas_name(source.gas)).c_str(), twice));
  std::stable_sort(lines.begin(), lines.end(),
                   [](const SpectralLine& a, const SpectralLine& b) { return a.wavenumber_cm < b.wavenumber_cm; });
  return lines;
}

// By their own partition sums, which are asked for each temperature of the table before the work begins.
LineGas gas_of_source(const GasRecipe::Source& source, const LineBake& bake, std::vector<SpectralLine> lines) {
  LineGas gas{.gas = source.gas, .lines = std::move(lines), .share = source.share};
  std::map<int, std::function<double(double)>> sums;
  for (const auto& [isotopologue, file] : source.partition_sum) {
    const auto& sum = sums[isotopologue] = read_partition_sum(file);
    for (const double t : bake.temperature) sum(t);
  }
  gas.partition = [sums, which = source.gas](int isotopologue, double kelvin) {
    const auto own = sums.find(isotopologue);
    return own == sums.end() ? partition_ratio(which, kelvin) : own->second(kelvin);
  };
  gas.mass = [masses = source.mass, which = source.gas](int isotopologue) {
    const auto own = masses.find(isotopologue);
    return own == masses.end() ? molar_mass(which) : own->second;
  };
  return gas;
}

// What a gas brings to the range of the table, and what is uncertain about it.
void print_source(const GasRecipe::Source& source, const LineGas& gas, const LineBake& bake) {
  const double low = bake.edges_cm.front() - kReach, high = bake.edges_cm.back() + kReach;
  const std::string name(gas_name(gas.gas));
  size_t within = 0;
  std::set<int> without;
  for (const SpectralLine& line : gas.lines) {
    if (line.wavenumber_cm < low || line.wavenumber_cm > high) continue;
    ++within;
    if (!source.partition_sum.contains(line.isotopologue)) without.insert(line.isotopologue);
  }
  std::printf("%-5s %zu lines from %g to %g cm-1, %zu of them within reach; self broadening as of %g ppm\n",
              name.c_str(), gas.lines.size(), gas.lines.front().wavenumber_cm, gas.lines.back().wavenumber_cm, within,
              1e6 * gas.share);
  if (within == 0) return warn(name + " has no line within reach of the range: nothing of it is in the table");
  std::string numbers;
  for (const int isotopologue : without) numbers += strf(numbers.empty() ? "%d" : ", %d", isotopologue);
  if (!without.empty()) note(name + ": no partition sum of isotopologue " + numbers + ": rotation alone stands for it");
  const double pressure = bake.pressure.front(), temperature = bake.temperature.front();
  const auto narrowest = narrowest_line(gas, low, high, pressure, temperature);
  if (narrowest && bake.step_cm > *narrowest)
    warn(
        strf("%s: steps of %g cm-1, and at %g Pa and %g K lines are as narrow as %.2g (half width at half maximum): "
             "what passes high up is rough; a smaller step_cm mends it",
             name.c_str(), bake.step_cm, pressure, temperature, *narrowest));
}

}  // namespace

int bake_gases(const ScenePrepOptions& o) {
  note_input(o.gases);
  check_outputs({o.output});
  GasRecipe recipe = read_gas_recipe(o.gases, o.settings);
  LineBake& bake = recipe.bake;
  std::map<std::string, std::vector<LineGas>> lists;
  std::vector<LineGas> gases;
  for (const GasRecipe::Source& source : recipe.gases) {
    gases.push_back(gas_of_source(source, bake, lines_of(source, lists)));
    print_source(source, gases.back(), bake);
  }
  lists.clear();
  std::optional<WaterContinuum> continuum;
  if (recipe.continuum == GasRecipe::Continuum::builtin) continuum = builtin_continuum();
  if (recipe.continuum == GasRecipe::Continuum::file) continuum = read_water_continuum(recipe.continuum_file);
  check_outputs({o.output});  // what the recipe names is known now
  const size_t spectra = bake_spectra(gases.size(), bake);
  std::printf("%zu bands from %g to %g cm-1 (%g to %g um) at %zu pressures and %zu temperatures: %zu spectra, %s\n",
              bake.edges_cm.size() - 1, bake.edges_cm.front(), bake.edges_cm.back(), 1e4 / bake.edges_cm.back(),
              1e4 / bake.edges_cm.front(), bake.pressure.size(), bake.temperature.size(), spectra,
              human_bytes(4.0 * static_cast<double>(spectra * bake.points)).c_str());
  if (o.output.empty()) return 0;
  make_folders_of({o.output});
  Progress progress("baking", static_cast<double>(spectra), "spectrum");
  bake.done = [&] { progress.add(1); };
  try {
    const GasTable table = bake_lines(gases, continuum ? &*continuum : nullptr, bake);
    progress.finish();
    write_air_table(o.output, table);
  } catch (const Error& e) {
    throw e.where().file.empty() ? Error(Where{o.gases, 0, 0, {}, -1}, e.message(), e.hint()) : e;
  }
  note("wrote " + o.output);
  return 0;
}

}  // namespace suite
