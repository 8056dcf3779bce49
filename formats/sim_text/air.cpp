#include "formats/sim_text/air.h"

#include "air/lowtran.h"
#include "air/spheres.h"
#include "base/files.h"
#include "formats/air_table/air_table.h"
#include "formats/hitran/hitran.h"
#include "formats/particles/particles.h"
#include "formats/profile/profile.h"
#include "formats/reptran/reptran.h"

namespace suite {

namespace {

std::vector<std::string> names_of(std::span<const std::string_view> names) { return {names.begin(), names.end()}; }

// Makes something of what p says; what is wrong with it is told there.
template <class Make>
auto located(const Params& p, const Make& make) {
  try {
    return make();
  } catch (const Error& e) {
    throw e.where().file.empty() ? p.error(e.message(), e.hint()) : e;
  }
}

AirProfile read_the_profile(const Params& p, std::vector<std::string>& notes) {
  const std::string name = p.as_text();
  const std::vector<std::string> known = names_of(standard_profiles());
  if (std::find(known.begin(), known.end(), name) != known.end()) return standard_profile(name);
  const std::string path = p.as_path();
  if (!file_exists(path)) {
    const std::string near = name_hint(name, known);
    throw p.error("there is neither a standard profile nor a file '" + name + "'", near);
  }
  ReadProfile read = read_profile(path);
  for (const std::string& sentence : read.notes) notes.push_back(path + ": " + sentence);
  return std::move(read.profile);
}

AirProfile read_scaled(const Params& p, std::vector<std::string>& notes) {
  ProfileScaling scaling;
  const auto optional = [&](const char* key, double high, const char* unit) -> std::optional<double> {
    if (!p.has(key)) return std::nullopt;
    return p.number_in(key, 0, high, unit);
  };
  scaling.water = optional("water_kg_m2", 200, "kg/m2");
  scaling.ozone = optional("ozone_du", 2000, "Dobson units");
  scaling.surface_pressure = optional("pressure_pa", 200000, "Pa at the lowest level");
  if (const auto shares = p.find("ppm"))
    for (const std::string& gas : shares->keys()) {
      const auto which = gas_of(gas);
      if (!which) {
        std::vector<std::string> known;
        for (int g = 0; g < kGases; ++g) known.emplace_back(gas_name(static_cast<Gas>(g)));
        throw shares->at(gas).error("unknown gas '" + gas + "'", name_hint(gas, known));
      }
      scaling.at_ground[static_cast<size_t>(*which)] = 1e-6 * shares->number_in(gas, 0, 1e6, "ppm at the lowest level");
    }
  const AirProfile profile = read_the_profile(p.at("profile"), notes);
  return located(p, [&] { return scaled(profile, scaling); });
}

std::string file_of(const Params& p, const char* otherwise) {
  const std::string path = p.as_path();
  if (!file_exists(path)) throw p.error("there is no file '" + path + "'", otherwise);
  return path;
}

// By name, a table of ours, or one of REPTRAN's (.cdf).
std::shared_ptr<const GasProvider> read_gases(const Params& p, std::vector<std::string>& notes) {
  const auto continuum = p.find("water_continuum");
  const auto gases = p.find("gases");
  const std::string name = gases ? gases->as_text() : "builtin";
  if (continuum && name != "builtin") throw continuum->error("a continuum of water goes with `gases: builtin`");
  if (name == "none") return nullptr;
  if (name == "builtin")
    return continuum ? builtin_gases(read_water_continuum(file_of(*continuum, "a CSV (formats/hitran)")))
                     : shared_builtin_gases();
  if (name == "lowtran") return {std::shared_ptr<void>(), &lowtran_gases()};
  const std::string path = file_of(*gases, "builtin, lowtran, none, or a file of formats/air_table or formats/reptran");
  if (!path.ends_with(".cdf")) return table_gases(read_air_table(path));
  ReadReptran read = read_reptran(path);
  for (const std::string& sentence : read.notes) notes.push_back(path + ": " + sentence);
  return representative_gases(std::move(read.table));
}

// A user's own; of an aerosol the extinction over that at 0.55 um.
std::shared_ptr<const ParticleData> read_optics(const Params& p, bool aerosol, std::vector<std::string>& notes) {
  const std::string path = file_of(p, "a file of formats/particles");
  ReadParticles read = read_particles(path);
  for (const std::string& sentence : read.notes) notes.push_back(path + ": " + sentence);
  return located(p, [&] {
    return std::make_shared<const ParticleData>(aerosol ? relative(std::move(read.data)) : std::move(read.data));
  });
}

SizeDistribution read_sizes(const Params& p) {
  constexpr double kLeast = 1e-4, kMost = 1e4;  // um
  const auto um = [&](const char* key) { return p.number_in(key, kLeast, kMost, "um"); };
  switch (p.at("sizes").as_choice({"log_normal", "gamma", "modified_gamma", "junge"})) {
    case 0:
      return SizeDistribution::log_normal(um("median_radius_um"), p.number("sigma"));
    case 1:
      return SizeDistribution::gamma(um("effective_radius_um"), p.number("effective_variance"));
    case 2:
      return SizeDistribution::modified_gamma(p.number("shape"), p.number("slope"), p.number("power", 1));
    default:
      return SizeDistribution::junge(p.number("exponent"), um("least_radius_um"), um("largest_radius_um"));
  }
}

std::shared_ptr<const SphereSpec> read_spheres(const Params& p, bool aerosol, const LightContext& context) {
  const auto k = p.find("k");
  SphereSpec spheres{located(p, [&] { return read_sizes(p); }), context.positive(p.at("n"), "n", "1"),
                     k ? context.positive(*k, "k", "1") : Curve::constant(0), 0, p.text("name", "spheres")};
  if (!aerosol) spheres.density = p.number_in("density_kg_m3", 1, 3e4, "kg/m3", 1000);
  return std::make_shared<const SphereSpec>(std::move(spheres));
}

ParticleSpec read_kind(const Params& p, const char* key, bool aerosol, const LightContext& context,
                       std::vector<std::string>& notes) {
  ParticleSpec spec;
  if (const auto spheres = p.find("spheres")) {
    for (const char* other : {"optics", key})
      if (p.has(other)) throw spheres->error(strf("both `spheres` and `%s`", other), "drop one of the two");
    spec.spheres = read_spheres(*spheres, aerosol, context);
    return spec;
  }
  if (const auto optics = p.find("optics")) {
    if (p.has(key)) throw optics->error(strf("both `optics` and `%s`", key), "drop one of the two");
    spec.data = read_optics(*optics, aerosol, notes);
    return spec;
  }
  std::vector<std::string> known;
  for (const ParticleKind& kind : particle_kinds())
    if (kind.aerosol == aerosol) known.push_back(kind.name);
  spec.name = known[p.at(key).as_choice(known)];
  // Each only where it changes anything; elsewhere the key is left unread and refused.
  if (spec.name == "desert")
    spec.wind_m_s = p.number_in("wind_m_s", 0, 30, "m/s", spec.wind_m_s);
  else if (aerosol && spec.name != "stratosphere")
    spec.relative_humidity = p.number_in("relative_humidity", 0, 0.99, "", spec.relative_humidity);
  if (!aerosol) spec.effective_radius_um = p.number_in("effective_radius_um", 1, 100, "um", spec.effective_radius_um);
  const double middle[] = {0.55};
  located(p, [&] { particle_optics(spec, middle); });
  return spec;
}

AirSpec::Aerosol read_aerosol(const Params& p, const LightContext& context, std::vector<std::string>& notes) {
  AirSpec::Aerosol a;
  a.boundary = read_kind(p, "model", true, context, notes);
  const auto depth = p.find("optical_depth_550");
  if (depth && p.has("visibility_km"))
    throw depth->error("both a depth and a visibility are given", "drop one of the two");
  if (const auto scale = p.find("scale_height_m")) {
    if (!depth) throw scale->error("a scale height goes with `optical_depth_550`");
    a.profile = AerosolProfile::exponential(depth->as_number_in(0, 100, ""), scale->as_number_in(1, 1e5, "m"));
    a.one_kind = true;
    return a;
  }
  using Season = AerosolProfile::Season;
  Season season = Season::spring_summer;
  if (const auto given = p.find("season"))
    season = given->as_choice({"spring_summer", "fall_winter"}) ? Season::fall_winter : Season::spring_summer;
  const double visibility = 1000 * p.number_in("visibility_km", 0.01, 337, "km", 23);
  a.profile = located(p, [&] { return AerosolProfile(visibility, season); });
  if (depth) a.profile = a.profile.with_depth(depth->as_number_in(0, 100, ""));
  return a;
}

// Extinction of a unit of a cloud at 0.55 um; nothing when its particles do not say.
std::optional<double> green_of(const ParticleSpec& particles) {
  if (particles.data) return particles.data->green();
  const double middle[] = {0.55};
  return particle_optics(particles, middle).extinction(0);
}

AirSpec::Cloud read_cloud(const Params& p, const LightContext& context, std::vector<std::string>& notes) {
  AirSpec::Cloud c;
  c.particles = read_kind(p, "kind", false, context, notes);
  c.base = p.number_in("base_m", -1000, 30000, "m above sea level");
  c.top = p.number_in("top_m", c.base + 1, 40000, "m above sea level");
  const auto depth = p.find("optical_depth_550"), content = p.find("content_g_m3");
  if (!depth == !content)
    throw p.error("a cloud has either `optical_depth_550` or `content_g_m3`", "give one of the two");
  if (content) {
    if (c.particles.data && c.particles.data->relative)
      throw content->error("a content of particles whose extinction is relative", "give `optical_depth_550`");
    c.content = 1e-3 * content->as_number_in(0, 100, "g/m3");
  } else {
    const std::optional<double> green = green_of(c.particles);
    if (!green || !(*green > 0))
      throw depth->error("a depth at 0.55 um of particles whose extinction there is 0 or unknown",
                         "give `content_g_m3`, or optics with extinction_relative");
    c.content = depth->as_number_in(0, 1e5, "") / (*green * (c.top - c.base));
  }
  return c;
}

// What was read and does nothing in this air is told, not refused: one file serves all ways of following its light.
void note_unused(const Params& p, AirSpec& air) {
  const auto unused = [&](std::initializer_list<const char*> keys, const char* why) {
    for (const char* key : keys)
      if (p.has(key)) air.notes.push_back(strf("atmosphere: '%s' does nothing %s", key, why));
  };
  if (air.scattering != AirScattering::diffuse)
    unused({"streams", "ground_albedo", "ground_temperature_k", "adjacency"}, "without `scattering: diffuse`");
  if (air.scattering == AirScattering::traced) unused({"refraction"}, "with `scattering: traced`");
  if (!air.gases) unused({"g_points", "ppm", "ozone_du"}, "without gases");
}

}  // namespace

std::shared_ptr<const AirSpec> read_air(const Params& p, const LightContext& context) {
  auto air = std::make_shared<AirSpec>();
  air->where = p.where();
  air->profile = read_scaled(p, air->notes);
  air->gases = read_gases(p, air->notes);
  air->points.most = static_cast<int>(p.integer("g_points", 1, 16, air->points.most));
  air->molecules = p.boolean("rayleigh", true);
  if (const auto aerosol = p.find("aerosol")) air->aerosol = read_aerosol(*aerosol, context, air->notes);
  if (const auto clouds = p.find("clouds"))
    for (const Params& cloud : clouds->items()) air->clouds.push_back(read_cloud(cloud, context, air->notes));
  if (p.has("scene_height_m")) air->scene_height = p.number_in("scene_height_m", -1000, 20000, "m above sea level");
  if (p.has("ground_height_m")) air->ground_height = p.number_in("ground_height_m", -1000, 20000, "m above sea level");
  if (const auto earth = p.find("shape")) air->round = earth->as_choice({"round", "flat"}) == 0;
  air->refraction = p.boolean("refraction", false);
  if (const auto scattering = p.find("scattering"))
    air->scattering = static_cast<AirScattering>(scattering->as_choice({"single", "diffuse", "traced"}));
  air->streams = static_cast<int>(p.integer("streams", 4, 64, air->streams));
  if (air->streams % 2) throw p.at("streams").error(strf("%d streams are not even", air->streams));
  if (const auto albedo = p.find("ground_albedo");
      albedo && albedo->kind() == Params::Kind::scalar && albedo->as_text() == "scene") {
    air->ground_of_scene = true;
  } else if (albedo) {
    air->ground_albedo = context.positive(*albedo, "albedo", "0 to 1");
    if (air->ground_albedo.max() > 1) throw albedo->error("the albedo exceeds 1");
  }
  if (p.has("ground_temperature_k")) air->ground_temperature = p.number_in("ground_temperature_k", 1, 2000, "K");
  air->adjacency = p.boolean("adjacency", true);
  air->ground_of_any_scene = !p.has("ground_albedo") && air->adjacency && air->scattering == AirScattering::diffuse;
  note_unused(p, *air);
  check_air(*air);
  return air;
}

}  // namespace suite
