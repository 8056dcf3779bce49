#include "light/kinds/night_sky.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "light/environment.h"
#include "light/far_points.h"
#include "light/kinds/body.h"
#include "light/kinds/rows.h"
#include "light/kinds/sky.h"
#include "light/kinds/solar_spectrum.h"
#include "light/night/glow_shells.h"
#include "motion/ephemeris.h"
#include "motion/ut1.h"
#include "spectral/photopic.h"

namespace suite {

namespace {

// Baked for a state. Drawn from cells of the upper hemisphere by what they send in the mean of all bins.
class NightSky final : public Light {
 public:
  NightSky(std::shared_ptr<const NightMap> map, const SceneFrame& frame, std::shared_ptr<const FarPoints> points,
           const SpectralState& state)
      : map_(std::move(map)), points_(std::move(points)), shells_(frame, map_->layers()), bins_(state.size()) {
    for (const NightMap::Component& c : map_->components())
      for (const Bin& bin : state.bins)
        spectra_.push_back(static_cast<float>(c.spectrum.mean(bin.low_um, bin.high_um)));
    sky_.emplace(density());
    nature_.far = nature_.wide = nature_.above = true;
    nature_.drawn = sky_->tabulated();
  }

  std::optional<LightSample> sample(const LightReceiver&, const std::array<double, 4>& u, double) const override {
    if (!nature_.drawn) return std::nullopt;
    const DirectionSample drawn = sky_->draw({u[0], u[1]});
    LightSample s;
    s.direction = drawn.direction;
    s.density = drawn.density;
    s.scale = 1;
    return s;
  }
  std::optional<LightMet> met_outside(Dir d, double) const override {
    if (d.z < 0 || map_->components().empty()) return std::nullopt;
    return LightMet{1, nullptr, nature_.drawn ? sky_->density(d) : 0};
  }
  void add(Dir d, double, float scale, std::span<float> radiance) const override {
    add(d, scale, radiance, map_->components().size());
  }
  void add_without_points(Dir d, double, float scale, std::span<float> radiance) const override {
    add(d, scale, radiance, points_ ? map_->first_point() : map_->components().size());
  }
  bool is_below(Vec3 place) const override { return shells_.is_below(place); }
  void add_from_above(const RayFromAbove& ray, std::span<float> radiance) const override {
    const size_t n = map_->components().size(), first = map_->first_layer();
    std::array<double, kMost> near{}, behind{};
    const bool open = std::isinf(ray.length) && !shells_.meets_earth(ray.from, ray.direction);
    if (open) map_->weights_beyond(ray.direction, std::span(behind.data(), n));
    if (ray.points_apart && points_) std::fill(behind.begin() + map_->first_point(), behind.end(), 0.0);
    for (size_t i = 0; i < map_->layers().size(); ++i) {
      const GlowShells::Share share = shells_.share(i, ray.from, ray.direction, ray.length);
      near[first + i] = share.near;
      if (open || std::isfinite(ray.length)) behind[first + i] = share.far;
    }
    for (size_t c = 0; c < n; ++c) {
      if (near[c] == 0 && behind[c] == 0) continue;
      const float* spectrum = &spectra_[c * bins_];
      for (size_t i = 0; i < radiance.size(); ++i)
        radiance[i] +=
            spectrum[i] * static_cast<float>(near[c] + behind[c] * (ray.air.empty() ? 1.0 : double{ray.air[i]}));
    }
  }
  const FarPoints* points() const override { return points_.get(); }
  size_t members() const override { return 0; }
  std::optional<LightSample> sample_member(size_t, double, const LightReceiver&, const std::array<double, 4>&,
                                           double) const override {
    throw Bug("a night sky has no members");
  }

 private:
  static constexpr size_t kMost = 64;  // components

  // Of the first components.
  void add(Dir d, float scale, std::span<float> radiance, size_t count) const {
    std::array<double, kMost> memory;
    const std::span<double> w(memory.data(), map_->components().size());
    map_->weights(d, w);
    for (size_t c = 0; c < count; ++c) {
      if (w[c] == 0) continue;
      const float by = scale * static_cast<float>(w[c]);
      const float* spectrum = &spectra_[c * bins_];
      for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += by * spectrum[i];
    }
  }

  SkySpec density() const {
    const size_t n = map_->components().size();
    SUITE_CHECK(n <= kMost);
    const NightMap::Integrals whole = map_->integrals();
    // Each bin counts alike: a component with its shares of the bins' fluxes.
    std::vector<double> share(n, 0.0);
    for (size_t k = 0; k < bins_; ++k) {
      double flux = 0;
      for (size_t c = 0; c < n; ++c) flux += whole.sky[c] * static_cast<double>(spectra_[c * bins_ + k]);
      if (flux > 0)
        for (size_t c = 0; c < n; ++c) share[c] += static_cast<double>(spectra_[c * bins_ + k]) / flux;
    }
    SkySpec spec;
    spec.radiance = Curve::constant(1);
    spec.cells = true;
    spec.zeniths = 45, spec.azimuths = 90;
    std::vector<double> w(n);
    for (size_t r = 0; r < spec.zeniths; ++r)
      for (size_t c = 0; c < spec.azimuths; ++c) {
        double sum = 0;
        for (const double v : {0.25, 0.75})
          for (const double u : {0.25, 0.75}) {
            map_->weights(dir_from_angles((static_cast<double>(r) + v) / 45 * kPi / 2,
                                          (static_cast<double>(c) + u) / 90 * 2 * kPi),
                          w);
            sum += std::inner_product(w.begin(), w.end(), share.begin(), 0.0);
          }
        spec.table.push_back(std::max(0.0, sum));
      }
    // Nothing is left out that lies between the places that were looked at.
    const double mean =
        std::accumulate(spec.table.begin(), spec.table.end(), 0.0) / static_cast<double>(spec.table.size());
    for (double& v : spec.table) v += 0.02 * mean;
    return spec;
  }

  std::shared_ptr<const NightMap> map_;
  std::shared_ptr<const FarPoints> points_;  // null = they are spread, in views as well
  const GlowShells shells_;
  size_t bins_;
  std::vector<float> spectra_;  // [component][bin]
  std::optional<Sky> sky_;
};

// Spectra of directions, so that none is negative; each as bright as in the mean over a level plane, so that the parts
// compare with each other and with what the air and the ground emit.
LightSpectra spectra_of(const NightMap& map) {
  LightSpectra seen;
  std::vector<GlowSpectrum> all;
  std::vector<float> bright;
  const auto& components = map.components();
  const std::vector<double> plane = map.integrals().plane;
  for (size_t i = 0; i < components.size(); ++i) {
    const bool red = i == 1 && components[1].part == NightPart::zodiacal;
    const bool set = plane[i] <= 0;
    if (red || set) continue;
    seen.names.push_back(strf("the night sky, %s %zu", name_of(components[i].part).c_str(), i));
    all.push_back(components[i].spectrum);
    bright.push_back(static_cast<float>(std::max(0.0, plane[i]) / kPi));
  }
  seen.over = [all, bright](const SpectralState& s) {
    std::vector<std::vector<float>> rows;
    for (size_t i = 0; i < all.size(); ++i) {
      rows.emplace_back();
      for (const Bin& b : s.bins)
        rows.back().push_back(bright[i] * static_cast<float>(all[i].mean(b.low_um, b.high_um)));
    }
    return rows;
  };
  return seen;
}

class NightSkyLight final : public LightSpec {
 public:
  // A moment of it.
  struct Now {
    SceneFrame frame;
    JulianDate tt, ut1;
    double seconds;
    std::shared_ptr<const NightMap> map;
    std::vector<SeenPlanet> planets;
    std::vector<std::shared_ptr<const SunlitPoint>> satellites;
    bool media;                                    // in the scene: real air is then no field that knows it
    std::shared_ptr<const FarPoints> points = {};  // not before it has settled
    bool settled = false;
  };
  explicit NightSkyLight(NightSkyLightSpec spec, std::optional<Now> now = std::nullopt)
      : spec_(std::move(spec)), now_(std::move(now)) {}
  std::string key() const override { return "night_sky"; }
  const SourceTime* date() const override { return now_ ? nullptr : &spec_.time; }

  LightSpecPtr resolved(const LightMoment& at) const override {
    if (now_) return nullptr;
    const SceneFrame frame =
        spec_.place ? SceneFrame(*spec_.place) : frame_of(at.scene, spec_.time.where, "a night sky");
    const Instant epoch = instant_of(spec_.time), instant = epoch + at.seconds;
    const double dut1 = dut1_at(instant, epoch, at.dut1);
    Now now{frame, julian_tt(instant), julian_ut1(instant, dut1), at.seconds, nullptr, {}, {}, !at.scene.media.empty()};
    if (!spec_.satellites.empty()) {
      const Dir to_sun = sun_at(frame, {}, instant, dut1).direction;
      for (const SatelliteSpec& s : spec_.satellites)
        now.satellites.push_back(std::make_shared<const SunlitPoint>(
            orbit_track(s.orbit, frame, Clock(parse_iso8601(spec_.time.utc)), at.dut1), frame, to_sun,
            s.area * s.albedo));
    }
    const CelestialSphere sphere(frame, now.tt, now.ut1);
    now.planets = seen_planets(sphere, now.tt);
    now.map = std::make_shared<const NightMap>(spec_, sphere, now.planets);
    at.said.push_back(sentence_of(*now.map, instant));
    return std::make_shared<const NightSkyLight>(spec_, std::move(now));
  }

  // Air lifts the stars; it would dim a second time what cities make of it; where paths are scattered in it, nobody
  // knows what it leaves of one.
  void settle(SourceSpecs& all, size_t own, std::vector<std::string>& said) const override {
    if (now_->settled) return;
    if (!spec_.glows.empty() && all.has_air())
      throw Error(all.where_air(), "city_glow is the light of air itself, and the simulation's air would dim it again",
                  "leave out the air or city_glow; in traced air lamps make their own glow");
    Now now = *now_;
    now.settled = true;
    const bool traced = all.air && all.air->scattering == AirScattering::traced;
    const bool lit = all.air && all.air->scattering == AirScattering::diffuse && all.air->adjacency;
    if (all.has_air() && !traced && !lit)
      said.push_back(
          "night sky: the air dims it, and what it scatters of it is left out (real air with 'scattering: diffuse' and "
          "adjacency has it)");
    const bool points = spec_.in_view && ((spec_.catalogue && scale(NightPart::stars) > 0) ||
                                          scale(NightPart::planets) > 0 || !spec_.satellites.empty());
    if (points && (traced || now.media))
      said.push_back(
          "night sky: under `scattering: traced`, or with media in the scene, its stars and planets are spread over "
          "cells of 3 "
          "degrees, in views as well");
    if (points && !traced && !now.media)
      now.points =
          std::make_shared<const FarPoints>(points_of(CelestialSphere(now.frame, now.tt, now.ut1), air_of(all)));
    all.lights[own] = std::make_shared<const NightSkyLight>(spec_, std::move(now));
  }

  std::shared_ptr<const Light> bake(const Tracer&, const SpectralState& state) const override {
    SUITE_CHECK(now_);
    return std::make_shared<const NightSky>(now_->map, now_->frame, now_->points, state);
  }
  bool in_scene() const override { return false; }
  bool shines(double low_um, double high_um) const override { return high_um > kNightLow && low_um < kNightHigh; }
  void add_spectra(std::vector<LightSpectra>& to) const override {
    SUITE_CHECK(now_);
    to.push_back(spectra_of(*now_->map));
  }
  std::vector<std::string> hardly_met(double) const override { return {}; }

 private:
  static std::optional<SurfaceAir> air_of(const SourceSpecs& all) {
    if (!all.has_air()) return std::nullopt;
    SurfaceAir air;
    if (all.air) {
      const AirLevel level = all.air->profile.at(all.air->height_of_scene());
      air.pressure = level.pressure, air.temperature = level.temperature;
    } else if (all.atmosphere) {
      air.pressure = all.atmosphere->pressure * std::exp(-all.atmosphere->scene_height / 8000);
    }
    return air;
  }
  double scale(NightPart part) const { return spec_.scale[static_cast<size_t>(part)]; }
  FarPoints points_of(const CelestialSphere& sphere, const std::optional<SurfaceAir>& air) const {
    FarPoints all;
    if (air) all.air = std::make_shared<const StarRefraction>(now_->frame, *air);
    all.pole = sphere.pole();
    all.seconds = now_->seconds;
    all.scintillation = spec_.scintillation, all.height = now_->frame.origin().height_m;
    if (const double s = scale(NightPart::stars); spec_.catalogue && s > 0)
      for (const CatalogueStar& star : *spec_.catalogue)
        if (star.v <= spec_.faintest)
          all.points.push_back({star.name, star.v, s, star.kelvin, {}, true, {}, sphere.without_air(star.place)});
    if (const double s = scale(NightPart::planets); s > 0)
      for (const SeenPlanet& p : now_->planets)
        all.points.push_back({name_of(p.planet),
                              p.v,
                              s,
                              0,
                              std::make_shared<const Curve>(planet_shape(p.planet)),
                              false,
                              {},
                              sphere.without_air(p.place)});
    for (size_t i = 0; i < now_->satellites.size(); ++i) {
      const SunlitPoint& moving = *now_->satellites[i];
      const double share = moving.share(now_->seconds, {}) * solar_irradiance().mean(0.545, 0.555) / kVegaIrradiance;
      all.points.push_back({spec_.satellites[i].name,
                            share > 0 ? -2.5 * std::log10(share) : 99,
                            1,
                            0,
                            {},
                            true,
                            now_->satellites[i],
                            normalized(moving.at(now_->seconds))});
    }
    return all;
  }
  static std::string sentence_of(const NightMap& map, Instant instant) {
    const NightIlluminance lx = illuminance_of(map);
    const auto sum = [](const auto& parts) { return std::accumulate(parts.begin(), parts.end(), 0.0); };
    std::string by_part;
    for (size_t p = 0; p < kNightParts; ++p)
      if (lx.photopic[p] > 0)
        by_part +=
            strf("%s%s %.3g", by_part.empty() ? "" : ", ", name_of(static_cast<NightPart>(p)).c_str(), lx.photopic[p]);
    return strf("night sky at %s: %.3g lx on a level plane without the air (%s); scotopic %.3g lx",
                to_iso8601(utc_from_instant(instant)).c_str(), sum(lx.photopic), by_part.c_str(), sum(lx.scotopic));
  }

  const NightSkyLightSpec spec_;
  const std::optional<Now> now_;  // none = not resolved
};

}  // namespace

NightIlluminance illuminance_of(const NightMap& map) {
  NightIlluminance lx;
  const std::vector<double> plane = map.integrals().plane;
  for (size_t i = 0; i < plane.size(); ++i) {
    const NightMap::Component& c = map.components()[i];
    lx.photopic[static_cast<size_t>(c.part)] += plane[i] * c.spectrum.photopic();
    lx.scotopic[static_cast<size_t>(c.part)] += plane[i] * c.spectrum.scotopic();
  }
  return lx;
}

LightSpecPtr make_light(NightSkyLightSpec spec) { return std::make_shared<const NightSkyLight>(std::move(spec)); }

LightRow night_sky_row() {
  return {
      {"night_sky",
       "natural night sky by place and date: zodiacal light, airglow, starlight, 9096 stars, planets (0.3 to 2.5 um)",
       "W/(m2 sr um)", read_night_sky},
      false,
      "The sky by night. A sample of it at every node, with a visibility ray; zodiacal light, airglow and stars are "
      "looked up for each.",
      "night_sky: {time_utc: 2026-03-20T22:00:00Z, place: {latitude_deg: 49.4, longitude_deg: 8.7}}\n"};
}

}  // namespace suite
