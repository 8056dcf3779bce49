#include "light/layer_optics.h"

#include <cmath>

#include "air/molecules.h"
#include "spectral/planck.h"

namespace suite {

namespace {

// Share of an exponential profile that lies between two heights.
double exponential_share(double low, double high, double bottom, double top, double scale) {
  const auto mass = [&](double z) { return -std::expm1(-(z - bottom) / scale); };
  return (mass(high) - mass(low)) / mass(top);
}

void bake_layer(const AtmosphereSpec& s, const SpectralState& state, size_t l, LayerOptics& to) {
  const double low = s.heights[l], high = s.heights[l + 1], bottom = s.heights.front(), top = s.heights.back(),
               thickness = high - low;
  // The weight of the air in a layer is the difference of the pressures at its bounds; the top layer carries the
  // rest.
  const double weight = standard_air(low).pressure - (l + 1 == to.layers ? 0 : standard_air(high).pressure);
  const double temperature =
      s.temperature_k.empty() ? standard_air(0.5 * (low + high)).temperature : s.temperature_k[l];
  for (size_t i = 0; i < to.bins; ++i) {
    const Bin& b = state.bins[i];
    const double w = b.center_um();
    const double rayleigh = s.rayleigh ? rayleigh_depth(w, weight * s.pressure / 101325) : 0;
    double aerosol = 0, absorbed = 0;
    if (const auto& a = s.aerosol) {
      const double depth =
          a->depth_550 * std::pow(w / 0.55, -a->angstrom) * exponential_share(low, high, bottom, top, a->scale_height);
      aerosol = depth * a->albedo.mean(b.low_um, b.high_um);
      absorbed = depth - aerosol;
    }
    for (const AtmosphereSpec::Gas& g : s.gases)
      absorbed += g.layers.empty()
                      ? g.column.mean(b.low_um, b.high_um) * exponential_share(low, high, bottom, top, g.scale_height)
                      : g.layers[l].mean(b.low_um, b.high_um);
    const double extinction = rayleigh + aerosol + absorbed;
    const size_t k = l * to.bins + i;
    to.extinction[k] = static_cast<float>(extinction / thickness);
    to.rayleigh[k] = static_cast<float>(rayleigh / thickness);
    to.aerosol[k] = static_cast<float>(aerosol / thickness);
    if (absorbed > 0)
      to.source[k] = static_cast<float>(absorbed / extinction * planck_band_radiance(b.low_um, b.high_um, temperature) /
                                        (b.high_um - b.low_um));
  }
}

}  // namespace

LayerOptics bake_layers(const AtmosphereSpec& spec, const SpectralState& state) {
  LayerOptics layers;
  layers.layers = spec.heights.size() - 1;
  layers.bins = state.size();
  const size_t n = layers.layers * layers.bins;
  layers.extinction.assign(n, 0), layers.rayleigh.assign(n, 0), layers.aerosol.assign(n, 0), layers.source.assign(n, 0);
  for (size_t l = 0; l < layers.layers; ++l) bake_layer(spec, state, l, layers);
  return layers;
}

}  // namespace suite
