// Light that is scattered more than once into a level way of 1 km near the ground: the field against air that is
// traced, and beside both what MODTRAN's two streams say.
//
// MODTRAN 5.2 (path1000 of ComputationalRadiometry, MPL-2.0; tropical air, rural particles, 23 km, black ground, Sun at
// 24.2 degrees, scattered by 112 degrees; no DISORT, thus the two streams of Isaacs et al., Appl. Opt. 26, 1987) agrees
// in what is scattered once and has about twice the rest. That solver is known as the less accurate one of MODTRAN's
// (ALG 2.0, Zenodo 3555575, "NSTR"), and its multiple scattering did not vary with the azimuth of the view (Acharya et
// al., "MODTRAN4: multiple scattering and BRDF upgrades", Proc. SPIE 3756, 1999); no published figure for this geometry
// is known to us. Traced air decides.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "air/air_spec.h"
#include "tests/support/radiometry_kit.h"

namespace suite::test::air_horizon_test {
namespace {

// Means over 20 cm-1 of tape7 where gases hardly absorb (12740 cm-1), W/(m2 sr um).
constexpr double kMicron = 1e4 / 12740, kIrradiance = 1228.0, kModtranSingle = 1.343, kModtranMultiple = 2.835;

struct Seen {
  double radiance, error;
};
Seen see(AirScattering scattering, uint32_t paths) {
  AirSpec air;
  air.profile = standard_profile("tropical");
  air.aerosol = AirSpec::Aerosol{};
  air.ground_albedo = Curve::constant(0);
  air.adjacency = false;
  air.scattering = scattering;
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  sources.add(SunSpec{{dir_from_angles(24.2 * kDegree, 162.84 * kDegree), 0, Curve::constant(kIrradiance)}});
  const Dir d = dir_from_angles(89 * kDegree, 0);
  const Vec3 from{0, 0, 0.5}, end = from + d * 1000.0;
  const auto scene =
      scene_of({mesh_of({end + Vec3{0, -1, -1}, end + Vec3{0, 1, -1}, end + Vec3{0, 1, 1}, end + Vec3{0, -1, 1}},
                        {0, 1, 2, 0, 2, 3}, 0),
                quad(1e5, 0, 0)},
               {material("black", lambert(0))});
  const std::vector<Band> bands{Band::rectangular("window", kMicron, 20 * kMicron * kMicron * 1e-4)};
  const CaptureResult r =
      render(scene, sources, std::make_unique<RaySensor>(std::vector<Ray>{{from, d, 0}}, bands, paths, 0.02)).result;
  return {r.radiance[0], r.standard_error[0]};
}

TEST(AirHorizon, TracedAirDecidesBetweenTheFieldAndTwoStreams) {
  const Seen once = see(AirScattering::single, 64), field = see(AirScattering::diffuse, 64),
             traced = see(AirScattering::traced, 200000);
  const double modtran = kModtranSingle + kModtranMultiple;
  std::printf("scattered once: %.3f, MODTRAN %.3f\n", once.radiance, kModtranSingle);
  std::printf("more often: field %.3f, traced %.3f +- %.3f, MODTRAN's two streams %.3f\n",
              field.radiance - once.radiance, traced.radiance - once.radiance, traced.error, kModtranMultiple);
  EXPECT_NEAR(once.radiance, kModtranSingle, 0.1 * kModtranSingle);
  EXPECT_LT(traced.error, 0.02 * traced.radiance);
  EXPECT_LT(std::fabs(field.radiance - traced.radiance), 3 * traced.error + 0.005 * traced.radiance);
  EXPECT_GT(std::fabs(modtran - traced.radiance), 10 * traced.error) << "control";
}

}  // namespace
}  // namespace suite::test::air_horizon_test
