#include "light/night/airglow.h"

#include <algorithm>
#include <cmath>

#include "math/vec.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kHydroxyl[] = {
#include "light/night/airglow_oh.inc"
};
static_assert(std::size(kHydroxyl) == 2 * 210);

constexpr double kEarthRadius = 6371e3, kHydroxylHeight = 87e3;
constexpr double kTypicalFlux = 130;  // sfu

struct Line {
  double wavelength_um, rayleigh, height;
  bool by_sun;  // grows with solar activity
};
constexpr Line kLines[] = {
    {0.5577, 250, 97e3, true}, {0.5893, 60, 92e3, false}, {0.6300, 60, 270e3, true}, {0.6364, 20, 270e3, true}};

// A band of a number of rayleigh, given by relative photon rates at wavelengths.
Curve band(double rayleigh, const std::vector<double>& edges_um, const std::vector<double>& relative) {
  std::vector<double> x, y;
  double photons = 0;
  for (size_t i = 0; i + 1 < edges_um.size(); ++i) {
    const double width = edges_um[i + 1] - edges_um[i];
    photons += 0.5 * (relative[i] + relative[i + 1]) * width;
    // Photons carry 1 / wavelength: chords of a 20th of a piece.
    for (int k = i == 0 ? 0 : 1; k <= 20; ++k) {
      x.push_back(edges_um[i] + width * k / 20);
      y.push_back((relative[i] + (relative[i + 1] - relative[i]) * k / 20) * rayleigh_radiance(1, x.back()));
    }
  }
  return Curve(std::move(x), std::move(y), Outside::zero).scaled(rayleigh / photons);
}

}  // namespace

double van_rhijn(double sine, double height) {
  const double s = sine * kEarthRadius / (kEarthRadius + height);
  return 1 / std::sqrt(1 - s * s);
}

double rayleigh_radiance(double rayleigh, double wavelength_um) {
  return rayleigh * 1e10 / (4 * kPi) * kPlanckConstant * kSpeedOfLight / (wavelength_um * 1e-6);
}

std::vector<AirglowLayer> airglow_layers(double flux) {
  const auto growth = [](double f) { return std::max(0.0, 0.9 + 0.0011 * (f - 100)); };
  const double active = growth(flux) / growth(kTypicalFlux);
  std::vector<AirglowLayer> layers;
  const auto curve = [&](double height, Curve c) { layers.push_back({height, {std::move(c)}}); };
  curve(95e3, band(430 * active, {0.30, 0.38}, {1, 1}));                           // O2, Herzberg
  curve(92e3, band(3000 * 0.65 * active, {0.35, 0.40, 1.0, 1.05}, {0, 1, 1, 0}));  // NO2, FeO: continuum
  curve(94e3, band(1000, {0.8615, 0.8675}, {1, 1}));                               // O2 (0-1)
  curve(kHydroxylHeight, band(20e3, {0.6, 1.0}, {0, 1}));                          // OH below 1 um
  curve(kHydroxylHeight, band(80e3, {1.26, 1.28}, {1, 1}));                        // O2 (0-0)
  for (const Line& l : kLines)
    layers.push_back(
        {l.height,
         {Curve::constant(0),
          {{l.wavelength_um, rayleigh_radiance(l.by_sun ? l.rayleigh * active : l.rayleigh, l.wavelength_um)}}}});
  AirglowLayer hydroxyl{kHydroxylHeight, {}};
  for (size_t i = 0; i < std::size(kHydroxyl); i += 2)
    hydroxyl.spectrum.lines.push_back({kHydroxyl[i], rayleigh_radiance(1000 * kHydroxyl[i + 1], kHydroxyl[i])});
  layers.push_back(std::move(hydroxyl));
  return layers;
}

}  // namespace suite
