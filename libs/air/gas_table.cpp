#include "air/gas_table.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "air/axis.h"

namespace suite {

namespace {

double mixed(double a, double b, double s) {
  if (s <= 0) return a;
  if (s >= 1) return b;
  return a > 0 && b > 0 ? a * std::pow(b / a, s) : a + s * (b - a);
}

class TableGases final : public GasProvider {
 public:
  explicit TableGases(GasTable table) : table_(std::move(table)) {
    for (const double p : table_.pressure) log_pressure_.push_back(std::log(p));
  }
  double low_um() const override { return 1e4 / table_.edges_cm.back(); }
  double high_um() const override { return 1e4 / table_.edges_cm.front(); }
  std::string note() const override { return table_.source; }

  std::vector<Band> bands(double low_cm, double high_cm) const override {
    const auto& edges = table_.edges_cm;
    std::vector<Band> out;
    auto i = static_cast<size_t>(std::upper_bound(edges.begin(), edges.end(), low_cm) - edges.begin());
    for (i = std::max<size_t>(i, 1); i < edges.size() && edges[i - 1] < high_cm; ++i)
      out.push_back({std::max(low_cm, edges[i - 1]), std::min(high_cm, edges[i]), i - 1});
    return out;
  }

  std::vector<GasPoints> absorbers(const Band& band, std::span<const AirLevel> levels) const override {
    std::vector<GasPoints> out;
    for (size_t g = 0; g < table_.gases.size(); ++g)
      if (absorbs(g, band.index)) out.push_back(points_of(g, band.index, levels));
    if (!table_.water_self.empty()) out.push_back(self_of_water(band.index, levels));
    return out;
  }

 private:
  bool absorbs(size_t gas, size_t band) const {
    const auto from = table_.cross_section.begin() + static_cast<std::ptrdiff_t>(table_.index(gas, band, 0, 0));
    const auto count =
        static_cast<std::ptrdiff_t>(table_.pressure.size() * table_.temperature.size() * table_.weight.size());
    return std::any_of(from, from + count, [](float k) { return k > 0; });
  }
  GasPoints points_of(size_t gas, size_t band, std::span<const AirLevel> levels) const {
    GasPoints out;
    out.weight = table_.weight;
    for (const AirLevel& level : levels) {
      const double molecules = level.density() * level.share(table_.gases[gas]);
      const AxisPlace p = place_on(log_pressure_, std::log(std::max(level.pressure, 1e-30))),
                      t = place_on(table_.temperature, level.temperature);
      const auto at = [&](size_t dp, size_t dt, size_t g) {
        const size_t ip = std::min(p.i + dp, table_.pressure.size() - 1),
                     it = std::min(t.i + dt, table_.temperature.size() - 1);
        return static_cast<double>(table_.cross_section[table_.index(gas, band, ip, it) + g]);
      };
      for (size_t g = 0; g < table_.weight.size(); ++g) {
        const double k = mixed(mixed(at(0, 0, g), at(0, 1, g), t.s), mixed(at(1, 0, g), at(1, 1, g), t.s), p.s);
        out.absorption.push_back(static_cast<float>(k * molecules));
      }
    }
    return out;
  }
  GasPoints self_of_water(size_t band, std::span<const AirLevel> levels) const {
    GasPoints out;
    out.weight = {1.0};
    const size_t count = table_.temperature.size();
    for (const AirLevel& level : levels) {
      const AxisPlace t = place_on(table_.temperature, level.temperature);
      const double share = level.share(Gas::h2o), low = static_cast<double>(table_.water_self[band * count + t.i]),
                   high = static_cast<double>(table_.water_self[band * count + std::min(t.i + 1, count - 1)]);
      out.absorption.push_back(
          static_cast<float>(mixed(low, high, t.s) * share * level.pressure * share * level.density()));
    }
    return out;
  }

  GasTable table_;
  std::vector<double> log_pressure_;
};

void check_axis(const std::vector<double>& axis, const char* name, size_t least, size_t most, const Where& where) {
  if (axis.size() < least || axis.size() > most)
    throw Error(where, strf("%zu %s", axis.size(), name), strf("%zu to %zu of them", least, most));
  for (size_t i = 0; i < axis.size(); ++i)
    if (!(axis[i] > (i ? axis[i - 1] : 0) && axis[i] < kLargestNumber))
      throw Error(where, strf("%s number %zu is %g", name, i + 1, axis[i]), "positive and ascending");
}

}  // namespace

size_t GasTable::index(size_t gas, size_t band, size_t p, size_t t) const {
  return (((gas * bands() + band) * pressure.size() + p) * temperature.size() + t) * weight.size();
}

void check_gas_table(const GasTable& table, const Where& where) {
  check_axis(table.edges_cm, "edges of bands", 2, kTableBands + 1, where);
  check_axis(table.pressure, "pressures", 1, kTablePressures, where);
  check_axis(table.temperature, "temperatures", 1, kTableTemperatures, where);
  if (table.weight.empty() || table.weight.size() > kTablePoints)
    throw Error(where, strf("%zu g-points", table.weight.size()), strf("1 to %zu", kTablePoints));
  double sum = 0;
  for (const double w : table.weight) {
    if (!(w > 0)) throw Error(where, strf("a g-point of weight %g", w), "weights are positive");
    sum += w;
  }
  if (!(std::abs(sum - 1) < 1e-6)) throw Error(where, strf("weights of g-points sum to %g", sum), "their sum is 1");
  if (table.gases.empty() || table.gases.size() > kGases)
    throw Error(where, strf("%zu gases", table.gases.size()), "1 to 13");
  for (size_t g = 0; g < table.gases.size(); ++g)
    if (std::find(table.gases.begin(), table.gases.begin() + static_cast<std::ptrdiff_t>(g), table.gases[g]) !=
        table.gases.begin() + static_cast<std::ptrdiff_t>(g))
      throw Error(where, std::string(gas_name(table.gases[g])) + " twice", "each gas once");
  const size_t per_gas = table.bands() * table.pressure.size() * table.temperature.size() * table.weight.size();
  if (table.cross_section.size() != per_gas * table.gases.size())
    throw Error(where, strf("%zu cross sections", table.cross_section.size()),
                strf("%zu fit", per_gas * table.gases.size()));
  if (!table.water_self.empty() && table.water_self.size() != table.bands() * table.temperature.size())
    throw Error(where, strf("%zu values of water's self continuum", table.water_self.size()),
                strf("%zu fit", table.bands() * table.temperature.size()));
  for (const auto* values : {&table.cross_section, &table.water_self})
    for (const float k : *values)
      if (!(k >= 0 && k < 1e-10f))
        throw Error(where, strf("a cross section of %g m2", static_cast<double>(k)), "0 to 1e-10 m2");
}

std::unique_ptr<GasProvider> table_gases(GasTable table) {
  check_gas_table(table);
  return std::make_unique<TableGases>(std::move(table));
}

}  // namespace suite
