#include "scheduler/features.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "light/light_rows.h"

namespace suite {

namespace {

struct Feature {
  std::string name, text;
};
// The keys of the lights stand where their table does.
std::vector<Feature> all_features() {
  std::vector<Feature> all{
      {"media",
       "Participating media: fog, clouds, water, plumes. Without any, paths go straight from surface to surface, and "
       "it costs nothing."},
      {"motion", "Things that move. Without any, all time windows share one set of acceleration structures."},
      {"schedules",
       "Things that come, go or change their material at times. Windows through which they do not share what "
       "is built."},
      {"SQT",
       "Materials of measured or fitted scattering. Their trees are decoded when a material that geometry shows has "
       "one."},
      {"class maps", "Rasters that choose the material of a place."},
      {"property maps",
       "Rasters that vary a material: mixtures, textures, curves, cubes, temperatures, bumps, normals, holes. A "
       "material without any costs nothing; one with some is put together at every hit."},
      {"emission",
       "Thermal emission. The blackbody radiance of a material is tabulated only when its temperature was loaded, "
       "which it is when it shows in some spectral window (--explain temperatures)."}};
  for (const LightRow* row : light_keys()) all.push_back({row->key(), row->uses});
  all.insert(all.end(), {{"atmosphere", "Layers of air that dim and scatter along every segment of a path."},
                         {"adjacency",
                          "Paths that go back to places in real air, for shadows in it and light of single places. "
                          "Without, or without air, kernels are made that know nothing of it."},
                         {"refracted light",
                          "Sun, moon and lamps asked for through smooth interfaces (water, panes, lenses) from every "
                          "node. Where no material passes light smoothly nothing of it is made, and it costs nothing."},
                         {"gloss guide",
                          "Photons of sun, moon and lamps that glossy surfaces throw on others, and continuations of "
                          "paths that are drawn to where they come from. Where no material has a narrow lobe, or none "
                          "of the light lands, no photon is kept, and paths cost what they did without."},
                         {"earth", "The ellipsoid under the scene, which rays that miss the scene may meet."},
                         {"truth", "What else is recorded of a pixel. Only collectors that a sensor names are made."},
                         {"bands", "Spectral bins are carried only where a band of the state responds."}});
  return all;
}

FeatureUse count(const std::string& name, size_t n, const char* what, const char* none) {
  return {name, n > 0, n > 0 ? strf("%zu %s", n, what) : none};
}
FeatureUse source(const std::string& name, bool there) {
  return {name, there, there ? "given by the simulation" : "not in the simulation"};
}

// One entry a key of the lights.
void add_lights(const SourceSpecs& sources, std::vector<FeatureUse>& to) {
  for (const LightRow* row : light_keys()) {
    size_t entries = 0;
    for (const LightSpecPtr& light : sources.lights)
      if (light->key() == row->key()) entries += light->entries();
    to.push_back(row->list ? count(row->key(), entries, "entries", "not in the simulation")
                           : source(row->key(), entries > 0));
  }
}

FeatureUse adjacency(const Scene& scene, const AirSpec* air, const PipelineOptions& options) {
  const char* missing = !air                                        ? "no real air in the simulation"
                        : air->scattering != AirScattering::diffuse ? "the air has no field over an even ground"
                        : !air->adjacency                           ? "`adjacency: false`"
                        : !scene.media.empty()                      ? "media fill the scene"
                        : options.method == Method::paper           ? "the paper's estimator"
                        : !goes_back(options)                       ? "lights are not asked"
                                                                    : nullptr;
  return {"adjacency", !missing, missing ? missing : "in the air of the simulation"};
}

FeatureUse refraction(const Scene& scene, const SourceSpecs& sources, const PipelineOptions& options) {
  const auto smooth = std::count_if(scene.materials.begin(), scene.materials.end(),
                                    [](const Material& m) { return m.surface.model == "dielectric"; });
  const bool small = std::any_of(sources.lights.begin(), sources.lights.end(), [](const LightSpecPtr& light) {
    return light->in_scene() || !light->hardly_met(1).empty();
  });
  const char* missing = smooth == 0                       ? "no material passes light smoothly"
                        : !small                          ? "no sun, moon or lamp in the simulation"
                        : options.method == Method::paper ? "the paper's estimator"
                        : !options.explicit_sources       ? "lights are not asked"
                        : !options.refracted_sources      ? "`light_through_refraction: false`"
                                                          : nullptr;
  return {"refracted light", !missing,
          missing ? missing : strf("%zu smooth material%s", static_cast<size_t>(smooth), smooth == 1 ? "" : "s")};
}

// Whether it is glossy enough to matter photons find out, which are sent when a state is begun.
FeatureUse gloss(const Scene& scene, const SourceSpecs& sources, const PipelineOptions& options) {
  const auto other = std::count_if(scene.materials.begin(), scene.materials.end(), [](const Material& m) {
    return !m.surface.model.empty() && m.surface.model != "lambert" && m.surface.model != "dielectric";
  });
  const bool small = std::any_of(sources.lights.begin(), sources.lights.end(), [](const LightSpecPtr& light) {
    return light->in_scene() || !light->hardly_met(1).empty();
  });
  const char* missing = other == 0                        ? "all materials are matte or smooth interfaces"
                        : !small                          ? "no sun, moon or lamp in the simulation"
                        : options.method == Method::paper ? "the paper's estimator"
                        : !options.explicit_sources       ? "lights are not asked"
                        : options.gloss_photons == 0      ? "`guide_to_gloss: false`"
                        : !scene.media.empty() && refraction(scene, sources, options).used
                            ? "paths in media behind refracting surfaces have guides of their own"
                            : nullptr;
  return {"gloss guide", !missing, missing ? missing : strf("%zu materials may be glossy", static_cast<size_t>(other))};
}

}  // namespace

std::vector<FeatureUse> features_of(const Scene& scene, const SourceSpecs& sources,
                                    std::span<const std::unique_ptr<Sensor>> sensors, const PipelineOptions& options) {
  size_t fitted = 0, warm = scene.temperatures.size();
  for (const Material& m : scene.materials) fitted += m.surface.bundle != nullptr, warm += m.temperature_k > 0;
  std::set<std::string> truth;
  size_t bands = 0, states = 0;
  for (const auto& sensor : sensors) {
    truth.insert(sensor->truth().begin(), sensor->truth().end());
    for (size_t s = 0; s < sensor->states().size(); ++s) bands += sensor->bands(s).size(), ++states;
  }
  std::string names;
  for (const std::string& t : truth) names += (names.empty() ? "" : ", ") + t;
  std::vector<FeatureUse> all{count("media", scene.media.size(), "in the scene", "none in the scene"),
                              count("motion", scene.tracks.size(), "motions", "nothing moves"),
                              count("schedules", scene.schedules.size(), "in the scene", "nothing comes and goes"),
                              count("SQT", fitted, "materials", "no material is a fit"),
                              count("class maps", scene.class_maps.size(), "in the scene", "none in the scene"),
                              count("property maps", scene.property_maps.size(), "in the scene", "none in the scene"),
                              count("emission", warm, "temperatures", "no temperature shows in any window")};
  add_lights(sources, all);
  all.push_back(source("atmosphere", sources.has_air()));
  all.push_back(adjacency(scene, sources.air.get(), options));
  all.push_back(refraction(scene, sources, options));
  all.push_back(gloss(scene, sources, options));
  all.push_back(source("earth", sources.earth.has_value()));
  all.push_back({"truth", !truth.empty(), truth.empty() ? "no sensor asks for any" : names});
  all.push_back({"bands", true, strf("%zu in %zu spectral states", bands, states)});
  return all;
}

std::string text_of(const std::vector<FeatureUse>& features) {
  std::string out;
  for (const FeatureUse& f : features)
    out += strf("%-20s %-9s %s\n", f.name.c_str(), f.used ? "used" : "left out", f.why.c_str());
  return out;
}

std::optional<std::string> explain_use(const std::string& feature) {
  for (const Feature& f : all_features())
    if (f.name == feature) return f.name + ": " + f.text + "\n";
  return std::nullopt;
}

std::vector<std::string> feature_names() {
  std::vector<std::string> names;
  for (const Feature& f : all_features()) names.push_back(f.name);
  return names;
}

}  // namespace suite
