#include "air/particle_data.h"

#include <algorithm>
#include <cmath>

#include "air/particle_tables.h"
#include "air/phase_grid.h"
#include "base/error.h"

namespace suite {

namespace {

constexpr double kGreenUm = 0.55;  // um
constexpr double kNone = 1e-12;    // of what absorbs

double natural_log(double x) { return std::log(x); }

// Over the logarithm of the wavelength, of logarithms where there are any.
template <class Value>
double along(const std::vector<double>& wavelengths, double wavelength_um, const Value& value) {
  const Between at = between(wavelengths, wavelength_um, natural_log);
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

bool ParticleData::reaches_green() const {
  return wavelengths_um.front() <= kGreenUm && kGreenUm <= wavelengths_um.back();
}

std::optional<double> ParticleData::green() const {
  if (relative) return 1;
  if (!reaches_green()) return std::nullopt;
  return extinction_at(kGreenUm);
}

template <class Use>
void ParticleData::each_phase(double wavelength_um, const Use& use) const {
  const Between at = between(phase_um, wavelength_um, natural_log);
  for (const bool up : {false, true}) {
    const double share = up ? at.share : 1 - at.share;
    if (!(share > 0)) continue;
    const size_t i = at.low + (up ? 1 : 0);
    use(i, share * std::max(extinction_at(phase_um[i]) * albedo_at(phase_um[i]), kNone));
  }
}

std::vector<PlaneBlocks> ParticleData::matrices_at(double wavelength_um) const {
  std::vector<PlaneBlocks> mixed(phase_cosines().size(), PlaneBlocks{0, 0, 0, 0, 0, 0});
  each_phase(wavelength_um, [&](size_t i, double weight) {
    // Where nothing is scattered the matrix still is one.
    for (size_t c = 0; c < mixed.size(); ++c)
      mixed[c] = mixed[c] + matrices[i][c] * (weight * std::max(phase[i][c], kNone));
  });
  for (PlaneBlocks& m : mixed) m = m * (1 / m.a);
  return mixed;
}

ParticleOptics ParticleData::optics(std::span<const double> at_um) const {
  ParticleOptics out;
  std::vector<double> mixed(phase_cosines().size());
  for (const double w : at_um) {
    std::fill(mixed.begin(), mixed.end(), 0.0);
    each_phase(w, [&](size_t i, double weight) {
      for (size_t c = 0; c < mixed.size(); ++c) mixed[c] += weight * phase[i][c];
    });
    out.add(extinction_at(w), albedo_at(w), mixed);
  }
  if (!matrices.empty())
    out.know_matrices(
        [data = *this, all = std::vector(at_um.begin(), at_um.end())](size_t w) { return data.matrices_at(all[w]); });
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
