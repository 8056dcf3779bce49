// The table of conditions (scheduler/techniques.h) against the kernels: over some twenty small scenes a technique that
// the table calls used is one whose switch changes the bits of what is rendered, or that the kernel of the state was
// chosen for, and one that it calls left out is not. Negative control: a row turned round is noticed.
#include "scheduler/techniques.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>

#include "tests/support/lamps_kit.h"
#include "tests/support/pipeline_kit.h"

namespace suite::test::techniques_test {
namespace {

// A floor of 2 m x 2 m that reflects a low sun onto a wall, over a bed of which little is seen.
struct Case {
  const char* name;
  std::shared_ptr<const Scene> scene;
  SourceSpecs sources;
  PipelineOptions options = {};
};

ModelSpec glass() { return {"dielectric", {}, {{"index", Curve::constant(1.33)}}, {}, nullptr}; }
ModelSpec mirror() { return {"mirror", {}, {{"reflectance", Curve::constant(0.9)}}, {}, nullptr}; }
ModelSpec gloss() {
  return {"ward",
          {{"roughness", 0.08}, {"roughness_y", 0}},
          {{"diffuse", Curve::constant(0.1)}, {"specular", Curve::constant(0.5)}},
          {},
          nullptr};
}

enum class Fill { nothing, haze, under_floor };

std::shared_ptr<const Scene> corner(const ModelSpec& floor, Fill fill = Fill::nothing) {
  const Mesh wall = mesh_of({{-1, 1, 0}, {1, 1, 0}, {1, 1, 2}, {-1, 1, 2}}, {0, 1, 2, 0, 2, 3}, 1);
  std::vector<Material> materials{material("floor", floor), material("wall", lambert(0.5))};
  auto scene = scene_of({quad(1, 0, 0), wall, quad(3, -1, 1)}, materials);
  if (fill == Fill::nothing) return scene;
  scene->media = {medium(Curve::constant(0), Curve::constant(0.6), hg(0.85))};
  if (fill == Fill::haze) {
    scene->materials.push_back(boundary(0));
    scene->meshes.push_back(box({-0.9, -0.9, 0.1}, {0.9, 0.9, 1.8}, 2, true));
    Placement p;
    p.target = 3;
    scene->groups[0].placements.push_back(p);
  } else {
    scene->media[0].index = Curve::constant(1.33);
    scene->materials[0].inside = 0;
  }
  check_scene(*scene, "corner");
  return scene;
}

SourceSpecs sky() {
  SourceSpecs s;
  s.add(uniform_sky(1, false));
  return s;
}
// From over the viewer's shoulder, so that the floor throws it on the wall.
SourceSpecs sun() {
  SourceSpecs s;
  s.add(SunSpec{normalized(Vec3{0.1, -1, 0.8}), 0.01, Curve::constant(1)});
  return s;
}
SourceSpecs lamps(size_t count) {
  SourceSpecs s;
  std::vector<LampSpec> all;
  for (size_t i = 0; i < count; ++i) all.push_back(point_lamp({{0.1 + 0.01 * static_cast<double>(i), -1, 1}}, 1));
  s.add(all);
  return s;
}
SourceSpecs lamp() { return lamps(1); }
SourceSpecs in_air(AirScattering scattering, bool adjacency = true) {
  SourceSpecs s = sun();
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.scattering = scattering;
  air.adjacency = adjacency;
  s.air = std::make_shared<const AirSpec>(air);
  return s;
}

PipelineOptions with(const std::function<void(PipelineOptions&)>& change) {
  PipelineOptions options;
  change(options);
  return options;
}
const PipelineOptions kPaper = with([](auto& o) { o.method = Method::paper; });
const PipelineOptions kUnsampled = with([](auto& o) { o.explicit_sources = false; });
const PipelineOptions kNoManifold = with([](auto& o) { o.refracted_sources = false; });
const PipelineOptions kNoEquiangular = with([](auto& o) { o.equiangular = false; });
const PipelineOptions kNoPhotons = with([](auto& o) { o.gloss_photons = 0; });

std::vector<Case> cases() {
  const ModelSpec matte = lambert(0.5);
  return {{"matte under a sky", corner(matte), sky()},
          {"matte in the sun", corner(matte), sun()},
          {"matte in the dark", corner(matte), {}},
          {"matte by the paper's method", corner(matte), sun(), kPaper},
          {"matte, lights met by chance", corner(matte), sky(), kUnsampled},
          {"gloss in the sun", corner(gloss()), sun()},
          {"gloss under a lamp", corner(gloss()), lamp()},
          {"gloss under a sky", corner(gloss()), sky()},
          {"gloss without photons", corner(gloss()), sun(), kNoPhotons},
          {"gloss by the paper's method", corner(gloss()), sun(), kPaper},
          {"glass in the sun", corner(glass()), sun()},
          {"glass under a lamp", corner(glass()), lamp()},
          {"a mirror in the sun", corner(mirror()), sun()},
          {"a mirror under a lamp", corner(mirror()), lamp()},
          {"glass under a sky", corner(glass()), sky()},
          {"glass without MNEE", corner(glass()), sun(), kNoManifold},
          {"glass by the paper's method", corner(glass()), sun(), kPaper},
          {"haze in the sun", corner(matte, Fill::haze), sun()},
          {"haze under a sky", corner(matte, Fill::haze), sky()},
          {"haze under a lamp", corner(matte, Fill::haze), lamp()},
          {"haze under a lamp without equiangular sampling", corner(matte, Fill::haze), lamp(), kNoEquiangular},
          {"haze under 16 lamps", corner(matte, Fill::haze), lamps(16)},
          {"haze under 17 lamps", corner(matte, Fill::haze), lamps(17)},
          {"haze and gloss in the sun", corner(gloss(), Fill::haze), sun()},
          {"water in the sun", corner(glass(), Fill::under_floor), sun()},
          {"water without MNEE", corner(glass(), Fill::under_floor), sun(), kNoManifold},
          {"air", corner(matte), in_air(AirScattering::diffuse)},
          {"air without adjacency", corner(matte), in_air(AirScattering::diffuse, false)},
          {"air that scatters once", corner(matte), in_air(AirScattering::single)},
          {"air around haze", corner(matte, Fill::haze), in_air(AirScattering::diffuse)},
          {"air by the paper's method", corner(matte), in_air(AirScattering::diffuse), kPaper}};
}

std::vector<double> rendered(const Case& c, const PipelineOptions& options) {
  std::vector<Ray> rays;
  for (int i = 0; i < 8; ++i)
    rays.push_back({{0.2, -2, 1.2}, normalized(Vec3{0.1 * i - 0.5, 3, i % 2 ? -1.6 : -0.5}), 0});
  return see(c.scene, c.sources, RaySensor(rays, one_band(), 32, 0.01, 2), options).radiance;
}

KernelChoice kernel_of(const Case& c, bool& refracted) {
  const Tracer tracer(c.scene);
  const Optics optics(*c.scene, RaySensor({}, one_band(), 1).states()[0]);
  const Environment environment = bake_environment(c.sources, tracer, false, optics.state());
  const Surface surface(tracer, optics);
  const KernelContext context{surface, optics, environment, c.options};
  refracted = refracts(context);
  return choose_kernel(context);
}

// What the kernels do of the techniques with conditions.
std::map<ListedTechnique, bool> done(const Case& c) {
  bool refracted = false;
  const KernelChoice kernel = kernel_of(c, refracted);
  const std::vector<double> all = rendered(c, c.options);
  const auto changes = [&](ListedTechnique technique) {
    PipelineOptions options = c.options;
    named_techniques()[static_cast<size_t>(technique)].off(options);
    return rendered(c, options) != all;
  };
  return {{ListedTechnique::manifold, changes(ListedTechnique::manifold)},
          {ListedTechnique::volume_chains, kernel.in_media() && refracted},
          {ListedTechnique::side_vertex, changes(ListedTechnique::side_vertex)},
          {ListedTechnique::equiangular, changes(ListedTechnique::equiangular)},
          {ListedTechnique::caustic_guide, changes(ListedTechnique::caustic_guide)},
          {ListedTechnique::adjacency, kernel.goes_back()}};
}

// Scenes and techniques on which a table and the kernels do not agree.
std::vector<std::string> disagreements(std::span<const Case> of, std::span<const std::map<ListedTechnique, bool>> done,
                                       std::span<const TechniqueRow> rows) {
  std::vector<std::string> found;
  for (size_t i = 0; i < of.size(); ++i) {
    const TechniqueFacts facts = technique_facts(*of[i].scene, of[i].sources, of[i].options);
    for (const TechniqueRow& row : rows) {
      const TechniqueCondition* missing = unmet(row, facts);
      if (!missing != done[i].at(row.technique))
        found.push_back(std::string(of[i].name) + ": " + name_of(row.technique) + " is " +
                        (missing ? std::string("done, though '") + missing->otherwise + "'" : "not done"));
    }
  }
  return found;
}

TEST(Techniques, TheTableAgreesWithTheKernels) {
  const std::vector<Case> all = cases();
  std::vector<std::map<ListedTechnique, bool>> kernels;
  for (const Case& c : all) kernels.push_back(done(c));
  for (const std::string& text : disagreements(all, kernels, technique_rows())) ADD_FAILURE() << text;

  // Each technique is used in some scene and left out in another.
  for (const TechniqueRow& row : technique_rows()) {
    const auto used = std::ranges::count_if(kernels, [&](const auto& k) { return k.at(row.technique); });
    EXPECT_GT(used, 0) << name_of(row.technique);
    EXPECT_LT(used, static_cast<long>(all.size())) << name_of(row.technique);
  }

  // Control: each row with one of its conditions turned round.
  static const TechniqueCondition* turned = nullptr;
  for (const TechniqueRow& row : technique_rows()) {
    for (size_t k = 0; k < row.conditions.size(); ++k) {
      std::vector<TechniqueCondition> conditions(row.conditions.begin(), row.conditions.end());
      turned = &row.conditions[k];
      conditions[k].holds = [](const TechniqueFacts& f) { return !turned->holds(f); };
      const TechniqueRow wrong{row.technique, row.text, conditions};
      EXPECT_FALSE(disagreements(all, kernels, {&wrong, 1}).empty())
          << name_of(row.technique) << ": " << row.conditions[k].needs;
    }
  }
}

}  // namespace
}  // namespace suite::test::techniques_test
