#include "scheduler/features.h"

#include <algorithm>
#include <set>

#include "base/error.h"
#include "light/light_rows.h"
#include "scheduler/techniques.h"

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
  all.push_back({"atmosphere", "Layers of air that dim and scatter along every segment of a path."});
  for (const TechniqueRow& row : technique_rows()) all.push_back({name_of(row.technique), row.text});
  all.insert(all.end(), {{"earth", "The ellipsoid under the scene, which rays that miss the scene may meet."},
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

// One entry a technique: why it is left out, or all that it needs.
void add_techniques(const TechniqueFacts& facts, std::vector<FeatureUse>& to) {
  for (const TechniqueRow& row : technique_rows()) {
    const TechniqueCondition* missing = unmet(row, facts);
    to.push_back({name_of(row.technique), !missing, missing ? missing->otherwise : row.conditions.front().needs});
  }
}

}  // namespace

std::vector<FeatureUse> features_of(const Scene& scene, const SourceSpecs& sources,
                                    std::span<const std::unique_ptr<Sensor>> sensors, const PipelineOptions& options,
                                    size_t laser_radars) {
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
  add_techniques(technique_facts(scene, sources, options, laser_radars), all);
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
  if (auto text = explain_technique(feature)) return text;
  for (const Feature& f : all_features())
    if (f.name == feature) return f.name + ": " + f.text + "\n";
  return std::nullopt;
}

std::vector<std::string> feature_names() {
  std::vector<std::string> names;
  for (const Feature& f : all_features()) names.push_back(f.name);
  return names;
}

std::vector<std::string> explained_names() {
  std::vector<std::string> names = feature_names();
  for (const NamedTechnique& t : named_techniques())
    if (std::ranges::find(names, t.name) == names.end()) names.push_back(t.name);
  return names;
}

}  // namespace suite
