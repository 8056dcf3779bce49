#include "air/particle_tables.h"

#include <algorithm>
#include <cmath>

#include "air/particles.h"
#include "air/phase_grid.h"
#include "base/error.h"

namespace suite {

namespace {

constexpr double kAerosolWavelengths[] = {
#include "air/tables/aerosols_wavelengths.inc"
};
constexpr double kAerosols[] = {
#include "air/tables/aerosols.inc"
};
constexpr short kAerosolPhase[] = {
#include "air/tables/aerosols_phase.inc"
};
constexpr double kDesert[] = {
#include "air/tables/desert.inc"
};
constexpr double kWaterWavelengths[] = {
#include "air/tables/water_bulk_wavelengths.inc"
};
constexpr double kWater[] = {
#include "air/tables/water_bulk.inc"
};
constexpr double kWaterPhaseWavelengths[] = {
#include "air/tables/water_phase_wavelengths.inc"
};
constexpr short kWaterPhase[] = {
#include "air/tables/water_phase.inc"
};
constexpr short kWaterMatrix[] = {
#include "air/tables/water_matrix.inc"
};
constexpr double kIceWavelengths[] = {
#include "air/tables/ice_wavelengths.inc"
};
constexpr double kIceRadii[] = {
#include "air/tables/ice_radii.inc"
};
constexpr double kIce[] = {
#include "air/tables/ice.inc"
};

constexpr double kHumidities[] = {0, 0.7, 0.8, 0.99}, kWinds[] = {0, 10, 20, 30}, kOnly[] = {0};
constexpr double kWaterRadii[] = {2, 3, 4.5, 6, 8, 10.5, 14, 18, 24, 32};  // as in the script
// In the order of the tables; the last has one state.
constexpr const char* kAerosolNames[] = {"rural", "maritime", "urban", "free_troposphere", "stratosphere"};
constexpr size_t kAngles = 133;
static_assert(std::size(kAerosolPhase) == 17 * std::size(kAerosolWavelengths) * kAngles);
static_assert(std::size(kWaterPhase) == std::size(kWaterRadii) * std::size(kWaterPhaseWavelengths) * kAngles);
static_assert(std::size(kWaterMatrix) == 3 * std::size(kWaterPhase));
static_assert(std::size(kWater) == 2 * std::size(kWaterRadii) * std::size(kWaterWavelengths));
static_assert(std::size(kIce) == 3 * std::size(kIceRadii) * std::size(kIceWavelengths));

// Rows of `columns` quantities a state, each over the wavelengths, from `values`.
void fill(ParticleTable& table, std::span<const double> values, size_t columns, bool relative) {
  const size_t n = table.wavelengths_um.size();
  for (size_t s = 0; s < table.states.size(); ++s)
    for (size_t w = 0; w < n; ++w) {
      const double extinction = values[(s * columns) * n + w], second = values[(s * columns + 1) * n + w];
      table.extinction.push_back(extinction);
      table.absorbed.push_back(relative ? second / extinction : second);
      if (columns == 3) table.asymmetry.push_back(values[(s * columns + 2) * n + w]);
    }
}

}  // namespace

Between between(std::span<const double> nodes, double x, double (*scale)(double)) {
  if (nodes.size() < 2) return {0, 0};
  const size_t above = static_cast<size_t>(std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin());
  const size_t i = std::clamp<size_t>(above, 1, nodes.size() - 1) - 1;
  const double a = scale(nodes[i]), b = scale(nodes[i + 1]);
  return {i, std::clamp((scale(x) - a) / (b - a), 0.0, 1.0)};
}

std::vector<double> ParticleTable::corner_phase(size_t entry) const {
  if (!asymmetry.empty()) return gridded_hg(asymmetry[entry]);
  double logs[kAngles];
  int sum = 0;
  for (size_t i = 0; i < kAngles; ++i) logs[i] = 1e-3 * (sum += phase[entry * kAngles + i]);
  return refined_phase(logs);
}

std::vector<PlaneBlocks> ParticleTable::corner_matrices(size_t entry) const {
  constexpr double kUnit = 1e-3;
  const short* differences = &matrix[entry * 3 * kAngles];
  std::vector<PlaneBlocks> stored(kAngles, PlaneBlocks::of(1, 0, 0, 0));
  for (double PlaneBlocks::*const of : {&PlaneBlocks::b, &PlaneBlocks::c, &PlaneBlocks::d}) {
    int sum = 0;
    for (PlaneBlocks& m : stored) m.*of = kUnit * (sum += *differences++);
  }
  return refined_matrices(stored);
}

// The four corners around a wavelength and a state.
template <class Use>
void ParticleTable::corners(std::span<const double> wavelengths, double wavelength_um, const Between& s,
                            const Use& use) const {
  const Between w = between(wavelengths, wavelength_um, [](double x) { return std::log(x); });
  for (const bool on : {false, true})
    for (const bool up : {false, true})
      if (const double share = (up ? w.share : 1 - w.share) * (on ? s.share : 1 - s.share); share > 0)
        use(share, (s.low + (on ? 1 : 0)) * wavelengths.size() + w.low + (up ? 1 : 0), s.low + (on ? 1 : 0),
            wavelengths[w.low + (up ? 1 : 0)]);
}

ParticleTable::Value ParticleTable::at(double wavelength_um, double state, double (*scale)(double)) const {
  const Between s = between(states, state, scale);
  double log_extinction = 0, log_absorbed = 0, scattered = 0;
  corners(wavelengths_um, wavelength_um, s, [&](double share, size_t entry, size_t, double) {
    log_extinction += share * std::log(extinction[entry]);
    log_absorbed += share * std::log(std::max(absorbed[entry], 1e-12));
  });
  Value value{std::exp(log_extinction), 1 - std::exp(log_absorbed), std::vector<double>(phase_cosines().size(), 0)};
  corners(phase_wavelengths_um, wavelength_um, s, [&](double share, size_t entry, size_t own_state, double own_um) {
    // Where nothing is scattered any function will do, but one.
    const double scattering = share * std::max(scattering_at(own_um, own_state), 1e-9);
    const std::vector<double> part = corner_phase(entry);
    for (size_t i = 0; i < part.size(); ++i) value.phase[i] += scattering * part[i];
    scattered += scattering;
  });
  for (double& p : value.phase) p /= scattered;
  return value;
}

std::vector<PlaneBlocks> ParticleTable::matrices(double wavelength_um, double state, double (*scale)(double)) const {
  std::vector<PlaneBlocks> sum(phase_cosines().size(), PlaneBlocks{0, 0, 0, 0, 0, 0});
  corners(phase_wavelengths_um, wavelength_um, between(states, state, scale),
          [&](double share, size_t entry, size_t own_state, double own_um) {
            const double scattering = share * std::max(scattering_at(own_um, own_state), 1e-9);
            const std::vector<double> part = corner_phase(entry);
            const std::vector<PlaneBlocks> own = corner_matrices(entry);
            for (size_t i = 0; i < sum.size(); ++i) sum[i] = sum[i] + own[i] * (scattering * part[i]);
          });
  for (PlaneBlocks& m : sum) m = m * (1 / m.a);
  return sum;
}

// By all particles of a state, interpolated over the wavelengths of the bulk.
double ParticleTable::scattering_at(double wavelength_um, size_t state) const {
  double sum = 0;
  corners(wavelengths_um, wavelength_um, {state, 0}, [&](double share, size_t entry, size_t, double) {
    sum += share * extinction[entry] * (1 - absorbed[entry]);
  });
  return sum;
}

ParticleTable aerosol_table(const std::string& name) {
  const size_t number = static_cast<size_t>(std::find(std::begin(kAerosolNames), std::end(kAerosolNames), name) -
                                            std::begin(kAerosolNames));
  SUITE_CHECK(number < std::size(kAerosolNames));
  ParticleTable table;
  table.wavelengths_um = table.phase_wavelengths_um = kAerosolWavelengths;
  const bool grows = number + 1 < std::size(kAerosolNames);
  table.states = grows ? std::span<const double>(kHumidities) : std::span<const double>(kOnly);
  const size_t first = number * std::size(kHumidities) * table.wavelengths_um.size();
  fill(table, std::span(kAerosols).subspan(2 * first), 2, true);
  table.phase = std::span(kAerosolPhase).subspan(first * kAngles);
  return table;
}

ParticleTable desert_table() {
  ParticleTable table;
  table.wavelengths_um = table.phase_wavelengths_um = kAerosolWavelengths;
  table.states = kWinds;
  fill(table, kDesert, 3, true);
  return table;
}

ParticleTable water_table() {
  ParticleTable table;
  table.wavelengths_um = kWaterWavelengths;
  table.phase_wavelengths_um = kWaterPhaseWavelengths;
  table.states = kWaterRadii;
  fill(table, kWater, 2, false);
  table.phase = kWaterPhase;
  table.matrix = kWaterMatrix;
  return table;
}

ParticleTable ice_table() {
  ParticleTable table;
  table.wavelengths_um = table.phase_wavelengths_um = kIceWavelengths;
  table.states = kIceRadii;
  fill(table, kIce, 3, false);
  return table;
}

}  // namespace suite
