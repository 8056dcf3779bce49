// The keys of `night_sky`.
#include <algorithm>
#include <cmath>

#include "light/kinds/body.h"
#include "light/kinds/night_sky.h"
#include "light/kinds/rows.h"
#include "spectral/photopic.h"

namespace suite {

namespace {

void read_parts(const Params& p, NightSkySpec& sky) {
  std::vector<std::string> names;
  for (size_t i = 0; i < kNightParts; ++i) names.push_back(name_of(static_cast<NightPart>(i)));
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

void read_catalogue(const Params& p, const LightContext& context, NightSkySpec& sky) {
  const auto catalogue = p.find("catalogue");
  const std::string which = catalogue ? catalogue->as_text() : "builtin";
  if (which == "builtin") {
    sky.catalogue = {std::shared_ptr<void>(), &bright_star_catalogue()};
  } else if (which != "none") {
    sky.catalogue = std::make_shared<const std::vector<CatalogueStar>>(context.stars(*catalogue));
    sky.faintest = 40;
  }
}

CityGlow read_glow(const Params& p, const LightContext& context) {
  CityGlow glow;
  glow.azimuth = azimuth_from_compass_deg(p.number_in("azimuth_deg", -360, 360, "degrees, compass"));
  glow.width = p.number_in("width_deg", 1, 360, "degrees", 20) * kDegree;
  glow.height = p.number_in("height_deg", 1, 360, "degrees", 15) * kDegree;
  const Params given = p.at("spectrum");
  const Curve spectrum = context.positive(given, "spectrum", "any unit");
  if (!spectrum.covers(0.38, 0.78))
    throw given.error("the spectrum reaches from " + spectrum.range_text() + ", not from 0.38 to 0.78 um",
                      "give a longer curve, or declare 'outside: hold' or 'zero'");
  const double lumens = photopic(spectrum);
  if (!(lumens > 0)) throw given.error("has no light that the eye sees, by which a glow is given");
  const auto people = p.find("population");
  if (!people == !p.has("horizon_cd_m2")) throw p.error("a glow has either 'horizon_cd_m2' or 'population'");
  double luminance = 0;
  if (people) {
    luminance = walker_luminance(people->as_number_in(100, 1e8, "people"),
                                 p.at("distance_km").as_number_in(5, 100, "km, where Walker's law means something")) *
                std::exp(45 * kDegree / glow.height);
  } else {
    luminance = p.number_in("horizon_cd_m2", 0, 1e4, "cd/m2");
  }
  glow.horizon = spectrum.scaled(luminance / lumens);
  return glow;
}

void read_glows(const Params& p, const LightContext& context, NightSkySpec& sky) {
  constexpr size_t kMostGlows = 32;
  const auto list = p.find("city_glow");
  if (!list) return;
  for (const Params& one : list->items()) sky.glows.push_back(read_glow(one, context));
  if (sky.glows.size() > kMostGlows) throw list->error(strf("more than %zu glows", kMostGlows));
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

void read_satellites(const Params& p, const LightContext& context, NightSkyLightSpec& sky) {
  const auto list = p.find("satellites");
  if (!list) return;
  for (const Params& one : list->items()) {
    SatelliteSpec s;
    const OrbitElements elements = context.orbit(one);
    try {
      s.orbit = std::make_shared<const Sgp4>(elements);
    } catch (const Error& e) {
      throw one.error(e.message(), e.hint());
    }
    s.name = one.text("name", elements.satellite);
    if (s.name.find(',') != s.name.npos) throw one.at("name").error("a name with a comma breaks the table of stars");
    s.area = one.number_in("area_m2", 1e-6, 1e6, "m2", s.area);
    s.albedo = one.number_in("albedo", 0, 1, "(Bond)", s.albedo);
    sky.satellites.push_back(std::move(s));
  }
}

}  // namespace

LightSpecPtr read_night_sky(const Params& p, const LightContext& context) {
  NightSkyLightSpec sky;
  read_parts(p, sky);
  sky.time = time_of(p, context);
  if (const auto place = p.find("place")) {
    sky.place = Geodetic{place->number_in("latitude_deg", -90, 90, "degrees"),
                         place->number_in("longitude_deg", -180, 360, "degrees"),
                         place->number_in("height_m", -1000, 20000, "m above WGS84", 0)};
  }
  read_catalogue(p, context, sky);
  read_glows(p, context, sky);
  sky.faintest = p.number_in("stars_to_mag", -2, 40, "mag", sky.faintest);
  if (const auto resolve = p.find("resolve_stars")) sky.in_view = resolve->as_choice({"in_view", "none"}) == 0;
  read_satellites(p, context, sky);
  if (const auto twinkling = p.find("scintillation"))
    sky.scintillation = static_cast<uint64_t>(twinkling->integer("seed", 0, 1 << 30, 1));
  sky.solar_flux = p.number_in("solar_flux_sfu", 50, 400, "sfu", sky.solar_flux);
  return make_light(std::move(sky));
}

}  // namespace suite
