// Absorption look-up tables (LUT): k over bands of wavenumber, pressure, temperature and g, and their provider.
#pragma once
#include <string>
#include <vector>

#include "air/gases.h"

namespace suite {

struct GasTable {
  std::string source;               // where the numbers come from and their stated error, a sentence
  std::vector<double> edges_cm;     // of the bands, ascending; one more than bands
  std::vector<double> pressure;     // Pa, ascending
  std::vector<double> temperature;  // K, ascending
  std::vector<double> weight;       // of the g-points; sum 1
  std::vector<Gas> gases;
  // m2/molecule: [gas][band][pressure][temperature][g]; of each the smallest k first. Between, ln k is linear in ln p
  // and T; outside, the nearest holds.
  std::vector<float> cross_section;
  // What water absorbs by itself (self continuum), m2/molecule for 1 Pa of water: [band][temperature]; or empty.
  std::vector<float> water_self;

  size_t bands() const { return edges_cm.size() - 1; }
  size_t index(size_t gas, size_t band, size_t p, size_t t) const;  // of the first g
};

inline constexpr size_t kTableBands = 200000, kTablePressures = 200, kTableTemperatures = 100, kTablePoints = 64;

// Error: what of a table does not fit, at `where`.
void check_gas_table(const GasTable& table, const Where& where = {});
// Error as check_gas_table.
std::unique_ptr<GasProvider> table_gases(GasTable table);

}  // namespace suite
