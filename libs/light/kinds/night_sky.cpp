#include "light/kinds/night_sky.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "light/kinds/body.h"
#include "light/kinds/rows.h"
#include "light/kinds/sky.h"
#include "motion/ut1.h"

namespace suite {

namespace {

// Baked for a state. Drawn from cells of the upper hemisphere by what they send in the mean of all bins.
class NightSky final : public Light {
 public:
  NightSky(std::shared_ptr<const NightMap> map, const SpectralState& state)
      : map_(std::move(map)), bins_(state.size()) {
    for (const NightMap::Component& c : map_->components())
      for (const Bin& bin : state.bins)
        spectra_.push_back(static_cast<float>(c.spectrum.mean(bin.low_um, bin.high_um)));
    sky_.emplace(density());
    nature_.far = nature_.wide = true;
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
    std::array<double, kMost> memory;
    const std::span<double> w(memory.data(), map_->components().size());
    map_->weights(d, w);
    for (size_t c = 0; c < w.size(); ++c) {
      if (w[c] == 0) continue;
      const float by = scale * static_cast<float>(w[c]);
      const float* spectrum = &spectra_[c * bins_];
      for (size_t i = 0; i < radiance.size(); ++i) radiance[i] += by * spectrum[i];
    }
  }
  size_t members() const override { return 0; }
  std::optional<LightSample> sample_member(size_t, double, const LightReceiver&, const std::array<double, 4>&,
                                           double) const override {
    throw Bug("a night sky has no members");
  }

 private:
  static constexpr size_t kMost = 32;  // components

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
  size_t bins_;
  std::vector<float> spectra_;  // [component][bin]
  std::optional<Sky> sky_;
};

// Spectra of directions, so that none is negative.
LightSpectra spectra_of(const NightMap& map) {
  LightSpectra seen;
  std::vector<GlowSpectrum> all;
  const auto& components = map.components();
  for (size_t i = 0; i < components.size(); ++i) {
    const bool red = i == 1 && components[1].part == NightPart::zodiacal;
    if (red) continue;
    seen.names.push_back(strf("the night sky, %s %zu", name_of(components[i].part).c_str(), i));
    all.push_back(components[i].spectrum);
  }
  seen.over = [all](const SpectralState& s) {
    std::vector<std::vector<float>> rows;
    for (const GlowSpectrum& g : all) {
      rows.emplace_back();
      for (const Bin& b : s.bins) rows.back().push_back(static_cast<float>(g.mean(b.low_um, b.high_um)));
    }
    return rows;
  };
  return seen;
}

class NightSkyLight final : public LightSpec {
 public:
  explicit NightSkyLight(NightSkyLightSpec spec, std::shared_ptr<const NightMap> map = nullptr)
      : spec_(std::move(spec)), map_(std::move(map)) {}
  std::string key() const override { return "night_sky"; }
  const SourceTime* date() const override { return map_ ? nullptr : &spec_.time; }

  LightSpecPtr resolved(const LightMoment& at) const override {
    if (map_) return nullptr;
    const SceneFrame frame =
        spec_.place ? SceneFrame(*spec_.place) : frame_of(at.scene, spec_.time.where, "a night sky");
    const Instant epoch = instant_of(spec_.time), instant = epoch + at.seconds;
    const CelestialSphere sphere(frame, julian_tt(instant), julian_ut1(instant, dut1_at(instant, epoch, at.dut1)));
    auto map = std::make_shared<const NightMap>(spec_, sphere);
    at.said.push_back(sentence_of(*map, instant));
    return std::make_shared<const NightSkyLight>(spec_, std::move(map));
  }

  std::shared_ptr<const Light> bake(const Tracer&, const SpectralState& state) const override {
    SUITE_CHECK(map_);
    return std::make_shared<const NightSky>(map_, state);
  }
  bool in_scene() const override { return false; }
  bool shines(double low_um, double high_um) const override { return high_um > kNightLow && low_um < kNightHigh; }
  void add_spectra(std::vector<LightSpectra>& to) const override {
    SUITE_CHECK(map_);
    to.push_back(spectra_of(*map_));
  }
  std::vector<std::string> hardly_met(double) const override { return {}; }

 private:
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
  const std::shared_ptr<const NightMap> map_;  // null = not resolved
};

constexpr size_t kFirstPart = 0;

void read_parts(const Params& p, NightSkySpec& sky) {
  std::vector<std::string> names;
  for (size_t i = kFirstPart; i < kNightParts; ++i) names.push_back(name_of(static_cast<NightPart>(i)));
  if (const auto parts = p.find("parts")) {
    sky.scale.fill(0);
    for (const Params& one : parts->items()) {
      double& scale = sky.scale[one.as_choice(names)];
      if (scale > 0) throw one.error("the part '" + one.as_text() + "' is named twice", "name it once");
      scale = 1;
    }
    if (parts->items().empty()) throw parts->error("no part is named", "one or more of the parts, or no `parts`: all");
  }
  const auto scales = p.find("scale");
  if (!scales) return;
  for (const std::string& key : scales->keys()) {
    const auto at = std::find(names.begin(), names.end(), key);
    if (at == names.end())
      throw Error(scales->where(key), "the night sky has no part '" + key + "'", name_hint(key, names));
    sky.scale[static_cast<size_t>(at - names.begin())] *= scales->number_in(key, 0, 1e6, "(of the part's light)");
  }
}

SourceTime time_of(const Params& p, const LightContext& context) {
  if (const auto time = p.find("time_utc")) {
    SourceTime given{time->as_text(), time->where()};
    instant_of(given);
    return given;
  }
  if (context.date) return *context.date;
  throw p.error("a night sky needs a date", "give `epoch` to the simulation, or `time_utc` here");
}

LightSpecPtr read_night_sky(const Params& p, const LightContext& context) {
  NightSkyLightSpec sky;
  read_parts(p, sky);
  sky.time = time_of(p, context);
  if (const auto place = p.find("place")) {
    sky.place = Geodetic{place->number_in("latitude_deg", -90, 90, "degrees"),
                         place->number_in("longitude_deg", -180, 360, "degrees"),
                         place->number_in("height_m", -1000, 20000, "m above WGS84", 0)};
  }
  const auto catalogue = p.find("catalogue");
  if (!catalogue || catalogue->as_choice({"builtin", "none"}) == 0)
    sky.catalogue = {std::shared_ptr<void>(), &bright_star_catalogue()};
  sky.faintest = p.number_in("stars_to_mag", -2, 20, "mag", sky.faintest);
  sky.solar_flux = p.number_in("solar_flux_sfu", 50, 400, "sfu", sky.solar_flux);
  return make_light(std::move(sky));
}

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
       "natural night sky by place and date: zodiacal light, airglow, starlight, 9096 stars (0.3 to 2.5 um)",
       "W/(m2 sr um)", read_night_sky},
      false,
      "The sky by night. A sample of it at every node, with a visibility ray; zodiacal light, airglow and stars are "
      "looked up for each.",
      "night_sky: {time_utc: 2026-03-20T22:00:00Z, place: {latitude_deg: 49.4, longitude_deg: 8.7}}\n"};
}

}  // namespace suite
