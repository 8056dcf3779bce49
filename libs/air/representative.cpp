#include "air/representative.h"

#include <algorithm>
#include <cmath>

#include "air/axis.h"

namespace suite {

namespace {

size_t wavelengths(const RepresentativeGas& gas) {
  const size_t per = gas.offset.size() * gas.share.size() * gas.pressure.size();
  return per ? gas.cross_section.size() / per : 0;
}

// Cross section of a gas at a place of its table, linear in ln p, temperature and share.
double section(const RepresentativeGas& gas, const std::vector<double>& log_pressure, size_t place,
               const AirLevel& level) {
  const AxisPlace p = place_on(log_pressure, std::log(std::max(level.pressure, 1e-30))),
                  v = place_on(gas.share, level.share(gas.gas));
  double sum = 0;
  for (size_t dp = 0; dp < 2; ++dp) {
    const double wp = dp ? p.s : 1 - p.s;
    if (!(wp > 0)) continue;  // an axis of one has nothing beside it
    const AxisPlace t = place_on(gas.offset, level.temperature - gas.temperature[p.i + dp]);
    for (size_t dt = 0; dt < 2; ++dt)
      for (size_t dv = 0; dv < 2; ++dv) {
        const double w = (dt ? t.s : 1 - t.s) * (dv ? v.s : 1 - v.s);
        if (!(w > 0)) continue;
        const size_t row = ((t.i + dt) * gas.share.size() + v.i + dv) * wavelengths(gas) + place;
        sum += wp * w * static_cast<double>(gas.cross_section[row * gas.pressure.size() + p.i + dp]);
      }
  }
  return std::max(sum, 0.0);
}

class RepresentativeGases final : public GasProvider {
 public:
  explicit RepresentativeGases(RepresentativeTable table) : table_(std::move(table)) {
    for (const RepresentativeGas& gas : table_.gases) {
      std::vector<double>& logs = log_pressure_.emplace_back();
      for (const double p : gas.pressure) logs.push_back(std::log(p));
    }
  }
  double low_um() const override { return 1e4 / table_.bands.back().high_cm; }
  double high_um() const override { return 1e4 / table_.bands.front().low_cm; }
  std::string note() const override { return table_.source; }

  std::vector<Band> bands(double low_cm, double high_cm) const override {
    std::vector<Band> out;
    for (size_t i = 0; i < table_.bands.size(); ++i) {
      const double low = std::max(low_cm, table_.bands[i].low_cm), high = std::min(high_cm, table_.bands[i].high_cm);
      if (high > low) out.push_back({low, high, i});
    }
    return out;
  }

  std::vector<GasPoints> absorbers(const Band& band, std::span<const AirLevel> levels) const override {
    const auto& members = table_.bands[band.index].members;
    GasPoints out;
    for (const auto& m : members) out.weight.push_back(m.weight);
    for (const AirLevel& level : levels)
      for (const auto& m : members) {
        double k = 0;
        for (size_t g = 0; g < table_.gases.size(); ++g) {
          const RepresentativeGas& gas = table_.gases[g];
          const long place = gas.place[m.wavelength];
          const double molecules = level.density() * level.share(gas.gas);
          if (place >= 0 && molecules > 0)
            k += molecules * section(gas, log_pressure_[g], static_cast<size_t>(place), level);
        }
        out.absorption.push_back(static_cast<float>(k));
      }
    return {out};
  }

 private:
  RepresentativeTable table_;
  std::vector<std::vector<double>> log_pressure_;  // of each gas
};

void check_gas(const RepresentativeGas& gas, size_t members, const Where& where) {
  const std::string name(gas_name(gas.gas));
  const auto wrong = [&](const char* what) { return Error(where, name + ": " + what); };
  for (const auto* axis : {&gas.pressure, &gas.offset, &gas.share})
    for (size_t i = 0; i < axis->size(); ++i)
      if (!(std::abs((*axis)[i]) < kLargestNumber && (i == 0 || (*axis)[i] > (*axis)[i - 1])))
        throw wrong("pressures, temperatures and shares ascend");
  if (gas.pressure.empty() || gas.offset.empty() || gas.share.empty()) throw wrong("an axis is empty");
  if (!(gas.pressure.front() > 0)) throw wrong("pressures are positive");
  if (gas.temperature.size() != gas.pressure.size()) throw wrong("a temperature for each pressure is expected");
  for (const double t : gas.temperature)
    if (!(std::abs(t) < kLargestNumber)) throw wrong("a temperature is no number");
  if (wavelengths(gas) * gas.offset.size() * gas.share.size() * gas.pressure.size() != gas.cross_section.size())
    throw wrong("cross sections do not fit their axes");
  if (gas.place.size() < members) throw wrong("wavelengths are missing");
  for (const long p : gas.place)
    if (p >= static_cast<long>(wavelengths(gas))) throw wrong("a wavelength is outside the table");
  for (const float k : gas.cross_section)
    if (!(std::abs(k) < 1e-10f)) throw wrong("a cross section is above 1e-10 m2");
}

}  // namespace

void check_representative(const RepresentativeTable& table, const Where& where) {
  if (table.bands.empty()) throw Error(where, "a table without bands");
  size_t most = 0;
  for (size_t i = 0; i < table.bands.size(); ++i) {
    const auto& b = table.bands[i];
    if (!(b.low_cm > 0 && b.high_cm > b.low_cm && b.high_cm < kLargestNumber))
      throw Error(where, strf("band %zu from %g to %g cm-1", i + 1, b.low_cm, b.high_cm), "positive and ascending");
    if (i > 0 && !(std::abs(b.low_cm / table.bands[i - 1].high_cm - 1) < 1e-6))
      throw Error(
          where,
          strf("band %zu begins at %g cm-1, the one before ends at %g", i + 1, b.low_cm, table.bands[i - 1].high_cm),
          "bands follow each other");
    double sum = 0;
    for (const auto& m : b.members) {
      if (!(m.weight >= 0)) throw Error(where, strf("a weight of %g in band %zu", m.weight, i + 1), "0 or more");
      sum += m.weight, most = std::max(most, m.wavelength + 1);
    }
    if (!(std::abs(sum - 1) < 1e-3))
      throw Error(where, strf("weights of band %zu sum to %g", i + 1, sum), "their sum is 1");
  }
  for (const RepresentativeGas& gas : table.gases) check_gas(gas, most, where);
}

std::unique_ptr<GasProvider> representative_gases(RepresentativeTable table) {
  check_representative(table);
  return std::make_unique<RepresentativeGases>(std::move(table));
}

}  // namespace suite
