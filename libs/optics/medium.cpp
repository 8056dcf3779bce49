#include "optics/medium.h"

#include <algorithm>

#include "spectral/planck.h"

namespace suite {

void check_medium(Medium& m, const Where& where) {
  const std::string name = "medium '" + m.id + "': ";
  if (m.absorption.min() < 0)
    throw Error(where, name + strf("absorption %g", m.absorption.min()), "1/m, at least 0", "SP601");
  if (m.scattering.min() < 0)
    throw Error(where, name + strf("scattering %g", m.scattering.min()), "1/m, at least 0", "SP601");
  if (!(m.index.min() >= 1 && m.index.max() <= 5))
    throw Error(where, name + strf("index of refraction %g to %g", m.index.min(), m.index.max()), "1 to 5", "SP601");
  if (!(m.temperature_k >= 0 && m.temperature_k <= 1e5))
    throw Error(where, name + strf("temperature %g", m.temperature_k), "1 to 1e5 K", "SP601");
  if (!(m.scattering.max() > 0)) return;
  if (m.phase.model.empty()) m.phase = {"hg", {}, {{"g", Curve::constant(0)}}, {}, nullptr};
  check_phase(m.phase, where);
}

namespace {

std::vector<float> sample(const Medium& m, const Curve& curve, const SpectralState& state) {
  try {
    return state.sample(curve);
  } catch (const Error& e) {
    throw Error(e.where(), "medium '" + m.id + "': " + e.message(), e.hint(), e.code());
  }
}

}  // namespace

double group_index(const Curve& index, double wavelength_um) {
  constexpr double kStep = 0.01;
  const double n = index.at(wavelength_um);
  if (index.is_constant()) return n;
  double low = wavelength_um * (1 - kStep), high = wavelength_um * (1 + kStep);
  if (index.outside() == Outside::error) low = std::max(low, index.low_um()), high = std::min(high, index.high_um());
  if (!(high > low)) return n;
  return n - wavelength_um * (index.at(high) - index.at(low)) / (high - low);
}

BakedMedium::BakedMedium(const Medium& m, const SpectralState& state)
    : absorption(sample(m, m.absorption, state)),
      scattering(sample(m, m.scattering, state)),
      index_squared(sample(m, m.index, state)),
      group_index(suite::group_index(m.index, state.bins[state.reference_bin()].center_um())) {
  for (float& n : index_squared) n *= n;
  if (std::any_of(scattering.begin(), scattering.end(), [](float s) { return s > 0; }))
    phase = bake_phase(m.phase, state);
  if (!(m.temperature_k > 0)) return;
  for (size_t i = 0; i < state.size(); ++i) {
    const Bin& b = state.bins[i];
    const double mean = planck_band_radiance(b.low_um, b.high_um, m.temperature_k) / (b.high_um - b.low_um);
    blackbody.push_back(static_cast<float>(mean * index_squared[i]));
  }
  // Water at 25 C sends out 1e-13 W/(m2 sr um) at 1 um: flights need not ask how much of it arrives.
  constexpr float kDark = 1e-12f;
  if (std::all_of(blackbody.begin(), blackbody.end(), [](float b) { return b < kDark; })) blackbody.clear();
}

BakedMedium::BakedMedium(std::vector<float> absorbs, std::vector<float> scatters_, std::vector<float> emits,
                         std::unique_ptr<const PhaseFunction> how)
    : absorption(std::move(absorbs)),
      scattering(std::move(scatters_)),
      index_squared(absorption.size(), 1.0f),
      blackbody(std::move(emits)),
      phase(std::move(how)) {
  SUITE_CHECK(scattering.size() == absorption.size() && (blackbody.empty() || blackbody.size() == absorption.size()));
}

bool BakedMedium::uniform() const {
  return !phase || (phase->spectrally_uniform() && std::all_of(scattering.begin(), scattering.end(),
                                                               [&](float s) { return s == scattering.front(); }));
}

}  // namespace suite
