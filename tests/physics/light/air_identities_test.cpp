// What real air must keep, whatever its numbers: very short and very long ways, hardly any air, reciprocity, energy.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "air/column.h"
#include "air/diffuse_field.h"
#include "light/stratified_air.h"
#include "spectral/planck.h"

namespace suite::air_identities_test {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

AirSpec full_air() {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.gases = shared_builtin_gases();
  air.aerosol = AirSpec::Aerosol{};
  air.scattering = AirScattering::single;
  return air;
}
SpectralState wide_state(const AirSpec& air) {
  std::vector<Band> bands;
  for (const double um : {0.45, 0.762, 2.7, 4.3, 10.5, 15.0}) bands.push_back(Band::rectangular("b", um, 0.01));
  return with_gas_points(air, make_state(bands, 1));
}

struct Seen {
  std::vector<float> T, S;
};
Seen look(const Atmosphere& air, size_t bins, Vec3 from, Dir d, double distance) {
  Seen seen{std::vector<float>(bins), std::vector<float>(bins)};
  air.path(from, d, distance, seen.T, seen.S);
  return seen;
}

struct Lit {
  explicit Lit(const AirSpec& air, double sun_zenith_deg = 50)
      : state(wide_state(air)),
        spectrum(state.size(), 1.0f),
        made(make_stratified_air(air, state, {{dir_from_angles(sun_zenith_deg * kDegree, 0.3), spectrum.data()}})) {}
  SpectralState state;
  std::vector<float> spectrum;
  std::unique_ptr<const Atmosphere> made;
};

// A millimetre: what it sends grows with its length, and 1 - T is the depth.
TEST(AirIdentities, AMillimetreOfAir) {
  const Lit air(full_air());
  for (const Vec3 from : {Vec3{0, 0, 0}, Vec3{100, -50, 249.98}, Vec3{0, 0, 9100}})
    for (const Dir d : {Dir{0, 0, 1}, dir_from_angles(90 * kDegree, 1), Dir{0, 0, -1}}) {
      const Seen one = look(*air.made, air.state.size(), from, d, 1e-3),
                 ten = look(*air.made, air.state.size(), from, d, 1e-2);
      for (size_t i = 0; i < air.state.size(); ++i) {
        const double k = air.made->extinction(air.made->shells().layer_of(from.z))[i];
        EXPECT_NEAR(one.T[i], std::exp(-1e-3 * k), 1e-4 * k * 1e-3 + 1.2e-7);
        EXPECT_NEAR(ten.S[i] / one.S[i], 10, 10 * (1e-5 + 5e-3 * k + 1e-4)) << air.state.bins[i].center_um();
        EXPECT_GT(one.S[i], 0);
      }
    }
}

// A million kilometres: no more than to the outside; along flat layers, too.
TEST(AirIdentities, AMillionKilometres) {
  for (const bool round : {true, false}) {
    AirSpec spec = full_air();
    spec.round = round;
    const Lit air(spec);
    for (const double zenith : {0.0, 80.0, 89.9, 90.0}) {
      const Dir d = dir_from_angles(zenith * kDegree, 1);
      const Seen far = look(*air.made, air.state.size(), {0, 0, 2000}, d, 1e9),
                 out = look(*air.made, air.state.size(), {0, 0, 2000}, d, kFar);
      for (size_t i = 0; i < air.state.size(); ++i) {
        EXPECT_TRUE(std::isfinite(far.S[i])) << zenith;
        EXPECT_NEAR(far.T[i], out.T[i], 1e-6 * out.T[i]) << zenith;
        EXPECT_NEAR(far.S[i], out.S[i], 1e-6 * out.S[i]) << zenith;
      }
      // And back from there.
      const Vec3 place{0, 0, 2000};
      const Seen back = look(*air.made, air.state.size(), place + d * 1e9, -d, 1e9);
      for (size_t i = 0; i < air.state.size(); ++i)
        EXPECT_NEAR(back.T[i], far.T[i], 1e-4 * far.T[i] + 1e-7) << zenith << (round ? " round" : " flat");
    }
  }
}

// Hardly any air: what it sends keeps all its digits where 1 - T has none left.
TEST(AirIdentities, HardlyAnyAir) {
  class Thin final : public GasProvider {
   public:
    explicit Thin(double absorption) : absorption_(absorption) {}
    double low_um() const override { return 0.1; }
    double high_um() const override { return 100; }
    std::string note() const override { return "thin"; }
    std::vector<Band> bands(double low_cm, double high_cm) const override { return {{low_cm, high_cm, 0}}; }
    std::vector<GasPoints> absorbers(const Band&, std::span<const AirLevel> levels) const override {
      return {{{1}, std::vector<float>(levels.size(), static_cast<float>(absorption_))}};
    }

   private:
    double absorption_;
  };
  AirSpec air;
  air.profile = standard_profile("us_standard");
  for (AirLevel& l : air.profile.levels) l.temperature = 280;
  air.molecules = false;
  air.scattering = AirScattering::single;
  for (const double depth : {1e-6, 1e-9, 1e-12}) {
    air.gases = std::make_shared<Thin>(depth / 120e3);
    const SpectralState state =
        with_gas_points(air, make_state(std::vector<Band>{Band::rectangular("b", 10, 0.01)}, 1));
    const Bin& b = state.bins[0];
    const double planck = planck_band_radiance(b.low_um, b.high_um, 280) / (b.high_um - b.low_um);
    const auto made = make_stratified_air(air, state, {});
    const Seen up = look(*made, 1, {0, 0, 0}, {0, 0, 1}, kFar), down = look(*made, 1, {0, 0, 120e3}, {0, 0, -1}, 120e3);
    EXPECT_NEAR(up.S[0] / (depth * (1 - depth / 2) * planck), 1, 1e-6) << depth;
    EXPECT_NEAR(down.S[0] / (depth * (1 - depth / 2) * planck), 1, 1e-6) << depth;
  }
}

// Light passes a way as well there as back.
TEST(AirIdentities, TransmittanceIsReciprocal) {
  const Lit air(full_air());
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<float> there(air.state.size()), back(air.state.size());
  for (int n = 0; n < 300; ++n) {
    const auto place = [&] { return Vec3{4e4 * u(random), 4e4 * u(random), 30 + 3e4 * std::pow(u(random), 3)}; };
    const Vec3 a = place(), b = place();
    const double distance = length(b - a);
    const Dir d = (b - a) / distance;
    air.made->transmittance(a, d, distance, there);
    air.made->transmittance(b, -d, distance, back);
    for (size_t i = 0; i < there.size(); ++i)
      // A float's rounding of the depth, and what is left of positions.
      EXPECT_NEAR(back[i], there[i], there[i] * 2e-5 + 1e-9) << air.state.bins[i].center_um();
  }
}

// Nothing is absorbed, and the ground keeps nothing: what comes in leaves again. Over a round Earth that holds for all
// of it together; of a place it holds as far as the air in the height, which lies over more ground and sees more of a
// low sun, does not matter: 0.4 % at 60 degrees, 1 % at 70, more below.
TEST(AirIdentities, WhiteGroundsAndAirKeepAllEnergy) {
  for (const bool round : {false, true})
    for (const double zenith_deg : {10.0, 60.0, 70.0, 80.0, 85.0, 88.0}) {
      if (round && zenith_deg > 70) continue;
      AirSpec air;
      air.profile = standard_profile("us_standard");
      air.round = round;
      air.ground_albedo = Curve::constant(1);
      std::vector<Band> bands;
      for (const double um : {0.32, 0.45, 0.8}) bands.push_back(Band::rectangular("b", um, 0.01));
      const SpectralState state = make_state(bands, 1);
      const std::vector<float> spectrum(state.size(), 1.0f);
      const AirColumn column = bake_column(air, state);
      const BeamTable table = bake_beam_table(air, column);
      const AirBeam beam{dir_from_angles(zenith_deg * kDegree, 0.3), spectrum.data()};
      DiffuseReport report;
      solve_diffuse_field(air, column, state, {&beam, 1}, {&table, 1}, &report);
      for (size_t i = 0; i < state.size(); ++i) {
        const double in = std::cos(zenith_deg * kDegree);
        EXPECT_NEAR(report.direct[i] + report.down[i], report.up[i], 1e-4 * report.up[i]);
        const double most = !round ? 1e-4 : zenith_deg > 60 ? 0.011 : zenith_deg > 10 ? 0.006 : 0.0015;
        EXPECT_NEAR(report.top_up[i] / in, 1, most) << zenith_deg << " " << state.bins[i].center_um();
        std::printf("%s, sun at %2.0f, %.2f um: %.6f of the light leaves\n", round ? "round" : "flat", zenith_deg,
                    state.bins[i].center_um(), report.top_up[i] / in);
      }
    }
}

}  // namespace
}  // namespace suite::air_identities_test
