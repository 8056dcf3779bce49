#include "scheduler/seen_lights.h"

#include <algorithm>
#include <cmath>

#include "math/warps.h"
#include "spectral/planck.h"

namespace suite {

namespace {

using Rows = std::vector<std::vector<float>>;

// Also curves that are constant: what they multiply is seen.
void add_curve(std::string name, const Curve& curve, std::vector<SeenSpectra>& to) {
  if (!curve.value().empty())
    to.push_back(
        {SpectrumRole::light, {std::move(name)}, [&curve](const SpectralState& s) { return Rows{s.sample(curve)}; }});
}

// A sky with one table a wavelength: some directions of the table.
void add_tabulated(const SkySpec& sky, std::vector<SeenSpectra>& to) {
  constexpr size_t kDirections = 12;
  const size_t directions = sky.zeniths * sky.azimuths, step = std::max<size_t>(1, directions / kDirections);
  SeenSpectra seen{SpectrumRole::light, {}, {}};
  std::vector<Curve> shapes;
  for (size_t d = 0; d < directions; d += step) {
    std::vector<double> value;
    for (size_t c = 0; c < sky.wavelength_um.size(); ++c) value.push_back(sky.table.at(c * directions + d));
    if (*std::max_element(value.begin(), value.end()) <= 0) continue;
    seen.names.push_back(strf("the sky, direction %zu of its table", d));
    shapes.emplace_back(sky.wavelength_um, std::move(value), Outside::hold);
  }
  seen.over = [&sky, shapes](const SpectralState& s) {
    const std::vector<float> radiance = s.sample(sky.radiance);
    Rows rows;
    for (const Curve& shape : shapes) {
      rows.push_back(s.sample(shape));
      for (size_t i = 0; i < radiance.size(); ++i) rows.back()[i] *= radiance[i];
    }
    return rows;
  };
  to.push_back(std::move(seen));
}

// A thermal sky at some zenith angles.
void add_thermal(const SkySpec& sky, std::vector<SeenSpectra>& to) {
  constexpr size_t kZeniths = 6;  // the last at the horizon
  SeenSpectra seen{SpectrumRole::light, {}, {}};
  for (size_t i = 0; i < kZeniths; ++i) seen.names.push_back(strf("the sky at zenith angle %zu", 18 * i));
  seen.over = [&sky](const SpectralState& s) {
    SkySpec few = sky;
    few.zeniths = kZeniths;
    const Sky baked(few, s);
    Rows rows;
    for (size_t i = 0; i < kZeniths; ++i) {
      rows.emplace_back(s.size(), 0.0f);
      baked.add(dir_from_angles(std::min(kPi / 2 - 1e-9, 18 * static_cast<double>(i) * kDegree), 0), 1, rows.back());
    }
    return rows;
  };
  to.push_back(std::move(seen));
}

// Air along some paths: what it sends back, what it lets through, and the beams at the ground.
void add_air(const SourceSpecs& sources, std::vector<SeenSpectra>& to) {
  struct Way {
    const char* name;
    double height, zenith, length;  // m, rad, m
  };
  static constexpr double kHigh = 1e5, kLevel = kPi / 2 - 1e-3;
  static constexpr Way kWays[] = {{"down from space", kHigh, kPi, kHigh},
                                  {"down from space at 60 degrees", kHigh, kPi - kPi / 3, 2 * kHigh},
                                  {"down from 1 km", 1000, kPi, 1000},
                                  {"up from the ground", 0, 0, kHigh},
                                  {"up from the ground at 75 degrees", 0, 1.31, 4 * kHigh},
                                  {"along 2 km of level ground", 0, kLevel, 2000}};
  // Rows: what is sent back and what passes along each way, then the beams.
  const auto rows_of = [&sources](const SpectralState& s) {
    std::vector<Sun> bodies;
    if (sources.sun) bodies.emplace_back(*sources.sun, s);
    if (sources.moon) bodies.emplace_back(sources.moon->disk, s);
    std::vector<Beam> beams;
    for (const Sun& b : bodies) beams.push_back({b.direction(), b.irradiance()});
    const auto air = make_layered_atmosphere(*sources.atmosphere, s, std::move(beams));
    Rows back, through, direct;
    for (const Way& w : kWays) {
      back.emplace_back(s.size()), through.emplace_back(s.size());
      air->path({0, 0, w.height}, dir_from_angles(w.zenith, 0.5), w.length, through.back(), back.back());
    }
    for (const Sun& b : bodies) {
      direct.emplace_back(s.size());
      air->transmittance({0, 0, 0}, b.direction(), INFINITY, direct.back());
      for (size_t i = 0; i < s.size(); ++i) direct.back()[i] *= b.irradiance()[i];
    }
    return std::array<Rows, 3>{back, through, direct};
  };
  SeenSpectra light{SpectrumRole::light, {}, {}}, passes{SpectrumRole::passes, {}, {}};
  for (const Way& w : kWays) {
    light.names.push_back(std::string("the air ") + w.name);
    passes.names.push_back(std::string("the air ") + w.name);
  }
  if (sources.sun) light.names.push_back("the sun through the air");
  if (sources.moon) light.names.push_back("the moon through the air");
  light.over = [rows_of](const SpectralState& s) {
    auto [back, through, direct] = rows_of(s);
    std::move(direct.begin(), direct.end(), std::back_inserter(back));
    return back;
  };
  passes.over = [rows_of](const SpectralState& s) { return rows_of(s)[1]; };
  to.push_back(std::move(light));
  to.push_back(std::move(passes));
}

}  // namespace

std::vector<float> blackbody_means(std::span<const Bin> bins, double kelvin) {
  std::vector<float> v;
  for (const Bin& b : bins)
    v.push_back(static_cast<float>(planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um)));
  return v;
}

void add_lights(const SourceSpecs& sources, std::vector<SeenSpectra>& to) {
  if (sources.sun) add_curve("the sun", sources.sun->irradiance, to);
  if (sources.moon) add_curve("the moon", sources.moon->disk.irradiance, to);
  for (const LampSpec& lamp : sources.lamps)
    add_curve("lamp '" + lamp.name + "'", lamp.kind == LampSpec::Kind::surface ? lamp.radiance : lamp.intensity, to);
  if (sources.atmosphere) add_air(sources, to);
  if (!sources.sky) return;
  if (!sources.sky->layers.empty())
    add_thermal(*sources.sky, to);
  else if (sources.sky->table.empty() || sources.sky->wavelength_um.empty())
    add_curve("the sky", sources.sky->radiance, to);
  else
    add_tabulated(*sources.sky, to);
}

}  // namespace suite
