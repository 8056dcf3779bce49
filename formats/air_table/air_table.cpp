#include "formats/air_table/air_table.h"

#include "base/files.h"
#include "formats/hdf5/format_version.h"
#include "formats/hdf5/h5.h"

namespace suite {

namespace {

constexpr const char *kFormat = "suite air table", *kVersion = "1";

}  // namespace

void write_air_table(const std::string& path, const GasTable& table) {
  const Where where{path, 0, 0, {}, -1};
  check_gas_table(table, where);
  std::vector<std::string> gases;
  for (const Gas gas : table.gases) gases.emplace_back(gas_name(gas));
  AtomicFile file(path);
  h5::Writer w(file.temporary(), path, [](const std::string&) { return 4; });
  w.attribute("format", kFormat);
  w.attribute("version", kVersion);
  w.attribute("source", table.source);
  w.put("/edges", table.edges_cm, "cm-1");
  w.put("/pressure", table.pressure, "Pa");
  w.put("/temperature", table.temperature, "K");
  w.put("/weight", table.weight, "1");
  w.put_names("/gases", gases);
  w.put("/cross_section", table.cross_section, "m2", table.weight.size());
  if (!table.water_self.empty()) w.put("/water_self", table.water_self, "m2/Pa", table.temperature.size());
  w.close();
  file.commit();
}

GasTable read_air_table(const std::string& path) {
  h5::Reader r(path, "bake the table again");
  if (r.text("format") != kFormat) r.fail("is not an air table");
  h5::check_version(r, kVersion);
  GasTable table;
  table.source = r.text("source");
  // The axes first, each within its bounds: what follows is as large as their product.
  const auto axis = [&](const char* name, const char* units, size_t most) {
    const h5::Reader::Opened d = r.open(name, h5::native<double>(), units, 1, -1);
    if (d.count < 1 || d.count > most) r.fail(strf("%s has %zu values, 1 to %zu are read", name, d.count, most));
    return r.get<double>(name, units);
  };
  table.edges_cm = axis("/edges", "cm-1", kTableBands + 1);
  if (table.edges_cm.size() < 2) r.fail("/edges has one value, a band has two");
  table.pressure = axis("/pressure", "Pa", kTablePressures);
  table.temperature = axis("/temperature", "K", kTableTemperatures);
  table.weight = axis("/weight", "1", kTablePoints);
  const std::vector<std::string> gases = r.get_names("/gases");
  if (gases.empty() || gases.size() > kGases)
    r.fail(strf("/gases has %zu names, 1 to %d are read", gases.size(), kGases));
  for (const std::string& name : gases) {
    const std::optional<Gas> gas = gas_of(name);
    if (!gas) r.fail("names the unknown gas '" + name + "'");
    table.gases.push_back(*gas);
  }
  const size_t rows = table.gases.size() * table.bands() * table.pressure.size() * table.temperature.size();
  table.cross_section = r.get<float>("/cross_section", "m2", table.weight.size(), static_cast<long long>(rows));
  if (r.has("/water_self"))
    table.water_self =
        r.get<float>("/water_self", "m2/Pa", table.temperature.size(), static_cast<long long>(table.bands()));
  check_gas_table(table, Where{path, 0, 0, {}, -1});
  return table;
}

}  // namespace suite
