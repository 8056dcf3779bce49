#include "scheduler/seen_spectra.h"

#include <algorithm>
#include <cmath>

#include "optics/models.h"
#include "scheduler/seen_lights.h"
#include "spectral/planck.h"
#include "thermal/models.h"

namespace suite {

namespace {

double radiates(double flux) { return std::pow(flux / kStefanBoltzmann, 0.25); }  // W/m2 -> K

// The highest temperature that a simulated surface is given, or that its loads can hold it at; neighbours are not
// counted. K. What it absorbs leaves by radiation and to the air, and either alone is enough.
double hottest_of(const TemperatureSpec& spec) {
  constexpr double kMost = 1e4;  // that a slab may have
  double most = hottest_given(spec);
  const auto still = spec.numbers.find("convection_still_w_m2_k");
  for (const SurfaceLoad& load : spec.loads) {
    const double absorbed = load.sun_absorbed + inner_power(spec),
                 around = std::max(radiates(load.sky_irradiance), load.air_temperature);
    most = std::max(most, around);
    if (!(absorbed > 0)) continue;
    const double by_radiation = radiates(absorbed / emissivity_of(spec) + load.sky_irradiance),
                 by_air = still == spec.numbers.end() ? INFINITY : around + absorbed / still->second;
    most = std::max(most, std::min(by_radiation, by_air));
  }
  return std::min(most, kMost);
}

using Rows = std::vector<std::vector<float>>;

bool known_in(const Curve& curve, std::span<const Bin> bins) {
  return std::all_of(bins.begin(), bins.end(), [&](const Bin& b) { return curve.covers(b.low_um, b.high_um); });
}

bool only_factors(const ModelSpec& model) {
  return !model.bundle && std::all_of(model.curves.begin(), model.curves.end(), [](const auto& named) {
    return named.second.is_constant() || named.first == "reflectance" || named.first == "transmittance";
  });
}

class Gatherer {
 public:
  Gatherer(const Scene& scene, std::span<const Band> bands) : scene_(scene) {
    constexpr double kSamples = 200;
    double support = 0;
    for (const Bin& b : make_state(bands, 1).bins) support += b.high_um - b.low_um;
    coarse_ = make_state(bands, support / kSamples, 0, 1);
  }

  void materials() {
    for (const Material& m : scene_.materials) {
      for (const auto& [name, curve] : m.surface.curves) add_curve(SpectrumRole::scatters, name + " of " + m.id, curve);
      leaf(m);
      if (!m.surface.model.empty() && !only_factors(m.surface)) model(m);
    }
    for (const PropertyBinding& b : scene_.property_bindings) {
      const PropertyMap& map = scene_.property_maps[b.property_map];
      if (map.kind == MapKind::curve_index) family(map);
      if (map.kind == MapKind::cube && map.channels > 1) cube(map);
    }
  }

  void media() {
    for (const Medium& m : scene_.media) {
      if (!known_in(m.absorption, coarse_.bins) || !known_in(m.scattering, coarse_.bins)) continue;
      add_curve(SpectrumRole::scatters, "index of " + m.id, m.index);
      if (m.absorption.is_constant() && m.scattering.is_constant() && m.phase.curves.empty()) continue;
      depths(m);
      phase(m);
    }
  }

  // What warm surfaces and media emit.
  void temperatures(FoundHeat heat) {
    std::vector<double> kelvins;
    const auto ladder = [&](double low, double high) {
      constexpr int kSteps = 4;
      for (int i = 0; i <= kSteps; ++i) kelvins.push_back(low * std::pow(high / low, i / double{kSteps}));
    };
    for (const Material& m : scene_.materials)
      if (m.temperature_k > 0) kelvins.push_back(m.temperature_k);
    for (const Medium& m : scene_.media)
      if (m.temperature_k > 0) kelvins.push_back(m.temperature_k);
    for (const TemperatureBinding& t : scene_.temperatures) {
      if (t.spec.model == "constant")
        kelvins.push_back(t.spec.numbers.at("kelvin"));
      else if (!t.spec.kelvins.empty())
        ladder(*std::min_element(t.spec.kelvins.begin(), t.spec.kelvins.end()),
               *std::max_element(t.spec.kelvins.begin(), t.spec.kelvins.end()));
      else if (!t.spec.model.empty()) {
        ladder(200, kSimulatedBelow);
        const double hottest = std::max(hottest_of(t.spec), t.spec.loads.empty() ? heat.hottest : 0.0);
        if (hottest > kSimulatedBelow) ladder(kSimulatedBelow, hottest);
      }
    }
    const auto of_values = [&](const std::vector<float>& values) {
      float low = INFINITY, high = 0;
      for (const float v : values)
        if (v > 0) low = std::min(low, v), high = std::max(high, v);
      if (high > 0) ladder(double{low}, double{high});
    };
    for (const PropertyMap& map : scene_.property_maps)
      if (map.kind == MapKind::temperature) of_values(map.values);
    for (const VoxelGrid& grid : scene_.grids) of_values(grid.temperature);
    glow(kelvins);
    if (!kelvins.empty()) emissivities();
  }

  std::vector<SeenSpectra> found;

 private:
  void add_curve(SpectrumRole role, std::string name, const Curve& curve) {
    if (curve.value().empty() || curve.is_constant() || !known_in(curve, coarse_.bins)) return;
    found.push_back({role, {std::move(name)}, [curve](const SpectralState& s) { return Rows{s.sample(curve)}; }});
  }

  // Light is scattered among leaves by reflection and transmission together.
  void leaf(const Material& m) {
    const auto rho = m.surface.curves.find("reflectance"), tau = m.surface.curves.find("transmittance");
    if (rho == m.surface.curves.end() || tau == m.surface.curves.end() || !known_in(rho->second, coarse_.bins) ||
        !known_in(tau->second, coarse_.bins) || (rho->second.is_constant() && tau->second.is_constant()))
      return;
    found.push_back({SpectrumRole::scatters,
                     {"scattering of " + m.id},
                     [&r = rho->second, &t = tau->second](const SpectralState& s) {
                       std::vector<float> sum = s.sample(r);
                       const std::vector<float> more = s.sample(t);
                       for (size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
                       return Rows{std::move(sum)};
                     }});
  }

  // A table over the coarse bins as a curve.
  void add_table(SpectrumRole role, std::string name, std::vector<float> values) {
    for (float& v : values) v = std::isfinite(v) && v > 0 ? v : 0;
    if (*std::max_element(values.begin(), values.end()) <= 0) return;
    std::vector<double> um;
    for (const Bin& b : coarse_.bins) um.push_back(b.center_um());
    add_curve(role, std::move(name), Curve(um, {values.begin(), values.end()}, Outside::hold));
  }

  void model(const Material& m) {
    for (const auto& [name, curve] : m.surface.curves)
      if (!known_in(curve, coarse_.bins)) return;  // refused elsewhere where it is shown
    const std::unique_ptr<const ScatterModel> baked = bake(m.surface, coarse_);
    const Dir out = dir_from_angles(0.35, 0.3);
    std::vector<float> w(coarse_.size());
    for (const double zenith : {0.3, 1.2}) {
      baked->total(dir_from_angles(zenith, 0.3), w);
      add_table(SpectrumRole::scatters, "total of " + m.id, w);
    }
    for (const Dir in : {dir_from_angles(0.7, 0.3), dir_from_angles(0.7, 3.4), dir_from_angles(1.1, 1.9)}) {
      baked->eval(out, in, w);
      add_table(SpectrumRole::scatters, "scattering of " + m.id, w);
    }
  }

  void family(const PropertyMap& map) {
    constexpr size_t kMost = 64;
    const size_t step = std::max<size_t>(1, map.family.size() / kMost);
    for (size_t i = 0; i < map.family.size(); i += step)
      add_curve(SpectrumRole::scatters, strf("curve %zu of map '%s'", i, map.name.c_str()), map.family[i]);
  }

  // Some pixels, and the piece of a spectrum that every channel stands for.
  void cube(const PropertyMap& map) {
    constexpr size_t kPixels = 16;
    const size_t pixels = map.values.size() / map.channels, step = std::max<size_t>(1, pixels / kPixels);
    const Outside beyond = map.outside == Outside::error ? Outside::hold : map.outside;
    for (size_t p = 0; p < pixels; p += step)
      if (!std::isnan(map.values[p * map.channels]))
        add_curve(SpectrumRole::scatters, strf("pixel %zu of map '%s'", p, map.name.c_str()),
                  Curve(map.wavelength_um,
                        {map.values.begin() + static_cast<long>(p * map.channels),
                         map.values.begin() + static_cast<long>((p + 1) * map.channels)},
                        beyond));
    for (size_t c = 0; c < map.channels; ++c) {
      std::vector<double> hat(map.channels, 0.0);
      hat[c] = 1;
      add_curve(SpectrumRole::part, strf("channel %zu of map '%s'", c + 1, map.name.c_str()),
                Curve(map.wavelength_um, std::move(hat), beyond));
    }
  }

  // Transmittance over some optical depths, and the albedo of single scattering.
  void depths(const Medium& m) {
    static constexpr double kDepths[] = {0.1, 0.5, 2, 8};
    std::vector<float> sums = coarse_.sample(m.absorption);
    const std::vector<float> scattered = coarse_.sample(m.scattering);
    for (size_t i = 0; i < sums.size(); ++i) sums[i] += scattered[i];
    std::nth_element(sums.begin(), sums.begin() + static_cast<long>(sums.size() / 2), sums.end());
    const double median = double{sums[sums.size() / 2]};
    if (median <= 0) return;
    SeenSpectra passes{SpectrumRole::passes, {}, {}};
    for (const double d : kDepths) passes.names.push_back(strf("%g mean depths of ", d) + m.id);
    passes.over = [&m, median](const SpectralState& s) {
      const std::vector<float> a = s.sample(m.absorption), b = s.sample(m.scattering);
      Rows rows;
      for (const double d : kDepths) {
        rows.emplace_back();
        for (size_t i = 0; i < a.size(); ++i)
          rows.back().push_back(static_cast<float>(std::exp(-d / median * double{a[i] + b[i]})));
      }
      return rows;
    };
    found.push_back(std::move(passes));
    found.push_back({SpectrumRole::scatters, {"albedo of " + m.id}, [&m](const SpectralState& s) {
                       Rows rows{s.sample(m.scattering)};
                       const std::vector<float> a = s.sample(m.absorption);
                       for (size_t i = 0; i < a.size(); ++i)
                         if (rows[0][i] > 0) rows[0][i] /= rows[0][i] + a[i];
                       return rows;
                     }});
  }

  void phase(const Medium& m) {
    for (const auto& [name, curve] : m.phase.curves)
      if (!known_in(curve, coarse_.bins)) return;
    if (m.phase.model.empty()) return;
    const std::unique_ptr<const PhaseFunction> baked = bake_phase(m.phase, coarse_);
    if (baked->spectrally_uniform()) return;
    std::vector<float> p(coarse_.size());
    for (const double cosine : {-0.9, 0.0, 0.7, 0.98}) {
      baked->eval(cosine, p);
      add_table(SpectrumRole::scatters, "phase function of " + m.id, p);
    }
  }

  void glow(std::vector<double> kelvins) {
    constexpr size_t kMost = 16;
    std::sort(kelvins.begin(), kelvins.end());
    kelvins.erase(std::unique(kelvins.begin(), kelvins.end(), [](double a, double b) { return b - a < 0.5; }),
                  kelvins.end());
    for (const size_t step = kelvins.size() / kMost + 1; const double k : kelvins)
      if (const size_t i = static_cast<size_t>(&k - kelvins.data()); i % step == 0 || i + 1 == kelvins.size())
        found.push_back({SpectrumRole::glow, {strf("a blackbody of %.4g K", k)}, [k](const SpectralState& s) {
                           return Rows{blackbody_means(s.bins, k)};
                         }});
  }

  void emissivities() {
    for (const Material& m : scene_.materials) {
      const auto rho = m.surface.curves.find("reflectance");
      if (rho == m.surface.curves.end() || rho->second.is_constant() || !known_in(rho->second, coarse_.bins)) continue;
      const auto tau = m.surface.curves.find("transmittance");
      const Curve through = tau == m.surface.curves.end() ? Curve::constant(0) : tau->second;
      if (!known_in(through, coarse_.bins)) continue;
      found.push_back(
          {SpectrumRole::emitting, {"emissivity of " + m.id}, [&r = rho->second, through](const SpectralState& s) {
             Rows rows{s.sample(r)};
             const std::vector<float> t = s.sample(through);
             for (size_t i = 0; i < t.size(); ++i) rows[0][i] = std::max(0.0f, 1 - rows[0][i] - t[i]);
             return rows;
           }});
    }
  }

  const Scene& scene_;
  SpectralState coarse_;
};

}  // namespace

std::vector<SeenSpectra> spectra_of(const Scene& scene, std::span<const SourceSpecs> sources,
                                    std::span<const Band> bands, FoundHeat heat) {
  Gatherer g(scene, bands);
  for (const SourceSpecs& s : sources) add_lights(s, g.found);
  g.temperatures(heat);
  g.materials();
  g.media();
  return std::move(g.found);
}

}  // namespace suite
