#include "scheduler/techniques.h"

#include <algorithm>

#include "base/error.h"
#include "transport/equiangular_law.h"
#include "transport/lost_light.h"

namespace suite {

namespace {

using Facts = TechniqueFacts;

constexpr TechniqueCondition kStandard{[](const Facts& f) { return f.options.method == Method::standard; },
                                       "the standard method", "the paper's estimator"};
constexpr TechniqueCondition kSampled{[](const Facts& f) { return f.options.explicit_sources; },
                                      "next-event estimation", "lights are not sampled"};
constexpr TechniqueCondition kSmall{[](const Facts& f) { return f.small_lights; }, "a sun, a moon or a lamp",
                                    "no sun, moon or lamp in the simulation"};
constexpr TechniqueCondition kSmooth{[](const Facts& f) { return f.smooth > 0; }, "a smooth refracting material",
                                     "no material refracts without roughness"};
constexpr TechniqueCondition kManifold{[](const Facts& f) { return f.options.refracted_sources; },
                                       "`manifold_nee: true`", "`manifold_nee: false`"};
constexpr TechniqueCondition kMedia{[](const Facts& f) { return f.media > 0; }, "media in the scene",
                                    "no media in the scene"};

bool behind_interfaces(const Facts& f) { return uses(ListedTechnique::manifold, f); }

constexpr TechniqueCondition kManifoldNee[] = {kSmooth, kSmall, kStandard, kSampled, kManifold};
constexpr TechniqueCondition kMultiVertex[] = {
    kMedia, {behind_interfaces, "MNEE", "no light is sampled through smooth interfaces"}};
constexpr TechniqueCondition kSplitting[] = {
    kMedia,
    kStandard,
    kSampled,
    {[](const Facts& f) { return f.beams || f.laser_radars > 0; }, "a sun, a moon or a laser radar",
     "no sun, moon or laser radar in the simulation"},
    {[](const Facts& f) { return f.smooth == 0 || f.laser_radars > 0; },
     "no smooth refracting material; paths of laser radars need none of this",
     "paths in media behind smooth interfaces have multi-vertex NEE"},
    {[](const Facts& f) { return f.options.side_flights; }, "splitting switched on", "switched off"}};
constexpr TechniqueCondition kEquiangular[] = {
    {[](const Facts& f) { return f.even_media; }, "media in the scene, without traced air",
     "no media in the scene, or traced air"},
    {[](const Facts& f) { return f.points > 0; }, "a point or spot lamp", "no point or spot lamp"},
    {[](const Facts& f) { return f.points <= kMostEquiangularLamps; }, "at most 16 of them",
     "more than 16 point and spot lamps"},
    kStandard,
    kSampled,
    {[](const Facts& f) { return f.options.equiangular; }, "equiangular sampling switched on", "switched off"}};
constexpr TechniqueCondition kCausticGuiding[] = {
    {[](const Facts& f) { return f.not_matte > 0; }, "a material that is not Lambertian",
     "all materials are Lambertian"},
    kSmall,
    {[](const Facts& f) { return f.rough > 0 || f.sized_lights; }, "a rough surface, or a source with a size",
     "no path meets point sources by way of mirrors and smooth interfaces"},
    kStandard,
    kSampled,
    {[](const Facts& f) { return f.options.gloss_photons > 0; }, "`caustic_guiding: true`", "`caustic_guiding: false`"},
    {[](const Facts& f) { return f.media == 0 || !behind_interfaces(f); }, "no media together with MNEE",
     "paths in media behind smooth interfaces have multi-vertex NEE"}};
constexpr TechniqueCondition kAdjacency[] = {
    {[](const Facts& f) { return f.real_air; }, "an atmosphere with a profile", "no real air in the simulation"},
    {[](const Facts& f) { return f.field; }, "`scattering: diffuse`", "the air has no field over an even ground"},
    {[](const Facts& f) { return f.adjacency; }, "`adjacency: true`", "`adjacency: false`"},
    kStandard,
    kSampled};

constexpr const char* kLightSampling =
    "Sun, moon, lamps and a sky that varies are sampled at every vertex, with a shadow ray each. A uniform sky is met "
    "by continuations alone.";

constexpr TechniqueRow kRows[] = {
    {ListedTechnique::manifold,
     "Sun, moon and lamps are connected through smooth interfaces (water, panes, "
     "lenses) from every vertex. Where no material refracts smoothly nothing of it is made, and it costs nothing.",
     kManifoldNee},
    {ListedTechnique::volume_chains,
     "Several scattering vertices between a vertex and a light behind smooth interfaces, sampled together where media "
     "scatter forwards.",
     kMultiVertex},
    {ListedTechnique::side_vertex,
     "A second free flight towards the sun or the moon from vertices in media that scatter forwards. Paths of laser "
     "radars leave such vertices, and surfaces beside such media, twice: as they scatter, and towards the end where "
     "they did not begin (laser or receiver).",
     kSplitting},
    {ListedTechnique::equiangular,
     "One more scattering vertex on flights that begin near a point lamp, in mean free paths, by the angle that the "
     "lamp "
     "sees. Flights in grids and traced air have none.",
     kEquiangular},
    {ListedTechnique::caustic_guide,
     "Photons find where narrow lobes reflect sun, moon and lamps to, and a share "
     "of continuations is drawn there. Where no material has a narrow lobe, or no photon lands, none is kept, and "
     "paths cost what they did without.",
     kCausticGuiding},
    {ListedTechnique::adjacency,
     "Shadows in the air and light of single places. Without, or "
     "without air, kernels are made that know nothing of it.",
     kAdjacency},
};

}  // namespace

std::span<const TechniqueRow> technique_rows() { return kRows; }

const TechniqueRow& technique_row(ListedTechnique technique) {
  const auto found = std::ranges::find(kRows, technique, &TechniqueRow::technique);
  if (found == std::end(kRows)) throw Bug(std::string(name_of(technique)) + " has no conditions");
  return *found;
}

const TechniqueCondition* unmet(const TechniqueRow& row, const TechniqueFacts& facts) {
  const auto found = std::ranges::find_if(row.conditions, [&](const auto& c) { return !c.holds(facts); });
  return found == row.conditions.end() ? nullptr : &*found;
}

std::optional<std::string> explain_technique(const std::string& name) {
  const NamedTechnique* technique = technique_of(name);
  if (!technique) return std::nullopt;
  std::string text = name + ": " + technique->term + ".";
  const auto row = std::ranges::find(kRows, technique->technique, &TechniqueRow::technique);
  if (row == std::end(kRows)) {
    text += std::string(" ") + kLightSampling;
  } else {
    text += std::string(" ") + row->text + "\nUsed with:";
    for (const TechniqueCondition& c : row->conditions) text += std::string("\n  ") + c.needs;
  }
  if (technique->off) text += "\nOff, for studies: `techniques: {" + name + ": off}`";
  return text + "\n";
}

TechniqueFacts technique_facts(const Scene& scene, const SourceSpecs& sources, const PipelineOptions& options,
                               size_t laser_radars) {
  TechniqueFacts f;
  f.options = options;
  f.laser_radars = laser_radars;
  constexpr double kNever = 1e-12;
  for (const LightSpecPtr& light : sources.lights) {
    const size_t parts = light->in_scene() ? light->entries() : light->hardly_met(1).size();
    f.small_lights = f.small_lights || parts > 0;
    f.sized_lights = f.sized_lights || parts > light->hardly_met(kNever).size();
    f.beams = f.beams || (!light->in_scene() && parts > 0);
    if (light->in_scene()) f.points += light->hardly_met(kNever).size();
  }
  const bool traced = sources.air && sources.air->scattering == AirScattering::traced;
  f.media = scene.media.size() + traced;
  f.even_media = !scene.media.empty() && !traced;
  for (const Material& m : scene.materials) {
    const std::string& model = m.surface.model;
    f.smooth += model == "dielectric";
    f.not_matte += !model.empty() && model != "lambert";
    f.rough += !model.empty() && model != "lambert" && model != "dielectric" && model != "mirror";
  }
  f.real_air = sources.air != nullptr;
  f.field = f.real_air && sources.air->scattering == AirScattering::diffuse;
  f.adjacency = f.real_air && sources.air->adjacency;
  return f;
}

TechniqueFacts technique_facts(const Scene& scene, const SourceSpecs& sources, const PipelineOptions& options,
                               const Optics& optics) {
  TechniqueFacts f = technique_facts(scene, sources, options);
  f.media = optics.media().size();
  f.smooth = LostLight::refracting(scene, optics).size();
  f.not_matte = 0;
  for (uint32_t i = 0; i < scene.materials.size(); ++i)
    if (const ScatterModel* m = optics.material(i).model) f.not_matte += m->diffuse() == nullptr;
  return f;
}

}  // namespace suite
