// What a simulation says it uses and leaves alone.
#include "scheduler/features.h"
#include "base/files.h"
#include "base/renamed.h"
#include "light/kinds/lamps.h"
#include "light/kinds/moon.h"
#include "scheduler/techniques.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/radiometry_kit.h"

namespace suite::features_test {
namespace {

TEST(Features, ALambertianSceneAtRestLeavesTheRestAlone) {
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});
  SourceSpecs sources;
  sources.add(test::uniform_sky(1, false));
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<test::RaySensor>(std::vector<Ray>(1), test::one_band(), 4));
  const std::vector<FeatureUse> uses = features_of(*scene, sources, sensors);
  for (const FeatureUse& f : uses)
    EXPECT_EQ(f.used, f.name == "sky" || f.name == "truth" || f.name == "bands") << f.name;
  EXPECT_THAT(text_of(uses), testing::HasSubstr("media                left out  none in the scene\n"));
}

TEST(Features, WhatIsThereIsNamed) {
  auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});
  scene->materials[0].temperature_k = 300;
  scene->media.emplace_back();
  SourceSpecs sources;
  sources.add(MoonSpec{});
  sources.add(std::vector<LampSpec>(3));
  const std::vector<FeatureUse> uses = features_of(*scene, sources, {});
  auto used = [&](const std::string& name) {
    for (const FeatureUse& f : uses)
      if (f.name == name) return f.used;
    ADD_FAILURE() << name;
    return false;
  };
  for (const char* name : {"media", "emission", "moon", "lamps"}) EXPECT_TRUE(used(name)) << name;
  for (const char* name : {"sun", "sky", "truth", "motion"}) EXPECT_FALSE(used(name)) << name;
}

// What the estimator does not do is not said to be used.
TEST(Features, AdjacencyIsThatOfTheEstimator) {
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>();
  PipelineOptions paper, blind;
  paper.method = Method::paper, blind.explicit_sources = false;
  EXPECT_THAT(text_of(features_of(*scene, sources, {})),
              testing::HasSubstr("adjacency            used      an atmosphere with a profile\n"));
  EXPECT_THAT(text_of(features_of(*scene, sources, {}, paper)),
              testing::HasSubstr("adjacency            left out  the paper's estimator\n"));
  EXPECT_THAT(text_of(features_of(*scene, sources, {}, blind)),
              testing::HasSubstr("adjacency            left out  lights are not sampled\n"));
}

TEST(Features, RefractionNeedsASmoothMaterialAndASun) {
  const auto scene = [](const char* model) {
    return test::scene_of({test::quad(1, 0, 0)},
                          {test::material("m", {model, {}, {{"index", Curve::constant(1.33)}}, {}, nullptr})});
  };
  SourceSpecs sun, none;
  SunSpec disk;
  disk.irradiance = Curve::constant(1);
  sun.add(disk);
  PipelineOptions off, paper;
  off.refracted_sources = false, paper.method = Method::paper;
  const auto said = [](const std::shared_ptr<Scene>& s, const SourceSpecs& sources, const PipelineOptions& options) {
    for (const FeatureUse& f : features_of(*s, sources, {}, options))
      if (f.name == "manifold") return f.why;
    return std::string("missing");
  };
  const auto water = scene("dielectric");
  const auto grey = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});
  EXPECT_EQ(said(water, sun, {}), "a smooth refracting material");
  EXPECT_EQ(said(grey, sun, {}), "no material refracts without roughness");
  EXPECT_EQ(said(water, none, {}), "no sun, moon or lamp in the simulation");
  EXPECT_EQ(said(water, sun, off), "`manifold_nee: false`");
  EXPECT_EQ(said(water, sun, paper), "the paper's estimator");
}

// Paths of laser radars branch towards their other end, in the dark and behind smooth interfaces, too.
TEST(Features, SplittingNeedsMediaAndASunOrALaserRadar) {
  const auto grey = test::material("grey", test::lambert(0.5));
  const auto glass = test::material("m", {"dielectric", {}, {{"index", Curve::constant(1.33)}}, {}, nullptr});
  const auto fog = test::scene_of({test::quad(1, 0, 0)}, {grey}),
             water = test::scene_of({test::quad(1, 0, 0)}, {glass});
  fog->media.emplace_back(), water->media.emplace_back();
  const auto clear = test::scene_of({test::quad(1, 0, 0)}, {grey});
  SourceSpecs sun;
  SunSpec disk;
  disk.irradiance = Curve::constant(1);
  sun.add(disk);
  PipelineOptions off;
  off.side_flights = false;
  const auto said = [](const Scene& s, const SourceSpecs& sources, size_t laser_radars,
                       const PipelineOptions& options = {}) {
    for (const FeatureUse& f : features_of(s, sources, {}, options, laser_radars))
      if (f.name == name_of(ListedTechnique::side_vertex)) return (f.used ? "" : "not: ") + f.why;
    return std::string("missing");
  };
  EXPECT_EQ(said(*fog, {}, 0), "not: no sun, moon or laser radar in the simulation");
  EXPECT_EQ(said(*fog, {}, 1), "media in the scene");
  EXPECT_EQ(said(*fog, sun, 0), "media in the scene");
  EXPECT_EQ(said(*fog, sun, 1, off), "not: switched off");
  EXPECT_EQ(said(*water, sun, 0), "not: paths in media behind smooth interfaces have multi-vertex NEE");
  EXPECT_EQ(said(*water, sun, 1), "media in the scene");
  EXPECT_EQ(said(*clear, sun, 1), "not: no media in the scene");
  const std::string text = explain_use(name_of(ListedTechnique::side_vertex)).value_or("");
  EXPECT_THAT(text, testing::HasSubstr("Paths of laser radars leave such vertices"));
  EXPECT_THAT(text, testing::HasSubstr("\n  a sun, a moon or a laser radar\n"));
}

// Texts, `--explain`, the list of parts and the table of conditions say the same words, those of one list.
TEST(Features, TechniquesHaveOneName) {
  std::set<std::string> with_conditions;
  for (const TechniqueRow& row : technique_rows()) {
    with_conditions.insert(name_of(row.technique));
    EXPECT_EQ(&technique_row(row.technique), &row);
    EXPECT_GT(row.conditions.size(), 0u);
  }
  const std::vector<std::string> parts = feature_names(), known = explained_names();
  for (size_t i = 0; i < named_techniques().size(); ++i) {
    const NamedTechnique& t = named_techniques()[i];
    const std::string name = t.name;
    EXPECT_EQ(static_cast<size_t>(t.technique), i) << name;
    EXPECT_EQ(technique_of(name), &t);
    EXPECT_THAT(explain_use(name).value_or(""), testing::StartsWith(name + ": " + t.term + ". "));
    EXPECT_EQ(std::ranges::count(known, name), 1) << name;
    const bool listed = std::ranges::find(parts, name) != parts.end();
    EXPECT_EQ(listed, with_conditions.contains(name)) << name;
    EXPECT_EQ(listed, t.technique != ListedTechnique::light_sampling) << name;
    for (const RenamedName& old : renamed_names()) EXPECT_NE(name, old.old_name);
  }
  EXPECT_EQ(technique_of("MNEE"), nullptr);
  // Old names lead to names that there are.
  for (const RenamedName& old : renamed_names())
    EXPECT_TRUE(old.of != RenamedName::Of::part || explain_use(std::string(old.new_name))) << old.new_name;
  // Sources that spell a technique's name out beside the list would be a second list.
  for (const char* file :
       {"scheduler/techniques.cpp", "scheduler/features.cpp", "scheduler/shortfall.cpp", "scheduler/air_limits.cpp"}) {
    const std::string text = read_text(std::string(SUITE_SOURCE_DIR "/libs/") + file, 1 << 20);
    for (const NamedTechnique& t : named_techniques())
      EXPECT_EQ(text.find('"' + std::string(t.name) + '"'), text.npos) << file << ": " << t.name;
  }
}

TEST(Features, EachIsExplained) {
  const auto scene = test::scene_of({test::quad(1, 0, 0)}, {test::material("grey", test::lambert(0.5))});
  const std::vector<FeatureUse> uses = features_of(*scene, {}, {});
  ASSERT_EQ(uses.size(), feature_names().size());
  for (const FeatureUse& f : uses) EXPECT_GT(explain_use(f.name).value_or("").size(), f.name.size() + 20) << f.name;
  EXPECT_FALSE(explain_use("mediums"));
}

}  // namespace
}  // namespace suite::features_test
