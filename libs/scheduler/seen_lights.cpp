#include "scheduler/seen_lights.h"

#include <algorithm>
#include <cmath>

#include "spectral/planck.h"

namespace suite {

namespace {

using Rows = std::vector<std::vector<float>>;

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
    Rows irradiance;
    std::vector<Beam> beams;
    for (const LightSpecPtr& light : sources.lights)
      if (light->disk()) irradiance.push_back(s.sample(light->disk()->irradiance));
    for (const LightSpecPtr& light : sources.lights)
      if (const FarDisk* d = light->disk())
        beams.push_back({normalized(d->direction), irradiance[beams.size()].data()});
    const auto air = make_layered_atmosphere(*sources.atmosphere, s, beams);
    Rows back, through, direct;
    for (const Way& w : kWays) {
      back.emplace_back(s.size()), through.emplace_back(s.size());
      air->path({0, 0, w.height}, dir_from_angles(w.zenith, 0.5), w.length, through.back(), back.back());
    }
    for (const Beam& b : beams) {
      direct.emplace_back(s.size());
      air->transmittance({0, 0, 0}, b.direction, INFINITY, direct.back());
      for (size_t i = 0; i < s.size(); ++i) direct.back()[i] *= b.irradiance[i];
    }
    return std::array<Rows, 3>{back, through, direct};
  };
  SeenSpectra light{SpectrumRole::light, {}, {}}, passes{SpectrumRole::passes, {}, {}};
  for (const Way& w : kWays) {
    light.names.push_back(std::string("the air ") + w.name);
    passes.names.push_back(std::string("the air ") + w.name);
  }
  for (const LightSpecPtr& body : sources.lights)
    if (body->disk()) light.names.push_back("the " + body->key() + " through the air");
  light.over = [rows_of](const SpectralState& s) {
    auto [back, through, direct] = rows_of(s);
    std::move(direct.begin(), direct.end(), std::back_inserter(back));
    return back;
  };
  passes.over = [rows_of](const SpectralState& s) { return rows_of(s)[1]; };
  to.push_back(std::move(light));
  to.push_back(std::move(passes));
}

// Tables of air at the corners of what their runs cover.
void add_tables(const std::shared_ptr<const TabledAirSpec>& air, std::vector<SeenSpectra>& to) {
  using Part = std::vector<TabledRow> TabledRows::*;
  const auto add = [&](SpectrumRole role, Part part) {
    SeenSpectra seen{role, {}, {}};
    // Which there are can be asked of any bin that the tables cover.
    const auto [low, high] = air->covered_um();
    SpectralState one;
    one.bins = {{low + 0.49 * (high - low), low + 0.51 * (high - low)}};
    TabledRows some = tabled_rows(*air, one);
    for (TabledRow& row : some.*part) seen.names.push_back(std::move(row.name));
    seen.over = [air, part](const SpectralState& s) {
      Rows rows;
      TabledRows all = tabled_rows(*air, s);
      for (TabledRow& row : all.*part) rows.push_back(std::move(row.means));
      return rows;
    };
    if (!seen.names.empty()) to.push_back(std::move(seen));
  };
  add(SpectrumRole::light, &TabledRows::light);
  add(SpectrumRole::passes, &TabledRows::passes);
}

}  // namespace

std::vector<float> blackbody_means(std::span<const Bin> bins, double kelvin) {
  std::vector<float> v;
  for (const Bin& b : bins)
    v.push_back(static_cast<float>(planck_band_radiance(b.low_um, b.high_um, kelvin) / (b.high_um - b.low_um)));
  return v;
}

void add_lights(const SourceSpecs& sources, std::vector<SeenSpectra>& to) {
  std::vector<LightSpectra> sent;
  for (const LightSpecPtr& light : sources.lights)
    if (!sources.air || light->disk()) light->add_spectra(sent);  // else AirPaths takes them through the air
  for (LightSpectra& s : sent) to.push_back({SpectrumRole::light, std::move(s.names), std::move(s.over)});
  if (sources.atmosphere) add_air(sources, to);
  if (sources.tabled) add_tables(sources.tabled, to);
}

}  // namespace suite
