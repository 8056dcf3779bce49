#include "heat/heat_optics.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "light/kinds/solar_spectrum.h"
#include "optics/models.h"
#include "optics/stored_range.h"
#include "spectral/planck.h"

namespace suite {

namespace {

constexpr double kSunEdges[] = {0.28, 0.34, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70, 0.76,
                                0.84, 0.93, 1.05, 1.20, 1.40, 1.65, 2.00, 2.50, 4.00};
constexpr double kShortest = 2.5, kLongest = 500;  // um, of a body's light
constexpr size_t kGlowBins = 8;
constexpr double kWindowLow = 8, kWindowHigh = 14;  // um, whose mean is held beyond

double body_share(double low, double high) {
  return planck_band_radiance(low, high, kGlowKelvin) * kPi / (kStefanBoltzmann * std::pow(kGlowKelvin, 4));
}

double sun_share(double low, double high) {
  const Curve& sun = solar_irradiance();
  return sun.integral(low, high) / sun.integral(kSunEdges[0], std::end(kSunEdges)[-1]);
}

// The wavelength below which a share of the body's light lies.
double quantile(double share) {
  double low = kShortest, high = kLongest;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (body_share(kShortest, middle) < share * body_share(kShortest, kLongest) ? low : high) = middle;
  }
  return low;
}

SpectralState state_of(const std::vector<double>& edges, size_t knots) {
  SpectralState state;
  state.low_um = edges.front(), state.high_um = edges.back();
  for (size_t k = 0; k + 1 < edges.size(); ++k) state.bins.push_back({edges[k], edges[k + 1]});
  state.reference_um = state.bins[state.bins.size() / 2].center_um();
  place_knots(state, knots);
  return state;
}

// What of a spectrum's range lies where the curve has points.
struct Covered {
  double sunlight = 1, infrared = 1;
};

Covered covered(const Curve& curve) {
  if (curve.is_constant() || curve.outside() != Outside::error) return {};
  const auto part = [&](double low, double high, double (*share)(double, double)) {
    const double a = std::clamp(curve.low_um(), low, high), b = std::clamp(curve.high_um(), low, high);
    return b > a ? std::min(1.0, share(a, b) / share(low, high)) : 0;
  };
  return {part(kSunEdges[0], std::end(kSunEdges)[-1], sun_share), part(kShortest, kLongest, body_share)};
}

// The curve with what is held beyond its ends.
Curve extended(const Curve& curve) {
  if (curve.is_constant() || curve.outside() != Outside::error) return curve;
  std::vector<double> x = curve.wavelength_um(), y = curve.value();
  if (x.back() > kWindowLow && x.front() < kWindowHigh) {
    const double low = std::max(kWindowLow, x.front()), high = std::min(kWindowHigh, x.back());
    const double held = high > low ? curve.mean(low, high) : y.back();
    x.push_back(x.back() * (1 + 1e-9));
    y.push_back(held);
  }
  return Curve(x, y, Outside::hold);
}

ModelSpec lambert_of(double reflectance) {
  ModelSpec spec;
  spec.model = "lambert";
  spec.curves["reflectance"] = Curve::constant(reflectance);
  check_model(spec);
  return spec;
}

// A material's optics for one of both parts of the spectrum.
struct Reach {
  double sunlight = 1, infrared = 1;  // covered shares, the least of all curves
};

Reach reach_of(const Scene& scene, size_t index) {
  Reach reach;
  const auto look = [&](const Curve& curve) {
    const Covered c = covered(curve);
    reach.sunlight = std::min(reach.sunlight, c.sunlight), reach.infrared = std::min(reach.infrared, c.infrared);
  };
  const ModelSpec& model = scene.materials[index].surface;
  for (const auto& [name, curve] : model.curves) look(curve);
  if (model.bundle) {
    const StoredRange range = stored_range(model);
    if (range.outside == Outside::error)
      look(Curve({range.low_um, std::max(range.high_um, range.low_um * (1 + 1e-9))}, {0, 0}, Outside::error));
  }
  for (const PropertyBinding& b : scene.property_bindings) {
    if (b.material != index) continue;
    const PropertyMap& map = scene.property_maps[b.property_map];
    for (const Curve& curve : map.family) look(curve);
    if (map.kind == MapKind::cube && map.outside == Outside::error)
      look(Curve({map.wavelength_um.front(), map.wavelength_um.back() * (1 + 1e-9)}, {0, 0}, Outside::error));
  }
  return reach;
}

// Materials without geometry, as the balance sees them in one part of the spectrum.
class Extender {
 public:
  Extender(const Scene& scene, const std::vector<bool>& used, const HeatOptics& optics)
      : scene_(scene), used_(used), optics_(optics) {}

  std::shared_ptr<Scene> make(bool sunlight) {
    auto out = std::make_shared<Scene>();
    out->materials = scene_.materials;
    out->property_maps = scene_.property_maps;
    out->class_maps.resize(scene_.class_maps.size());
    for (PropertyMap& map : out->property_maps) {
      for (Curve& curve : map.family) curve = extended(curve);
      if (map.kind == MapKind::cube && map.outside == Outside::error) map.outside = Outside::hold;
    }
    for (size_t i = 0; i < out->materials.size(); ++i) {
      Material& m = out->materials[i];
      m.temperature_k = 0;
      m.inside = m.outside = Material::kNoMedium;
      if (!used_[i] || m.surface.model.empty()) continue;
      const Reach reach = reach_of(scene_, i);
      const std::optional<double> given = sunlight ? optics_.heated[i].absorptance : optics_.heated[i].emissivity;
      if ((sunlight ? reach.sunlight : reach.infrared) < kLeast) {
        if (!given)
          throw Error("material '" + m.id + "': its optics say nothing of " +
                          (sunlight ? "sunlight (0.28 to 4 um)" : "the thermal infrared (8 to 14 um)"),
                      std::string("give its temperature an '") + (sunlight ? "absorptance'" : "emissivity'") +
                          ", or curves that reach there");
        m.surface = lambert_of(1 - *given);
        plain_.push_back(static_cast<uint32_t>(i));
        continue;
      }
      for (auto& [name, curve] : m.surface.curves) curve = extended(curve);
      if (m.surface.bundle) m.surface.texts["outside"] = "hold";
    }
    for (const PropertyBinding& b : scene_.property_bindings)
      if (std::ranges::find(plain_, b.material) == plain_.end()) out->property_bindings.push_back(b);
    return out;
  }

 private:
  static constexpr double kLeast = 0.05;  // of the spectrum, for curves to say anything
  const Scene& scene_;
  const std::vector<bool>& used_;
  const HeatOptics& optics_;
  std::vector<uint32_t> plain_;
};

// Of the flat material, without maps.
double mean_emissivity(const Optics& glow, uint32_t material) {
  const ScatterModel& model = *glow.material(material).model;
  std::vector<float> W(glow.state().size());
  double sum = 0;
  constexpr int kDirections = 16;
  for (int k = 0; k < kDirections; ++k) {  // even in the square of the sine: as a body emits
    const double sine = std::sqrt((k + 0.5) / kDirections);
    model.total({sine, 0, std::sqrt(1 - sine * sine)}, W);
    for (const float w : W) sum += 1 - std::min(1.0f, w);
  }
  return sum / kDirections / static_cast<double>(W.size());
}

void check_emissivity(const Scene& scene, uint32_t material, const HeatOptics& optics,
                      const std::function<void(const std::string&)>& warn) {
  const std::optional<double>& given = optics.heated[material].emissivity;
  if (!given) return;
  const double own = mean_emissivity(*optics.glow, material), share = reach_of(scene, material).infrared;
  if (std::fabs(own - *given) <= 0.05) return;
  const std::string text = strf(
      "material '%s': its emissivity is given as %.3g, its optics have %.3g (curves cover %.0f %% "
      "of a body's light at 300 K)",
      scene.materials[material].id.c_str(), *given, own, 100 * share);
  if (share >= 0.8) throw Error(text, "leave one of them out");
  if (warn) warn(text + "; the optics' is used");
}

void refuse_parts(const Scene& scene, const HeatOptics& optics) {
  for (const PropertyBinding& b : scene.property_bindings) {
    const PropertyMap& map = scene.property_maps[b.property_map];
    if (map.kind != MapKind::mixture || optics.has_heat[b.material]) continue;
    for (const uint32_t part : map.materials)
      if (optics.has_heat[part])
        throw Error("material '" + scene.materials[b.material].id +
                        "' is a mixture without a heat of its own, of which '" + scene.materials[part].id + "' has one",
                    "give the mixture 'temperature: {model: heat, ...}': it has one temperature");
  }
}

}  // namespace

SpectralState sunlight_state() { return state_of(std::vector<double>(std::begin(kSunEdges), std::end(kSunEdges)), 4); }

SpectralState infrared_state() {
  std::vector<double> edges{kShortest};
  for (size_t k = 1; k < kGlowBins; ++k) edges.push_back(quantile(static_cast<double>(k) / kGlowBins));
  edges.push_back(kLongest);
  SpectralState state = state_of(edges, kGlowBins);
  // Every bin is a knot, in its order.
  state.knots.resize(kGlowBins);
  for (size_t k = 0; k < kGlowBins; ++k) state.knots[k] = k;
  state.reference_um = state.bins[0].center_um();
  return state;
}

HeatOptics heat_optics(const Scene& scene, const std::vector<bool>& used,
                       const std::function<void(const std::string&)>& warn) {
  HeatOptics out;
  out.heated.resize(scene.materials.size());
  out.has_heat.resize(scene.materials.size(), false);
  for (const TemperatureBinding& t : scene.temperatures) {
    if (t.spec.model != "heat") continue;
    out.heated[t.material] = heated_material(t.spec);
    out.has_heat[t.material] = true;
  }
  refuse_parts(scene, out);
  Extender extender(scene, used, out);
  const auto sun = extender.make(true);
  out.sun = std::make_unique<Optics>(*sun, sunlight_state(), used);
  out.materials = sun;
  Extender infrared(scene, used, out);
  const auto glow = infrared.make(false);
  out.glow = std::make_unique<Optics>(*glow, infrared_state(), used);
  out.infrared_materials = glow;
  for (uint32_t m = 0; m < scene.materials.size(); ++m) {
    if (!used[m] || scene.materials[m].surface.model.empty()) continue;
    const Reach reach = reach_of(scene, m);
    if (reach.sunlight < 1 - 1e-3 || reach.infrared < 1 - 1e-3)
      out.assumed.push_back({m, 1 - reach.sunlight, 1 - reach.infrared});
    if (out.has_heat[m]) check_emissivity(scene, m, out, warn);
  }
  return out;
}

}  // namespace suite
