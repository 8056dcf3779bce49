#include "air/particles.h"

#include <algorithm>
#include <cmath>

#include "air/particle_data.h"
#include "air/particle_tables.h"
#include "air/phase_grid.h"
#include "air/spheres.h"
#include "base/error.h"
#include "math/share.h"
#include "optics/phases/cosine_table.h"
#include "optics/phases/henyey_greenstein.h"

namespace suite {

namespace {

void check_value(const std::string& name, const char* what, const char* unit, double low, double high, double value) {
  check_range("particles '" + name + "'", {what, Parameter::Kind::number, unit, "", low, high}, value, {});
}

void check_wavelengths(const std::string& name, std::span<const double> wavelengths, double low, double high) {
  for (const double w : wavelengths)
    if (!(w >= low && w <= high))
      throw Error(strf("particles '%s': no table at %g um", name.c_str(), w), strf("%g .. %g um", low, high));
}

ParticleOptics from_table(const ParticleTable& table, double state, double (*scale)(double),
                          std::span<const double> wavelengths, double unit) {
  ParticleOptics optics;
  for (const double w : wavelengths) {
    const ParticleTable::Value value = table.at(w, state, scale);
    optics.add(value.extinction / unit, value.albedo, value.phase);
  }
  if (table.has_matrices())
    optics.know_matrices([table, state, scale, all = std::vector(wavelengths.begin(), wavelengths.end())](size_t w) {
      return table.matrices(all[w], state, scale);
    });
  return optics;
}

// Particles swell towards saturation as the logarithm of the dryness.
double dryness(double humidity) { return std::log(1 - humidity); }
double itself(double x) { return x; }
double logarithm(double x) { return std::log(x); }

constexpr double kGreen = 0.55;  // um, where visibility is defined

ParticleOptics aerosol(const ParticleSpec& spec, std::span<const double> wavelengths) {
  check_value(spec.name, "relative_humidity", "1", 0, 0.99, spec.relative_humidity);
  return from_table(aerosol_table(spec.name), spec.relative_humidity, dryness, wavelengths, 1);
}

ParticleOptics desert(const ParticleSpec& spec, std::span<const double> wavelengths) {
  check_value(spec.name, "wind", "m/s", 0, 30, spec.wind_m_s);
  const ParticleTable table = desert_table();
  return from_table(table, spec.wind_m_s, itself, wavelengths, table.at(kGreen, spec.wind_m_s, itself).extinction);
}

ParticleOptics cloud(const ParticleSpec& spec, std::span<const double> wavelengths, const ParticleTable& table) {
  check_value(spec.name, "effective_radius", "um", table.states.front(), table.states.back(), spec.effective_radius_um);
  return from_table(table, spec.effective_radius_um, logarithm, wavelengths, 1);
}

}  // namespace

std::span<const float> ParticleOptics::phase(size_t w) const {
  const size_t n = phase_cosines().size();
  SUITE_CHECK(w < size());
  return std::span(phase_).subspan(w * n, n);
}

std::vector<double> ParticleOptics::moments(size_t w, size_t count) const { return legendre_moments(phase(w), count); }

void ParticleOptics::add(double extinction, double albedo, std::span<const double> values) {
  SUITE_CHECK(values.size() == phase_cosines().size());
  if (!(extinction >= 0 && std::isfinite(extinction)))
    throw Error(strf("particles: the extinction %g is negative or not finite", extinction));
  albedo = as_share(albedo);
  if (!(albedo >= 0 && albedo <= 1)) throw Error(strf("particles: the albedo %g is outside 0 .. 1", albedo));
  for (const double p : values)
    if (!(p >= 0)) throw Error(strf("particles: the phase function has a value of %g", p), "values of at least 0");
  const std::span<const double> cosines = phase_cosines();
  const CosineTable table({cosines.begin(), cosines.end()}, {values.begin(), values.end()});
  if (!table.valid()) throw Error("particles: the phase function is all zero, or too large");
  const double whole = phase_integral(values);
  extinction_.push_back(extinction);
  albedo_.push_back(albedo);
  asymmetry_.push_back(table.asymmetry());
  for (const double p : values) phase_.push_back(static_cast<float>(p / whole));
}

const Registry<ParticleKind>& particle_kinds() {
  static const Registry<ParticleKind> table = [] {
    auto row = [](const char* name, const char* summary, bool is_aerosol, auto make) {
      const char* unit = is_aerosol ? "1" : "m2/kg";
      const double low = std::string(name) == "ice" ? 0.202 : 0.2;
      return ParticleKind{{name, summary, unit, make}, low, 40, is_aerosol};
    };
    auto water = [](const ParticleSpec& s, std::span<const double> w) { return cloud(s, w, water_table()); };
    auto ice = [](const ParticleSpec& s, std::span<const double> w) { return cloud(s, w, ice_table()); };
    return Registry<ParticleKind>(
        "kind of particles", "",
        {row("rural", "continental air far from towns (Shettle & Fenn 1979)", true, aerosol),
         row("maritime", "sea salt and continental background (Shettle & Fenn 1979)", true, aerosol),
         row("urban", "rural air with a fifth of soot (Shettle & Fenn 1979)", true, aerosol),
         row("free_troposphere", "above the boundary layer; very clear air (Shettle & Fenn 1979)", true, aerosol),
         row("stratosphere", "background of sulphuric acid (LOWTRAN 7)", true, aerosol),
         row("desert", "dust by wind speed (Longtin 1988); Henyey-Greenstein", true, desert),
         row("water", "drops of a cloud or fog by effective radius (Mie)", false, water),
         row("ice", "general habit mixture by effective radius (Baum 2014); Henyey-Greenstein", false, ice)});
  }();
  return table;
}

ParticleOptics particle_optics(const ParticleSpec& spec, std::span<const double> wavelengths) {
  if (spec.data) {
    const std::vector<double>& own = spec.data->wavelengths_um;
    check_wavelengths(spec.data->name, wavelengths, own.front(), own.back());
    return spec.data->optics(wavelengths);
  }
  if (spec.spheres) return sphere_optics(*spec.spheres, wavelengths);
  const ParticleKind& kind = particle_kinds().find(spec.name);
  check_wavelengths(spec.name, wavelengths, kind.low_um, kind.high_um);
  return kind.make(spec, wavelengths);
}

std::vector<double> gridded_phase(std::span<const double> angles, std::span<const double> values) {
  if (angles.size() < 2 || angles.size() != values.size())
    throw Error("phase function: a table of at least two angles, each with a value, is needed");
  if (!(angles.front() == 0 && std::abs(angles.back() - kPi) < 1e-9))
    throw Error("phase function: the table does not go from 0 to 180 degrees");
  std::vector<double> cosines(angles.size()), table(angles.size());
  for (size_t i = 0; i < angles.size(); ++i) {
    if (i > 0 && !(angles[i] > angles[i - 1]))
      throw Error(strf("phase function: the angle %g is not ascending", angles[i]));
    if (!(values[i] >= 0)) throw Error(strf("phase function: the value %g is negative", values[i]));
    cosines[angles.size() - 1 - i] = std::cos(angles[i]);
    table[angles.size() - 1 - i] = values[i];
  }
  cosines.front() = -1;
  const CosineTable read(std::move(cosines), std::move(table));
  if (!read.valid()) throw Error("phase function: the values are all zero, or too large");
  std::vector<double> gridded;
  for (const double c : phase_cosines()) gridded.push_back(read.at(c));
  return gridded;
}

std::vector<PlaneBlocks> gridded_matrices(std::span<const double> angles, std::span<const PlaneBlocks> over_first) {
  SUITE_CHECK(angles.size() == over_first.size() && angles.size() >= 2);
  std::vector<PlaneBlocks> gridded;
  size_t i = angles.size() - 1;  // the upper angle, going down: cosines ascend
  for (const double c : phase_cosines()) {
    while (i > 1 && std::cos(angles[i - 1]) < c) --i;
    const double low = std::cos(angles[i]), high = std::cos(angles[i - 1]);
    const double t = std::clamp((c - low) / (high - low), 0.0, 1.0);
    gridded.push_back(over_first[i] * (1 - t) + over_first[i - 1] * t);
  }
  return gridded;
}

std::vector<double> gridded_hg(double asymmetry) {
  if (!(std::abs(asymmetry) <= 0.99))
    throw Error(strf("phase function: the asymmetry %g is outside -0.99 .. 0.99", asymmetry));
  std::vector<double> gridded;
  for (const double c : phase_cosines()) gridded.push_back(hg_value(asymmetry, c));
  return gridded;
}

std::vector<double> gridded_moments(std::span<const double> moments) {
  std::vector<double> gridded;
  for (const double c : phase_cosines()) {
    double sum = 0, p = 1, before = 0;
    for (size_t l = 0; l < moments.size(); ++l) {
      const double n = static_cast<double>(l);
      sum += (2 * n + 1) / (4 * kPi) * moments[l] * p;
      const double next = ((2 * n + 1) * c * p - n * before) / (n + 1);
      before = p, p = next;
    }
    gridded.push_back(sum);
  }
  return gridded;
}

}  // namespace suite
