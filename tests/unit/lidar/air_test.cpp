// Real air sends light back: single scattering of molecules and aerosol against an integral over its layers, where the
// air is a field and where paths are scattered in it.
#include <gtest/gtest.h>

#include "air/column.h"
#include "air/discrete_ordinates.h"
#include "tests/support/lidar_kit.h"

namespace suite::test::air_test {
namespace {

AirSpec haze() {
  AirSpec air;
  air.profile = standard_profile("us_standard");
  air.aerosol = AirSpec::Aerosol{};
  air.aerosol->profile = air.aerosol->profile.with_depth(0.2);
  return air;
}

// Of a unit energy and aperture: integral of beta exp(-2 tau) / R^2 over ranges from low to high (m), straight down
// from a height.
double backscattered(const AirSpec& air, double um, double height, double low, double high) {
  const Band line[] = {Band::rectangular("line", um, 1e-4)};
  const SpectralState state = make_state(line, 2e-4, um, 1);
  const AirColumn column = bake_column(air, state);
  const std::span<const double> heights = column.shells.heights();
  std::vector<double> beta(column.layers(), 0);
  for (const auto& kind : column.kinds) {
    float back = 0;
    kind.phase->eval(-1, {&back, 1});
    for (size_t l = 0; l < beta.size(); ++l) beta[l] += double{kind.scattering[l]} * double{back};
  }
  double tau = 0, sum = 0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double R = high * (i + 0.5) / n, z = height - R;
    const size_t layer = column.shells.layer_of(z);
    const double step = high / n, extinction = layer < beta.size() ? double{column.extinction[layer]} : 0;
    tau += extinction * step / 2;
    if (R > low && layer < beta.size()) sum += beta[layer] * std::exp(-2 * tau) / (R * R) * step;
    tau += extinction * step / 2;
  }
  return sum;
}

TEST(LidarAir, MoleculesAndAerosolSendLightBack) {
  const double height = 10e3, um = 0.532, low = 2000, high = 9000;
  const auto black = scene_of({quad(1e4, 0, 0)}, {material("black", lambert(0))});
  for (const AirScattering scattering : {AirScattering::diffuse, AirScattering::traced}) {
    AirSpec air = haze();
    air.scattering = scattering;
    SourceSpecs sources;
    sources.air = std::make_shared<const AirSpec>(air);
    DownLidar lidar(height, 16);
    lidar.train->like.wavelength_um = um;
    lidar.laser.beam.full_angle_1_e2 = 2e-4;
    lidar.receiver.field_of_view = 1e-3;
    lidar.gate_of(low, high, 1e-7);
    lidar.orders = 1;
    const Received got = receive(black, lidar, sources);
    const double expected = lidar.photons() * kPi * 0.01 / 4 * backscattered(air, um, height, low, high);
    const RunningStats rows = got.rows();
    EXPECT_NEAR(rows.mean(), expected, 4 * rows.stderr_of_mean() + 2e-3 * expected) << static_cast<int>(scattering);
    EXPECT_LT(rows.stderr_of_mean(), 2e-3 * expected);
    // Every bin has its error: 15 m of thin air to some percent a pulse.
    const ResponseRow row(got.head, got.blocks.at(0), 0);
    EXPECT_GT(row.size(), 0.95 * got.head.bins);
    double worst = 0;
    for (size_t k = 1; k + 1 < row.size(); ++k)
      worst = std::max(worst, std::sqrt(row.photon_variance(k)) / row.photons(k));
    EXPECT_LT(worst, 0.5);
  }
}

// What a surface returns is left exp(-2 tau).
TEST(LidarAir, AirWeakensWhatSurfacesReturn) {
  const double height = 1000, um = 0.532;
  AirSpec air = haze();
  SourceSpecs sources;
  sources.air = std::make_shared<const AirSpec>(air);
  DownLidar lidar(height, 16);
  lidar.train->like.wavelength_um = um;
  lidar.laser.beam.full_angle_1_e2 = 2e-4;
  lidar.receiver.field_of_view = 1e-3;
  lidar.gate_of(height - 1, height + 1, 1e-9);
  lidar.orders = 1;
  const auto plate = scene_of({quad(1e4, 0, 0)}, {material("plate", lambert(0.3))});
  const Received got = receive(plate, lidar, sources);
  const Band line[] = {Band::rectangular("line", um, 1e-4)};
  const AirColumn column = bake_column(air, make_state(line, 2e-4, um, 1));
  double tau = 0;
  for (int i = 0; i < 1000; ++i) tau += double{column.extinction[column.shells.layer_of(i + 0.5)]};
  const double expected = lidar.photons() * 0.3 / kPi / 1e6 * kPi * 0.01 / 4 * std::exp(-2 * tau);
  EXPECT_NEAR(got.rows().mean(), expected, 2e-3 * expected);
}

}  // namespace
}  // namespace suite::test::air_test
