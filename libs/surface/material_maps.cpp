#include "surface/material_maps.h"

#include <algorithm>
#include <cmath>

#include "surface/optics.h"

namespace suite {

namespace {

// Beyond the channels of a cube; where that is an error it has been refused.
Outside beyond(const PropertyMap& map) { return map.outside == Outside::zero ? Outside::zero : Outside::hold; }

// The share that one channel has in a curve that is linear between the channels.
Curve hat(const PropertyMap& map, size_t channel) {
  if (map.channels == 1) return Curve::constant(1);
  std::vector<double> value(map.channels, 0.0);
  value[channel] = 1;
  return Curve(map.wavelength_um, std::move(value), beyond(map));
}

// w of a few models for a few pairs of directions, on either side of the surface.
class Probe {
 public:
  Probe(const ScatterModel& low, const ScatterModel& middle, const ScatterModel& high, size_t bins) : bins_(bins) {
    const Dir out = dir_from_angles(0.5, 0.3);
    for (const ScatterModel* m : {&low, &middle, &high})
      for (const Dir in : {dir_from_angles(0.5, 0.3 + kPi), dir_from_angles(1.2, 0.3), dir_from_angles(0.8, 2),
                           dir_from_angles(2.4, 1)})
        m->eval(out, in, w_.emplace_back(bins));
  }
  // The middle is the mean of both ends.
  bool linear() const {
    for (size_t d = 0; d < kPairs; ++d)
      for (size_t i = 0; i < bins_; ++i) {
        const float ends = w_[d][i] + w_[2 * kPairs + d][i];
        if (!(std::fabs(0.5f * ends - w_[kPairs + d][i]) <= 1e-4f * ends + 1e-9f)) return false;
      }
    return true;
  }
  // The ratio of two bins is the same for all pairs and models: w(d) stands to w(first d) as it does elsewhere.
  bool one_shape() const {
    const std::vector<float>* high = &w_[2 * kPairs];
    for (size_t d = 1; d < kPairs; ++d) {
      const float ratio = high[0][0] > 0 ? high[d][0] / high[0][0] : 0;
      for (size_t m = 0; m < 3; ++m)
        for (size_t i = 0; i < bins_; ++i) {
          const float expected = ratio * w_[m * kPairs][i], got = w_[m * kPairs + d][i];
          if (!(std::fabs(got - expected) <= 1e-5f * expected + 1e-9f)) return false;
        }
    }
    return true;
  }

 private:
  static constexpr size_t kPairs = 4;
  size_t bins_;
  std::vector<std::vector<float>> w_;  // [model][pair], each with one value a bin
};

}  // namespace

BakedCube::BakedCube(const PropertyMap& map, const ModelSpec& model, const SpectralState& state) : map_(map) {
  const size_t channels = map.channels, bins = state.size();
  if (map.outside == Outside::error &&
      (state.low_um < map.wavelength_um.front() || state.high_um > map.wavelength_um.back()))
    throw Error(strf("map '%s' has channels from %g to %g um, %g to %g um are asked for", map.name.c_str(),
                     map.wavelength_um.front(), map.wavelength_um.back(), state.low_um, state.high_um),
                "declare 'outside: hold' or 'zero' in the map");
  std::vector<double> low(channels, INFINITY), high(channels, -INFINITY), middle;
  for (size_t i = 0; i < map.values.size(); ++i) {
    const double v = map.values[i];
    low[i % channels] = std::min(low[i % channels], v);
    high[i % channels] = std::max(high[i % channels], v);
  }
  for (size_t c = 0; c < channels; ++c) middle.push_back(0.5 * (low[c] + high[c]));
  ModelSpec spec = model;
  const auto with = [&](const std::vector<double>& value) {
    spec.curves[map.parameter] =
        channels == 1 ? Curve::constant(value[0]) : Curve(map.wavelength_um, value, beyond(map));
    lowest_ = state.sample(spec.curves[map.parameter]);
    return bake(spec, state);
  };
  high_ = with(high);
  range_ = lowest_;
  const std::unique_ptr<const ScatterModel> half = with(middle);
  low_ = with(low);
  for (size_t i = 0; i < bins; ++i) range_[i] -= lowest_[i];
  const Probe probe(*low_, *half, *high_, bins);
  one_shape_ = probe.one_shape();
  if (!probe.linear())
    throw Error("model '" + model.model + "' is not linear in '" + map.parameter + "', which map '" + map.name +
                    "' gives as spectra",
                "use a texture or curve index map, or a model such as lambert, oren_nayar, leaf or ward");
  std::vector<std::vector<Weight>> rows(bins);
  for (size_t c = 0; c < channels; ++c) {
    const Curve shape = hat(map, c);
    const double from = c == 0 ? 0 : map.wavelength_um[c - 1],
                 to = c + 1 >= channels ? INFINITY : map.wavelength_um[c + 1];
    for (size_t i = 0; i < bins; ++i)
      if (state.bins[i].high_um > from && state.bins[i].low_um < to)
        rows[i].push_back(
            {static_cast<uint32_t>(c), static_cast<float>(shape.mean(state.bins[i].low_um, state.bins[i].high_um))});
  }
  for (const auto& row : rows) {
    first_.push_back(static_cast<uint32_t>(weights_.size()));
    weights_.insert(weights_.end(), row.begin(), row.end());
  }
  first_.push_back(static_cast<uint32_t>(weights_.size()));
}

bool BakedCube::shares(const MapPlace& place, std::span<float> low, std::span<float> high) const {
  thread_local std::vector<float> channel;
  channel.resize(map_.channels);
  if (!values_at(map_, place, channel)) return false;
  for (size_t i = 0; i < high.size(); ++i) {
    float value = 0;
    for (uint32_t w = first_[i]; w < first_[i + 1]; ++w) value += weights_[w].weight * channel[weights_[w].channel];
    high[i] = range_[i] > 0 ? std::clamp((value - lowest_[i]) / range_[i], 0.0f, 1.0f) : 0.0f;
    low[i] = 1 - high[i];
  }
  return true;
}

namespace {

// Emissivities below this count as none where emission is polarised: they are what rounding leaves of 1 - W.
constexpr float kEmits = 1e-6f;

// Adds what one material is at a place, mixtures apart, to a mixture; `share` of all wavelengths.
void add_reflection(const BakedMaterial& m, const SpectralState& state, const MapPlace& place, float share,
                    LocalMaterial& memory, size_t& cubes) {
  if (m.maps && m.maps->curve_index)
    if (const auto index = value_at(*m.maps->curve_index, place))
      return memory.mixed.add(*m.maps->variants[static_cast<size_t>(*index)], share);
  if (m.maps && m.maps->cube) {
    for (size_t k = 0; k < 2; ++k) memory.spectra[2 * cubes + k].resize(state.size());
    std::vector<float>&low = memory.spectra[2 * cubes], &high = memory.spectra[2 * cubes + 1];
    if (m.maps->cube->shares(place, low, high)) {
      ++cubes;
      memory.mixed.add(m.maps->cube->low(), share, low);
      return memory.mixed.add(m.maps->cube->high(), share, high);
    }
  }
  memory.mixed.add(*m.model, share);
}

// Kelvin of a material at a place and time; 0 = does not emit.
double kelvin_of(const MaterialMaps& maps, const MapPlace& place, double time) {
  if (maps.temperature)
    if (const auto mapped = value_at(*maps.temperature, place)) return *mapped;
  if (!maps.field) return maps.constant_k;
  return maps.field->kelvin({place.position, place.normal, place.instance, place.triangle, maps.material}, time);
}

// Blackbody radiance of a material; returns its temperature, 0 when it does not emit.
double blackbody_of(const BakedMaterial& m, const MapPlace& place, double time, std::vector<float>& out, size_t bins) {
  if (!m.maps || !m.maps->blackbody) {
    out = m.blackbody;
    return m.kelvin;
  }
  const double kelvin = kelvin_of(*m.maps, place, time);
  out.resize(kelvin > 0 ? bins : 0);
  if (kelvin > 0) m.maps->blackbody->radiance(kelvin, out);
  return std::max(kelvin, 0.0);
}

// The blackbody radiance that, emitted with the emissivity of the whole, is what the parts emit: sum of shares times
// (1 - W) B over 1 - W of the mixture. True when the parts are not equally warm.
bool mix_emission(const MaterialMaps& maps, const SpectralState& state, const MapPlace& place, double time, Dir out,
                  LocalMaterial& memory, BakedMaterial& made) {
  const size_t n = state.size();
  std::vector<float>& sum = made.blackbody;
  sum.assign(n, 0.0f);
  memory.totals.resize(n);
  memory.glow.resize(maps.parts.size());
  double warm = 0, kelvin = 0;  // shares of the parts that emit, and their temperatures times shares
  double lowest = INFINITY, highest = 0;
  // A part's own variation counts for its emissivity too.
  for (size_t p = 0; p < maps.parts.size(); ++p) {
    if (!(memory.fractions[p] > 0)) continue;
    std::vector<float>& glow = memory.glow[p];
    const double part = blackbody_of(*maps.parts[p], place, time, glow, n);
    lowest = std::min(lowest, part), highest = std::max(highest, part);
    if (!(part > 0)) continue;
    warm += double{memory.fractions[p]}, kelvin += double{memory.fractions[p]} * part;
    LocalMaterial own;
    own.spectra.resize(2);
    own.mixed.reset(state.knots);
    size_t cubes = 0;
    add_reflection(*maps.parts[p], state, place, 1, own, cubes);
    own.mixed.total(out, memory.totals);
    for (size_t i = 0; i < n; ++i) {
      sum[i] += memory.fractions[p] * std::max(0.0f, 1 - memory.totals[i]) * glow[i];
      if (!(1 - memory.totals[i] > kEmits)) glow[i] = 0;
    }
  }
  if (!(warm > 0)) {
    sum.clear();
    return false;
  }
  made.kelvin = kelvin / warm;
  memory.mixed.total(out, memory.totals);
  for (size_t i = 0; i < n; ++i) sum[i] = memory.totals[i] < 1 ? sum[i] / (1 - memory.totals[i]) : 0.0f;
  return lowest < highest;
}

// What polarises the emission of a mixture of unequal temperatures: shares times B over that of the whole.
void weigh_by_glow(const SpectralState& state, std::span<const float> whole, LocalMaterial& memory) {
  memory.emitting.reset(state.knots);
  for (size_t p = 0; p < memory.fractions.size(); ++p) {
    std::vector<float>& glow = memory.glow[p];
    if (!(memory.fractions[p] > 0) || glow.empty()) continue;
    for (size_t i = 0; i < whole.size(); ++i) glow[i] = whole[i] > 0 ? glow[i] / whole[i] : 0.0f;
    memory.emitting.add(memory.mixed, p > 0 ? memory.ends[p - 1] : 0, memory.ends[p], glow);
  }
}

}  // namespace

const BakedMaterial* material_here(const BakedMaterial& base, const SpectralState& state, const MapPlace& place,
                                   double time, Dir out, LocalMaterial& memory, BakedMaterial& made) {
  const MaterialMaps& maps = *base.maps;
  if (!maps.varies()) return &base;
  size_t cubes = 0;
  made.model = base.model;
  made.emitting = nullptr;
  bool mixture = false;
  if (maps.mixture) {
    memory.fractions.resize(maps.parts.size());
    mixture = values_at(*maps.mixture, place, memory.fractions);
  }
  if (mixture) {
    memory.mixed.reset(state.knots);
    memory.spectra.resize(2 * maps.parts.size());
    memory.ends.resize(maps.parts.size());
    for (size_t p = 0; p < maps.parts.size(); ++p) {
      if (memory.fractions[p] > 0) add_reflection(*maps.parts[p], state, place, memory.fractions[p], memory, cubes);
      memory.ends[p] = memory.mixed.parts();
    }
    made.model = &memory.mixed;
  } else if (const auto index = maps.curve_index ? value_at(*maps.curve_index, place) : std::nullopt) {
    made.model = maps.variants[static_cast<size_t>(*index)].get();
  } else if (maps.cube) {
    memory.mixed.reset(state.knots);
    memory.spectra.resize(2);
    add_reflection(base, state, place, 1, memory, cubes);
    made.model = &memory.mixed;
  }
  made.kelvin = blackbody_of(base, place, time, made.blackbody, state.size());
  if (!(made.kelvin > 0) && mixture && mix_emission(maps, state, place, time, out, memory, made)) {
    weigh_by_glow(state, made.blackbody, memory);
    made.emitting = &memory.emitting;
  }
  return &made;
}

}  // namespace suite
