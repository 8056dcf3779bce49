#include "scheduler/step_check.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {

struct Named {
  std::string name;
  std::vector<float> value;  // per bin
};

SpectralState halved(const SpectralState& state) {
  SpectralState fine = state;
  fine.bins.clear();
  for (const Bin& b : state.bins) {
    fine.bins.push_back({b.low_um, b.center_um()});
    fine.bins.push_back({b.center_um(), b.high_um});
  }
  for (size_t& k : fine.knots) k *= 2;
  return fine;
}

// Averages of what shines and of what scatters, over the bins of a state. Curves that do not cover them are refused
// elsewhere.
class Spectra {
 public:
  Spectra(const Scene& scene, const SourceSpecs& sources, const SpectralState& state) : state_(state) {
    if (sources.sun) add(lights, "the sun", sources.sun->irradiance);
    if (sources.sky) add(lights, "the sky", sources.sky->radiance);
    for (const LampSpec& lamp : sources.lamps)
      add(lights, "lamp '" + lamp.name + "'", lamp.kind == LampSpec::Kind::surface ? lamp.radiance : lamp.intensity);
    for (const Material& m : scene.materials) {
      for (const auto& [name, curve] : m.surface.curves) add(materials, name + " of " + m.id, curve);
      if (m.temperature_k > 0) lights.push_back({"warm " + m.id, blackbody(m.temperature_k)});
    }
  }
  std::vector<Named> lights, materials;

 private:
  void add(std::vector<Named>& to, std::string name, const Curve& curve) {
    if (curve.value().empty() || curve.is_constant() || !curve.covers(state_.low_um, state_.high_um)) return;
    to.push_back({std::move(name), state_.sample(curve)});
  }
  std::vector<float> blackbody(double kelvin) const {
    std::vector<float> v;
    for (const Bin& b : state_.bins)
      v.push_back(static_cast<float>(planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um)));
    return v;
  }
  const SpectralState& state_;
};

// Band values of each light alone and of each light on each material, one after the other.
struct Combinations {
  std::vector<std::string> names;
  std::vector<double> values;  // [combination][band]
};
Combinations combine(const Spectra& spectra, const BandProjection& projection, size_t bins) {
  Combinations all;
  std::vector<float> product(bins);
  const auto take = [&](std::string name) {
    all.names.push_back(std::move(name));
    all.values.resize(all.names.size() * projection.bands());
    projection.add(product, {&all.values[(all.names.size() - 1) * projection.bands()], projection.bands()});
  };
  const Named white{"white light", std::vector<float>(bins, 1.0f)};
  for (size_t l = 0; l <= spectra.lights.size(); ++l) {
    const Named& light = l < spectra.lights.size() ? spectra.lights[l] : white;
    product = light.value;
    take(light.name);
    for (const Named& m : spectra.materials) {
      for (size_t k = 0; k < bins; ++k) product[k] = light.value[k] * m.value[k];
      take(light.name + " on the " + m.name);
    }
  }
  return all;
}

// The largest relative change of a band from one state to another; what changed and where.
CoarseStep largest_change(const Combinations& coarse, const Combinations& fine, std::span<const Band> bands) {
  CoarseStep worst;
  for (size_t i = 0; i < fine.names.size() * bands.size(); ++i) {
    if (!(fine.values[i] > 0)) continue;
    const double change = std::fabs(coarse.values[i] / fine.values[i] - 1);
    if (change > worst.change)
      worst.change = change, worst.under = fine.names[i / bands.size()], worst.band = bands[i % bands.size()].name;
  }
  return worst;
}

}  // namespace

std::optional<CoarseStep> coarse_step(const Scene& scene, const SourceSpecs& sources, const Sensor& sensor) {
  constexpr int kMostHalvings = 10;
  constexpr size_t kMostBins = 1 << 16;
  std::optional<CoarseStep> worst;
  for (size_t s = 0; s < sensor.states().size(); ++s) {
    SpectralState state = sensor.states()[s];
    const std::span<const Band> bands = sensor.bands(s);
    double width = state.high_um;
    for (const Bin& b : state.bins) width = std::min(width, b.high_um - b.low_um);
    Combinations now = combine(Spectra(scene, sources, state), BandProjection(state, bands), state.size());
    std::optional<CoarseStep> found;
    for (int halvings = 0; halvings <= kMostHalvings && state.size() < kMostBins; ++halvings) {
      state = halved(state);
      Combinations next = combine(Spectra(scene, sources, state), BandProjection(state, bands), state.size());
      const CoarseStep change = largest_change(now, next, bands);
      if (!found) {
        if (change.change <= kStepLimit) break;
        found = change;
        found->bin_um = width;
      } else if (change.change <= kStepLimit) {
        found->halvings = halvings;
        break;
      }
      now = std::move(next);
    }
    if (found && (!worst || found->change > worst->change)) worst = found;
  }
  return worst;
}

}  // namespace suite
