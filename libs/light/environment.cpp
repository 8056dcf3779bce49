#include "light/environment.h"

#include <algorithm>
#include <cmath>

#include "light/stratified_air.h"

namespace suite {

void SourceSpecs::add(std::vector<LightSpecPtr> more) {
  lights.insert(lights.end(), more.begin(), more.end());
  for (size_t i = 0; i < lights.size(); ++i)
    if (lights[i])
      if (auto one = lights[i]->joined(std::span(lights).subspan(i + 1))) lights[i] = std::move(one);
  std::erase(lights, nullptr);
}

LightSpecPtr SourceSpecs::sun() const {
  const auto found = std::find_if(lights.begin(), lights.end(), [](auto& light) { return light->is_sun(); });
  return found == lights.end() ? nullptr : *found;
}

const SourceTime* SourceSpecs::date() const {
  for (const LightSpecPtr& light : lights)
    if (light->date()) return light->date();
  return nullptr;
}

namespace {

// Mean radius of curvature of the WGS84 ellipsoid, m.
double curvature_radius(double latitude_deg) {
  constexpr double a = 6378137, e2 = 6.69437999014e-3;
  const double s = std::sin(latitude_deg * kDegree);
  return a * std::sqrt(1 - e2) / (1 - e2 * s * s);
}

// What the way of following its light leaves out.
std::string neglected(const AirSpec& air) {
  if (air.scattering == AirScattering::traced) return {};
  const std::string shadows = "shadows that the scene throws into the air";
  if (air.scattering == AirScattering::single)
    return "air: light is scattered once; what is scattered more often, also between ground and air, and " + shadows +
           " are left out";
  if (air.adjacency) return {};
  const std::string albedo = air.ground_of_scene || air.ground_of_any_scene
                                 ? "that of the scene in the mean"
                                 : strf("%.3g to %.3g", air.ground_albedo.min(), air.ground_albedo.max());
  return strf(
      "air: light between ground and air is that of an even ground (albedo %s); what single places "
      "send into it (adjacency) and %s are left out",
      albedo.c_str(), shadows.c_str());
}

constexpr const char* kBent =
    "refraction: the beams of sun and moon are dimmed as on bent ways; they come from where these truly stand, without "
    "air, and rays of sight and shadows are straight";

// Below the horizon of a flat Earth nothing shines.
void check_sun(const SourceSpecs& specs) {
  const LightSpecPtr sun = specs.sun();
  if (!specs.air || specs.air->round || !sun || !sun->disk()) return;
  const double rise = std::asin(normalized(sun->disk()->direction).z) / kDegree;
  if (!(rise > 0))
    throw Error(
        specs.air->where,
        strf("the sun stands %.3g degrees below the horizon, and the air over a flat Earth has no twilight", -rise),
        "`shape: round`");
}

// Air over the scene's place on Earth, where that is known.
std::shared_ptr<const AirSpec> placed(const std::shared_ptr<const AirSpec>& air, const Scene& scene,
                                      std::vector<std::string>& said) {
  if (!air) return air;
  said.insert(said.end(), air->notes.begin(), air->notes.end());
  if (air->gases) said.push_back("gases: " + air->gases->note());
  if (const std::string left_out = neglected(*air); !left_out.empty()) said.push_back(left_out);
  if (air->refraction && air->scattering != AirScattering::traced) said.push_back(kBent);
  if (air->scene_height) return air;
  auto here = std::make_shared<AirSpec>(*air);
  here->scene_height = scene.origin.given ? scene.origin.ellipsoid_height_m : 0;
  if (scene.origin.given) here->radius = curvature_radius(scene.origin.latitude_deg);
  return here;
}

std::shared_ptr<const TabledAirSpec> placed(const std::shared_ptr<const TabledAirSpec>& air, const Scene& scene,
                                            std::vector<std::string>& said) {
  if (!air) return air;
  said.insert(said.end(), air->notes.begin(), air->notes.end());
  if (air->scene_height) return air;
  auto here = std::make_shared<TabledAirSpec>(*air);
  here->scene_height = scene.origin.given ? scene.origin.ellipsoid_height_m : 0;
  if (scene.origin.given) here->radius = curvature_radius(scene.origin.latitude_deg);
  return here;
}

}  // namespace

std::vector<std::string> resolve_sources(SourceSpecs& specs, const Scene& scene, double seconds) {
  std::vector<std::string> said;
  specs.air = placed(specs.air, scene, said);
  specs.tabled = placed(specs.tabled, scene, said);
  for (LightSpecPtr& light : specs.lights)
    if (auto now = light->resolved({scene, seconds, specs.dut1, said})) light = std::move(now);
  for (size_t i = 0; i < specs.lights.size(); ++i) {
    const LightSpecPtr light = specs.lights[i];  // it may put another one in its place
    light->settle(specs, i, said);
  }
  check_sun(specs);
  return said;
}

uint32_t earth_material(const EarthSpec& spec, const Scene& scene) {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    if (scene.materials[i].id == spec.material && scene.materials[i].bounds_medium())
      throw Error(spec.where,
                  "the Earth: the material '" + spec.material + "' bounds a medium, and the Earth is no body",
                  "name a material without inside and outside");
    if (scene.materials[i].id == spec.material && !scene.materials[i].surface.model.empty()) return i;
    names.push_back(scene.materials[i].id);
  }
  throw Error(spec.where, "the Earth: the scene has no material '" + spec.material + "' with a model of its own",
              name_hint(spec.material, names));
}

namespace {

// The air scatters the beams of the bodies; where it is traced, paths do.
void bake_air(Environment& e, const SourceSpecs& specs, const SpectralState& state) {
  if (!specs.has_air() || (specs.air && specs.air->scattering == AirScattering::traced)) return;
  if (specs.tabled) {
    std::optional<TabledSun> sun;
    if (e.sun != kNoLight) sun = TabledSun{*e.lights[e.sun]->beam(), specs.lights[e.sun]->disk()->half_angle};
    e.atmosphere = make_tabled_air(*specs.tabled, state, sun);
    return;
  }
  std::vector<Beam> beams;
  for (const auto& light : e.lights)
    if (const auto beam = light->beam()) beams.push_back(*beam);
  if (!specs.air) {
    e.atmosphere = make_layered_atmosphere(*specs.atmosphere, state, std::move(beams));
    return;
  }
  if (!e.column) e.column = std::make_shared<const AirColumn>(bake_column(*specs.air, state));
  e.atmosphere = make_stratified_air(*specs.air, e.column, state, std::move(beams));
}

}  // namespace

void rebake_changed(Environment& e, const SourceSpecs& now, const Tracer& tracer, const SpectralState& state) {
  SUITE_CHECK(now.lights.size() == e.specs.size());
  bool changed = false;
  for (size_t i = 0; i < e.specs.size(); ++i) {
    if (e.specs[i] == now.lights[i]) continue;
    e.specs[i] = now.lights[i];
    e.lights[i] = now.lights[i]->bake(tracer, state);
    changed = true;
  }
  if (changed) bake_air(e, now, state);
}

Environment bake_environment(const SourceSpecs& specs, const Tracer& tracer, bool periodic,
                             const SpectralState& state) {
  const Scene& scene = tracer.scene();
  Environment e;
  e.specs = specs.lights;
  for (const LightSpecPtr& light : specs.lights) {
    if (light->is_sun() && e.sun == kNoLight) e.sun = e.lights.size();
    e.lights.push_back(light->bake(tracer, state));
  }
  bake_air(e, specs, state);
  if (specs.earth) {
    if (periodic) throw Error(specs.earth->where, "a scene that repeats itself has no Earth under it");
    const SceneFrame frame = frame_of(scene, specs.earth->where, "the Earth");
    const double lowest = tracer.bounds().empty() ? 0 : std::min(0.0, tracer.bounds().low.z);
    e.earth =
        std::make_shared<const Earth>(frame, specs.earth->height.value_or(scene.origin.ellipsoid_height_m + lowest - 1),
                                      earth_material(*specs.earth, scene));
  }
  return e;
}

}  // namespace suite
