// Maps through the whole renderer, each against what a pencil gives.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/texture.h"
#include "spectral/planck.h"
#include "tests/support/stokes_kit.h"

namespace suite::test::maps_test {
namespace {

// A square of half size 1 at z = 0 with texture coordinates (0, 0) to (1, 1).
Mesh square(uint32_t material) {
  Mesh m = quad(1, 0, material);
  m.uvs = {0, 0, 1, 0, 1, 1, 0, 1};
  return m;
}
std::vector<Ray> straight_down(const std::vector<Vec2>& places) {
  std::vector<Ray> rays;
  for (const Vec2& p : places) rays.push_back({{p.x, p.y, 5}, {0, 0, -1}, 0});
  return rays;
}
// Covers the square with width x height pixels.
PropertyMap over_square(MapKind kind, uint32_t width, uint32_t height, uint32_t channels, std::vector<float> values,
                        Projection projection) {
  PropertyMap m;
  m.name = "map";
  m.kind = kind;
  m.width = width, m.height = height, m.channels = channels;
  m.values = std::move(values);
  m.projection = projection;
  m.drape = {-1, 1, 2.0 / width, 2.0 / height, Drape::Extend::clamp};
  return m;
}
struct Case {
  Scene scene;
  explicit Case(std::vector<Material> materials, std::vector<PropertyMap> maps) {
    scene.groups.push_back({"root", {Placement{}}});
    scene.meshes = {square(0)};
    scene.materials = std::move(materials);
    for (uint32_t i = 0; i < maps.size(); ++i) scene.property_bindings.push_back({0, i});
    scene.property_maps = std::move(maps);
  }
  Rendered run(std::vector<Ray> rays, std::vector<Band> bands, const SourceSpecs& sources, uint32_t paths,
               size_t knots = 4) const {
    check_scene(scene, "case");
    return render(std::make_shared<Scene>(scene), sources,
                  std::make_unique<RaySensor>(std::move(rays), std::move(bands), paths, 0.01, knots));
  }
};
SourceSpecs sky(double radiance) {
  SourceSpecs s;
  s.add(uniform_sky(radiance, true));
  return s;
}
SourceSpecs sun(Dir towards) {
  SourceSpecs s;
  s.add(SunSpec{towards, 0, Curve::constant(kPi)});
  return s;
}
ModelSpec ward(double diffuse, double specular, double rough, double rough_y) {
  ModelSpec s;
  s.model = "ward";
  s.numbers = {{"diffuse", diffuse}, {"specular", specular}, {"roughness", rough}, {"roughness_y", rough_y}};
  return s;
}
std::vector<Band> two_bands() { return {Band::rectangular("a", 0.5, 0.01), Band::rectangular("b", 0.8, 0.01)}; }
const Projection kBoth[] = {Projection::drape, Projection::uv};

TEST(Maps, MixtureReturnsTheSumOfItsParts) {
  // Left pixel a quarter lambert and three quarters ward, right pixel only lambert; a uniform sky of 2.
  for (const Projection projection : kBoth) {
    Case c({material("mix", lambert(0)), material("l", lambert(0.6)), material("w", ward(0.2, 0.5, 0.2, 0))},
           {over_square(MapKind::mixture, 2, 1, 2, {0.25f, 0.75f, 1, 0}, projection)});
    c.scene.property_maps[0].materials = {1, 2};
    const auto run = c.run(straight_down({{-0.5, 0.2}, {0.5, 0.2}}), one_band(), sky(2), 1 << 14);
    const SpectralState state = make_state(one_band(), 0.01);
    std::vector<float> W(state.size());
    bake(c.scene.materials[2].surface, state)->total({0, 0, 1}, W);
    EXPECT_NEAR(run.result.radiance[0], 2 * (0.25 * 0.6 + 0.75 * W[0]), 5 * run.result.standard_error[0] + 1e-4);
    EXPECT_NEAR(run.result.radiance[1], 2 * 0.6, 1e-5);
    // Lambert parts of different reflectance cost no variance at all: the mixture is seen whole by every path.
    Case plain({material("mix", lambert(0)), material("l", lambert(0.6)), material("w", lambert(0.1))},
               c.scene.property_maps);
    const auto quiet = plain.run(straight_down({{-0.5, 0.2}}), one_band(), sky(2), 64);
    EXPECT_NEAR(quiet.result.radiance[0], 2 * (0.25 * 0.6 + 0.75 * 0.1), 1e-6);
    EXPECT_LT(quiet.result.standard_error[0], 1e-6);
  }
}

TEST(Maps, CurveIndexReplacesTheCurve) {
  for (const Projection projection : kBoth) {
    PropertyMap map = over_square(MapKind::curve_index, 2, 2, 1, {0, 1, 2, 0}, projection);
    map.parameter = "reflectance";
    map.family = {Curve::constant(0.1), Curve({0.4, 1.0}, {0.2, 0.8}, Outside::hold), Curve::constant(0.7)};
    const Case c({material("m", lambert(0.9))}, {map});
    const auto r = c.run(straight_down({{-0.5, 0.5}, {0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}}), two_bands(), sky(1), 16)
                       .result.radiance;
    const double expected[] = {0.1, 0.1, 0.3, 0.6, 0.7, 0.7, 0.1, 0.1};
    for (size_t i = 0; i < 8; ++i) EXPECT_NEAR(r[i], expected[i], 1e-5) << i;
  }
}

TEST(Maps, OutsideAMapThatDoesNotExtendTheMaterialHolds) {
  PropertyMap map = over_square(MapKind::curve_index, 1, 1, 1, {0}, Projection::drape);
  map.parameter = "reflectance";
  map.family = {Curve::constant(0.1)};
  map.drape = {-1, 1, 1, 2, Drape::Extend::none};  // the western half
  const Case c({material("m", lambert(0.9))}, {map});
  const auto r = c.run(straight_down({{-0.01, 0.5}, {0.01, 0.5}}), one_band(), sky(1), 16).result.radiance;
  EXPECT_NEAR(r[0], 0.1, 1e-6);
  EXPECT_NEAR(r[1], 0.9, 1e-6);
}

TEST(Maps, CubeGivesEveryPixelItsSpectrum) {
  for (const Projection projection : kBoth)
    for (const char* model : {"lambert", "oren_nayar", "ward"}) {
      PropertyMap map = over_square(MapKind::cube, 2, 1, 3, {0.1f, 0.3f, 0.2f, 0.4f, 0.05f, 0.6f}, projection);
      map.wavelength_um = {0.45, 0.65, 0.85};
      map.parameter = std::string(model) == "ward" ? "diffuse" : "reflectance";
      ModelSpec spec = std::string(model) == "ward" ? ward(0.3, 0.2, 0.3, 0) : lambert(0.3);
      if (std::string(model) == "oren_nayar")
        spec = {"oren_nayar", {{"sigma", 0.4}, {"reflectance", 0.3}}, {}, {}, nullptr};
      const Case c({material("m", spec)}, {map});
      const auto run = c.run(straight_down({{-0.5, 0}, {0.5, 0}}), two_bands(), sky(1), 1 << 13);
      // By hand: linear between the channels at the middle of the bands, which are one bin each.
      for (size_t pixel = 0; pixel < 2; ++pixel)
        for (size_t b = 0; b < 2; ++b) {
          const float* v = &map.values[3 * pixel];
          const double rho = b == 0 ? v[0] + (v[1] - v[0]) * 0.25 : v[1] + (v[2] - v[1]) * 0.75;
          ModelSpec here = c.scene.materials[0].surface;
          here.curves[map.parameter] = Curve::constant(rho);
          const SpectralState state = make_state(two_bands(), 0.01);
          std::vector<float> W(state.size());
          bake(here, state)->total({0, 0, 1}, W);
          EXPECT_NEAR(run.result.radiance[2 * pixel + b], W[b], 5 * run.result.standard_error[2 * pixel + b] + 2e-5)
              << model << pixel << b;
        }
    }
  PropertyMap map = over_square(MapKind::cube, 2, 1, 1, {1.2f / 2, 0.9f}, Projection::drape);
  map.wavelength_um = {0.5};
  map.parameter = "k";
  const Case refused(
      {material("m", {"rpv", {{"rho0", 0.1}, {"k", 0.8}, {"asymmetry", -0.1}, {"rho_c", 0.1}}, {}, {}, nullptr})},
      {map});
  EXPECT_THROW(refused.run(straight_down({{0, 0}}), one_band(), sky(1), 1), Error);
}

TEST(Maps, TemperatureOfMapsTablesAndParts) {
  const std::vector<Band> bands{Band::rectangular("t", 10, 1)};
  const auto planck = [](double kelvin) { return planck_band_radiance(9.5, 10.5, kelvin); };
  PropertyMap map = over_square(MapKind::temperature, 2, 1, 1, {280, 320}, Projection::drape);
  const Case mapped({material("m", lambert(0.1))}, {map});
  auto r = mapped.run(straight_down({{-0.5, 0}, {0.5, 0}}), bands, {}, 1).result.radiance;
  EXPECT_NEAR(r[0], 0.9 * planck(280), 1e-4 * r[0]);
  EXPECT_NEAR(r[1], 0.9 * planck(320), 1e-4 * r[1]);

  Case timed({material("m", lambert(0.1))}, {});
  timed.scene.temperatures = {{0, {"tabulated", {}, {0, 100}, {280, 320}, false, {}}}};
  std::vector<Ray> rays = straight_down({{0, 0}, {0, 0}, {0, 0}});
  rays[1].time = 25, rays[2].time = 100;
  r = timed.run(rays, bands, {}, 1).result.radiance;
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(r[i], 0.9 * planck(280 + 0.4 * rays[i].time), 1e-4 * r[i]);
  timed.scene.temperatures[0].spec = {"slab",
                                      {{"thickness_m", 1},
                                       {"density_kg_m3", 1600},
                                       {"specific_heat_j_kg_k", 900},
                                       {"conductivity_w_m_k", 0.6},
                                       {"period_s", 86400}},
                                      {},
                                      {},
                                      false,
                                      {}};
  EXPECT_THROW(timed.run(rays, bands, {}, 1), Error);  // nobody says what heats it

  // A mixture emits what its parts emit: 30 % of a grey body at 300 K, 70 % of a black one at 280 K.
  std::vector<Material> parts{material("mix", lambert(0)), material("a", lambert(0.4)), material("b", lambert(0))};
  parts[1].temperature_k = 300, parts[2].temperature_k = 280;
  PropertyMap fractions = over_square(MapKind::mixture, 1, 1, 2, {0.3f, 0.7f}, Projection::drape);
  fractions.materials = {1, 2};
  const Case mixed(parts, {fractions});
  r = mixed.run(straight_down({{0, 0}}), bands, {}, 1).result.radiance;
  EXPECT_NEAR(r[0], 0.3 * 0.6 * planck(300) + 0.7 * planck(280), 1e-5 * r[0]);
}

// The same behind polarizers: a smooth metal sends out polarised light, however much of the emissivity and of the light
// is that of the wall beside it, whose spectrum is a map's. The last part emits nothing.
TEST(Maps, PartsOfMixturesPolariseTheirOwnEmission) {
  const ModelSpec metal{
      "ggx", {{"roughness", 0.1}}, {{"n", Curve::constant(25.3)}, {"k", Curve::constant(89.8)}}, {}, nullptr};
  const std::vector<Band> bands{Band::rectangular("t", 10, 0.1)};
  const std::vector<float> shares{0.5f, 0.3f, 0.2f};
  PropertyMap mixture = over_square(MapKind::mixture, 1, 1, 3, shares, Projection::drape),
              spectrum = over_square(MapKind::cube, 1, 1, 2, {0.2f, 0.4f}, Projection::drape);
  mixture.materials = {1, 2, 3};
  spectrum.wavelength_um = {9, 11}, spectrum.parameter = "reflectance";
  const Dir down = dir_from_angles(105 * kDegree, 0.7);
  for (const auto& [metal_k, wall_k] : {std::pair{400.0, 300.0}, std::pair{300.0, 400.0}, std::pair{350.0, 350.0}}) {
    Case c({material("mix", lambert(0)), material("metal", metal), material("wall", lambert(0.3)),
            material("cold", lambert(0.5))},
           {mixture, spectrum});
    c.scene.materials[1].temperature_k = metal_k, c.scene.materials[2].temperature_k = wall_k;
    c.scene.property_bindings = {{0, 0}, {2, 1}};
    std::vector<StokesSeen> seen;  // the mixture, and its parts by themselves
    for (uint32_t m = 0; m < 4; ++m) {
      c.scene.meshes = {square(m)};
      check_scene(c.scene, "case");
      auto sensor = std::make_unique<StokesRays>(std::vector<Ray>{{Vec3{} - down * 5, down, 0}}, 4096, Polarimetry{},
                                                 bands, 0.05);
      seen.push_back(seen_of(render(std::make_shared<Scene>(c.scene), {}, std::move(sensor)).result)[0]);
    }
    Stokes wanted{};
    double error = 0;
    for (size_t k = 0; k < 4; ++k) {
      error = seen[0].error[k];
      for (size_t m = 1; m < 4; ++m) {
        wanted[k] += double{shares[m - 1]} * seen[m].S[k];
        error = std::hypot(error, double{shares[m - 1]} * seen[m].error[k]);
      }
      EXPECT_NEAR(seen[0].S[k], wanted[k], 12 * error + 1e-5 * wanted[0]) << "IQUV"[k] << metal_k;
      if (k != 1) continue;
      // As if all were equally warm, by the emissivities alone:
      const double emissivity = 0.5 * seen[1].S[0] / planck_radiance(10, metal_k) + 0.3 * 0.7 + 0.2 * 0.5,
                   alike = 0.5 * seen[1].S[1] / planck_radiance(10, metal_k) * wanted[0] / emissivity;
      EXPECT_GT(std::fabs(alike - wanted[1]), 2 * 12 * error) << "the fault would be seen";
    }
  }
}

// A ramp of heights is a tilted plane: under a collimated sun of irradiance pi, Lambert gives rho cos(angle to its
// normal).
TEST(Maps, BumpsAndNormalsTiltTheSurface) {
  const Dir towards = normalized(Vec3{0.3, -0.2, 1});
  for (const Projection projection : kBoth) {
    std::vector<float> heights, normals;
    for (int row = 0; row < 16; ++row)
      for (int column = 0; column < 16; ++column) {
        heights.push_back(static_cast<float>(0.4 * column * 0.125 + 0.1 * row * 0.125));  // slope 0.4 east, -0.1 north
        normals.insert(normals.end(), {-0.4f, 0.1f, 1.0f});
      }
    const Dir n = normalized(Vec3{-0.4, 0.1, 1});
    const double expected = 0.5 * dot(n, towards);
    const Case bump({material("m", lambert(0.5))}, {over_square(MapKind::bump, 16, 16, 1, heights, projection)});
    EXPECT_NEAR(bump.run(straight_down({{0.1, 0.3}}), one_band(), sun(towards), 1).result.radiance[0], expected, 2e-6);
    const Case normal({material("m", lambert(0.5))}, {over_square(MapKind::normal, 16, 16, 3, normals, projection)});
    EXPECT_NEAR(normal.run(straight_down({{0.1, 0.3}}), one_band(), sun(towards), 1).result.radiance[0], expected,
                2e-6);
    EXPECT_NEAR(length(n), 1, 1e-12);
  }
}

TEST(Maps, BumpsLeakNoLightAndHaveNoBlackEdges) {
  // Steep random heights; a sky that shines from below only may not show on an opaque sheet, at any angle; a sky from
  // above must show at every angle: at least half of what the flat sheet shows.
  std::mt19937 random(5);
  std::vector<float> heights;
  for (int i = 0; i < 32 * 32; ++i) heights.push_back(0.08f * static_cast<float>(random()) / 4294967296.0f);
  const Case c({material("m", lambert(0.8))}, {over_square(MapKind::bump, 32, 32, 1, heights, Projection::drape)});
  std::vector<Ray> rays;
  for (int i = 0; i < 200; ++i) {
    const Dir out = dir_from_angles((0.5 + i % 89) * kDegree, 0.7 * i);
    rays.push_back({Vec3{0.9 * std::sin(1.0 * i), 0.9 * std::cos(2.3 * i), 0} + out * 0.01, -out, 0});
  }
  SourceSpecs below;
  below.add(SkySpec{Curve::constant(1), {0, 0, 0, 1, 1}, 5, 1, true});  // every 45 deg; the horizon itself is dark
  const auto dark = c.run(rays, one_band(), below, 256);
  const auto lit = c.run(rays, one_band(), sky(1), 256);
  for (size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(dark.result.radiance[i], 0) << i;
    EXPECT_GT(lit.result.radiance[i], 0.4 - 5 * lit.result.standard_error[i]) << i << " zenith " << rays[i].direction.z;
    EXPECT_LT(lit.result.radiance[i], 0.8 + 1e-6);
  }
}

TEST(Maps, AnisotropicModelsFollowTheTextureCoordinates) {
  // Rough along u, smooth along v; half vectors tilted along u or along v. Turning the texture by 90 degrees swaps
  // them.
  const auto gloss = [&](std::vector<float> uvs, Dir towards) {
    Case c({material("m", ward(0, 0.5, 0.5, 0.1))}, {});
    c.scene.meshes[0].uvs = std::move(uvs);
    return c.run(straight_down({{0.2, 0.1}}), one_band(), sun(towards), 1).result.radiance[0];
  };
  const Dir east = normalized(Vec3{0.5, 0, 1}), north = normalized(Vec3{0, 0.5, 1});
  const std::vector<float> plain{0, 0, 1, 0, 1, 1, 0, 1},
      turned{0, 0, 0, 1, -1, 1, -1, 0};  // turned: u runs south, v east
  EXPECT_GT(gloss(plain, east), 4 * gloss(plain, north));
  EXPECT_NEAR(gloss(turned, north) / gloss(plain, east), 1, 1e-5);
  EXPECT_NEAR(gloss(turned, east) / gloss(plain, north), 1, 1e-5);
  EXPECT_NEAR(gloss({}, east) / gloss(plain, east), 1, 1e-5);  // without: the local x axis
}

TEST(Maps, TextureKeepsMeanAndCovarianceOfItsFamilyThroughTheRenderer) {
  // 40 curves of two independent kinds of variation; a skewed image chooses; every pixel is seen once.
  std::mt19937 random(3);
  const auto uniform = [&] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<Curve> family;
  for (int k = 0; k < 40; ++k) {
    const double level = uniform(), tilt = uniform() - 0.5;
    family.push_back(
        Curve({0.4, 0.9}, {0.2 + 0.2 * level - 0.1 * tilt, 0.3 + 0.25 * level + 0.1 * tilt}, Outside::error));
  }
  constexpr uint32_t kSide = 40;
  std::vector<float> image(kSide * kSide);
  for (float& v : image) v = static_cast<float>(std::pow(uniform(), 3));
  const std::array<double, 2> band{0.45, 0.8};
  const std::vector<uint16_t> chosen = choose_curves(image, 1, family, std::span(&band, 1));
  PropertyMap map =
      over_square(MapKind::curve_index, kSide, kSide, 1, {chosen.begin(), chosen.end()}, Projection::drape);
  map.parameter = "reflectance";
  map.family = family;
  const Case c({material("m", lambert(0.5))}, {map});
  std::vector<Vec2> places;
  for (uint32_t row = 0; row < kSide; ++row)
    for (uint32_t column = 0; column < kSide; ++column)
      places.push_back({-1 + (column + 0.5) * 2 / kSide, 1 - (row + 0.5) * 2 / kSide});
  std::vector<Band> bands;
  for (int b = 0; b < 5; ++b) bands.push_back(Band::rectangular("b" + std::to_string(b), 0.45 + 0.1 * b, 0.01));
  const auto r = c.run(straight_down(places), bands, sky(1), 1).result.radiance;
  const auto moments = [&](size_t n, const auto& value) {
    std::vector<double> m(5 + 25, 0.0);
    for (size_t i = 0; i < n; ++i)
      for (size_t b = 0; b < 5; ++b) m[b] += value(i, b) / static_cast<double>(n);
    for (size_t i = 0; i < n; ++i)
      for (size_t a = 0; a < 5; ++a)
        for (size_t b = 0; b < 5; ++b)
          m[5 + 5 * a + b] += (value(i, a) - m[a]) * (value(i, b) - m[b]) / static_cast<double>(n);
    return m;
  };
  const auto wanted =
      moments(family.size(), [&](size_t k, size_t b) { return family[k].at(0.45 + 0.1 * static_cast<double>(b)); });
  const auto got = moments(places.size(), [&](size_t i, size_t b) { return r[5 * i + b]; });
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(got[i] / wanted[i], 1, 0.05) << i;
}

}  // namespace
}  // namespace suite::test::maps_test
