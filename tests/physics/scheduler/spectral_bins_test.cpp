// A hundred bands of 6 nm from 0.4 to 1 um over structured sunlight and three reflectances: every band within 0.1 % of
// steps of 0.1 nm, for light that is scattered up to three times; and rendered.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "base/files.h"
#include "formats/curve/curve.h"
#include "light/kinds/solar_spectrum.h"
#include "math/sampling.h"
#include "support/bins_kit.h"

namespace suite::spectral_bins_test {
namespace {

using test::BinSensor;

double user_seconds() {
  struct rusage use {};
  ::getrusage(RUSAGE_SELF, &use);
  return static_cast<double>(use.ru_utime.tv_sec) + 1e-6 * static_cast<double>(use.ru_utime.tv_usec);
}

std::vector<Band> hundred_bands() {
  std::vector<Band> bands;
  for (int i = 0; i < 100; ++i) bands.push_back(Band::gaussian(strf("b%d", i), 0.403 + 0.006 * i, 0.006));
  return bands;
}

struct World {
  Curve sun;
  std::vector<Curve> reflectance;
};

// All products of the sun with up to three of the reflectances.
std::vector<std::vector<Curve>> products_of(const World& w) {
  std::vector<std::vector<Curve>> all{{w.sun}};
  const size_t n = w.reflectance.size();
  for (size_t i = 0; i < n; ++i) {
    all.push_back({w.sun, w.reflectance[i]});
    for (size_t j = i; j < n; ++j) {
      all.push_back({w.sun, w.reflectance[i], w.reflectance[j]});
      for (size_t k = j; k < n; ++k) all.push_back({w.sun, w.reflectance[i], w.reflectance[j], w.reflectance[k]});
    }
  }
  return all;
}

// Squares side by side, one a reflectance, seen from above under a sun in the zenith.
struct Seen {
  std::shared_ptr<Scene> scene;
  SourceSpecs sources;
  std::vector<Ray> rays;
};
Seen seen(const World& w) {
  Seen s;
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  for (uint32_t i = 0; i < w.reflectance.size(); ++i) {
    const double x = 3.0 * i;
    meshes.push_back(test::mesh_of({{x, 0, 0}, {x + 2, 0, 0}, {x + 2, 2, 0}, {x, 2, 0}}, {0, 1, 2, 0, 2, 3}, i));
    ModelSpec model;
    model.model = "lambert";
    model.curves["reflectance"] = w.reflectance[i];
    materials.push_back(test::material(strf("m%u", i), model));
    s.rays.push_back({{x + 0.7, 0.8, 5}, {0, 0, -1}, 0});
  }
  s.scene = test::scene_of(std::move(meshes), std::move(materials));
  s.sources.add(SunSpec{{{0, 0, 1}, 0, w.sun}});
  return s;
}

// Renders and returns the largest error of a band against steps of 0.1 nm.
double rendered_error(const Seen& s, const World& w, std::unique_ptr<BinSensor> sensor) {
  const std::vector<Band> bands = hundred_bands();
  const CaptureResult r = test::render(s.scene, s.sources, std::move(sensor)).result;
  double worst = 0;
  for (size_t p = 0; p < w.reflectance.size(); ++p)
    for (size_t b = 0; b < bands.size(); ++b) {
      const double right =
          test::by_small_steps(bands[b], [&](double um) { return w.sun.at(um) * w.reflectance[p].at(um) / kPi; });
      worst = std::max(worst, std::fabs(r.radiance[p * bands.size() + b] / right - 1));
    }
  return worst;
}

void hold(const World& w) {
  const std::vector<Band> bands = hundred_bands();
  const Seen s = seen(w);
  auto even = std::make_unique<BinSensor>(s.rays, bands, 200000, 0, 0.01);
  auto sensor = std::make_unique<BinSensor>(s.rays, bands, 200000, 1e-3);
  double begun = user_seconds();
  const BinReport report = choose_bins(*s.scene, {&s.sources, 1}, *sensor).at(0);
  std::printf("%s; chosen in %.2f s of user time\n", report.text().c_str(), user_seconds() - begun);
  EXPECT_TRUE(report.met());
  EXPECT_LE(sensor->state().size(), 250u);
  double worst = 0, worst_even = 0;
  for (const std::vector<Curve>& product : products_of(w)) {
    // Three reflections that leave less than 1e-4 of the light are too dark to count.
    const double least = product.size() > 3 ? 1e-4 : 0;
    worst = std::max(worst, test::error_of(sensor->state(), bands, product, 1e-4, least));
    worst_even = std::max(worst_even, test::error_of(even->state(), bands, product));
  }
  std::printf("products of up to three reflections: %.4f %% off at most; with %zu even bins of 10 nm %.2f %%\n",
              100 * worst, even->state().size(), 100 * worst_even);
  EXPECT_LE(worst, 1e-3);
  EXPECT_GT(worst_even, 1e-2);  // negative control: the test tells good bins from bad ones
  begun = user_seconds();
  const double coarse = rendered_error(s, w, std::move(even)), after_even = user_seconds();
  const double fine = rendered_error(s, w, std::move(sensor)), after = user_seconds();
  std::printf("rendered: %.4f %% off at most in %.2f s of user time; with even bins %.2f %% in %.2f s\n", 100 * fine,
              after - after_even, 100 * coarse, after_even - begun);
  EXPECT_LE(fine, 1e-3);
  EXPECT_GT(coarse, 1e-2);
}

// A surface as a field spectrometer gives it: every nanometre, a slope, absorption of some widths, a steep edge, noise
// of a few thousandths. The shape differs with the seed.
Curve surface(uint64_t seed) {
  Pcg32 random(seed);
  struct Dip {
    double at, width, depth;
  };
  std::vector<Dip> dips;
  for (int k = 0; k < 6; ++k)
    dips.push_back({0.38 + 0.65 * random.uniform(), 0.006 + 0.05 * random.uniform(), 0.5 * random.uniform()});
  const double level = 0.05 + 0.3 * random.uniform(), edge = 0.65 + 0.1 * random.uniform(),
               rise = 0.3 * random.uniform();
  std::vector<double> um, value;
  for (int k = 350; k <= 1100; ++k) {
    const double w = 0.001 * k;
    double r = level * (0.8 + 0.3 * w) + rise / (1 + std::exp((edge - w) / 0.012));
    for (const Dip& d : dips) r *= 1 - d.depth * std::exp(-0.5 * (w - d.at) * (w - d.at) / (d.width * d.width));
    um.push_back(w), value.push_back(r * (1 + 0.003 * (2 * random.uniform() - 1)));
  }
  return Curve(um, value, Outside::error);
}

TEST(SpectralBins, HundredBandsOfSurfacesOfEveryNanometreUnderTheSunInSpace) {
  hold({solar_irradiance(), {surface(1), surface(2), surface(3)}});
}

// The oxygen band at 763 nm is in this sun.
TEST(SpectralBins, HundredBandsOfInventedSurfacesUnderTheSunOnTheGround) {
  const std::string folder = SUITE_SOURCE_DIR "/sample_scenes/calibration_range/curves/";
  World w{read_curve(folder + "sun_direct.txt", {}), {}};
  for (const char* name : {"grass.txt", "soil.txt", "forest.txt"})
    w.reflectance.push_back(read_curve(folder + name, {}));
  hold(w);
}

}  // namespace
}  // namespace suite::spectral_bins_test
