// What is told of air that is solved for an even ground: each limit where it matters and only there.
#include "scheduler/air_limits.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "air/lowtran.h"
#include "support/radiometry_kit.h"

namespace suite::air_limits_test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

struct Told {
  double half_width = 1e3, sun_zenith_deg = 30;
  Vec3 from{0, 0, 7e5};
  Dir towards{0, 0, -1};
  double um = 0.55;
  AirSpec air = {};
  std::optional<EarthSpec> earth = {};
  JobOptions job = {};
  bool smoke = false;  // a medium fills the scene

  std::vector<std::string> said() const {
    SourceSpecs sources;
    auto own = std::make_shared<AirSpec>(air);
    own->profile = standard_profile("us_standard");
    sources.air = std::move(own);
    sources.earth = earth;
    sources.add(SunSpec{{dir_from_angles(sun_zenith_deg * kDegree, 0), 0, Curve::constant(1)}});
    auto scene = test::scene_of({test::quad(half_width, 0, 0)}, {test::material("grey", test::lambert(0.5))});
    scene->bounds = scene_bounds(*scene);
    if (smoke) scene->media.emplace_back();
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(std::make_unique<test::RaySensor>(std::vector<Ray>{{from, towards, 0}},
                                                        std::vector<Band>{Band::rectangular("b", um, 0.01)}, 4));
    return lines_of(diagnose_air(sources, *scene, sensors, job));
  }
};

TEST(AirLimits, ShareOfTheGroundBeyond) {
  EXPECT_NEAR(share_from_beyond(0), 1, 1e-12);
  // Far out it is the mean height over the reach.
  EXPECT_NEAR(share_from_beyond(1e6), 8000 / 1e6, 0.01 * 0.008);
  EXPECT_NEAR(share_from_beyond(2e3, 1000), share_from_beyond(16e3), 1e-12);
}

TEST(AirLimits, TheGroundBeyondTheScene) {
  EXPECT_THAT(
      Told{}.said(),
      Contains(AllOf(HasSubstr("the scene, which reaches 1 km from its middle, an even ground (albedo 0.2 to 0.2) goes "
                               "on; of the light that molecules receive from the ground over the middle some 90 %"),
                     HasSubstr("[DR403]"))));
  EXPECT_THAT(Told{.half_width = 3e5}.said(), IsEmpty());
  EXPECT_THAT(Told{.earth = EarthSpec{}}.said(), IsEmpty());
  JobOptions repeated;
  repeated.periodic = Periodic{};
  EXPECT_THAT(Told{.job = repeated}.said(), IsEmpty());
  AirSpec even;
  even.adjacency = false;  // told with the sources
  EXPECT_THAT(Told{.air = even}.said(), IsEmpty());
  AirSpec traced;
  traced.scattering = AirScattering::traced;
  EXPECT_THAT((Told{.half_width = 3e5, .sun_zenith_deg = 80, .air = traced}).said(), IsEmpty());
  EXPECT_THAT((Told{.air = traced, .earth = EarthSpec{}}).said(), IsEmpty());
  EXPECT_THAT(Told{.air = traced}.said(),
              Contains(AllOf(HasSubstr("nothing ends the lowest air"), HasSubstr("[DR402]"))));
}

TEST(AirLimits, ViewsFromWithinHaze) {
  AirSpec hazy;
  hazy.aerosol = AirSpec::Aerosol{};
  const auto said = [&](double height, double um) {
    return Told{.half_width = 3e5, .from = {0, 0, height}, .um = um, .air = hazy}.said();
  };
  EXPECT_THAT(said(2, 0.55), Contains(AllOf(HasSubstr("'rays' look from within haze of 'rural' particles"),
                                            HasSubstr("up to 37 % on level ways"), HasSubstr("[DR409]"))));
  EXPECT_THAT(said(7e5, 0.55), IsEmpty());
  EXPECT_THAT(said(2, 2.2), IsEmpty());
  hazy.aerosol->boundary.name = "desert";
  EXPECT_THAT(said(2, 0.55), IsEmpty());
}

// Runs with and without `earth`, 65536 paths for the sun at 92 degrees and 8192 else, 2 degrees over the horizon away
// from the sun or to its side, as glow_from_below says: what differed, the standard error taken off.
TEST(AirLimits, OpenAirIsNoBrighterThanReported) {
  struct Run {
    double reach, sun_deg, brighter;
  };
  for (const Run& r : {Run{2e3, 80, 0.482 - 0.028},
                       {2e3, 88, 0.472 - 0.039},
                       {2e3, 92, 0.697 - 0.109},
                       {15e3, 80, 0.133 - 0.026},
                       {15e3, 85, 0.131 - 0.034},
                       {15e3, 88, 0.148 - 0.041},
                       {15e3, 90, 0.152 - 0.062},
                       {15e3, 92, 0.172 - 0.049},
                       {50e3, 80, 0.034 - 0.023},
                       {50e3, 88, 0.063 - 0.041}}) {
    const double reported = glow_from_below(r.reach, r.sun_deg * kDegree);
    EXPECT_GT(reported, r.brighter) << r.reach << " " << r.sun_deg;
    EXPECT_LT(reported, 2.5 * r.brighter + 0.03) << "a report of any size would pass";
  }
  AirSpec traced;
  traced.scattering = AirScattering::traced;
  const auto said = [&](double sun_deg) {
    return Told{.half_width = 15e3, .sun_zenith_deg = sun_deg, .air = traced}.said();
  };
  EXPECT_THAT(said(80), Contains(HasSubstr("up to 17 % of what is seen near the horizon")));
  EXPECT_THAT(said(92), Contains(HasSubstr("up to 20 % of what is seen near the horizon")));
  EXPECT_THAT(said(80), Contains(HasSubstr("a third of that in the zenith")));
  EXPECT_THAT(said(92), Contains(HasSubstr("as much in the zenith")));
  EXPECT_THAT(said(92), Not(Contains(HasSubstr("all of it"))));
  EXPECT_THAT(said(95), Contains(HasSubstr("it may be all of it")));
}

// Shares by light/scattered_again.h, which is held to walks of photons.
TEST(AirLimits, WhatIsScatteredAgainIsToldOfTheQuickAtmosphere) {
  const auto told = [](double um, double sun_deg) {
    SourceSpecs sources;
    sources.atmosphere.emplace();
    sources.add(SunSpec{{dir_from_angles(sun_deg * kDegree, 0), 0, Curve::constant(1)}});
    auto scene = test::scene_of({test::quad(1e3, 0, 0)}, {test::material("grey", test::lambert(0.5))});
    std::vector<std::unique_ptr<Sensor>> sensors;
    sensors.push_back(std::make_unique<test::RaySensor>(std::vector<Ray>{{{0, 0, 7e5}, {0, 0, -1}, 0}},
                                                        std::vector<Band>{Band::rectangular("b", um, 0.01)}, 4));
    return lines_of(diagnose_air(sources, *scene, sensors, {}));
  };
  EXPECT_THAT(told(0.45, 30), Contains(AllOf(HasSubstr("sensor 'rays' lacks what is scattered again"),
                                             HasSubstr("20 % of band 'b' over a black ground"), HasSubstr("[DR408]"))));
  EXPECT_THAT(told(2.2, 30), IsEmpty());   // less than 1 %
  EXPECT_THAT(told(0.45, 95), IsEmpty());  // the sun has set
}

TEST(AirLimits, EstimatorsThatDoNotGoBack) {
  JobOptions paper, blind;
  paper.pipeline.method = Method::paper, blind.pipeline.explicit_sources = false;
  for (const JobOptions& job : {paper, blind}) {
    const std::vector<std::string> said = Told{.job = job}.said();
    ASSERT_THAT(said, SizeIs(1));
    EXPECT_THAT(said[0], AllOf(HasSubstr("(adjacency) and shadows in it are left out"), HasSubstr("[DR404]")));
  }
}

// Media in the scene leave nothing of it out.
TEST(AirLimits, MediaLeaveNothingOut) {
  EXPECT_THAT((Told{.half_width = 3e5, .smoke = true}).said(), IsEmpty());
  JobOptions blind;
  blind.pipeline.explicit_sources = false;
  EXPECT_THAT((Told{.half_width = 3e5, .job = blind, .smoke = true}).said(),
              Contains(HasSubstr("[DR404]")));  // control
}

TEST(AirLimits, BandsWhereGasesAreLessSure) {
  AirSpec air;
  air.gases = shared_builtin_gases();
  const auto at = [&](double um) { return Told{.half_width = 3e5, .um = um, .air = air}.said(); };
  EXPECT_THAT(at(3.8), Contains(AllOf(HasSubstr("gases: from 3.4 to 4.15 um transmittance is off by 0.056 rms (mean "
                                                "-0.029), up to 0.16; brightness from space over a ground of 299 K"),
                                      HasSubstr("bands there: 'b' of 'rays' [DR401]"))));
  EXPECT_THAT(at(0.69), IsEmpty());
  EXPECT_THAT(at(12.6), Contains(HasSubstr("by 1.7 K rms, up to 4.3 K, on slanted paths")));
  EXPECT_THAT(at(4.7), Contains(HasSubstr("up to 0.098")));
  EXPECT_THAT(at(17), Contains(HasSubstr("carbon dioxide")));
  EXPECT_THAT(at(0.55), IsEmpty());
  EXPECT_THAT(at(11), Contains(HasSubstr("up to 0.036")));
  air.gases = {std::shared_ptr<void>(), &lowtran_gases()};
  EXPECT_THAT(at(11), Contains(HasSubstr("up to 0.067")));
  EXPECT_THAT(at(4.7), Contains(HasSubstr("`gases: builtin` has 0.028 rms")));
  air.scattering = AirScattering::single;  // whatever way light is followed
  EXPECT_THAT(at(9.6), Contains(HasSubstr("ozone")));
}

TEST(AirLimits, LowSuns) {
  const auto low = [](double zenith_deg) { return Told{.half_width = 3e5, .sun_zenith_deg = zenith_deg}.said(); };
  EXPECT_THAT(low(80), IsEmpty());
  EXPECT_THAT(low(85), Contains(HasSubstr("the sun stands up to 85 degrees from the zenith")));
  EXPECT_THAT(low(85), Contains(AllOf(HasSubstr("up to 1.6 %"), HasSubstr("[DR406]"))));
  EXPECT_THAT(low(95), Contains(HasSubstr("has not been measured")));
  AirSpec flat;
  flat.round = false;
  EXPECT_THAT((Told{.half_width = 3e5, .sun_zenith_deg = 80, .air = flat}).said(), IsEmpty());
}

TEST(AirLimits, ViewsAlongTheLimb) {
  const double radius = 6371e3, at = radius + 7e5;
  const auto towards = [&](double lowest) {  // nadir angle of a line that comes down to this height
    const double sine = (radius + lowest) / at;
    return Dir{sine, 0, -std::sqrt(1 - sine * sine)};
  };
  Told limb{.half_width = 3e5, .sun_zenith_deg = 86};
  const auto looks = Contains(AllOf(HasSubstr("sensor 'rays' looks along the limb"), HasSubstr("[DR407]")));
  for (const double lowest : {5e3, 6e4}) {
    limb.towards = towards(lowest);
    EXPECT_THAT(limb.said(), looks) << lowest;
  }
  for (const double lowest : {-1e3, 3e5}) {
    limb.towards = towards(lowest);
    EXPECT_THAT(limb.said(), Not(looks)) << lowest;
  }
  limb.towards = towards(5e3), limb.um = 10;  // the sun's light does not matter
  EXPECT_THAT(limb.said(), Not(looks));
  limb.um = 0.55, limb.sun_zenith_deg = 60;
  EXPECT_THAT(limb.said(), Not(looks));
  // From a mountain, a little down: the horizon.
  EXPECT_THAT((Told{.half_width = 3e5, .from = {0, 0, 2e3}, .towards = normalized(Vec3{1, 0, -0.001})}).said(),
              IsEmpty());
}

}  // namespace
}  // namespace suite::air_limits_test
