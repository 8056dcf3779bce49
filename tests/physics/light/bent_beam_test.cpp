// Beams that are bent in round air: twilight and the low sun in renders, against quadratures of n r sin(theta) that
// share nothing with the tables but the layers; and what a flat Earth refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "air/molecules.h"
#include "air/refraction.h"
#include "light/stratified_air.h"
#include "support/bent_rays.h"
#include "support/message_of.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::bent_beam_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

AirSpec bent_air() {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.scattering = AirScattering::single;
  air.refraction = true;
  return air;
}

std::vector<Band> bands_at(const std::vector<double>& centers_um) {
  std::vector<Band> bands;
  for (const double c : centers_um) bands.push_back(Band::rectangular("b", c, 0.004));
  return bands;
}

// What one ray sees in the light of a sun, per band.
std::vector<double> seen(const AirSpec& air, const std::vector<Band>& bands, double sun_zenith_deg, const Ray& ray,
                         double albedo = 0, uint32_t paths = 1) {
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(sun_zenith_deg * kDegree, 0.3), 0, Curve::constant(1)}});
  const auto scene = scene_of({quad(1, 0, 0)}, {material("ground", lambert(albedo))});
  return render(scene, sources, std::make_unique<RaySensor>(std::vector<Ray>{ray}, bands, paths, 0.01)).result.radiance;
}

// Sunlight that the air straight above scatters once towards the ground, per bin; all of the extinction scatters, as
// molecules do. spread: with the rays' distance from each other, which refraction widens.
std::vector<double> zenith_sky(const Bent& air, size_t bins, double sun_zenith, bool spread) {
  static constexpr double node[] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526},
                          weight[] = {0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  std::vector<double> sky(bins), below(bins);
  const double shadow = [&] {
    double dark = 0, lit = air.heights().back();
    for (int i = 0; i < 50; ++i) (air.lowest(0.5 * (dark + lit), sun_zenith) < 0 ? dark : lit) = 0.5 * (dark + lit);
    return lit;
  }();
  for (size_t l = 0; l + 1 < air.heights().size(); ++l) {
    const double low = air.heights()[l], a = std::max(low, shadow), b = air.heights()[l + 1];
    for (int i = 0; a < b && i < 4; ++i) {
      const double h = 0.5 * (a + b) + 0.5 * (b - a) * node[i], t = air.lowest(h, sun_zenith);
      const Bent::Sums sums = air.along(t, h, bins);
      double wide = 1;
      if (spread) {
        // d(apparent)/d(true) zenith angle, times the ratio of their sines.
        const auto apparent = [&](double x) { return kPi - std::asin(air.at(x).nr / air.at(h).nr); };
        const double t2 = t + 1e-3 * (h - t);
        wide = (apparent(t2) - apparent(t)) / (air.zenith(t2, h) - air.zenith(t, h)) * std::sin(apparent(t)) /
               std::sin(sun_zenith);
      }
      for (size_t bin = 0; bin < bins; ++bin) {
        const double k = air.extinction(bin, l);
        sky[bin] += 0.5 * (b - a) * weight[i] * wide * k * rayleigh_phase(std::cos(sun_zenith)) *
                    std::exp(-sums.depth[bin] - below[bin] - k * (h - low));
      }
    }
    for (size_t bin = 0; bin < bins; ++bin) below[bin] += air.extinction(bin, l) * (b - low);
  }
  return sky;
}

// Dense air (0.36 um: a depth of 0.6, of 45 at the horizon) to thin air, in which all of the shadow's edge is seen.
struct Twilight {
  double zenith_deg;
  double bound, straight;  // of bent beams and, by twice as thick layers, of straight ones
};
class BentTwilight : public testing::TestWithParam<Twilight> {};
TEST_P(BentTwilight, InTheZenith) {
  const Twilight& c = GetParam();
  const std::vector<Band> bands = bands_at({0.36, 0.45, 0.55, 0.7, 1.0, 1.6});
  const SpectralState state = make_state(bands, 1);
  AirSpec air = bent_air();
  AirSpec straight_air = air;
  straight_air.refraction = false;
  const Bent bent = bent_of(air, state), straight = bent_of(straight_air, state, true);
  const Ray up{{0, 0, 0.5}, {0, 0, 1}, 0};
  const double zenith = c.zenith_deg * kDegree;
  const std::vector<double> narrow = zenith_sky(bent, state.size(), zenith, false),
                            expected = zenith_sky(bent, state.size(), zenith, true),
                            unbent = zenith_sky(straight, state.size(), zenith, false),
                            got = seen(air, bands, c.zenith_deg, up);
  const std::vector<double> got_straight = seen(straight_air, bands, c.zenith_deg, up);
  for (size_t i = 0; i < bands.size(); ++i) {
    std::printf("sun at %.0f, %.2f um: %.4g, off %+.2f %%; straight %.4g, off %+.2f %%; spreading: %+.1f %%\n",
                c.zenith_deg, bands[i].center_um, got[i], 100 * (got[i] / expected[i] - 1), got_straight[i],
                100 * (got_straight[i] / unbent[i] - 1), 100 * (expected[i] / narrow[i] - 1));
    EXPECT_NEAR(got[i] / expected[i], 1, c.bound) << bands[i].center_um;
    EXPECT_NEAR(got_straight[i] / unbent[i], 1, c.straight) << bands[i].center_um;
    // Controls: straight beams, and bent ones that are not spread.
    EXPECT_GT(std::fabs(got_straight[i] / expected[i] - 1), i > 0 ? c.bound : 0);
    EXPECT_GT(std::fabs(got[i] / narrow[i] - 1), 2 * c.bound);
  }
}
INSTANTIATE_TEST_SUITE_P(Suns, BentTwilight, testing::Values(Twilight{92, 0.005, 0.01}, Twilight{94, 0.01, 0.03}));

// All orders, with the field of a flat Earth: no less than once, and night after it.
TEST(BentBeam, TwilightOfTheDiffuseField) {
  const std::vector<Band> bands = bands_at({0.6});
  AirSpec air = bent_air();
  const Ray up{{0, 0, 0.5}, {0, 0, 1}, 0};
  const std::vector<double> once = seen(air, bands, 92, up);
  air.scattering = AirScattering::diffuse;
  const std::vector<double> often = seen(air, bands, 92, up), night = seen(air, bands, 103, up);
  for (size_t i = 0; i < bands.size(); ++i) {
    EXPECT_GT(often[i], once[i]);
    EXPECT_LT(often[i], 5 * once[i]);
    EXPECT_LT(night[i], 1e-6 * once[i]);
  }
}

// Absorbs as there are molecules, and scatters nothing.
class Grey final : public GasProvider {
 public:
  explicit Grey(double section) : section_(section) {}
  double low_um() const override { return 0.1; }
  double high_um() const override { return 100; }
  std::string note() const override { return "grey"; }
  std::vector<Band> bands(double low_cm, double high_cm) const override { return {{low_cm, high_cm, 0}}; }
  std::vector<GasPoints> absorbers(const Band&, std::span<const AirLevel> levels) const override {
    GasPoints p{{1}, {}};
    for (const AirLevel& l : levels) p.absorption.push_back(static_cast<float>(section_ * l.density()));
    return {p};
  }

 private:
  double section_;
};

// A level ground under a low sun, and the sun's disk in the sky, by air masses of bent rays through air that thins out
// exponentially between its levels (air/refraction.h).
TEST(BentBeam, SurfacesInTheLowSun) {
  AirSpec air = bent_air();
  air.molecules = false;
  const std::vector<AirLevel> levels = air_levels(air);
  std::vector<double> heights, density;
  for (const AirLevel& l : levels) heights.push_back(l.height), density.push_back(l.density());
  double column = 0;
  for (size_t l = 0; l + 1 < levels.size(); ++l)
    column += (density[l] - density[l + 1]) / std::log(density[l] / density[l + 1]) * (heights[l + 1] - heights[l]);
  constexpr double kDepth = 0.1;
  air.gases = std::make_shared<Grey>(kDepth / column);
  const Refraction rays(kBentRadius, heights, density,
                        refractivity(0.55, levels[0].pressure, levels[0].temperature) / density[0]);
  const std::vector<Band> bands = bands_at({0.55});
  constexpr double zenith_deg = 88;
  const double zenith = zenith_deg * kDegree;
  const auto apparent = rays.apparent_zenith(0, zenith);
  ASSERT_TRUE(apparent);
  const double left = std::exp(-kDepth * rays.ray(0, *apparent)->air_mass);
  const Ray down{{0, 0, 1}, {0, 0, -1}, 0};
  const double ground = seen(air, bands, zenith_deg, down, 0.5, 16)[0] / (0.5 * std::cos(zenith) / kPi);
  // The air's own transmittance on the metre of sight is 1 - 1e-5.
  EXPECT_NEAR(ground / left, 1, 0.005);
  // A disk of 0.2 degrees is seen where it truly stands, and as bright.
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  const Dir to_sun = dir_from_angles(zenith, 0.3);
  sources.add(SunSpec{{to_sun, 0.1 * kDegree, Curve::constant(1)}});
  const auto scene = scene_of({quad(1, -10, 0)}, {material("ground", lambert(0))});
  const std::vector<Ray> towards{{{0, 0, 0}, to_sun, 0}};
  const double disk = render(scene, sources, std::make_unique<RaySensor>(towards, bands, 1, 0.01)).result.radiance[0];
  const double solid = kPi * std::pow(std::sin(0.1 * kDegree), 2);
  EXPECT_NEAR(disk * solid / left, 1, 0.005);
  // Straight beams have more air before them.
  AirSpec straight = air;
  straight.refraction = false;
  const double less = seen(straight, bands, zenith_deg, down, 0.5, 16)[0] / (0.5 * std::cos(zenith) / kPi);
  EXPECT_LT(less, 0.95 * left);
}

TEST(BentBeam, ASunBelowTheHorizonNeedsARoundEarth) {
  const Ray up{{0, 0, 0.5}, {0, 0, 1}, 0};
  AirSpec air = bent_air();
  air.where.file = "sim.yaml", air.where.line = 4, air.where.column = 3;
  air.round = false;
  EXPECT_THAT(message_of([&] { seen(air, bands_at({0.55}), 60, up); }), StartsWith("sim.yaml:4:3"));
  air.refraction = false;
  EXPECT_THAT(message_of([&] { seen(air, bands_at({0.55}), 92, up); }),
              testing::AllOf(StartsWith("sim.yaml:4:3"), HasSubstr("2 degrees below the horizon")));
  EXPECT_GT(seen(air, bands_at({0.55}), 89, up)[0], 0);
}

}  // namespace
}  // namespace suite::test::bent_beam_test
