// Refracting surfaces whose surroundings are not those that they are made for are told before paths are run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scheduler/surroundings.h"
#include "tests/support/media_kit.h"
#include "tests/support/pipeline_kit.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::surroundings_test {
namespace {

constexpr double kGlass = 1.5, kWater = 1.34;

Medium clear(const char* id, double index, int priority = 0) {
  Medium m = medium(Curve::constant(0.1), Curve::constant(0));
  m.id = id;
  m.index = Curve::constant(index);
  m.priority = priority;
  return m;
}
Material interface_of(const char* id, double index, uint32_t inside, uint32_t outside = kNone) {
  Material m = material(id, {"dielectric", {}, {{"index", Curve::constant(index)}}, {}, nullptr});
  m.inside = inside, m.outside = outside;
  return m;
}

// A box of glass, its lower face at `low`, in or above water that fills z < 0.
std::vector<std::string> told(double low, Material glass) {
  auto scene = std::make_shared<Scene>();
  scene->media = {clear("water", kWater), clear("glass", kGlass, 1)};
  scene->materials = {interface_of("surface", kWater, 0), std::move(glass)};
  place(*scene, PrimitiveKind::plane, {0, 0}, 0);
  place(*scene, PrimitiveKind::box, {-1, -1, low, 1, 1, low + 0.5}, 1);
  check_scene(*scene, "glass and water");
  const Tracer tracer(scene);
  const RaySensor sensor(std::vector<Ray>{{{0, 0, 9}, {0, 0, -1}, 0}}, one_band(), 1);
  const Optics optics(*scene, sensor.states()[0]);
  return lines_of(diagnose_surroundings(tracer, optics));
}

using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

TEST(Surroundings, GlassInWaterThatIsMadeForAir) {
  EXPECT_THAT(told(-2, interface_of("pane", kGlass, 1)),
              ElementsAre(AllOf(HasSubstr("'pane' has 'water'"), HasSubstr("1.34"), HasSubstr("`outside`"),
                                HasSubstr("[DR303]"))));
  EXPECT_THAT(told(-2, interface_of("pane", kGlass / kWater, 1, 0)), IsEmpty());
  EXPECT_THAT(told(-2, interface_of("pane", kGlass / kWater, 1)), IsEmpty()) << "its index suits";
}

// The surface of the water goes on within the glass.
TEST(Surroundings, GlassHalfInWater) {
  EXPECT_THAT(told(-0.25, interface_of("pane", kGlass, 1)),
              ElementsAre(HasSubstr("'pane' has 'water'"), HasSubstr("'surface' has 'glass'")));
  EXPECT_THAT(told(-0.25, interface_of("pane", kGlass / kWater, 1, 0)),
              ElementsAre(HasSubstr("'pane' has nothing"), HasSubstr("'surface' has 'glass'")));
}

TEST(Surroundings, GlassOnWater) {
  EXPECT_THAT(told(0, interface_of("pane", kGlass, 1)),
              ElementsAre(AllOf(HasSubstr("('pane', 'surface') lie in each other"), HasSubstr("[DR301]"))));
  EXPECT_THAT(told(0.01, interface_of("pane", kGlass, 1)), IsEmpty());
}

// Water whose side has no model, in air; a layer in it, which goes on beyond it below an opaque bed; matter like air.
TEST(Surroundings, BoundariesThatShouldBend) {
  const auto diagnosed = [](double index, bool surface) {
    auto scene = std::make_shared<Scene>();
    scene->media = {clear("water", kWater), clear("layer", index, 1)};
    scene->materials = {interface_of("surface", kWater, 0), boundary(1), material("bed", lambert(0.3))};
    scene->materials[1].id = "side";
    if (surface) {
      place(*scene, PrimitiveKind::box, {-2, -2, -1.9, 2, 2, 0}, 0);
      place(*scene, PrimitiveKind::plane, {0, 0}, 2, translation({0, 0, -2}));
      place(*scene, PrimitiveKind::plane, {0, 0}, 1, translation({0, 0, -2.5}));
      place(*scene, PrimitiveKind::box, {-1, -1, -1.5, 1, 1, -1}, 1);
    } else {
      place(*scene, PrimitiveKind::box, {-1, -1, 0, 1, 1, 0.5}, 1);
    }
    check_scene(*scene, "boundaries");
    const Tracer tracer(scene);
    const RaySensor sensor(std::vector<Ray>{{{0, 0, 9}, {0, 0, -1}, 0}}, one_band(), 1);
    return lines_of(diagnose_surroundings(tracer, Optics(*scene, sensor.states()[0])));
  };
  EXPECT_THAT(diagnosed(kWater, false),
              ElementsAre(AllOf(HasSubstr("'side' parts 'layer' (index 1.34)"), HasSubstr("bends nothing"),
                                HasSubstr("dielectric"), HasSubstr("[DR302]"))));
  EXPECT_THAT(diagnosed(1, false), IsEmpty());
  EXPECT_THAT(diagnosed(kWater, true), IsEmpty());
  EXPECT_THAT(diagnosed(kGlass, true), ElementsAre(HasSubstr("'side' parts 'layer' (index 1.5) from 'water'")));
}

// Dense water of a large mesh, of which places are coarse; a small one, or clear water, is met exactly.
TEST(Surroundings, DenseMatterOfALargeObject) {
  const auto diagnosed = [](double side, double absorption) {
    const auto scene = scene_of(
        {mesh_of({{-side, -side, 0}, {side, -side, 0}, {side, side, 0}, {-side, side, 0}}, {0, 1, 2, 0, 2, 3}, 0)},
        {material("surface", lambert(0))});
    scene->media = {clear("water", kWater)};
    scene->media[0].absorption = Curve::constant(absorption);
    scene->materials = {interface_of("surface", kWater, 0)};
    check_scene(*scene, "large water");
    const Tracer tracer(scene);
    const RaySensor sensor(std::vector<Ray>{{{0, 0, 9}, {0, 0, -1}, 0}}, one_band(), 1);
    const Optics optics(*scene, sensor.states()[0]);
    return lines_of(diagnose_surroundings(tracer, optics));
  };
  EXPECT_THAT(diagnosed(2e4, 3),
              ElementsAre(AllOf(HasSubstr("paths in 'water'"), HasSubstr("'surface'"), HasSubstr("[DR306]"))));
  EXPECT_THAT(diagnosed(2e4, 1e-3), IsEmpty());
  EXPECT_THAT(diagnosed(10, 3), IsEmpty());
}

// A layer of higher priority around glass with a medium holds within the glass; two bodies that cut each other hold by
// the direction; nested ones, touching ones and those of one medium do not.
TEST(Surroundings, PrioritiesThatAreAmbiguous) {
  const auto diagnosed = [](int of_layer, double low, uint32_t medium) {
    auto scene = std::make_shared<Scene>();
    scene->media = {clear("haze", 1, of_layer), clear("glass", kGlass), clear("smoke", 1)};
    scene->materials = {boundary(0), interface_of("ball", kGlass, 1), boundary(medium)};
    scene->materials[0].id = "layer", scene->materials[2].id = "cloud";
    place(*scene, PrimitiveKind::box, {-4, -4, 0, 4, 4, 4}, 0);
    place(*scene, PrimitiveKind::sphere, {0.9}, 1, translation({0, 0, 1.5}));
    place(*scene, PrimitiveKind::box, {-1, -1, low, 1, 1, low + 1}, 2);
    check_scene(*scene, "priorities");
    const Tracer tracer(scene);
    const RaySensor sensor(std::vector<Ray>{{{0, 0, 9}, {0, 0, -1}, 0}}, one_band(), 1);
    return lines_of(diagnose_surroundings(tracer, Optics(*scene, sensor.states()[0])));
  };
  EXPECT_THAT(diagnosed(0, 2.5, 2), IsEmpty()) << "nested";
  EXPECT_THAT(diagnosed(0, 4, 2), IsEmpty()) << "touching";
  EXPECT_THAT(diagnosed(0, 3.5, 0), IsEmpty()) << "one medium";
  EXPECT_THAT(diagnosed(1, 3.5, 2),
              ElementsAre(AllOf(HasSubstr("'ball' bends light into matter of index 1.5"), HasSubstr("'haze' (index 1)"),
                                HasSubstr("0.444 times"), HasSubstr("[DR304]"))));
  EXPECT_THAT(diagnosed(0, 3.5, 2), ElementsAre(AllOf(HasSubstr("'cloud' and 'layer' overlap in part"),
                                                      HasSubstr("'smoke' (extinction 0.1 1/m"), HasSubstr("[DR305]"))));
}

}  // namespace
}  // namespace suite::test::surroundings_test
