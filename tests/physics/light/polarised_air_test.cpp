// Polarised light along ways through real air, beside the vector field of the same layers by itself.
#include "light/polarised_air.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "air/phase_grid.h"
#include "air/spheres.h"
#include "air/stokes_field.h"
#include "light/stratified_air.h"

namespace suite::polarised_air_test {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity(), kSunAzimuth = 0.3, kGround = 0.2;

struct Case {
  AirSpec air;
  SpectralState state;
  double sun_zenith_deg = 60;
};
Case clear(double um) {
  Case c;
  c.air.profile = standard_profile("us_standard");
  c.air.round = false;
  c.air.ground_albedo = Curve::constant(kGround);
  c.state = make_state(std::vector<Band>{Band::rectangular("b", um, 0.01)}, 1);
  return c;
}

// The layers of the air, flat, as the vector field takes them; the whole matrices for single scattering.
struct Field {
  std::shared_ptr<const AirColumn> column;
  std::vector<GreekMatrix> matrices;
  std::vector<StokesAirLayer> layers;
  Dir sun;
  explicit Field(const Case& c)
      : column(std::make_shared<const AirColumn>(bake_column(c.air, c.state))),
        sun(dir_from_angles(c.sun_zenith_deg * kDegree, kSunAzimuth)) {
    for (size_t l = column->layers(); l-- > 0;) {
      const double k = double{column->extinction[l]};
      double scattering = 0;
      for (const AirColumn::Kind& kind : column->kinds) scattering += double{kind.scattering[l]};
      GreekMatrix& m = matrices.emplace_back();
      for (const AirColumn::Kind& kind : column->kinds) m.add(series_of(kind), double{kind.scattering[l]} / scattering);
      layers.push_back({k * (column->shells.heights()[l + 1] - column->shells.heights()[l]),
                        std::min(1.0, scattering / k), nullptr});
    }
    for (size_t n = 0; n < layers.size(); ++n) layers[n].matrix = &matrices[n];
  }
  bool molecules(const AirColumn::Kind& kind) const { return &kind == column->kinds.data(); }
  // 1/sr.
  PlaneBlocks matrix_of(const AirColumn::Kind& kind, double cosine) const {
    if (molecules(kind)) return GreekMatrix::rayleigh(0.0279).at(cosine) * (1 / (4 * kPi));
    PlaneBlocks m[1];
    float phase[1];
    kind.phase->eval(cosine, phase);
    if (kind.phase->polarised(cosine, m).unknown > 0) m[0] = {1, 0, 0, 0, 0, 0};
    return m[0] * double{phase[0]};
  }
  GreekMatrix series_of(const AirColumn::Kind& kind) const {
    if (molecules(kind)) return GreekMatrix::rayleigh(0.0279);
    std::vector<PlaneBlocks> blocks;
    for (const double c : phase_cosines()) blocks.push_back(matrix_of(kind, c));
    return GreekMatrix::tabulated(phase_cosines(), blocks, 40);
  }
  // With the views of |cosine|.
  StokesField solved(double cosine) const {
    StokesProblem p;
    p.layers = layers;
    p.beam.irradiance = 1, p.beam.cosine = sun.z, p.ground_albedo = kGround;
    StokesField field(StokesField::Light::circular, 16, {cosine});
    field.solve(p);
    return field;
  }
  // Light that comes from d: at the ground, or leaving the air.
  Stokes seen(const StokesField& field, Dir d) const {
    std::vector<Stokes> single;
    for (size_t l = column->layers(); l-- > 0;) {
      PlaneBlocks sum{0, 0, 0, 0, 0, 0};
      double all = 0;
      for (const AirColumn::Kind& kind : column->kinds) {
        const double s = double{kind.scattering[l]};
        sum = sum + matrix_of(kind, dot(d, sun)) * s, all += s;
      }
      single.push_back(scattered_once(sum * (1 / all), -d, -sun));
    }
    const double turn = azimuth(-d) - azimuth(-sun);
    return d.z > 0 ? field.radiance(static_cast<int>(layers.size()), 0, StokesField::Way::down, turn, single)
                   : field.radiance(0, 0, StokesField::Way::up, turn, single);
  }
};

// The largest differences over I: of I, Q and U; and of V, where the largest is told as well.
struct Worst {
  double linear = 0, v = 0, most_v = 0;
};
// scalar: of the scalar I alone.
Worst compare(const Case& c, double& scalar) {
  const Field field(c);
  std::vector<float> sun(1, 1.0f), T(1), S(1), I(1), Q(1), U(1), V(1);
  const auto air = make_stratified_air(c.air, field.column, c.state, {{field.sun, sun.data()}});
  const PolarisedAir* const knows = air->polarisation(StokesParts::all);
  EXPECT_NE(knows, nullptr);
  EXPECT_TRUE(knows->tells_v());
  Worst worst;
  for (const double zenith_deg : {0.5, 80.0, 110.0, 152.0}) {
    const StokesField solved = field.solved(std::fabs(std::cos(zenith_deg * kDegree)));
    const double ground = solved.fluxes(static_cast<int>(field.layers.size())).up / kPi;
    for (const double around : {0.4, 1.7, 3.3, 5.5}) {
      const Dir d = dir_from_angles(zenith_deg * kDegree, kSunAzimuth + around);
      const bool up = d.z > 0;
      const Vec3 from = up ? Vec3{0, 0, 0} : d * (1.2e5 / d.z);
      const double distance = up ? kFar : length(from);
      air->path(from, d, distance, T, S);
      knows->along(from, d, distance, {I, Q, U, V});
      const Stokes want = field.seen(solved, d);
      // What comes through from the ground is none of the air's.
      const double shown = double{S[0]} + (up ? 0 : ground * double{T[0]});
      const double got[3] = {shown + double{I[0]}, double{Q[0]}, double{U[0]}};
      for (size_t k = 0; k < 3; ++k) worst.linear = std::max(worst.linear, std::fabs(got[k] - want[k]) / want[0]);
      worst.v = std::max(worst.v, std::fabs(double{V[0]} - want[3]) / want[0]);
      worst.most_v = std::max(worst.most_v, std::fabs(want[3]) / want[0]);
      scalar = std::max(scalar, std::fabs(shown - want[0]) / want[0]);
    }
  }
  std::printf("I, Q and U within %.4f of I, V within %.2g of I where it is up to %.2g\n", worst.linear, worst.v,
              worst.most_v);
  return worst;
}

// Tables between cosines and heights against the solver at the very directions.
TEST(PolarisedAir, WaysAreThoseOfTheVectorField) {
  double scalar = 0;
  EXPECT_LT(compare(clear(0.40), scalar).linear, 0.002);
  EXPECT_GT(scalar, 0.04);  // control: what the scalar field is off
}
// With particles, whose forward peaks the solver cuts off.
TEST(PolarisedAir, WaysThroughHazeAreThoseOfTheVectorField) {
  Case hazy = clear(0.45);
  hazy.air.aerosol = AirSpec::Aerosol{};
  hazy.air.aerosol->profile = hazy.air.aerosol->profile.with_depth(0.3);
  double scalar = 0;
  EXPECT_LT(compare(hazy, scalar).linear, 0.005);
  // Small spheres without absorption, which polarise and turn more.
  hazy.air.aerosol->boundary.spheres = std::make_shared<const SphereSpec>(
      SphereSpec{SizeDistribution::log_normal(0.1, 1.6), Curve::constant(1.45), Curve::constant(0)});
  hazy.air.aerosol->one_kind = true;
  const Worst spheres = compare(hazy, scalar);
  EXPECT_LT(spheres.linear, 0.005);
  EXPECT_LT(spheres.v, 0.2 * spheres.most_v);
}

// Tables that no machine should be asked for are refused before memory is.
TEST(PolarisedAir, TablesHaveABound) {
  const std::vector<double> cosines{-1, 0, 1};
  EXPECT_NO_THROW(PolarisedSource({50, 10, 2, 3, cosines}));
  EXPECT_THROW(PolarisedSource({50, 10'000'000, 2, 3, cosines}), Error);
  EXPECT_THROW(PolarisedSource({50, size_t{1} << 40, 2, 3, cosines}), Error);
}

}  // namespace
}  // namespace suite::polarised_air_test
