// What interfaces given by an index alone enclose: clear matter of that index. In a world of one temperature all of it
// looks like a blackbody, whatever is inside of what; from within matter of index n, like n^2 of one.
#include <gtest/gtest.h>

#include <cmath>

#include "spectral/planck.h"
#include "tests/support/media_kit.h"

namespace suite::test::clear_matter_test {
namespace {

constexpr double kKelvin = 300, kIndex = 1.5;
constexpr double kSigmas = 4.5;  // less than 1e-5 a comparison by chance

std::vector<Band> thermal_bands() { return {Band::rectangular("a", 9, 0.1), Band::rectangular("b", 11, 0.1)}; }
double black(const Band& b) {
  return planck_band_radiance(b.low_um(), b.high_um(), kKelvin) / (b.high_um() - b.low_um());
}

enum class Around { nothing, air, haze };
struct Case {
  const char* model;
  bool named;  // by a medium
  Around around;
};
std::string name_of(const Case& c) {
  return std::string(c.model) + (c.named ? ", a medium, " : ", by index alone, ") +
         (c.around == Around::nothing ? "nothing"
          : c.around == Around::air   ? "air"
                                      : "haze") +
         " around";
}

Material interface_of(const char* model, Curve index, uint32_t inside) {
  ModelSpec spec{model, {}, {{"index", std::move(index)}}, {}, nullptr};
  if (spec.model == "ggx_dielectric") spec.numbers["roughness"] = 0.3;
  Material m = material("glass", spec);
  m.inside = inside;
  return m;
}

// A warm black room, in it a ball of glass about a warm grey ball.
std::shared_ptr<Scene> room(const Case& c, const Curve& index = Curve::constant(kIndex)) {
  auto scene = std::make_shared<Scene>();
  scene->media = {medium(Curve::constant(0.1), Curve::constant(0.05)), medium(Curve::constant(0), Curve::constant(0))};
  for (Medium& m : scene->media) m.temperature_k = kKelvin;
  scene->media[1].index = index;
  scene->media[1].id = "glass";
  if (c.around == Around::haze) scene->ambient = 0;
  if (c.around != Around::haze && !c.named) scene->media.clear();
  scene->materials = {interface_of(c.model, index, c.named ? 1 : kNone), material("grey", lambert(0.4)),
                      material("room", lambert(0))};
  scene->materials[1].temperature_k = scene->materials[2].temperature_k = kKelvin;
  place(*scene, PrimitiveKind::sphere, {1}, 0);
  place(*scene, PrimitiveKind::sphere, {0.5}, 1);
  place(*scene, PrimitiveKind::sphere, {30}, 2);
  check_scene(*scene, "room");
  return scene;
}

SourceSpecs sources_of(const Case& c) {
  SourceSpecs sources;
  if (c.around != Around::air) return sources;
  sources.atmosphere = AtmosphereSpec{};
  sources.atmosphere->heights = {0, 1000};
  sources.atmosphere->temperature_k = {kKelvin};
  AtmosphereSpec::Gas gas;
  gas.name = "gas";
  gas.layers = {Curve::constant(50)};
  sources.atmosphere->gases = {gas};
  return sources;
}

// Regression: matter in glass given by its index shone B / n^2 (-56 %), and haze filled it (-0.8 % of its pixels).
TEST(ClearMatter, LooksLikeABlackbody) {
  for (const char* model : {"dielectric", "ggx_dielectric"})
    for (const bool named : {false, true})
      for (const Around around : {Around::nothing, Around::air, Around::haze}) {
        const Case c{model, named, around};
        const std::vector<Band> bands = thermal_bands();
        const Ray to_middle{{0.1, -4, 0.2}, normalized(Vec3{-0.02, 1, -0.03}), 0},
            to_rim{{0.75, -4, 0.2}, {0, 1, 0}, 0}, within{{0.1, -0.8, 0.1}, normalized(Vec3{0.3, 1, 0.2}), 0},
            out{{0.1, -0.8, 0.1}, normalized(Vec3{0.3, -1, 0.2}), 0};
        const double squared = kIndex * kIndex;
        for (const auto& [ray, expected] :
             {std::pair{to_middle, 1.0}, {to_rim, 1.0}, {within, squared}, {out, squared}}) {
          const auto r =
              render(room(c), sources_of(c), std::make_unique<RaySensor>(repeated(ray), bands, 36, 0.05)).result;
          for (size_t b = 0; b < bands.size(); ++b) {
            const Repeated got = over_problems(r, b);
            EXPECT_NEAR(got.mean / black(bands[b]), expected, kSigmas * got.error / black(bands[b]) + 1e-4 * expected)
                << name_of(c) << ", band " << b;
            EXPECT_LT(kSigmas * got.error, 0.07 * got.mean) << "that would not be seen";
          }
        }
      }
}

// Regression: a smooth interface scales all bins of a knot by the knot's index, matter shone by that of each bin: up to
// 3 % of wrong emission between knots. At normal incidence the two must agree in every bin.
TEST(ClearMatter, ShinesByTheIndexThatItsSurfaceBendsBy) {
  const Curve water({8, 9, 10, 11, 12, 13, 14}, {1.291, 1.262, 1.218, 1.153, 1.111, 1.138, 1.177}, Outside::hold);
  const std::vector<Band> bands{Band::rectangular("b", 11, 6)};
  const SpectralState state = make_state(bands, 0.5, 0, 3);
  double most = 0;
  for (const char* model : {"dielectric", "ggx_dielectric"})
    for (const bool named : {false, true}) {
      const auto scene = room({model, named, Around::nothing}, water);
      const Optics optics(*scene, state);
      const std::vector<float> own = optics.state().sample(water);
      const BakedMedium& matter = optics.matter(optics.medium_behind(0));
      std::vector<float> W(own.size());
      optics.material(0).model->total({0, 0, 1}, W);
      const bool smooth = std::string(model) == "dielectric";
      for (size_t i = 0; i < own.size(); ++i) {
        const double squared = double{matter.index_squared[i]}, n = std::sqrt(squared),
                     r = std::pow((n - 1) / (n + 1), 2);
        if (smooth) {
          EXPECT_NEAR(W[i], r + (1 - r) / squared, 1e-6) << named << i;
        } else {
          EXPECT_NEAR(n, own[i], 1e-6) << named << i;
        }
        most = std::max(most, std::fabs(squared / (double{own[i]} * own[i]) - 1));
      }
    }
  EXPECT_GT(most, 0.02);  // control: the indices of bins and of their knots are told apart
}

}  // namespace
}  // namespace suite::test::clear_matter_test
