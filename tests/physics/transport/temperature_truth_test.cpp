// The truth `temperature` is what was rendered: the radiance of a black body in a narrow band, inverted, for every way
// in which a surface can have a temperature.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::temperature_truth_test {
namespace {

constexpr double kLow = 9.95, kHigh = 10.05;

class Thermometer final : public RaySensor {
 public:
  using RaySensor::RaySensor;
  std::span<const std::string> truth() const override { return names_; }

 private:
  std::vector<std::string> names_{"temperature"};
};

// The temperature at which a black body has this radiance, by bisection.
double inverted(double radiance) {
  double low = 50, high = 2000;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (planck_band_radiance(kLow, kHigh, middle) / (kHigh - kLow) < radiance ? low : high) = middle;
  }
  return low;
}

Scene scene_with(std::vector<Material> materials) {
  Scene scene;
  scene.groups.push_back({"root", {Placement{}}});
  Mesh square = quad(1, 0, 0);
  square.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  scene.meshes = {square};
  scene.materials = std::move(materials);
  return scene;
}

PropertyMap map_of(MapKind kind, uint32_t width, uint32_t channels, std::vector<float> values) {
  PropertyMap m;
  m.name = "map";
  m.kind = kind;
  m.width = width, m.height = 1, m.channels = channels;
  m.values = std::move(values);
  m.drape = {-1, 1, 2.0 / width, 2.0, Drape::Extend::clamp};
  return m;
}

struct Seen {
  double kelvin, truth, radiance;
};
// Looks at (x, 0) at the times, in a capture that lasts for all of them.
std::vector<Seen> look(Scene scene, const std::vector<double>& x, const std::vector<double>& times = {0}) {
  check_scene(scene, "case");
  std::vector<Ray> rays;
  for (const double at : x)
    for (const double t : times) rays.push_back({{at, 0.1, 5}, {0, 0, -1}, t});
  class During final : public Sensor {
   public:
    During(std::vector<Ray> rays, TimeWindow w)
        : inner_(std::move(rays), {Band::rectangular("t", 10, kHigh - kLow)}, 4, 0.01),
          tasks_(inner_.tasks().begin(), inner_.tasks().end()) {
      tasks_[0].window = tasks_[0].captures[0].window = w;
    }
    std::string name() const override { return "thermometer"; }
    std::span<const SpectralState> states() const override { return inner_.states(); }
    std::span<const Band> bands(size_t s) const override { return inner_.bands(s); }
    std::span<const Task> tasks() const override { return tasks_; }
    std::span<const std::string> truth() const override { return inner_.truth(); }
    SensorRay ray(const RayRequest& r) const override { return inner_.ray(r); }
    void accept(CaptureResult&& r) override { result = std::move(r); }
    CaptureResult result;

   private:
    Thermometer inner_;
    std::vector<Task> tasks_;
  };
  std::vector<std::unique_ptr<Sensor>> sensors;
  sensors.push_back(std::make_unique<During>(rays, TimeWindow{times.front(), times.back()}));
  JobOptions job;
  job.progress = false;
  run_job(std::make_shared<Scene>(std::move(scene)), {}, sensors, job);
  const CaptureResult& r = static_cast<During&>(*sensors[0]).result;
  std::vector<Seen> out;
  for (size_t i = 0; i < rays.size(); ++i) out.push_back({inverted(r.radiance[i]), r.truth[i], r.radiance[i]});
  return out;
}
// Blackbody tables are right to 1e-4 of the radiance: 6 mK here. A truth 0.1 K off is refused.
void expect_same(const std::vector<Seen>& seen, double coldest, double hottest) {
  double low = INFINITY, high = 0;
  for (const Seen& s : seen) {
    EXPECT_NEAR(s.truth, s.kelvin, 0.01);
    EXPECT_GT(std::fabs(s.truth + 0.1 - s.kelvin), 0.01);
    low = std::min(low, s.truth), high = std::max(high, s.truth);
  }
  EXPECT_NEAR(low, coldest, 0.5);
  EXPECT_NEAR(high, hottest, 0.5);
}

Material black() { return material("black", lambert(0)); }

TEST(TemperatureTruth, ConstantOfTheMaterial) {
  Material warm = black();
  warm.temperature_k = 312.5;
  expect_same(look(scene_with({warm}), {0}), 312.5, 312.5);
}

// Was the static temperature of the material, or nothing.
TEST(TemperatureTruth, ModelsAtTheTimeOfTheRay) {
  Material warm = black();
  warm.temperature_k = 250;  // what models replace
  Scene scene = scene_with({warm});
  scene.temperatures = {{0, {"constant", {{"kelvin", 287}}, {}, {}, false, {}}}};
  expect_same(look(scene, {0}), 287, 287);
  scene.temperatures = {{0, {"tabulated", {}, {0, 100}, {280, 320}, false, {}}}};
  expect_same(look(scene, {0}, {0, 30, 100}), 280, 320);
}

TEST(TemperatureTruth, SlabsThatWereSolved) {
  Scene scene = scene_with({black()});
  TemperatureSpec slab{"slab",
                       {{"thickness_m", 0.1},
                        {"density_kg_m3", 1600},
                        {"specific_heat_j_kg_k", 900},
                        {"conductivity_w_m_k", 0.6},
                        {"period_s", 86400}},
                       {},
                       {},
                       false,
                       {}};
  slab.load_times = {0, 43200, 86400};
  slab.loads = {{0, 300, 280, 2}, {600, 330, 295, 2}, {0, 300, 280, 2}};
  slab.loads_repeat = true;
  scene.temperatures = {{0, slab}};
  const std::vector<Seen> seen = look(scene, {0}, {10000, 40000, 50000, 80000});
  double low = INFINITY, high = 0;
  for (const Seen& s : seen) {
    EXPECT_NEAR(s.truth, s.kelvin, 0.01);
    low = std::min(low, s.truth), high = std::max(high, s.truth);
  }
  EXPECT_GT(high - low, 5);  // it was not one temperature all day
}

TEST(TemperatureTruth, MapsAndTheMaterialBeyondThem) {
  Material warm = black();
  warm.temperature_k = 300;
  Scene scene = scene_with({warm});
  scene.property_maps = {map_of(MapKind::temperature, 4, 1, {280, 290, 305, 330})};
  scene.property_bindings = {{0, 0}};
  expect_same(look(scene, {-0.75, -0.25, 0.25, 0.75}), 280, 330);
  // Outside of a map that does not extend the material's own holds.
  scene.property_maps[0].drape = {-1, 1, 0.25, 2.0, Drape::Extend::none};
  expect_same(look(scene, {-0.9, 0.5}), 280, 300);
}

TEST(TemperatureTruth, ClassMapsAndMixtures) {
  Material a = material("a", lambert(0)), b = material("b", lambert(0));
  a.temperature_k = 300, b.temperature_k = 300;
  Scene mixed = scene_with({material("mix", lambert(0)), a, b});
  PropertyMap shares = map_of(MapKind::mixture, 1, 2, {0.3f, 0.7f});
  shares.materials = {1, 2};
  mixed.property_maps = {shares};
  mixed.property_bindings = {{0, 0}};
  expect_same(look(mixed, {0}), 300, 300);
  // Of parts that differ the truth is their mean by share; radiances average, so what is inverted lies above it.
  mixed.materials[2].temperature_k = 280;
  const Seen seen = look(mixed, {0})[0];
  EXPECT_NEAR(seen.truth, 0.3 * 300 + 0.7 * 280, 1e-4);
  EXPECT_GT(seen.kelvin, seen.truth);
  EXPECT_LT(seen.kelvin - seen.truth, 1);

  Scene classes = scene_with({material("ground", lambert(0)), a, b});
  classes.materials[2].temperature_k = 330;
  ClassMap map;
  map.name = "classes";
  map.width = 2, map.height = 1;
  map.classes = {0, 1};
  map.materials = {1, 2};
  map.drape = {-1, 1, 1, 2, Drape::Extend::clamp};
  classes.class_maps = {map};
  classes.map_bindings = {{0, 0}};
  expect_same(look(classes, {-0.5, 0.5}), 300, 330);
}

TEST(TemperatureTruth, NothingWhereNothingIsWarm) {
  EXPECT_TRUE(std::isnan(look(scene_with({black()}), {0})[0].truth));
}

}  // namespace
}  // namespace suite::test::temperature_truth_test
