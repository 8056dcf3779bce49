#include "air/particle_data.h"

#include <algorithm>
#include <cmath>

#include "air/particle_tables.h"
#include "air/phase_grid.h"
#include "base/error.h"

namespace suite {

namespace {

constexpr double kGreen = 0.55;  // um
constexpr double kNone = 1e-12;  // of what absorbs

double logarithm(double x) { return std::log(x); }

// Over the logarithm of the wavelength, of logarithms where there are any.
template <class Value>
double along(const std::vector<double>& wavelengths, double wavelength_um, const Value& value) {
  const Between at = between(wavelengths, wavelength_um, logarithm);
  if (!(at.share > 0)) return value(at.low);
  const double a = value(at.low), b = value(at.low + 1);
  return a > 0 && b > 0 ? a * std::pow(b / a, at.share) : a + at.share * (b - a);
}

}  // namespace

double ParticleData::extinction_at(double wavelength_um) const {
  return along(wavelengths_um, wavelength_um, [&](size_t i) { return extinction[i]; });
}

double ParticleData::albedo_at(double wavelength_um) const {
  return 1 - along(wavelengths_um, wavelength_um, [&](size_t i) { return std::max(1 - albedo[i], kNone); });
}

bool ParticleData::reaches_green() const { return wavelengths_um.front() <= kGreen && kGreen <= wavelengths_um.back(); }

std::optional<double> ParticleData::green() const {
  if (relative) return 1;
  if (!reaches_green()) return std::nullopt;
  return extinction_at(kGreen);
}

ParticleOptics ParticleData::optics(std::span<const double> at_um) const {
  ParticleOptics out;
  std::vector<double> scattering;
  for (const double w : phase_um) scattering.push_back(std::max(extinction_at(w) * albedo_at(w), kNone));
  std::vector<double> mixed(phase_cosines().size());
  for (const double w : at_um) {
    const Between at = between(phase_um, w, logarithm);
    std::fill(mixed.begin(), mixed.end(), 0.0);
    for (const bool up : {false, true}) {
      const double share = up ? at.share : 1 - at.share;
      if (!(share > 0)) continue;
      const size_t i = at.low + (up ? 1 : 0);
      for (size_t c = 0; c < mixed.size(); ++c) mixed[c] += share * scattering[i] * phase[i][c];
    }
    out.add(extinction_at(w), albedo_at(w), mixed);
  }
  return out;
}

ParticleData relative(ParticleData data) {
  const std::optional<double> green = data.green();
  if (!green || !(*green > 0))
    throw Error("particles '" + data.name + "': the extinction at 0.55 um is " + (green ? "0" : "not given"),
                "extinction_relative is over that, wherever its wavelengths lie");
  for (double& e : data.extinction) e /= *green;
  data.relative = true;
  return data;
}

}  // namespace suite
